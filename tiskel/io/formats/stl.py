"""Meshes in STL, through Open3D, which is shown only files that are whole: others make it hang."""

import re

from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed
from tiskel.io.formats.open3d_reader import read_mesh

HEAD, FACET = 84, 50  #: bytes of a binary file before its facets, and of each
VERTEX = re.compile(rb"^[ \t]*vertex(?:[ \t]+[-+.\deE]+){3}[ \t\r]*$", re.MULTILINE)


def read(data: bytes, name: str) -> Parsed:
    """Return vertices and triangles.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is cut short or damaged, or Open3D is missing.
    """
    if not (_whole_binary(data) or _whole_text(data)):
        raise TiskelError(f"{name} is no whole STL file, neither binary nor text; export it again")
    return read_mesh(data, name, ".stl")


def _whole_binary(data: bytes) -> bool:
    """Return whether the file is as long as its count of facets says."""
    return len(data) >= HEAD and len(data) == HEAD + FACET * int.from_bytes(data[HEAD - 4 : HEAD], "little")


def _whole_text(data: bytes) -> bool:
    """Return whether every facet has three vertices of three numbers each."""
    facets = data.count(b"endfacet")
    return data.lstrip().startswith(b"solid") and len(VERTEX.findall(data)) == data.count(b"vertex") == 3 * facets


STL = Format("STL", (".stl",), read)
