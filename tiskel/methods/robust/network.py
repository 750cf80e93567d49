"""Which points are neighbours along the surface, and what the neighbourhoods say: prepared once for a cloud."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from tiskel.arrays import TINY, Edges, Indices, Lists, Masks, Numbers, Points, Table
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.geometry.oriented import OrientedCloud, oriented_away, oriented_by_propagation
from tiskel.geometry.rings import Rings
from tiskel.geometry.spacing import spacings_from

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
NORMAL_NEIGHBOURS = 12  # points, itself included, whose plane gives a point's normal [14, 14]
AREA_NEIGHBOURS = 8  # points in the disc about a point that gives its area [1, 0]
FARTHEST = 6.0  # spacings of either point; what is further away is no neighbour [10, 4]
FEWER = 0.5  # of the points without an inside and an outside that propagated normals leave, to be taken
SURE = 0.99  # of the points between an inside and an outside: propagated normals could do no better
LINE_NEIGHBOURS = 12  # points, itself included, that say whether the cloud is a line about a point
LINE = 0.6  # (s1 - s2) / s1 with the root eigenvalues of the scatter: a line above it [by trial on generated trees]
ALONG_NORMALS = 0.75  # cosine to both normals: such a step leaves the surface at both of its ends [13, 11]


@dataclass(frozen=True, eq=False)
class Network:
    """A cloud in its own axes, and its neighbour graph.

    Attributes
    ----------
    axes : (3, 3) float64
        The cloud's own axes as rows: points = given points @ axes.T.
    points : (n, 3) float64
        The points.
    normals : (n, 3) float64
        Of unit length, not oriented.
    areas : (n,) float64
        Of the surface that each point stands for.
    spacings : (n,) float64
        How far the points are apart about each.
    neighbours : (n, k) int32
        By distance, the point itself first.
    kept : (n, k) bool
        Which of them are neighbours along the surface.
    edges : (e, 2) int32
        Pairs of neighbours along the surface, lower row first.
    lengths : (e,) float64
        How long they are.
    surface : MeshSurface or None
        What the mesh knows that the points lie on; then normals and areas are its own, and what it does not link is
        no neighbour.
    """

    axes: Table
    points: Points
    normals: Points
    areas: Numbers
    spacings: Numbers
    neighbours: Lists
    kept: Masks
    edges: Edges
    lengths: Numbers
    surface: MeshSurface | None = None

    @cached_property
    def spacing(self) -> float:
        """The median spacing."""
        return float(np.median(self.spacings))

    @cached_property
    def linear_share(self) -> float:
        """The share of the points about which the cloud is a line."""
        near = self.points[self.neighbours[:, :LINE_NEIGHBOURS]]
        offset = near - near.mean(axis=1, keepdims=True)
        root = np.sqrt(np.maximum(np.linalg.eigvalsh(np.einsum("nki,nkj->nij", offset, offset)), 0))
        return float(((root[:, 2] - root[:, 1]) > LINE * np.maximum(root[:, 2], TINY)).mean())

    @cached_property
    def links(self) -> sparse.csr_array:
        """The upper triangle of the graph's matrix, ones; its data are in the order of the edges."""
        count = len(self.points)
        ones = np.ones(len(self.edges))
        return sparse.coo_array((ones, (self.edges[:, 0], self.edges[:, 1])), shape=(count, count)).tocsr()

    @cached_property
    def component(self) -> Indices:
        """(n,) the connected component of every point."""
        return np.asarray(connected_components(self.links, directed=False)[1], np.int32)

    @cached_property
    def averaging(self) -> sparse.csr_array:
        """The matrix (n, n) that replaces values by their mean over a point and its neighbours."""
        half = self.links
        whole = sparse.csr_array(half + half.T + sparse.eye_array(len(self.points), format="csr"))
        return sparse.csr_array(sparse.diags_array(1 / whole.sum(axis=1)) @ whole)

    def placed(self, place: tuple[float, float, float]) -> Numbers:
        """Return a place (3,) of the given coordinates in the cloud's own axes."""
        return np.asarray(self.axes @ np.array(place))

    def rings(self) -> Rings:
        """Return the neighbours that count as open rings, nearest first."""
        sizes = self.kept.sum(axis=1).astype(np.int32)
        members = np.full((len(sizes), max(1, int(sizes.max(initial=1)))), -1, np.int32)
        members[np.arange(members.shape[1]) < sizes[:, None]] = self.neighbours[self.kept]
        return Rings(members, sizes, np.zeros_like(sizes))

    def oriented(self, contracted: Points) -> OrientedCloud:
        """Return the cloud with normals away from where the points (n, 3) contract to, or with better ones.

        As a mesh has them; or propagated ones, where these leave clearly fewer points
        without an inside and an outside: points of a bulky body hardly contract.
        """
        if self.surface is not None and self.surface.outward:
            return OrientedCloud(self.points, self.normals, self.areas)
        near = np.ascontiguousarray(self.neighbours[:, :NORMAL_NEIGHBOURS])
        away = oriented_away(self.points, self.normals, self.areas, contracted)
        if away.consistency >= SURE:
            return away
        propagated = oriented_by_propagation(self.points, self.normals, self.areas, contracted, near)
        return propagated if 1 - propagated.consistency <= FEWER * (1 - away.consistency) else away


