"""Meshes and clouds in OBJ, read here: Open3D loses files of points alone and hangs on damaged ones."""

from collections.abc import Iterator
from itertools import chain

import numpy as np

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, rows_of, short
from tiskel.io.formats.faces import BATCH, fans, joined


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
    whole = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")  # rows that go on in the next
    points = _points(whole, name)
    return Parsed(points, joined(fans(each, len(points), name) for each in _polygons(whole, name)))


def _points(data: bytes, name: str) -> Points:
    rests = filter(None, (row[1:].strip() for row in rows_of(data) if _is(row, "v")))
    first = next(rests, None)
    if first is None:
        raise TiskelError(f"{name} holds no points; check how it was made")
    try:
        return np.loadtxt(chain([first], rests), usecols=(0, 1, 2), comments=None, ndmin=2)
    except ValueError as error:
        raise TiskelError(f"{name}: {short(str(error))}; every vertex needs three numbers") from None


def _is(row: str, word: str) -> bool:
    return row[0] == word and (len(row) == 1 or row[1].isspace())


def _polygons(data: bytes, name: str) -> Iterator[list[list[int]]]:
    """Yield the corners of so many faces at a time."""
    polygons: list[list[int]] = []
    so_far = 0
    for row in rows_of(data):
        if _is(row, "v"):
            if len(row) == 1:
                raise TiskelError(f"{name}: vertex {so_far + 1} holds nothing; every vertex needs three numbers")
            so_far += 1
        elif _is(row, "f"):
            polygons.append(_corners(row[1:], so_far, name))
        if len(polygons) == BATCH:
            yield polygons
            polygons = []
    yield polygons


def _corners(rest: str, so_far: int, name: str) -> list[int]:
    """Return the corners of a face, counted from 0, from words like 3, 3/1 or 3//2."""
    try:
        numbers = [int(word.partition("/")[0]) for word in rest.split()]
    except ValueError:
        numbers = []
    if not numbers or 0 in numbers:
        raise TiskelError(f"{name}: 'f {short(rest.strip())}' is no face; it needs numbers of vertices from 1")
    return [number - 1 if number > 0 else so_far + number for number in numbers]


OBJ = Format("OBJ", (".obj",), read)
