"""Bytes in and bytes out: files, standard streams, and files that are whole or absent."""

import contextlib
import functools
import mmap
import os
import stat
import sys
import tempfile
import time
from pathlib import Path
from typing import BinaryIO

from tiskel.errors import TiskelError
from tiskel.io.limits import MOST_MEGABYTES, VARIABLE, most_bytes

STANDARD = "-"
PIECE = 16 << 20  #: bytes that are read at once from what does not say how long it is
BESIDE = ".tiskel-"  #: begins the names of files that are being written
STALE = 60.0  #: seconds after which such a file, where nobody holds it, was left behind
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
    try:
        if path.is_dir():
            raise TiskelError(f"{path} is a directory; name a file in it")
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
        _to_standard_output(data)
        return
    check_target(target)
    path = _place_of(target)
    try:
        if path.exists() and not path.is_file():  # a device or a named pipe takes bytes as they come
            path.write_bytes(data)
        else:
            _replace(path, data)
    except BrokenPipeError:
        raise
    except OSError as error:
        raise TiskelError(
            f"cannot write {target}: {error.strerror}; check the folder, its space and permissions"
        ) from None


def check_target(target: str | Path) -> None:
    """Raise TiskelError where a file cannot be written, before the work for it begins.

    The folder must be there, take files and have space left; the target must be no folder.
    """
    if str(target) == STANDARD:
        return
    try:
        path = _place_of(target)
        if path.is_dir():
            raise TiskelError(f"{target} is a directory; name a file in it")
        if path.exists() and not path.is_file():
            return
        folder = path.parent
        if not folder.is_dir():
            raise TiskelError(f"cannot write {target}: there is no folder {folder}; make it, or name another")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise TiskelError(f"cannot write {target}: the folder {folder} takes no files; check its permissions")
        space = os.statvfs(folder) if hasattr(os, "statvfs") else None
    except (OSError, ValueError) as error:
        raise TiskelError(
            f"cannot write {target}: {getattr(error, 'strerror', None) or error}; name another file"
        ) from None
    if space is not None and space.f_blocks and space.f_bavail == 0:
        raise TiskelError(f"cannot write {target}: no space is left in {folder}; free some, or name another folder")


def _place_of(target: str | Path) -> Path:
    """Return what is replaced, which is what a link leads to; pipes have no other name than their link in /dev/fd."""
    path = Path(target)
    return path if path.exists() and not path.is_file() else Path(os.path.realpath(target))


def _to_standard_output(data: bytes) -> None:
    if sys.stdout is None:
        raise TiskelError("standard output is closed; name a file with -o")
    try:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise TiskelError(f"cannot write standard output: {error.strerror}; name a file with -o") from None


def _replace(path: Path, data: bytes) -> None:
    """Write a file beside its target, and put it in its place; what killed runs left beside it goes."""
    _remove_left_behind(path.parent)
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=BESIDE, suffix=".part")
    try:
        with os.fdopen(handle, "wb") as file:
            _lock(file.fileno())
            file.write(data)
            file.flush()
            Path(beside).chmod(_mode(path))
            Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise


def _mode(path: Path) -> int:
    """Return the permissions of a file that is there, or those of an ordinary new one."""
    if path.exists():
        return stat.S_IMODE(path.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _lock(descriptor: int) -> bool:
    """Lock a file for as long as it is open; False where another process holds it, or cannot be asked."""
    try:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (ImportError, OSError):
        return False
    return True


@functools.cache
def _remove_left_behind(folder: Path) -> None:
    """Remove what runs that were killed left in a folder: old enough, and locked by nobody; once in a process."""
    for path in folder.glob(f"{BESIDE}*.part"):
        with contextlib.suppress(OSError):
            if time.time() - path.stat().st_mtime > STALE:
                with path.open("rb") as file:
                    if _lock(file.fileno()):
                        path.unlink()
