"""Closed parts of a mesh that run into each other are one body: what lies inside another part is no surface of it.

The winding number of all other parts about a point is one where it lies inside
one of them, and zero outside. Where parts only touch, or nearly, it is about a
half, since the surface is made of points.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points
from tiskel.geometry.mesh_surface import MeshSurface, unique_pairs
from tiskel.geometry.oriented import OrientedCloud

BURIED = 0.75  # winding number of the other parts from which on a point lies inside one of them
ACROSS = 2.0  # spacings over which points of two parts are linked where one enters the other
CRUMB = 0.005  # of the points; smaller pieces next to hidden ones go with them
LISTED = 12  # nearest points that are asked for such links


def united(points: Points, surface: MeshSurface, part: Indices) -> tuple[MeshSurface, Indices]:
    """Return what is known of the points that bound the union of closed parts, and which of them do.

    Parameters
    ----------
    points : (n, 3) float64
        On the mesh, in any unit.
    surface : MeshSurface
        What the mesh knows about them.
    part : (n,) int32
        The part of the mesh that each lies on.

    Returns
    -------
    MeshSurface
        The argument itself where no part enters another; else without known handles.
    rows : (m,) int32
        The points that are left.
    """
    every = np.arange(len(points), dtype=np.int32)
    if not surface.outward or part.max(initial=0) == 0:
        return surface, every
    buried = _winding_of_others(points, surface, part) > BURIED
    if not buried.any():
        return surface, every
    links = np.concatenate([surface.links, _entries(points, surface, part, buried)])
    links = links[~buried[links].any(axis=1)]
    left = every[~(buried | _crumbs(links, buried, surface))]
    whole = MeshSurface(surface.normals, surface.areas, unique_pairs(links), surface.outward, None)
    return whole.at(left), left


def _winding_of_others(points: Points, surface: MeshSurface, part: Indices) -> Numbers:
    """Return (n,) the winding number about each point of all other parts; for a hollow, but what is around.

    The walls of a hollow have their normals inwards, and their own winding number is negative.
    """
    found = OrientedCloud(points, surface.normals, surface.areas).winding_numbers(points)
    order = np.argsort(part, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        own = np.ascontiguousarray(points[rows])
        alone = OrientedCloud(own, surface.normals[rows], surface.areas[rows]).winding_numbers(own)
        found[rows] -= alone + float(np.median(alone) < 0)
    return found


def _crumbs(links: Edges, buried: Mask, surface: MeshSurface) -> Mask:
    """Return (n,) which points hang together with few others only, next to buried ones: they are as good as buried."""
    count = len(buried)
    graph = sparse.coo_array((np.ones(len(links), bool), (links[:, 0], links[:, 1])), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    size, near = np.bincount(label), np.zeros(len(np.bincount(label)), bool)
    one, other = surface.links.T
    near[label[one[buried[other]]]] = near[label[other[buried[one]]]] = True
    return np.asarray((near & (size < CRUMB * count))[label])


def _entries(points: Points, surface: MeshSurface, part: Indices, buried: Mask) -> Edges:
    """Return links (l, 2) between the parts, from points that are next to what another part hides."""
    one, other = surface.links.T
    rim = np.zeros(len(points), bool)
    rim[one[buried[other]]] = rim[other[buried[one]]] = True
    rows, left = np.flatnonzero(rim & ~buried), np.flatnonzero(~buried)
    if len(rows) == 0:
        return np.zeros((0, 2), np.int32)
    distances, near = cKDTree(points[left]).query(points[rows], min(LISTED, len(left)))
    near = left[near].reshape(len(rows), -1)
    reach = ACROSS * np.sqrt(np.maximum(surface.areas[rows][:, None], surface.areas[near]))
    wanted = (part[near] != part[rows][:, None]) & (distances.reshape(near.shape) <= reach)
    return np.stack([np.repeat(rows, wanted.sum(axis=1)), near[wanted]], axis=1).astype(np.int32)
