"""Meshes and clouds in OBJ, read here: Open3D loses files of points alone and hangs on damaged ones."""

from collections.abc import Sequence

import numpy as np

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short
from tiskel.io.formats.faces import fans


def read(data: bytes, name: str) -> Parsed:
    """Return vertices and triangles; all other statements are left out.

    A face counts vertices from 1, or backwards from the last one before it.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where a vertex has no three numbers, or a face names no vertex or one that is not there.
    """
    vertices: list[str] = []
    polygons: list[list[int]] = []
    for line in data.decode("latin-1").replace("\\\r\n", " ").replace("\\\n", " ").splitlines():
        word, _, rest = line.strip().partition(" ")
        if word == "v":
            vertices.append(rest)
        elif word == "f":
            polygons.append(_corners(rest, len(vertices), name))
    return Parsed(_points(vertices, name), fans(polygons, len(vertices), name))


def _points(rows: Sequence[str], name: str) -> Points:
    if not any(row.partition("#")[0].strip() for row in rows):
        raise TiskelError(f"{name} holds no points; check how it was made")
    try:
        points = np.loadtxt(rows, usecols=(0, 1, 2), comments="#", ndmin=2)
    except ValueError as error:
        raise TiskelError(f"{name}: {short(str(error))}; every vertex needs three numbers") from None
    if len(points) != len(rows):
        raise TiskelError(f"{name}: {len(rows) - len(points)} vertices hold nothing; every vertex needs three numbers")
    return points


def _corners(rest: str, so_far: int, name: str) -> list[int]:
    """Return the corners of a face, counted from 0, from words like 3, 3/1 or 3//2."""
    try:
        numbers = [int(word.partition("/")[0]) for word in rest.partition("#")[0].split()]
    except ValueError:
        numbers = []
    if not numbers or 0 in numbers:
        raise TiskelError(f"{name}: 'f {short(rest)}' is no face; it needs numbers of vertices from 1")
    return [number - 1 if number > 0 else so_far + number for number in numbers]


OBJ = Format("OBJ", (".obj",), read)
