"""Bytes in and bytes out: files, standard streams, and files that are whole or absent."""

import mmap
import os
import sys
import tempfile
from pathlib import Path

from tiskel.errors import TiskelError

STANDARD = "-"
Bytes = bytes | mmap.mmap


def read_bytes(source: str | Path) -> bytes:
    """Return what a file or standard input ("-") holds.

    Raises
    ------
    TiskelError
        Where the file is missing, a folder, or cannot be read.
    """
    if str(source) == STANDARD:
        return sys.stdin.buffer.read()
    path = Path(source)
    if path.is_dir():
        raise TiskelError(f"{path} is a directory; name a file in it")
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise TiskelError(f"no file {path}; check the path") from None
    except OSError as error:
        raise TiskelError(f"cannot read {path}: {error.strerror}") from None


def mapped(source: str | Path) -> Bytes:
    """Return what a file holds, mapped into memory, or what standard input ("-") holds, read.

    A map is read where it is looked at, which saves a copy of large files.
    Raises TiskelError as :func:`read_bytes` does.
    """
    path = Path(source)
    if str(source) == STANDARD or not path.is_file() or path.stat().st_size == 0:
        return read_bytes(source)
    try:
        with path.open("rb") as file:
            return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except OSError:
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
