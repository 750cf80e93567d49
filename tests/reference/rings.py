"""One-rings from a full Delaunay triangulation."""

import itertools

import numpy as np
from scipy.spatial import Delaunay

Ring = tuple[list[int], bool]


def one_ring(flat: np.ndarray) -> Ring:
    """Return the one-ring of the origin among points (m, 2) by Qhull: labels in order, and whether it is closed."""
    everyone = np.concatenate([[[0.0, 0.0]], flat])
    triangles = Delaunay(everyone).simplices
    links: dict[int, set[int]] = {}
    for triangle in triangles[(triangles == 0).any(axis=1)]:
        a, b = (int(v) - 1 for v in triangle if v != 0)
        links.setdefault(a, set()).add(b)
        links.setdefault(b, set()).add(a)
    ends = [v for v, others in links.items() if len(others) == 1]
    ring = [ends[0] if ends else min(links)]
    while len(ring) < len(links):
        ring.append(next(v for v in sorted(links[ring[-1]]) if v not in ring))
    return _counter_clockwise(flat, ring, not ends), not ends


def _counter_clockwise(flat: np.ndarray, ring: list[int], closed: bool) -> list[int]:
    """Turn a ring as the library documents it; a closed one starts at its nearest member."""
    turns = [flat[a, 0] * flat[b, 1] - flat[a, 1] * flat[b, 0] for a, b in itertools.pairwise(ring)]
    if sum(turn > 0 for turn in turns) < len(turns) / 2:
        ring = ring[::-1]
    if closed:
        start = int(np.argmin(np.sum(flat[ring] ** 2, axis=1)))
        ring = ring[start:] + ring[:start]
    return ring


def same(a: Ring, b: Ring) -> bool:
    """Tell whether two rings are equal up to rotation (closed only) and reversal."""
    return _canonical(a) == _canonical(b)


def _canonical(ring: Ring) -> tuple[list[int], bool]:
    members, closed = list(ring[0]), bool(ring[1])
    if not closed or not members:
        return min(members, members[::-1]), closed
    start = members.index(min(members))
    forwards = members[start:] + members[:start]
    return min(forwards, [forwards[0], *forwards[:0:-1]]), closed


def published(table: np.ndarray) -> list[Ring]:
    """Return the rings of a toolbox file: -1 pads, a closed ring repeats its first index at its end."""
    rings = []
    for row in table:
        members = [int(v) for v in row if v >= 0]
        closed = len(members) > 1 and members[0] == members[-1]
        rings.append((members[:-1] if closed else members, closed))
    return rings
