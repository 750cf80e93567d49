"""``--log``: what was run, with versions, settings and times, and all that was said."""

import json
import logging
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tiskel.errors import TiskelError
from tiskel.wording import printable

TOLD = ("numpy", "scipy", "taichi")  #: packages whose versions results depend on
log = logging.getLogger("tiskel")
log.addHandler(logging.NullHandler())  # or Python prints warnings on stderr a second time
log.propagate = False


def open_log(path: Path, settings: Mapping[str, Any], given_up: Any) -> None:
    """Begin an entry: the command line, versions, and every setting, defaults included, as JSON.

    Parameters
    ----------
    path : Path
        A text file; what it holds stays.
    settings : mapping
        Every option and argument of the command by name.
    given_up : callable
        Told in one line where the log can no longer be written.

    Raises
    ------
    TiskelError
        Where the file cannot be opened.
    """
    try:
        handler = _LogFile(path, encoding="utf-8", errors="backslashreplace")
    except (OSError, ValueError) as error:
        said = getattr(error, "strerror", None) or error
        raise TiskelError(f"cannot write the log {path}: {said}; name another file with --log") from None
    handler.given_up = given_up
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    log.info("%s", printable(" ".join(["tiskel", *sys.argv[1:]])))
    log.info("versions: %s", ", ".join(f"{name} {number}" for name, number in _versions().items()))
    log.info("settings: %s", printable(json.dumps(dict(settings), default=str)))


def ended(how: str, began: float) -> None:
    """Say how a command ended, and after how many seconds of the clock and of the processor."""
    if began:
        log.info("%s after %.3f s (processor: %.3f s)", how, time.perf_counter() - began, time.process_time())


def timed(seconds: Mapping[str, float]) -> None:
    """Log what the parts of a command took."""
    log.info("seconds: %s", json.dumps({part: round(value, 6) for part, value in seconds.items()}))


def _versions() -> dict[str, str]:
    import platform
    from importlib import metadata

    from tiskel import __version__

    own = {"tiskel": __version__, "python": platform.python_version()}
    return own | {name: metadata.version(name) for name in TOLD} | {"on": platform.platform(terse=True)}


class _LogFile(logging.FileHandler):
    """A log that is given up, with one warning, where it can no longer be written."""

    given_up: Any

    def handleError(self, record: logging.LogRecord) -> None:
        """Say it once, and write no more."""
        log.removeHandler(self)
        reason = getattr(sys.exc_info()[1], "strerror", None) or sys.exc_info()[1]
        self.stream = None
        self.given_up(f"the log {self.baseFilename} cannot be written: {reason}")
