"""Tables of PLY files, each element at once where its rows are of one length."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from plyfile import PlyData, PlyElement, PlyListProperty, PlyParseError

from tiskel.io.streams import Bytes

HEADER_END = b"end_header"  #: the last line of a header
FACE, LENGTH = "face", " length"  #: an element, and what follows the name of a list in a table; names have no blanks
CORNERS = 255  #: of a face, at most, to be read at once


def has_lists(elements: Sequence[PlyElement]) -> bool:
    """Tell whether rows have different lengths somewhere, so that a table is not its bytes."""
    return any(isinstance(kind, PlyListProperty) for element in elements for kind in element.properties)


def read_tables(ply: PlyData, data: Bytes, start: int) -> int:
    """Fill the elements of a binary file, each at once; plyfile reads rows with lists one by one, into many objects.

    The rows begin at start; where they end is returned, -1 where an element has lists of several lengths, or others
    than faces have. The tables are views of the data, not to be written to.
    """
    for element in ply.elements:
        kind = _row(element, ply.byte_order, data, start)
        if kind is None:
            return -1
        if start + element.count * kind.itemsize > len(data):
            if has_lists([element]):  # the first may be the longest
                return -1
            raise PlyParseError(f"element {element.name!r}: early end-of-file")
        table = np.frombuffer(data, kind, element.count, start)
        if not all((table[name] == table[name][0]).all() for name in kind.names or () if name.endswith(LENGTH)):
            return -1
        element.data = table
        start += element.count * kind.itemsize
    return start


def _row(element: PlyElement, order: str, data: Bytes, start: int) -> np.dtype[Any] | None:
    """Return the type of an element's rows if all lists of a face are as long as those of the first; None if not."""
    if not has_lists([element]):
        whole: np.dtype[Any] = np.dtype(element.dtype(order))
        return whole
    if element.name != FACE or element.count == 0:
        return None
    row: list[tuple[Any, ...]] = []
    for prop in element.properties:
        if not isinstance(prop, PlyListProperty):
            row.append((prop.name, prop.dtype(order)))
            continue
        kind, values = prop.list_dtype(order)
        at = start + np.dtype(row).itemsize
        length = np.frombuffer(data[at : at + np.dtype(kind).itemsize], kind)
        if len(length) == 0 or not 1 <= length[0] <= CORNERS:
            return None
        row += [(prop.name + LENGTH, kind), (prop.name, values, (int(length[0]),))]
    return np.dtype(row)


def surplus(ply: PlyData, data: Bytes, rest: bytes) -> str:
    """Return what the file holds beyond the rows of its header, in words; nothing where it is as promised."""
    if ply.text:
        rows = [line for line in bytes(data).split(HEADER_END, 1)[1].splitlines()[1:] if line.strip()]
        more = len(rows) - sum(element.count for element in ply.elements)
        return f"{more} rows" if more > 0 else ""
    return f"{len(rest)} bytes" if rest.strip() else ""
