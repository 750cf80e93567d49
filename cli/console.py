"""Messages on stderr, and how errors leave the program."""

import contextlib
import functools
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tiskel.cli import logbook
from tiskel.cli.logbook import log
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
    began: float = 0.0


session = Session()


def begin(
    settings: Mapping[str, Any], *, threads: int | None, quiet: bool, verbose: bool, strict: bool,
    log_file: Path | None, config: Path | None,
) -> None:  # fmt: skip
    """Take over the common options before the command does anything; what config says is among the settings."""
    import os

    session.quiet, session.verbose, session.strict = quiet, verbose, strict
    session.began = time.perf_counter()
    session.warned.clear()
    if threads is not None:
        os.environ["TISKEL_NUM_THREADS"] = str(threads)
    if log_file is not None:
        logbook.open_log(log_file, settings, lambda reason: warn((reason,)))


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
    logbook.ended("failed", session.began)
    with contextlib.suppress(OSError):  # nobody can be told
        errors().print(f"error: {said}", markup=False)


def _print(message: str) -> None:
    with contextlib.suppress(OSError):  # a full disk behind standard error is no reason to stop
        errors().print(printable(message), markup=False)


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
    logbook.ended("done", session.began)


def tell(messages: Messages) -> None:
    """Say what the stages have to say, warnings as warnings; details with --verbose only, and in the log."""
    hidden = not session.verbose and any(message.detail for message in messages)
    for message in messages:
        if message.warning:
            warn((message.text,))
        elif message.detail and not session.verbose:
            log.info(printable(message.text))
        else:
            say(message.text)
    if hidden:
        say("--verbose has a line for each of them")


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
