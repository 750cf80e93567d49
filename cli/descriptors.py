"""Standard input, output and error as the program needs them, whatever it was started with.

Closed ones are opened, so that no file of ours takes their number. Standard
output is kept for data: libraries that print to it, from Python or C, print to
standard error instead.
"""

import os
import sys
from typing import TextIO

READ, WRITE, ERROR = 0, 1, 2


def guard() -> None:
    """Open what is closed, and keep standard output for the data that the program writes."""
    closed = [number for number in (READ, WRITE, ERROR) if not _is_open(number)]
    for number in closed:  # in ascending order, each gets the lowest free number, its own
        os.open(os.devnull, os.O_WRONLY if number == ERROR else os.O_RDONLY)
    if ERROR in closed or sys.stderr is None:
        sys.stderr = _text(ERROR)
    private = os.dup(WRITE)
    os.dup2(ERROR, WRITE)
    if sys.stdout is not None:
        sys.stdout.flush()
    sys.stdout = sys.__stdout__ = _text(private)  # type: ignore[assignment, misc]  # Taichi asks whether they are the same


def abandon_output() -> None:
    """Send what is still to be written nowhere, or the interpreter complains on its way out."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _is_open(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return False
    return True


def _text(number: int) -> TextIO:
    return os.fdopen(number, "w", encoding="utf-8", errors="backslashreplace", closefd=number > ERROR)
