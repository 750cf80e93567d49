"""Clouds in PCD, the format of the Point Cloud Library: text, binary and compressed, fields of any type."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short
from tiskel.io.formats.lzf import decompress
from tiskel.io.limits import check_unpacked

KEYS = ("VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA")
KINDS = {"F": "f", "I": "i", "U": "u"}
TYPES = ("f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8")
PADDING = "_"  #: name of fields that only fill a row up
LONGEST_NUMBER = 18  #: digits that a count may have and still be one
SIZES = 8  #: bytes before compressed data: how many follow, how many they become


@dataclass(frozen=True)
class Header:
    """What stands in front of the rows.

    Attributes
    ----------
    fields : tuple of (str, str, int)
        The name, the type and the number of values of every field of a row.
    count : int
        Rows.
    layout : str
        "ascii", "binary" or "binary_compressed".
    start : int
        Byte at which the rows begin.
    """

    fields: tuple[tuple[str, str, int], ...]
    count: int
    layout: str
    start: int

    @property
    def row_bytes(self) -> int:
        """The number of bytes of a row that is not text."""
        return sum(many * int(kind[1:]) for _, kind, many in self.fields)

    @property
    def width(self) -> int:
        """The number of values in a row."""
        return sum(many for _, _, many in self.fields)


def read(data: bytes, name: str) -> Parsed:
    """Return the points and the other fields of one number; the viewpoint is not applied.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the header contradicts itself or the rows are not as many as it promises.
    """
    header = _header(data, name)
    if header.layout not in LAYOUTS:
        raise TiskelError(f"{name}: DATA {short(header.layout)!r} is unknown; save it as {', '.join(LAYOUTS)}")
    columns = LAYOUTS[header.layout](data, header, name)
    found = {key: column[:, 0] for (key, _, many), column in zip(header.fields, columns, strict=True) if many == 1}
    points = np.stack([found.pop(axis).astype(np.float64) for axis in "xyz"], axis=1)
    return Parsed(points, properties={key: column for key, column in found.items() if key != PADDING})


def _header(data: bytes, name: str) -> Header:
    entries: dict[str, list[str]] = {}
    start = 0
    while "DATA" not in entries:
        end = data.find(b"\n", start)
        words = data[start:end].decode("latin-1").split()
        if end < 0 or (words and words[0] not in KEYS and not words[0].startswith("#")):
            raise TiskelError(f"{name} is not a valid PCD file: no header that ends with DATA; export it again")
        if words:
            entries[words[0]] = words[1:]
        start = end + 1
    fields = _fields(entries, name)
    return Header(fields, _count(entries, name), " ".join(entries["DATA"]), start)


def _fields(entries: dict[str, list[str]], name: str) -> tuple[tuple[str, str, int], ...]:
    names, sizes, kinds = (entries.get(key, []) for key in ("FIELDS", "SIZE", "TYPE"))
    counts = [_whole(word, "COUNT", name) for word in entries.get("COUNT", ["1"] * len(names))]
    if not names or not len(names) == len(sizes) == len(kinds) == len(counts):
        raise TiskelError(f"{name}: FIELDS, SIZE, TYPE and COUNT of the header differ in length; export it again")
    types = [KINDS.get(kind, kind) + size for kind, size in zip(kinds, sizes, strict=True)]
    wrong = [kind for kind in types if kind not in TYPES]
    if wrong:
        raise TiskelError(
            f"{name}: a field of TYPE and SIZE {short(wrong[0])!r} is unknown; known are {', '.join(TYPES)}"
        )
    missing = [axis for axis in "xyz" if (axis, 1) not in zip(names, counts, strict=True)]
    if missing:
        raise TiskelError(f"{name} has no field {', '.join(missing)} of one number; it needs x, y and z")
    return tuple(zip(names, types, counts, strict=True))


def _count(entries: dict[str, list[str]], name: str) -> int:
    """Return the number of rows, which may stand in the header twice."""
    given = {key: _whole(" ".join(entries[key]), key, name) for key in ("WIDTH", "HEIGHT", "POINTS") if key in entries}
    size = given["WIDTH"] * given.get("HEIGHT", 1) if "WIDTH" in given else None
    if size is None and "POINTS" not in given:
        raise TiskelError(f"{name}: the header has neither POINTS nor WIDTH; export it again")
    if 0 in given.values():
        raise TiskelError(f"{name} holds no points; check how it was made")
    if None not in (size, given.get("POINTS")) and size != given["POINTS"]:
        raise TiskelError(f"{name}: the header promises {given['POINTS']} points and {size}; export it again")
    return given["POINTS"] if size is None else size


def _whole(word: str, key: str, name: str) -> int:
    if not (word.isascii() and word.isdigit() and len(word) < LONGEST_NUMBER):
        raise TiskelError(f"{name}: {key} {short(word)!r} is no whole number; export it again")
    return int(word)


def _promise(header: Header, there: int, unit: str, needed: int, name: str) -> None:
    if there != needed:
        raise TiskelError(
            f"{name}: the header promises {header.count} points, {needed} {unit}, {there} follow; export it again"
        )


def _text(data: bytes, header: Header, name: str) -> list[npt.NDArray[Any]]:
    lines = [line for line in data[header.start :].decode("latin-1").splitlines() if line.strip()]
    _promise(header, len(lines), "lines", header.count, name)
    try:
        table = np.loadtxt(lines, comments=None, ndmin=2)
    except ValueError as error:
        raise TiskelError(f"{name}: {short(str(error))}; every row needs {header.width} numbers") from None
    if table.shape[1] != header.width:
        raise TiskelError(f"{name}: rows of {table.shape[1]} numbers, the header promises {header.width}")
    return np.split(table, np.cumsum([many for _, _, many in header.fields])[:-1], axis=1)


def _binary(data: bytes, header: Header, name: str) -> list[npt.NDArray[Any]]:
    needed = header.count * header.row_bytes
    there = len(data) - header.start
    blank = not data[header.start + needed :].strip()  # a line end after the last row
    _promise(header, min(there, needed) if blank else there, "bytes", needed, name)
    row = np.dtype([(str(i), f"<{kind}", (many,)) for i, (_, kind, many) in enumerate(header.fields)])  # names repeat
    table = np.frombuffer(data, row, header.count, header.start)
    return [table[key] for key in row.names or ()]


def _compressed(data: bytes, header: Header, name: str) -> list[npt.NDArray[Any]]:
    """Return the fields, which stand one behind the other here."""
    if len(data) < header.start + SIZES:
        raise TiskelError(f"{name} ends before its compressed data; export it again")
    packed, unpacked = np.frombuffer(data, "<u4", 2, header.start).tolist()
    _promise(header, unpacked, "bytes", header.count * header.row_bytes, name)
    check_unpacked(unpacked, len(data), name)
    body = data[header.start + SIZES :][:packed]
    try:
        flat = decompress(body, unpacked)
    except ValueError as error:
        raise TiskelError(f"{name}: its compressed data are damaged ({error}); export it again") from None
    columns, start = [], 0
    for _, kind, many in header.fields:
        columns.append(np.frombuffer(flat, f"<{kind}", header.count * many, start).reshape(-1, many))
        start += columns[-1].nbytes
    return columns


LAYOUTS = {"ascii": _text, "binary": _binary, "binary_compressed": _compressed}


def _sniff(data: bytes) -> bool:
    return data.startswith((b"# .PCD", b"VERSION ")) and b"FIELDS" in data[:1000]


PCD = Format("PCD", (".pcd",), read, None, _sniff)
