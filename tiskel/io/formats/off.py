"""Meshes and clouds in OFF, read here: Open3D crashes or hangs on files whose header is wrong."""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import islice

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, rows_of, short
from tiskel.io.formats.faces import BATCH, fans, joined

MARK = re.compile(r"(ST)?C?N?OFF")  #: texture, colours and normals may follow the coordinates of a vertex


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
        Where the file is no OFF, or rows and header do not agree.
    """
    rows = rows_of(data)
    first = next(rows, "")
    mark = MARK.match(first)
    if mark is None:
        raise TiskelError(f"{name} is no OFF file: it does not begin with OFF; is its suffix right?")
    counts = re.fullmatch(r"(\d{1,18})\s+(\d{1,18})(\s+-?\d+)?", first[mark.end() :].strip() or next(rows, ""))
    if counts is None:
        raise TiskelError(f"{name}: no counts of vertices and faces after OFF; export it again")
    vertices, faces = int(counts[1]), int(counts[2])
    head = 1 if first[mark.end() :].strip() else 2  # rows of it
    follow = sum(1 for _ in rows)
    if follow != vertices + faces:
        raise TiskelError(
            f"{name}: the header promises {vertices} vertices and {faces} faces, {follow} rows follow; export it again"
        )
    if vertices == 0:
        raise TiskelError(f"{name} holds no points; check how it was made")
    rows = islice(rows_of(data), head, None)
    points = _points(islice(rows, vertices), name)
    return Parsed(points, joined(fans(each, vertices, name) for each in _polygons(rows, name)))


def _points(rows: Iterable[str], name: str) -> Points:
    try:
        return np.ascontiguousarray(np.loadtxt(rows, comments=None, ndmin=2)[:, :3])
    except ValueError as error:
        raise TiskelError(f"{name}: {short(str(error))}; every vertex needs the same numbers") from None


def _polygons(rows: Iterator[str], name: str) -> Iterator[Sequence[Sequence[int]] | npt.NDArray[np.int64]]:
    """Yield the corners of so many faces at a time, as one array where all are triangles without colours."""
    while batch := list(islice(rows, BATCH)):
        if all(row.startswith("3 ") and row.count(" ") == 3 for row in batch):
            with suppress(ValueError):
                yield np.loadtxt(batch, np.int64, comments=None, ndmin=2)[:, 1:]
                continue
        yield [_corners(row, name) for row in batch]


def _corners(row: str, name: str) -> list[int]:
    """Return the corners of a row of a face: how many, which, and perhaps a colour."""
    words = row.split()
    try:
        corners = [int(word) for word in words[1 : 1 + int(words[0])]]
    except ValueError:
        corners = []
    if not corners or len(corners) != int(words[0]):
        raise TiskelError(f"{name}: {short(row)!r} is no face; it needs a count and so many whole numbers")
    return corners


OFF = Format("OFF", (".off",), read, None, lambda data: bool(MARK.match(data[:5].decode("latin-1"))))
