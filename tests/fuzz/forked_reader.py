"""Readers with a process for every file, in forks of this process: the same function, without starting Python anew.

A start takes a quarter of a second, a fork some milliseconds, and what is
fuzzed is the library and what becomes of its death. A fork has the processor's
time and the memory that a case may have, and says where it took more.
"""

import io
import os
import resource
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import IO

from tiskel.io.formats import isolated

LIBRARIES = ("laspy", "lazrs", "e57")


class TooMuch(Exception):
    """A fork that took more time or memory than a case may."""


@contextmanager
def forks(seconds: int, free: int, per_byte: int) -> Iterator[None]:
    """Let `read_apart` fork instead of starting Python; a fork may take so many seconds and bytes."""
    before = isolated._in_a_process
    for name in filter(find_spec, LIBRARIES):
        import_module(name)  # once, in front of all forks

    def in_a_fork(function: Callable[[bytes], isolated.Arrays], data: bytes) -> tuple[int, bytes, bytes]:
        own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as said:
            given.write(data)
            child = os.fork()
            if child == 0:
                _become(function, (given, out, said), seconds)
            _, status, used = os.wait4(child, 0)
            code = os.waitstatus_to_exitcode(status)
            grown = (used.ru_maxrss - own) * 1024
            if code == -signal.SIGXCPU:
                raise TooMuch(f"more than {seconds} s")
            if grown > free + per_byte * len(data):
                raise TooMuch(f"{grown >> 20} MB for {len(data)} bytes")
            return code, _whole(out), _whole(said)

    isolated._in_a_process = in_a_fork
    try:
        yield
    finally:
        isolated._in_a_process = before


def _become(function: Callable[[bytes], isolated.Arrays], files: tuple[IO[bytes], ...], seconds: int) -> None:
    """Be the process that reads; never returns."""
    code = 1
    try:
        files[0].seek(0)
        for number, file in enumerate(files):
            os.dup2(file.fileno(), number)
        sys.stdin = io.TextIOWrapper(open(0, "rb", closefd=False))  # noqa: SIM115
        sys.stderr = open(2, "w", closefd=False)  # noqa: SIM115
        isolated.BASE_BYTES += _address_space()
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        isolated.main(function.__module__, function.__name__)
        code = 0
    finally:
        os._exit(code)


def _address_space() -> int:
    """Return how many bytes of address space this process has, and a fork begins with; a new process has few."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()


def _whole(file: IO[bytes]) -> bytes:
    file.seek(0)
    return file.read()
