"""The member order of the published toolbox, ring by ring: Qhull's triangles about a point, walked one by one."""

import numpy as np
from scipy.spatial import Delaunay, QhullError

from tiskel.arrays import Lists, Points, Table
from tiskel.geometry.rings import Rings


def in_published_order(points: Points, neighbours: Lists, rings: Rings) -> Lists:
    """Return the members of all rings, those that Qhull triangulates otherwise as they are."""
    clouds = points[neighbours]
    axes = np.linalg.svd(clouds - clouds.mean(axis=1, keepdims=True), full_matrices=False)[2]
    flat = np.einsum("nkc,nac->nka", clouds, axes[:, :2])
    members: Lists = np.array(rings.members, np.int32)
    for i in range(len(rings)):
        walk = neighbours[i, _walk(flat[i])]
        if len(walk) == rings.sizes[i] and set(walk) == set(rings.of(i)):
            members[i, : len(walk)] = walk
    return members


def _walk(flat: Table) -> list[int]:
    """Return the ranks of the ring members of point 0 in the order of the toolbox."""
    try:
        triangles = Delaunay(flat, qhull_options="Qt Qbb Qc").simplices
    except QhullError:
        return []
    about = [triangle for triangle in triangles.tolist() if 0 in triangle]
    about.sort(key=lambda triangle: triangle[2] == 0)  # column by column; the first two are one to it
    sides = [sorted(set(triangle) - {0}) for triangle in about]
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
