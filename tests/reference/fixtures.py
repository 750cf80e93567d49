"""Types of the shared fixtures, the program, and what a failed run must look like."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

Runner = Callable[..., subprocess.CompletedProcess[bytes]]  #: words, data=bytes, environment variables
Load = Callable[[str], Any]  #: name -> array, or arrays by name

PROGRAM = Path(sys.executable).with_name("tiskel")


def one_error_line(done: subprocess.CompletedProcess[bytes], code: int = 1) -> str:
    """Return the only line of a failed run, having checked that it is one, on stderr, and no traceback."""
    assert done.returncode == code, done.stderr.decode()
    assert done.stdout == b""
    lines = [line for line in done.stderr.decode().splitlines() if not line.startswith("warning: ")]
    assert len(lines) == 1
    assert lines[0].startswith("error: ")
    return lines[0]


def wrong_usage(done: subprocess.CompletedProcess[bytes]) -> str:
    """Return what a run says that was called wrongly, without the frame around it, having checked its exit code."""
    assert done.returncode == 2, done.stderr.decode()
    assert done.stdout == b""
    return " ".join(done.stderr.decode().translate(dict.fromkeys(map(ord, "│╭╮╰╯─"), " ")).split())
