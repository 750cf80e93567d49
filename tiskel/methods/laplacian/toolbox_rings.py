"""Rings as the toolbox of GLSkeleton keeps and merges them: lists, in which a closed ring repeats its first member.

What a list says of itself decides: one whose ends are the same is closed, however it came to be so.
"""

import numpy as np
from scipy.spatial import Delaunay, QhullError

from tiskel.arrays import Indices, Numbers, Points, Table
from tiskel.geometry.rings import Rings

Ring = list[int]
LEAST = 4  # members of the list of a merged ring, the repeated one of a closed ring among them
EPS = float(np.finfo(float).eps)  # what counts as 0 there


def with_repeats(rings: Rings) -> list[Ring]:
    """Return rings as lists, the first member of a closed one again at its end."""
    lists = [rings.of(i).tolist() for i in range(len(rings))]
    return [one + one[:1] if closed else one for one, closed in zip(lists, rings.closed, strict=True)]


def without_repeats(lists: list[Ring]) -> Rings:
    """Return lists as rings; closed are those of two members at least whose ends are the same."""
    closed = np.array([len(one) > 1 and one[0] == one[-1] for one in lists], np.int32)
    sizes = np.array([len(one) for one in lists], np.int32) - closed
    members = np.full((len(lists), max(int(sizes.max(initial=1)), 1)), -1, np.int32)
    members[np.arange(members.shape[1]) < sizes[:, None]] = [
        member for one, size in zip(lists, sizes.tolist(), strict=True) for member in one[:size]
    ]
    return Rings(members, sizes, closed)


def merged_ring(origin: Points, kept: int, lost: int, rings: list[Ring], direction: Numbers) -> Ring:
    """Return the one-ring of a point among the members of two rings, empty where it is too small.

    Parameters
    ----------
    origin : (n, 3) float64
        The points before all contraction.
    kept, lost : int
        The point and the one that merges into it.
    rings : list of lists
        Of all points.
    direction : (3,) float64
        What the points are projected along; their principal plane is taken where it vanishes.
    """
    others = sorted((set(rings[kept]) | set(rings[lost])) - {kept, lost})
    if len(others) < 2:
        return []
    candidates = [kept, *others]
    ranks = walk(origin[candidates] @ _plane(direction, origin[candidates]))
    return [candidates[rank] for rank in ranks] if len(ranks) >= LEAST else []


def _plane(direction: Numbers, points: Points) -> Table:
    """Return two vectors (3, 2) across a direction, those of the toolbox: where rings start depends on them."""
    x, y, z = (float(part) for part in direction)
    if np.linalg.norm(direction) < EPS or (z < EPS and np.hypot(x, y) == 0):
        return np.asarray(np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2][:2].T)
    first = np.array([y, -x, 0.0]) if z < EPS else np.array([1.0, 1.0, -(x + y) / z])
    second = np.cross(direction, first)
    return np.stack([first / np.linalg.norm(first), second / np.linalg.norm(second)], axis=1)


def walk(flat: Table) -> list[int]:
    """Return the ring of the first of some points in a plane as the toolbox walks it; a closed one ends as it began.

    Of Qhull's triangles about it those come last that have it as their third corner; an open ring starts at its end of
    lower number, a closed one at the lower number of its first side.

    Examples
    --------
    >>> walk(np.array([[0.0, 0], [1, 0], [0, 1], [-1, 0], [0, -1.1]]))
    [3, 4, 1, 2, 3]
    >>> walk(np.array([[0.0, 0], [1, 0.1], [1, 1], [0, 1]]))
    [1, 3]
    """
    try:
        triangles = Delaunay(flat, qhull_options="QJ Pp").simplices.tolist()
    except QhullError:
        return []
    about = sorted((triangle for triangle in triangles if 0 in triangle), key=lambda triangle: triangle[2] == 0)
    sides = [sorted(set(triangle) - {0}) for triangle in about]
    if not sides:
        return []
    labels, times = np.unique(np.array(sides), return_counts=True)
    ends = labels[times == 1]
    at = int(ends[0]) if len(ends) else sides[0][0]
    ring = []
    for _ in range(len(labels) + (len(ends) == 0)):
        ring.append(at)
        at = _across(sides, at)
    return ring


def _across(sides: list[list[int]], label: int) -> int:
    """Leave a label through the first side that holds it, first members before second ones; the far end is used up."""
    for place in (0, 1):
        for side in sides:
            if side[place] == label:
                other, side[1 - place] = side[1 - place], -1
                return other
    return label


def renamed(rings: list[Ring], into: Indices) -> list[Ring]:
    """Return the rings of the points that stay, in their numbers; of members side by side that are one, one is left."""
    kept = np.flatnonzero(into < 0)
    number = np.full(len(into), -1)
    number[kept] = np.arange(len(kept))
    name = np.where(into >= 0, number[into], number).tolist()
    fresh = ([name[member] for member in rings[i]] for i in kept.tolist())
    return [[one for one, after in zip(ring, [*ring[1:], None], strict=True) if one != after] for ring in fresh]
