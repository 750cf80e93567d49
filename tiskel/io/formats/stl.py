"""Meshes in STL, text and binary: facets, each with corners of its own."""

import re

import numpy as np

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed

HEAD = 84  #: bytes of a binary file before its facets: a remark, and how many there are
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("remark", "<u2")])
NUMBER = rb"[ \t]+([-+.\deE]+)"
VERTEX = re.compile(rb"^[ \t]*vertex" + 3 * NUMBER + rb"[ \t\r]*$", re.MULTILINE)


def read(data: bytes, name: str) -> Parsed:
    """Return vertices and triangles, three corners for each facet; its normal follows from them.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is cut short or damaged, or holds no facet.
    """
    if _whole_binary(data):
        corners: Points = np.frombuffer(data, FACET, offset=HEAD)["corners"].reshape(-1, 3).astype(np.float64)
    else:
        corners = _text_corners(data, name)
    if len(corners) == 0:
        raise TiskelError(f"{name} holds no facets; check how it was made")
    return Parsed(np.ascontiguousarray(corners), np.arange(len(corners), dtype=np.int32).reshape(-1, 3))


def _whole_binary(data: bytes) -> bool:
    """Return whether the file is as long as its count of facets says."""
    count = int.from_bytes(data[HEAD - 4 : HEAD], "little")
    return len(data) >= HEAD and len(data) == HEAD + FACET.itemsize * count


def _text_corners(data: bytes, name: str) -> Points:
    """Return the corners of a text file in which every facet has three vertices of three numbers each."""
    found = VERTEX.findall(data)
    whole = data.lstrip().startswith(b"solid") and len(found) == data.count(b"vertex") == 3 * data.count(b"endfacet")
    if not whole:
        raise TiskelError(f"{name} is no whole STL file, neither binary nor text; export it again")
    try:
        return np.array(found, np.bytes_).reshape(-1, 3).astype(np.float64)
    except ValueError as error:
        raise TiskelError(f"{name}: {error}; every vertex needs three numbers") from None


STL = Format("STL", (".stl",), read)
