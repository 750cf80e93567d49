"""How thick a body is behind each point of its surface: the shape diameter, from points with normals.

A step inwards along the normal ends where points of the other side are near:
those whose normals look the other way (Shapira, Shamir and Cohen-Or, Consistent
mesh partitioning and skeletonisation using the shape diameter function, Visual
Computer 2008, with one ray for each point and a median over neighbours instead
of a cone of rays). Steps are as long as the way to the nearest point is free.
"""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Numbers, Points

AGAINST = -0.3  # cosine of two normals from which on they belong to opposite sides
CONE = 0.7  # cosine to the inward normal: what lies within is behind the point
LISTED = 16  # nearest points in which the other side of what is thinner than the points are apart is found
HIT = 1.0  # of the spacing there: so near to a point of the other side the way ends
FIRST = 1.5  # spacings that the first step is long
STEPS = 48  # at most; each is at least half a spacing
AVERAGED = 8  # points whose median thickness each gets


def thicknesses(points: Points, normals: Points, spacings: Numbers, farthest: float) -> Numbers:
    """Return the thickness behind each point of a surface.

    Parameters
    ----------
    points : (n, 3) float64
        On the surface, in any unit.
    normals : (n, 3) float64
        Of unit length, outwards.
    spacings : (n,) float64
        How far the points are apart about each, in their unit.
    farthest : float
        What counts as without another side, in the same unit.

    Returns
    -------
    (n,) float64
        At most the farthest.
    """
    tree = cKDTree(points)
    near = tree.query(points, min(LISTED, len(points)))[1].reshape(len(points), -1)
    offset = points[near] - points[:, None]
    depth = -np.einsum("nkc,nc->nk", offset, normals)
    against = np.einsum("nkc,nc->nk", normals[near], normals) < AGAINST
    behind = against & (depth > CONE * np.linalg.norm(offset, axis=2)) & (depth > 0)
    found = np.where(behind, depth, farthest).min(axis=1)
    going = np.flatnonzero(~behind.any(axis=1)).astype(np.int32)
    found[going] = _marched(tree, normals, spacings, going, farthest)
    steady = np.median(found[near[:, : min(AVERAGED, near.shape[1])]], axis=1)
    return np.asarray(np.minimum(steady, farthest))


def _marched(tree: cKDTree, normals: Points, spacings: Numbers, rows: Indices, farthest: float) -> Numbers:
    """Return how far it is inwards from some rows of the points to the other side."""
    points, way, depth = tree.data, FIRST * spacings[rows], np.full(len(rows), farthest)
    left = np.arange(len(rows))
    for _ in range(STEPS):
        here = rows[left]
        distance, nearest = tree.query(points[here] - way[left, None] * normals[here])
        opposite = np.einsum("ij,ij->i", normals[nearest], normals[here]) < AGAINST
        hit = opposite & (distance < HIT * spacings[nearest])
        depth[left[hit]] = way[left[hit]]
        way[left] += np.maximum(distance - 0.5 * HIT * spacings[nearest], 0.5 * spacings[here])
        left = left[~hit & (way[left] < farthest)]
        if len(left) == 0:
            break
    return depth
