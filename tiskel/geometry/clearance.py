"""How far places inside a body are from its surface: of unions of round cones, of meshes and of clouds."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Mask, Numbers, Points
from tiskel.errors import TiskelError
from tiskel.geometry.oriented import OrientedCloud, checked
from tiskel.geometry.round_cones import ConeGraph, bounding_balls, cone_areas, touching, visible

FINE = 0.15  # local radii between samples of a union: the distance to the nearest is 0.6 % too long at the axis
MOST = 1_000_000  # samples of a union: bounds the memory; a larger one is sampled more coarsely
OF_MESH = 100_000  # points of a mesh
PLASTIC = 1 / 1.32471795724474602596  # steps of an even sequence of pairs, see tiskel.geometry.round_cones


class Body(Protocol):
    """A body that says how far places in it are from its surface."""

    def clearance(self, places: Points) -> Numbers:
        """Return (q,) the distance from places (q, 3) inside to the surface; 0 outside."""
        ...


@runtime_checkable
class QuickBody(Body, Protocol):
    """A body whose distances cost less than to tell inside from outside, which then is asked of few places."""

    def contains(self, places: Points) -> Mask:
        """Return (q,) which places (q, 3) are inside."""
        ...

    def distances(self, places: Points) -> Numbers:
        """Return (q,) how far places (q, 3) are from the surface, inside or outside."""
        ...


@dataclass(frozen=True)
class ConeBody:
    """A union of round cones; its surface is sampled by local thickness, the inside is exact.

    From inside, the distance to the surface of a union is not the least distance
    to that of a part, since parts of it lie inside others.

    Attributes
    ----------
    shape : ConeGraph
        In any unit; open ends count as closed.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import shape_graph
    >>> from tiskel.geometry.clearance import ConeBody
    >>> capsule = shape_graph("capsule")
    >>> deep = ConeBody(capsule).clearance(np.array([capsule.nodes.mean(axis=0), [9, 9, 9]])) / capsule.radii[0]
    >>> deep.round(1).tolist()
    [1.0, 0.0]
    """

    shape: ConeGraph

    def contains(self, places: Points) -> Mask:
        """Return (q,) which places (q, 3) are inside one of the cones."""
        from tiskel.kernels.cones import cone_feet

        shape, count = self.shape, len(places)
        edge, share, out = np.empty(count, np.int32), np.empty(count), np.empty(count)
        every = np.arange(len(shape.edges), dtype=np.int32)[None]
        rows, lists = np.arange(count, dtype=np.int32), np.zeros(count, np.int32)
        arrays = [np.ascontiguousarray(array) for array in (places, shape.nodes, shape.radii, shape.edges)]
        held = bounding_balls(shape.nodes, shape.radii, shape.edges)
        cone_feet(arrays[0], rows, lists, every, *arrays[1:], *held, 1, 0, edge, share, out)
        return np.asarray(out < 0)

    def distances(self, places: Points) -> Numbers:
        """Return (q,) how far places (q, 3) are from the nearest sample of the surface."""
        return np.asarray(self._surface.query(places)[0])

    def clearance(self, places: Points) -> Numbers:
        """Return (q,) the same inside, 0 outside."""
        return np.where(self.contains(places), self.distances(places), 0.0)

    @cached_property
    def _surface(self) -> cKDTree:
        """Samples of the parts, without those inside other parts."""
        shape, generator = replace(self.shape, open_ends=()), np.random.default_rng(0)
        radii = shape.radii[shape.edges]
        fine = FINE * np.maximum(radii.min(axis=1), radii.mean(axis=1) / 2)  # of a tip that runs to nothing
        wanted, around = cone_areas(shape) / fine**2, touching(shape)
        counts = np.ceil(wanted * min(1.0, MOST / wanted.sum())).astype(int)
        return cKDTree(np.concatenate([visible(shape, e, int(n), around[e], generator) for e, n in enumerate(counts)]))


@dataclass(frozen=True, eq=False)
class CloudBody:
    """The solid within an oriented surface: inside by winding number, distances to the nearest point.

    Attributes
    ----------
    surface : OrientedCloud
        Points of a scan, or of a mesh, see :func:`mesh_surface`; they should be trusted.
    """

    surface: OrientedCloud

    def contains(self, places: Points) -> Mask:
        """Return (q,) which places (q, 3) are inside."""
        return self.surface.contains(places)

    def distances(self, places: Points) -> Numbers:
        """Return (q,) how far places (q, 3) are from the nearest point."""
        return np.asarray(self._tree.query(places)[0])

    def clearance(self, places: Points) -> Numbers:
        """Return (q,) the same inside, 0 outside."""
        return np.where(self.contains(places), self.distances(places), 0.0)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.surface.points)


def mesh_surface(vertices: Points, faces: Edges, count: int = OF_MESH) -> OrientedCloud:
    """Return points on a triangle mesh with the normals of its faces, turned outwards.

    Parameters
    ----------
    vertices : (v, 3) float64
        In any unit.
    faces : (m, 3) int32
        The vertices of every triangle; together they should be closed and turn one way, whichever.
    count : int
        How many points, evenly by area.

    Returns
    -------
    OrientedCloud
        Its consistency says whether the mesh has an inside.

    Raises
    ------
    TiskelError
        Where the triangles have no area.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.clearance import mesh_surface
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> surface = mesh_surface(corners, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], np.int32), 2000)
    >>> surface.trusted, surface.contains(np.array([[0.2, 0.2, 0.2], [1, 1, 1]])).tolist()
    (True, [True, False])
    """
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    crosses = np.cross(b - a, c - a)
    areas = np.linalg.norm(crosses, axis=1) / 2
    total = float(areas.sum())
    if not total > 0:
        raise TiskelError(f"the mesh of {len(faces)} triangles has no area; check its vertices")
    steps = (np.arange(count) + 0.5) / count
    face = np.minimum(np.searchsorted(np.cumsum(areas), steps * total), len(faces) - 1)
    root, share = np.sqrt(np.arange(count) * PLASTIC % 1)[:, None], (np.arange(count) * PLASTIC**2 % 1)[:, None]
    points = (1 - root) * a[face] + root * (1 - share) * b[face] + root * share * c[face]  # Osada et al. 2002
    points, first = np.unique(points, axis=0, return_index=True)
    normals = (crosses[face] / (2 * areas[face])[:, None])[first]
    made = [
        checked(OrientedCloud(points, side * normals, np.full(len(points), total / count)), 0) for side in (1.0, -1.0)
    ]
    return max(made, key=lambda surface: surface.consistency)
