"""Meshes and clouds in OFF, read here: Open3D crashes or hangs on files whose header is wrong."""

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short
from tiskel.io.formats.faces import fans

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
    lines = [line.partition("#")[0].strip() for line in data.decode("latin-1").splitlines()]
    rows = [line for line in lines if line]
    mark = MARK.match(rows[0]) if rows else None
    if mark is None:
        raise TiskelError(f"{name} is no OFF file: it does not begin with OFF; is its suffix right?")
    rows[:1] = [rest] if (rest := rows[0][mark.end() :].strip()) else []
    counts = re.fullmatch(r"(\d{1,18})\s+(\d{1,18})(\s+-?\d+)?", rows[0]) if rows else None
    if counts is None:
        raise TiskelError(f"{name}: no counts of vertices and faces after OFF; export it again")
    vertices, faces = int(counts[1]), int(counts[2])
    if len(rows) - 1 != vertices + faces:
        raise TiskelError(
            f"{name}: the header promises {vertices} vertices and {faces} faces, {len(rows) - 1} rows follow; "
            "export it again"
        )
    points = _points(rows[1 : 1 + vertices], name)
    return Parsed(points, fans(_polygons(rows[1 + vertices :], name), vertices, name))


def _points(rows: Sequence[str], name: str) -> Points:
    if not rows:
        raise TiskelError(f"{name} holds no points; check how it was made")
    try:
        return np.ascontiguousarray(np.loadtxt(rows, comments=None, ndmin=2)[:, :3])
    except ValueError as error:
        raise TiskelError(f"{name}: {short(str(error))}; every vertex needs the same numbers") from None


def _polygons(rows: Sequence[str], name: str) -> Sequence[Sequence[int]] | npt.NDArray[np.int64]:
    """Return the corners of all faces: as one array where all are triangles without colours, which takes a tenth."""
    if all(row.startswith("3 ") and row.count(" ") == 3 for row in rows):
        try:
            return np.loadtxt(rows, np.int64, comments=None, ndmin=2)[:, 1:].reshape(-1, 3) if rows else []
        except ValueError:
            pass
    return [_corners(row, name) for row in rows]


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
