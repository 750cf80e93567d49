"""Readers that are compiled libraries, each file in a process of its own: where one dies, it is a message.

The process is handed the bytes and hands arrays back. It may take memory in
proportion to the file, so that counts that lie end there.
"""

import io
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.io.formats.base import short

Arrays = Mapping[str, npt.NDArray[Any]]
BASE_BYTES, PER_BYTE = 3 << 30, 60  #: address space of such a process: so much, and for each byte of the file
FAILED = 3  #: exit code of a reader that refuses the file, with the reason on standard error
START = "import sys; sys.path[:] = {!r}; from tiskel.io.formats.isolated import main; main({!r}, {!r})"


def read_apart(function: Callable[[bytes], Arrays], data: bytes, name: str, kind: str) -> Arrays:
    """Return the arrays that a function of a module makes of a file, called in a process of its own.

    Parameters
    ----------
    function : callable
        From the bytes to arrays by name; found by its module and name.
    data : bytes
        What the file holds.
    name, kind : str
        The file's name and type, for messages.

    Raises
    ------
    TiskelError
        Where the function raises, or the process dies.
    """
    code, out, said = _in_a_process(function, data)
    if code == 0:
        with np.load(io.BytesIO(out), allow_pickle=False) as arrays:
            return {key: arrays[key] for key in arrays.files}
    lines = said.decode("utf-8", "replace").strip().splitlines()
    reason = (lines[-1] if code == FAILED else lines[0]) if lines else f"its reader died ({code})"
    raise TiskelError(f"{name} is not a valid {kind} file: {short(reason)}; export it again")


def _in_a_process(function: Callable[[bytes], Arrays], data: bytes) -> tuple[int, bytes, bytes]:
    """Call `main` in a new process; return its exit code and what stands on its standard output and error."""
    done = subprocess.run(
        [sys.executable, "-c", START.format(sys.path, function.__module__, function.__name__)],
        input=data, capture_output=True, check=False,
        env={**os.environ, "RUST_BACKTRACE": "0", "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


def main(module: str, function: str) -> None:
    """Read standard input with a function, and write its arrays to standard output; what it prints is no data."""
    data = sys.stdin.buffer.read()
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    _limit(len(data))
    try:
        arrays = getattr(import_module(module), function)(data)
    except BaseException as error:  # Rust's panics are no Exception
        sys.stderr.write(f"{short(str(error)) or type(error).__name__}\n")
        sys.stderr.flush()
        os._exit(FAILED)
    with out:
        np.savez(out, **arrays)


def _limit(size: int) -> None:
    try:
        import resource
    except ImportError:
        return
    most = BASE_BYTES + PER_BYTE * size
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    if hard == resource.RLIM_INFINITY or hard > most:
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))
