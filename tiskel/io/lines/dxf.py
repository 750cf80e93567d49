"""Curves as DXF: what CAD programs and CloudCompare read."""

import io
from collections.abc import Iterator
from itertools import chain

import numpy as np

from tiskel.arrays import Points
from tiskel.io.lines.base import Lines, joined
from tiskel.skeleton import Skeleton

BINARY = b"AutoCAD Binary DXF"
CLOSED = 1  #: bit of group 70 of a polyline
Group = tuple[int, str]


def read(data: bytes, name: str) -> Lines:
    """Return the lines and polylines of a text file, whatever their layers; equal ends are one node."""
    if data.startswith(BINARY):
        raise ValueError("it is a binary DXF; save it as text")
    segments = [segment for way in _ways(_groups(data)) for segment in zip(way[:-1], way[1:], strict=True)]
    if not segments:
        raise ValueError("it holds no LINE, POLYLINE or LWPOLYLINE")
    ends = np.array(segments, np.float64)
    return joined(ends[:, 0], ends[:, 1])


def _groups(data: bytes) -> Iterator[Group]:
    rows = io.TextIOWrapper(io.BytesIO(data), "latin-1")
    for code, value in zip(rows, rows, strict=False):
        yield int(code), value.strip()


def _ways(groups: Iterator[Group]) -> Iterator[list[list[float]]]:
    """Yield the places along every line and polyline."""
    kind, way, closed = "", [], False
    polyline: list[list[float]] | None = None  # an old polyline, whose places are entities of their own
    held: list[Group] = []
    for code, value in chain(groups, [(0, "EOF")]):
        if code != 0:
            held.append((code, value))
            continue
        if kind == "VERTEX" and polyline is not None:
            polyline += _places(held, (10, 20, 30))
        elif kind == "LINE":
            yield _places(held, (10, 20, 30))[:1] + _places(held, (11, 21, 31))[:1]
        elif kind == "LWPOLYLINE":
            height = next((float(value) for code, value in held if code == 38), 0.0)
            way = [[x, y, height] for x, y, _ in _places(held, (10, 20, 30))]
            yield way + way[:1] if _flag(held) & CLOSED else way
        elif kind == "POLYLINE":
            polyline, closed = [], bool(_flag(held) & CLOSED)
        if value != "VERTEX" and polyline is not None and kind != "POLYLINE":
            yield polyline + polyline[:1] if closed else polyline
            polyline = None
        kind, held = value, []


def _places(held: list[Group], codes: tuple[int, int, int]) -> list[list[float]]:
    """Return the places of an entity; a group of x begins one, y and z may be missing."""
    places: list[list[float]] = []
    for code, value in held:
        if code == codes[0]:
            places.append([float(value), 0.0, 0.0])
        elif code in codes and places:
            places[-1][codes.index(code)] = float(value)
    return places


def _flag(held: list[Group]) -> int:
    return next((int(value) for code, value in held if code == 70), 0)


def write(s: Skeleton) -> bytes:
    """Return DXF (release 12, text) with a polyline in space for each branch, on a layer of its own."""
    rows = ["0", "SECTION", "2", "HEADER", "9", "$ACADVER", "1", "AC1009", *_extent(s.nodes), "0", "ENDSEC"]
    rows += ["0", "SECTION", "2", "ENTITIES"]
    for number, branch in enumerate(s.branches):
        if len(branch) < 2:
            continue
        layer = ["8", f"branch_{number}"]
        rows += ["0", "POLYLINE", *layer, "66", "1", "70", "8", "10", "0.0", "20", "0.0", "30", "0.0"]
        for x, y, z in s.nodes[branch].tolist():
            rows += ["0", "VERTEX", *layer, "10", repr(x), "20", repr(y), "30", repr(z), "70", "32"]
        rows += ["0", "SEQEND", *layer]
    return ("\r\n".join([*rows, "0", "ENDSEC", "0", "EOF"]) + "\r\n").encode()


def _extent(nodes: Points) -> list[str]:
    rows: list[str] = []
    for name, corner in (("$EXTMIN", nodes.min(axis=0)), ("$EXTMAX", nodes.max(axis=0))):
        x, y, z = corner.tolist()
        rows += ["9", name, "10", repr(x), "20", repr(y), "30", repr(z)]
    return rows
