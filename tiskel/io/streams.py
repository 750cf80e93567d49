"""Bytes in and bytes out: files, standard streams, and files that are whole or absent."""

import mmap
import os
import stat
import sys
import tempfile
from pathlib import Path
from typing import BinaryIO

from tiskel.errors import TiskelError
from tiskel.io.limits import MOST_MEGABYTES, VARIABLE, most_bytes

STANDARD = "-"
PIECE = 16 << 20  #: bytes that are read at once from what does not say how long it is
DEVICE_BYTES = 64 << 20  #: bytes after which a device such as /dev/zero counts as endless
Bytes = bytes | mmap.mmap


def read_bytes(source: str | Path) -> bytes:
    """Return what a file or standard input ("-") holds.

    Raises
    ------
    TiskelError
        Where the file is missing, a folder, or cannot be read, and where a pipe or a device gives more than
        :func:`tiskel.io.limits.most_bytes`.
    """
    if str(source) == STANDARD:
        return _all_of(_standard_input(), "standard input")
    path = Path(source)
    if path.is_dir():
        raise TiskelError(f"{path} is a directory; name a file in it")
    try:
        with path.open("rb") as file:
            return file.read() if path.is_file() else _all_of(file, str(path))
    except FileNotFoundError:
        raise TiskelError(f"no file {path}; check the path") from None
    except ValueError as error:  # a null character
        raise TiskelError(f"{path} cannot be the name of a file: {error}; check the path") from None
    except OSError as error:
        raise TiskelError(f"cannot read {path}: {error.strerror}; check the path and its permissions") from None


def _standard_input() -> BinaryIO:
    if sys.stdin is None:
        raise TiskelError("standard input is closed; name a file, or pipe one in")
    return sys.stdin.buffer


def _all_of(file: BinaryIO, name: str) -> bytes:
    """Return all that a pipe or a device gives; a device other than a terminal has no end, as a rule."""
    endless = stat.S_ISCHR(os.fstat(file.fileno()).st_mode) and not file.isatty()
    most = min(DEVICE_BYTES, most_bytes()) if endless else most_bytes()
    data = bytearray()
    try:
        while piece := file.read(PIECE):
            data += piece
            if len(data) > most:
                raise TiskelError(
                    f"{name} gives more than {most >> 20} MB and is no file on disk; save it to one, or raise the "
                    f"limit of {MOST_MEGABYTES} MB for pipes with {VARIABLE}"
                )
    except OSError as error:
        raise TiskelError(f"cannot read {name}: {error.strerror}") from None
    return bytes(data)


def mapped(source: str | Path) -> Bytes:
    """Return what a file holds, mapped into memory, or what standard input ("-") holds, read.

    A map is read where it is looked at, which saves a copy of large files.
    Raises TiskelError as :func:`read_bytes` does.
    """
    path = Path(source)
    try:
        if str(source) == STANDARD or not path.is_file() or path.stat().st_size == 0:
            return read_bytes(source)
        with path.open("rb") as file:
            return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except (OSError, ValueError):
        return read_bytes(source)


def write_bytes(target: str | Path, data: bytes) -> None:
    """Write a file beside its target and rename it, or write to standard output.

    Parameters
    ----------
    target : str or Path
        A path, or "-" for standard output. A file is whole or absent, never cut short.
    data : bytes
        What is written.

    Raises
    ------
    TiskelError
        Where the target is a folder or cannot be written.
    """
    if str(target) == STANDARD:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
        return
    path = Path(target)
    if path.is_dir():
        raise TiskelError(f"{path} is a directory; name a file in it")
    if path.exists() and not path.is_file():  # a device or a named pipe takes bytes as they come
        path.write_bytes(data)
        return
    try:
        _replace(path, data)
    except OSError as error:
        raise TiskelError(f"cannot write {path}: {error.strerror}; check the folder and its permissions") from None


def _replace(path: Path, data: bytes) -> None:
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        mask = os.umask(0)
        os.umask(mask)
        Path(beside).chmod(0o666 & ~mask)  # as an ordinary new file would have
        Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise
