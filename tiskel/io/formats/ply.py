"""Clouds and meshes in PLY; a stage file of tiskel gives its input cloud back."""

import re
from typing import Any

from tiskel.arrays import Edges, Points
from tiskel.errors import TiskelError
from tiskel.io import ply
from tiskel.io.formats.base import NO_FACES, Format, Parsed, short
from tiskel.io.formats.faces import BATCH, Lists, fans, joined
from tiskel.io.ply_tables import HEADER_END, PLACE, lists_at

BYTE_ORDER_MARK = b"\xef\xbb\xbf"
HOLDERS = ("vertex", "point", "points", "vertices")  #: elements that programs keep points in
NOT_ASCII = bytes(range(128)) + b"?" * 128  #: table that puts a question mark for every byte beyond ASCII
NAN_OF_WINDOWS = re.compile(rb"[+-]?nan\([a-z]+\)")


def read(data: bytes, name: str) -> Parsed:
    """Return points, triangles and further columns.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is damaged or has no x, y, z.
    """
    plain = _tidy(data)
    file = ply.parse(plain, name)
    ours = any(c.startswith("tiskel ") for c in file.comments) and "cloud" in file
    holder = "cloud" if ours else next((one for one in HOLDERS if one in file), "")
    if not holder:
        raise TiskelError(
            f"{name} has no element 'vertex'; it holds {short(', '.join(e.name for e in file.elements)) or 'nothing'}"
        )
    table = file[holder].data
    axes = _axes(table, holder, name)
    columns = [key for key in table.dtype.names or () if key not in axes and table.dtype[key].kind != "O"]
    return Parsed(
        ply.points_of(table, axes), _triangles(file, plain, name), {key: table[key].copy() for key in columns}
    )


def write(points: Points) -> bytes:
    """Return points (n, 3) as binary PLY."""
    return ply.dump([ply.element("vertex", ply.xyz(points))], "cloud", {})


def _tidy(data: bytes) -> bytes:
    """Return the file without a byte order mark, its header in ASCII and its not-a-numbers as C writes them."""
    data = data.removeprefix(BYTE_ORDER_MARK)
    header = data[: max(data.find(HEADER_END), 0)]
    if not header.isascii():
        data = header.translate(NOT_ASCII) + data[len(header) :]
    return NAN_OF_WINDOWS.sub(b"nan", data) if b"format ascii" in header and b"nan(" in data else data


def _axes(table: Any, holder: str, name: str) -> list[str]:
    """Return the names of the columns x, y and z as the file spells them."""
    names = {key.lower(): key for key in reversed(table.dtype.names or ())}
    missing = [axis for axis in "xyz" if axis not in names]
    if missing:
        raise TiskelError(f"{name}: element {holder!r} has no property {', '.join(missing)}; it needs x, y and z")
    lists = [names[axis] for axis in "xyz" if table.dtype[names[axis]].kind == "O"]
    if lists:
        raise TiskelError(f"{name}: property {lists[0]} of {holder!r} is a list; x, y and z must be single numbers")
    return [names[axis] for axis in "xyz"]


def _triangles(file: Any, data: bytes, name: str) -> Edges:
    """Return faces as triangles; none where the file has none."""
    if "face" not in file or "vertex" not in file or len(file["face"].data) == 0:
        return NO_FACES
    table = file["face"].data
    lists = [key for key in table.dtype.names if key in ("vertex_indices", "vertex_index")]
    if not lists:
        return NO_FACES
    kind = table.dtype[lists[0]]
    if kind.kind != "O" and kind != PLACE and not kind.shape:
        raise TiskelError(f"{name}: {lists[0]} of 'face' is a single number; it must list the corners of a face")
    corners = table[lists[0]]
    count = file["vertex"].count
    if corners.dtype != PLACE:
        return fans(corners, count, name)
    values = file["face"].ply_property(lists[0]).list_dtype(file.byte_order)[1]
    parts = (corners[at : at + BATCH] for at in range(0, len(corners), BATCH))
    return joined(fans(Lists(lists_at(part, values, data), part["length"]), count, name) for part in parts)


PLY = Format("PLY", (".ply",), read, write, lambda data: data.removeprefix(BYTE_ORDER_MARK).startswith(ply.MAGIC))
