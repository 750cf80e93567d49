"""Messages on stderr, and how errors leave the program."""

import contextlib
import functools
import logging
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from tiskel.errors import TiskelError
from tiskel.messages import Messages
from tiskel.wording import printable, shortened

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table


@dataclass
class Session:
    """What the options that all commands share say; set once per process by the callback of the command."""

    quiet: bool = False
    verbose: bool = False
    strict: bool = False
    warned: list[str] = field(default_factory=list)


session = Session()
log = logging.getLogger("tiskel")
log.addHandler(logging.NullHandler())  # or Python prints warnings on stderr a second time
log.propagate = False


def begin(*, threads: int | None, quiet: bool, verbose: bool, strict: bool, log_file: Path | None) -> None:
    """Take over the common options before the command does anything."""
    import os

    session.quiet, session.verbose, session.strict = quiet, verbose, strict
    session.warned.clear()
    if threads is not None:
        os.environ["TISKEL_NUM_THREADS"] = str(threads)
    if log_file is not None:
        try:
            handler = _LogFile(log_file, encoding="utf-8", errors="backslashreplace")
        except (OSError, ValueError) as error:
            said = getattr(error, "strerror", None) or error
            raise TiskelError(f"cannot write the log {log_file}: {said}; name another file with --log") from None
        handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
        log.addHandler(handler)
        log.setLevel(logging.INFO)
        log.info("%s", printable(" ".join(sys.argv[1:])))


@functools.cache
def errors() -> "Console":
    """Return the one console of stderr; Rich is imported where something is said."""
    from rich.console import Console

    return Console(stderr=True, highlight=False, soft_wrap=True)


def say(message: str) -> None:
    """Tell the user something on stderr, unless quiet."""
    log.info(printable(message))
    if not session.quiet:
        _print(message)


def fail(message: str) -> None:
    """Say why the program ends: in the log, and on stderr however quiet it is to be."""
    said = shortened(printable(message))
    log.error(said)
    with contextlib.suppress(OSError):  # nobody can be told
        errors().print(f"error: {said}", markup=False)


def _print(message: str) -> None:
    with contextlib.suppress(OSError):  # a full disk behind standard error is no reason to stop
        errors().print(printable(message), markup=False)


class _LogFile(logging.FileHandler):
    """A log that is given up, with one warning, where it can no longer be written."""

    def handleError(self, record: logging.LogRecord) -> None:
        """Say it once, and write no more."""
        log.removeHandler(self)
        reason = getattr(sys.exc_info()[1], "strerror", None) or sys.exc_info()[1]
        with contextlib.suppress(OSError):
            self.stream = None
        warn((f"the log {self.baseFilename} cannot be written: {reason}",))


def warn(messages: tuple[str, ...]) -> None:
    """Print warnings, and keep them in mind for --strict."""
    for message in messages:
        session.warned.append(message)
        log.warning(printable(message))
        if not session.quiet:
            _print(f"warning: {shortened(printable(message))}")


def end() -> None:
    """Raise TiskelError with --strict where there was a warning; what the command made is written by now."""
    if session.strict and session.warned:
        first, *others = session.warned
        more = f" and {len(others)} more" if others else ""
        raise TiskelError(f"{first} (an error because of --strict{more}; what was made is written)")


def tell(messages: Messages) -> None:
    """Say what the stages have to say, warnings as warnings."""
    for message in messages:
        if message.warning:
            warn((message.text,))
        else:
            say(message.text)


def table(title: str, columns: list[str], rows: list[list[str]]) -> "Table":
    """Return a Rich table of strings, numbers to the right."""
    from rich.table import Table
    from rich.text import Text

    made = Table(title=Text(printable(title)), title_justify="left")
    for column in columns:
        made.add_column(column, justify="right")
    for row in rows:
        made.add_row(*(Text(printable(cell)) for cell in row))
    return made
