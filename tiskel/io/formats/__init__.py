"""The file types of clouds and meshes: one file each, one line each in the table below."""

import re
from collections.abc import Callable
from pathlib import PurePath

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats import e57, las, numpy_arrays, obj, off, pcd, ply, ptx, stl, text
from tiskel.io.formats.base import Format, Parsed, short

__all__ = ["FORMATS", "SUFFIXES", "WRITTEN", "Format", "Parsed", "format_of", "writer_of"]

FORMATS: tuple[Format, ...] = (
    ply.PLY,
    numpy_arrays.NPY,
    numpy_arrays.NPZ,
    text.XYZ,
    text.PTS,
    text.CSV,
    text.TSV,
    ptx.PTX,
    pcd.PCD,
    las.LAS,
    e57.E57,
    off.OFF,
    obj.OBJ,
    stl.STL,
)
LOOKED_AT = 4096  #: bytes that tell what a file is whose suffix says nothing
ROW = re.compile(rb"\s*[-+.\deEdDnaifNAIF]+([\s,;]+[-+.\deEdDnaifNAIF]+){2,}\s*")
BY_SUFFIX = {suffix: kind for kind in FORMATS for suffix in kind.suffixes}
SUFFIXES = tuple(BY_SUFFIX)  #: of all files that are read
WRITTEN = tuple(suffix for suffix, kind in BY_SUFFIX.items() if kind.write)  #: of all files that are written


def format_of(name: str, data: bytes, by_content: bool = False) -> Format:
    """Return the type of a file.

    Parameters
    ----------
    name : str
        Its name; the suffix says of which type it is.
    data : bytes
        What it holds; where the suffix is unknown, its first bytes say it.
    by_content : bool
        Whether the first bytes say it in any case: text where no type claims them.

    Raises
    ------
    TiskelError
        For an unknown suffix of what is neither text nor of a known type.
    """
    suffix = PurePath(name).suffix.lower()
    if suffix in BY_SUFFIX and not by_content:
        return BY_SUFFIX[suffix]
    found = next((kind for kind in FORMATS if kind.sniff(data)), None)
    if found is None and not by_content and not _looks_like_numbers(data):
        kind = f"{short(suffix)!r}" if suffix else "without a suffix"
        raise TiskelError(f"{name}: unknown kind of file {kind}; known are {', '.join(SUFFIXES)}, each also with .gz")
    return found or text.XYZ


def _looks_like_numbers(data: bytes) -> bool:
    """Tell whether a file begins with characters that tables of numbers are made of, rows of three and more."""
    rows = data[:LOOKED_AT].removeprefix(b"\xef\xbb\xbf").splitlines()[1:-1] or data.splitlines()
    return bool(rows) and all(ROW.fullmatch(row) for row in rows)


def writer_of(suffix: str) -> Callable[[Points], bytes]:
    """Return the function from points (n, 3) to bytes that writes the type of a suffix (with its dot).

    Raises
    ------
    TiskelError
        Where clouds are not written in this type.
    """
    kind = BY_SUFFIX.get(suffix.lower())
    if kind is None or kind.write is None:
        asked = repr(suffix) if suffix else "'a file without a suffix'"
        raise TiskelError(f"a cloud cannot be written as {asked}; choose {', '.join(WRITTEN)}")
    return kind.write
