"""The file types of clouds and meshes: one file each, one line each in the table below."""

from collections.abc import Callable
from pathlib import PurePath

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats import numpy_arrays, obj, off, pcd, ply, stl, text
from tiskel.io.formats.base import Format, Parsed

__all__ = ["FORMATS", "SUFFIXES", "WRITTEN", "Format", "Parsed", "format_of", "writer_of"]

FORMATS: tuple[Format, ...] = (
    ply.PLY,
    numpy_arrays.NPY,
    numpy_arrays.NPZ,
    text.XYZ,
    text.PTS,
    text.CSV,
    pcd.PCD,
    off.OFF,
    obj.OBJ,
    stl.STL,
)
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
        What it holds.
    by_content : bool
        Whether the first bytes say it instead: text where no type claims them.

    Raises
    ------
    TiskelError
        For an unknown suffix.
    """
    if by_content:
        return next((kind for kind in FORMATS if kind.sniff(data)), text.XYZ)
    suffix = PurePath(name).suffix.lower()
    if suffix not in BY_SUFFIX:
        kind = repr(suffix) if suffix else "'without a suffix'"
        raise TiskelError(f"{name}: unknown kind of file {kind}; known are {', '.join(SUFFIXES)}, and these with .gz")
    return BY_SUFFIX[suffix]


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