def own_axes(points: Points) -> Table:
    """Return (3, 3) the cloud's principal axes as rows, each towards its longer tail.

    Winding numbers are summed over blocks of a grid, so they depend a little on
    how the cloud lies in it. In its own axes it always lies the same.
    """
    offset = points - points.mean(axis=0)
    axes = np.linalg.eigh(offset.T @ offset)[1].T
    turned = offset @ axes.T
    return np.asarray(axes * np.where((turned * turned * turned).sum(axis=0) < 0, -1.0, 1.0)[:, None])


def prepared(points: Points, k: int, surface: MeshSurface | None = None) -> Network:
    """Return the network of a cloud (n, 3), and of the mesh that it lies on, in its own axes, see :func:`own_axes`."""
    axes = own_axes(points)
    turned = None if surface is None else replace(surface, normals=np.ascontiguousarray(surface.normals @ axes.T))
    return neighbour_network(np.ascontiguousarray(points @ axes.T), k, axes, turned)


def neighbour_network(
    points: Points, k: int, axes: Table | None = None, surface: MeshSurface | None = None
) -> Network:  # fmt: skip
    """Return the network of a cloud (n, 3) that lies in its axes, from its k nearest neighbours.

    Left out are steps that run along the normals at both ends, which would join
    the sides of a narrow gap, and steps to points that stand apart.
    """
    neighbours, squares = nearest_neighbours(points, min(k, len(points)))
    normals = principal_axes(points, np.ascontiguousarray(neighbours[:, :NORMAL_NEIGHBOURS]))[1][:, 2]
    normals = normals if surface is None else surface.normals
    steps, lengths = points[neighbours] - points[:, None], np.sqrt(squares)
    here = np.abs(np.einsum("nkc,nc->nk", steps, normals))
    there = np.abs(np.einsum("nkc,nkc->nk", steps, normals[neighbours]))
    disc = min(AREA_NEIGHBOURS, neighbours.shape[1] - 1)
    spacings = spacings_from(squares)
    kept = np.minimum(here, there) < ALONG_NORMALS * lengths
    kept &= lengths <= FARTHEST * np.minimum(spacings[:, None], spacings[neighbours])
    kept[:, 0] = False
    if surface is not None:
        kept &= surface.linked(neighbours)
    edges, edge_lengths = _edges(neighbours, kept, lengths)
    own = np.eye(3) if axes is None else axes
    areas = np.pi * squares[:, disc] / disc if surface is None else surface.areas
    return Network(own, points, normals, areas, spacings, neighbours, kept, edges, edge_lengths, surface)


def _edges(neighbours: Lists, kept: Masks, lengths: Table) -> tuple[Edges, Numbers]:
    count = len(neighbours)
    first, second = np.repeat(np.arange(count), kept.sum(axis=1)), neighbours[kept]
    keys, once = np.unique(np.minimum(first, second) * np.int64(count) + np.maximum(first, second), return_index=True)
    return np.stack([keys // count, keys % count], axis=1).astype(np.int32), lengths[kept][once]
