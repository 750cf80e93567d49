"""What reading a curve gives, and the checks that all readers share."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Numbers, Points

MOST_NODES = 2**31  #: nodes are numbered by int32
RADII = ("radius", "radii", "r", "maximuminscribedsphereradius", "thickness")  #: names of radii, in lower case


@dataclass(frozen=True, eq=False)
class Lines:
    """A curve as a file has it.

    Attributes
    ----------
    nodes : (v, 3) float64
        Where the nodes are.
    edges : (e, 2) int32
        The two nodes of every edge.
    radii : (v,) float64 or None
        How thick the body is there; None where the file does not say.
    """

    nodes: Points
    edges: Edges
    radii: Numbers | None = None


def lines(nodes: Any, edges: Any, radii: Any = None) -> Lines:
    """Return a curve, checked: finite nodes of three numbers, edges between them, radii of 0 and more or NaN.

    Raises ValueError or TypeError with what is wrong.
    """
    places = table(nodes, 3, "nodes", np.float64)
    bad = np.flatnonzero(~np.isfinite(places).all(axis=1))
    if len(bad):
        raise ValueError(f"node {bad[0]} is at {places[bad[0]].tolist()}")
    links = table(edges, 2, "edges", np.int64)
    wrong = np.flatnonzero(((links < 0) | (links >= len(places))).any(axis=1))
    if len(wrong):
        raise ValueError(f"edge {wrong[0]} joins nodes {links[wrong[0]].tolist()}, there are {len(places)}")
    if radii is None:
        return Lines(places, links.astype(np.int32))
    known = np.array(radii, np.float64)
    if known.shape != (len(places),):
        raise ValueError(f"{known.size} radii for {len(places)} nodes")
    low = np.flatnonzero((known < 0) | np.isinf(known))
    if len(low):
        raise ValueError(f"the radius of node {low[0]} is {known[low[0]]}")
    return Lines(places, links.astype(np.int32), known)


def table(rows: Any, width: int, what: str, kind: Any) -> npt.NDArray[Any]:
    """Return rows of so many numbers; rows of another number are never cut or joined to fit."""
    if isinstance(rows, np.ndarray) and rows.ndim == 2 and rows.shape[1] == width:
        return rows.astype(kind)
    found = list(rows)
    lengths = sorted(set(map(len, found)) - {width})
    if lengths:
        raise ValueError(f"{what} have rows of {lengths[0]} numbers, {width} are needed")
    if not all(isinstance(value, int | float) and not isinstance(value, bool) for row in found for value in row):
        raise ValueError(f"{what} hold something that is no number")
    made = np.array(found, np.float64 if kind is np.float64 else None).reshape(-1, width)
    if kind is np.int64 and made.size and made.dtype.kind not in "iu":
        raise ValueError(f"{what} hold something that is no whole number of reasonable size")
    return made.astype(kind)


def joined(starts: Points, stops: Points, radii: tuple[Numbers, Numbers] | None = None) -> Lines:
    """Return segments as a curve: ends at the very same place are one node, segments without length are left out."""
    ends = np.concatenate([starts, stops]) + 0.0  # no negative zeros
    if not np.isfinite(ends).all():
        raise ValueError("a segment has an end that is not finite")
    nodes, first, place = np.unique(ends, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # nodes in the order of the file
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    pairs = rank[place.ravel()].reshape(2, -1).T
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    known = None if radii is None else np.concatenate(radii)[first[order]]
    return lines(nodes[order], pairs, known)


def chained(ways: Sequence[Sequence[int]]) -> list[tuple[int, int]]:
    """Return the edges along ways of nodes."""
    return [pair for way in ways for pair in zip(way[:-1], way[1:], strict=True)]


def radii_of(names: Sequence[str]) -> str | None:
    """Return which of the names is that of radii, None where none is."""
    lower = {name.lower(): name for name in reversed(names)}
    return next((lower[known] for known in RADII if known in lower), None)
