"""The member order that the published toolbox gives to a ring.

A ring is the same ring wherever it starts, but the toolbox depends on the
start: the repeated first member of a closed ring counts twice in the first
contraction weight, and the curve stage joins samples by the *first* foreign
member. The order follows from how the toolbox reads its triangulation: Qhull's
triangles about the point, in Qhull's order, walked from the smaller label of
the first one; the labels are ranks among the neighbours, the coordinates the
neighbours' own (not centred) on LAPACK's singular vectors. Done so, more than
99 % of the rings of the reference clouds start and turn as in the toolbox;
the others are the same rings from another start.
"""

import numpy as np
from scipy.spatial import Delaunay, QhullError

from tiskel.arrays import Lists, Points, Table
from tiskel.geometry.rings import Rings


def in_published_order(points: Points, neighbours: Lists, rings: Rings) -> Rings:
    """Return the same rings, each starting and turning as in the toolbox.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    neighbours : (n, k) int32
        The nearest of every point, itself first.
    rings : Rings
        Of all points.

    Returns
    -------
    Rings
        Those that Qhull triangulates otherwise stay as they are.
    """
    clouds = points[neighbours]
    axes = np.linalg.svd(clouds - clouds.mean(axis=1, keepdims=True), full_matrices=False)[2]
    flat = np.einsum("nkc,nac->nka", clouds, axes[:, :2])
    members = rings.members.copy()
    for i in range(len(rings)):
        walk = neighbours[i, _walk(flat[i])]
        if len(walk) == rings.sizes[i] and set(walk) == set(rings.of(i)):
            members[i, : len(walk)] = walk
    return Rings(members, rings.sizes, rings.closed)


def _walk(flat: Table) -> list[int]:
    """Return the ranks of the ring members of point 0 in the order of the toolbox."""
    try:
        triangles = Delaunay(flat, qhull_options="Qt Qbb Qc").simplices
    except QhullError:
        return []
    sides = [sorted(set(map(int, triangle)) - {0}) for triangle in triangles[(triangles == 0).any(axis=1)]]
    if not sides:
        return []
    labels, counts = np.unique(np.array(sides), return_counts=True)
    ends = labels[counts == 1]
    at = int(ends[0]) if len(ends) else sides[0][0]
    walk = []
    for _ in range(len(labels)):
        walk.append(at)
        at = _across(sides, at)
    return walk


def _across(sides: list[list[int]], label: int) -> int:
    """Leave a label through the first side that holds it, first members before second ones; the far end is used up."""
    for place in (0, 1):
        for side in sides:
            if side[place] == label:
                other, side[1 - place] = side[1 - place], -1
                return other
    return label
