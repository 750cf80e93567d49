"""Tables of PLY files, each element at once, faces whose lists have several lengths by their places."""

import struct
from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from plyfile import PlyData, PlyElement, PlyListProperty, PlyParseError, PlyProperty

from tiskel.arrays import within_runs
from tiskel.io.streams import Bytes

HEADER_END = b"end_header"  #: the last line of a header
FACE, LENGTH = "face", " length"  #: an element, and what follows the name of a list in a table; names have no blanks
CORNERS = 255  #: of a face, at most, to be read at once
PLACE = np.dtype([("start", np.int64), ("length", np.int64)])  #: of a list: its first byte in the file, and its values


def has_lists(elements: Sequence[PlyElement]) -> bool:
    """Tell whether rows have different lengths somewhere, so that a table is not its bytes."""
    return any(isinstance(kind, PlyListProperty) for element in elements for kind in element.properties)


def read_tables(ply: PlyData, data: Bytes, start: int) -> int:
    """Fill the elements of a binary file, each at once; plyfile reads rows with lists one by one, into many objects.

    The rows begin at start; where they end is returned, -1 where an element that is no face has lists. The tables are
    views of the data, not to be written to. Where lists of faces have several lengths, a table holds nothing but where
    each of them is (PLACE).
    """
    for element in ply.elements:
        if has_lists([element]) and element.name != FACE:
            return -1
        kind = _row(element, ply.byte_order, data, start)
        table = None if kind is None else _even(element, kind, data, start)
        if table is None:
            element.data, start = _places(element, ply.byte_order, data, start)
        else:
            element.data = table
            start += table.nbytes
    return start


def lists_at(places: npt.NDArray[Any], kind: str, data: Bytes) -> npt.NDArray[Any]:
    """Return the values of all lists one behind the other, from their places in the file."""
    size = np.dtype(kind).itemsize
    values: npt.NDArray[Any] = np.ndarray(max(len(data) - size + 1, 0), kind, data, strides=(1,))  # from every byte on
    lengths = places["length"]
    step = within_runs(lengths)
    return np.asarray(values[np.repeat(places["start"], lengths) + size * step])


def _even(element: PlyElement, kind: np.dtype[Any], data: Bytes, start: int) -> npt.NDArray[Any] | None:
    """Return the table of an element if all its rows are as long as the first; None if not."""
    if start + element.count * kind.itemsize > len(data):
        if has_lists([element]):  # the first may be the longest
            return None
        raise PlyParseError(f"element {element.name!r}: early end-of-file")
    table = np.frombuffer(data, kind, element.count, start)
    even = all((table[name] == table[name][0]).all() for name in kind.names or () if name.endswith(LENGTH))
    return table if even else None


def _places(element: PlyElement, order: str, data: Bytes, start: int) -> tuple[npt.NDArray[Any], int]:
    """Return where each list of each row is, and where the rows end."""
    steps: list[tuple[int, struct.Struct | None, int]] = []  # bytes to go, or what says how many values of what size
    row: list[tuple[Any, ...]] = []
    for prop in element.properties:
        if isinstance(prop, PlyListProperty):
            length, values = (np.dtype(one) for one in prop.list_dtype(order))
            steps.append((length.itemsize, struct.Struct(f"{order}{length.char}"), values.itemsize))
            row.append((prop.name, PLACE))
        else:
            row.append((prop.name, np.uint8, (0,)))  # nothing of it is kept
            steps.append((np.dtype(prop.dtype(order)).itemsize, None, 0))
    found = array("q")
    try:
        for _ in range(element.count):
            for size, length_of, each in steps:
                count = length_of.unpack_from(data, start)[0] if length_of else 0
                start += size
                if length_of:
                    found.extend((start, count))
                    start += each * count
                if count < 0 or start > len(data):
                    raise PlyParseError(f"element {element.name!r}: early end-of-file")
    except struct.error:
        raise PlyParseError(f"element {element.name!r}: early end-of-file") from None
    table = np.frombuffer(found, np.dtype(row), element.count)
    return table, start


def _row(element: PlyElement, order: str, data: Bytes, start: int) -> np.dtype[Any] | None:
    """Return the type of an element's rows if all lists of a face are as long as those of the first; None if not."""
    if not has_lists([element]):
        whole: np.dtype[Any] = np.dtype(element.dtype(order))
        return whole
    if element.count == 0:
        return None
    row: list[tuple[Any, ...]] = []
    for prop in element.properties:
        width = 0
        if isinstance(prop, PlyListProperty):
            kind, at = np.dtype(prop.list_dtype(order)[0]), start + np.dtype(row).itemsize
            length = np.frombuffer(data[at : at + kind.itemsize], kind)
            if len(length) == 0 or not 1 <= length[0] <= CORNERS:
                return None
            width = int(length[0])
        row += _fields(prop, order, width)
    return np.dtype(row)


def _fields(prop: PlyProperty, order: str, width: int) -> list[tuple[Any, ...]]:
    """Return the fields of a property in the type of a row, a list's with so many values."""
    if not isinstance(prop, PlyListProperty):
        return [(prop.name, prop.dtype(order))]
    length, values = prop.list_dtype(order)
    return [(prop.name + LENGTH, length), (prop.name, values, (width,))]


def packed(element: PlyElement, order: str) -> bytes | memoryview | None:
    """Return the rows of an element as a binary file has them, where lists have one length in all; None if not.

    plyfile writes rows with lists one by one.
    """
    if not has_lists([element]):
        return memoryview(element.data.astype(element.dtype(order), copy=False))
    row: list[tuple[Any, ...]] = []
    columns: list[Any] = []
    for prop in element.properties:
        column, width = element.data[prop.name], 0
        if isinstance(prop, PlyListProperty):
            widths = {len(values) for values in column} or {0}
            if len(widths) > 1:
                return None
            width = widths.pop()
            columns.append(width)
            column = np.concatenate([*column]).reshape(-1, width) if width else np.zeros((element.count, 0))
        row += _fields(prop, order, width)
        columns.append(column)
    table = np.empty(element.count, row)
    for (name, *_), column in zip(row, columns, strict=True):
        table[name] = column
    return table.tobytes()


def surplus(ply: PlyData, data: Bytes, rest: bytes) -> str:
    """Return what the file holds beyond the rows of its header, in words; nothing where it is as promised."""
    if ply.text:
        rows = [line for line in bytes(data).split(HEADER_END, 1)[1].splitlines()[1:] if line.strip()]
        more = len(rows) - sum(element.count for element in ply.elements)
        return f"{more} rows" if more > 0 else ""
    return f"{len(rest)} bytes" if rest.strip() else ""
