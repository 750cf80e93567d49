"""Clouds as numbers in text, and as NumPy arrays."""

import io
import zipfile

import numpy as np

from tiskel.arrays import Points
from tiskel.errors import TiskelError

COMMENTS = ("#", "//")


def parse_text(data: bytes, name: str) -> Points:
    """Return the first three columns (or those headed x, y, z) of XYZ, PTS, CSV or TXT.

    Columns are separated by white space, commas or semicolons. A first line of
    one whole number counts the rows, as PTS has it, and must be right; a first
    line that is no numbers is a header.
    """
    try:
        lines = data.decode("utf-8-sig").replace(",", " ").replace(";", " ").splitlines()
    except UnicodeDecodeError:
        raise TiskelError(f"{name} is not text; is its suffix right?") from None
    rows = [line for line in map(str.strip, lines) if line and not line.startswith(COMMENTS)]
    if not rows:
        raise TiskelError(f"{name} holds no points; check how it was made")
    columns: tuple[int, ...] = (0, 1, 2)
    promised = None
    if rows[0].isdigit():
        promised, rows = int(rows[0]), rows[1:]
    elif not _is_number(rows[0].split()[0]):
        columns, rows = _headed(rows[0]), rows[1:]
    if promised not in (None, len(rows)):
        raise TiskelError(f"{name}: the first line promises {promised} points, {len(rows)} follow; export it again")
    if not rows:
        raise TiskelError(f"{name} holds no points; check how it was made")
    try:
        return np.loadtxt(rows, usecols=columns, ndmin=2, comments=None)
    except (ValueError, IndexError) as error:
        raise TiskelError(f"{name}: {str(error).splitlines()[0]}; every row needs three numbers") from None


def _headed(line: str) -> tuple[int, ...]:
    """Return the columns headed x, y, z, or the first three."""
    names = [word.strip("\"'").lower() for word in line.split()]
    return tuple(names.index(axis) for axis in "xyz") if {"x", "y", "z"} <= set(names) else (0, 1, 2)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def parse_numpy(data: bytes, name: str) -> Points:
    """Return an (n, 3) array from NPY, or from NPZ its array "points" or its only one."""
    try:
        loaded = np.load(io.BytesIO(data), allow_pickle=False)
        if isinstance(loaded, np.lib.npyio.NpzFile):
            key = "points" if "points" in loaded else loaded.files[0] if len(loaded.files) == 1 else None
            if key is None:
                raise TiskelError(f"{name} holds {', '.join(loaded.files) or 'nothing'}; name the cloud 'points'")
            loaded = loaded[key]
        array = np.asarray(loaded, dtype=np.float64)
    except (ValueError, TypeError, EOFError, OSError, zipfile.BadZipFile) as error:
        raise TiskelError(f"{name} is not a valid NumPy file of numbers: {error}") from None
    if array.ndim != 2 or array.shape[1] < 3:
        raise TiskelError(f"{name} must hold an array of shape (n, 3), got {array.shape}")
    return np.ascontiguousarray(array[:, :3])


def dump_text(points: Points, separator: str = " ") -> bytes:
    """Return one point per line, with as many digits as it takes to read the same numbers back."""
    return "".join(separator.join(map(repr, row)) + "\n" for row in points.tolist()).encode()


def dump_numpy(points: Points) -> bytes:
    """Return NPY."""
    out = io.BytesIO()
    np.save(out, np.ascontiguousarray(points))
    return out.getvalue()
