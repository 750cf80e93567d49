"""Triangle meshes: what hangs together, where they are open, and how many handles they have.

Corners at one place are one vertex, whatever the file says. Where two triangles
meet along an edge the surface goes on; where one ends, or more than two meet, it
is cut. What is left is a surface with an edge, so that vertices - edges + faces =
2 - 2 genus - boundary loops holds for each piece of it.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Mask, Numbers, Pairs, Points, diagonal, finite_rows

WELD = 2.4e-7  # of the diagonal; corners nearer than two steps of single precision are one vertex


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles whose corners are one vertex where they are at one place.

    Attributes
    ----------
    vertices : (v, 3) float64
        In any unit.
    faces : (m, 3) int32
        Their corners, counter-clockwise seen from outside where the mesh has an outside.
    """

    vertices: Points
    faces: Edges

    @cached_property
    def areas(self) -> Numbers:
        """(m,) the areas."""
        return np.asarray(np.linalg.norm(self._crosses, axis=1) / 2)

    @cached_property
    def normals(self) -> Points:
        """(m, 3) unit normals; zero where a triangle has no area."""
        length = np.linalg.norm(self._crosses, axis=1, keepdims=True)
        return np.asarray(np.divide(self._crosses, length, out=np.zeros_like(self._crosses), where=length > 0))

    @cached_property
    def _crosses(self) -> Points:
        a, b, c = (self.vertices[self.faces[:, corner]] for corner in range(3))
        return np.asarray(np.cross(b - a, c - a))

    @cached_property
    def part(self) -> Indices:
        """(m,) the connected part of every triangle: triangles that share a vertex hang together."""
        first, second = self.faces[:, [0, 1]].ravel(), self.faces[:, [1, 2]].ravel()
        label = connected_components(_matrix(first, second, len(self.vertices)), directed=False)[1]
        return np.unique(label[self.faces[:, 0]], return_inverse=True)[1].astype(np.int32)

    @cached_property
    def halves(self) -> "HalfEdges":
        """Which sides of triangles meet."""
        return half_edges(self.faces)


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """The sides of triangles: 3 f + i runs from corner i of triangle f to the next.

    Attributes
    ----------
    meeting : (p, 2) int64
        Pairs of sides of two triangles that meet there, and no others.
    free : (q,) int32
        Sides where the surface ends.
    crowded : int
        How many of these lie where more than two triangles meet.
    opposite : (p,) bool
        Which pairs run opposite ways, as they do where both triangles have the same side out.
    """

    meeting: Pairs
    free: Indices
    crowded: int
    opposite: Mask


def pair_keys(pairs: Pairs, count: int) -> npt.NDArray[np.int64]:
    """Return (n,) one number for each pair (n, 2) of numbers below a count, whichever of them is first."""
    return np.asarray(pairs.min(axis=1) * np.int64(count) + pairs.max(axis=1))


def half_edges(faces: Edges) -> HalfEdges:
    """Return which sides of triangles (m, 3) meet."""
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    keys = pair_keys(ends, int(faces.max(initial=0)) + 1)
    _, edge, counts = np.unique(keys, return_inverse=True, return_counts=True)
    order = np.argsort(edge, kind="stable")
    paired = order[counts[edge[order]] == 2].reshape(-1, 2)
    free = np.flatnonzero(counts[edge] != 2).astype(np.int32)
    opposite = ends[paired[:, 0], 0] == ends[paired[:, 1], 1]
    return HalfEdges(paired, free, int((counts[edge] > 2).sum()), np.asarray(opposite))


def welded(vertices: Points, faces: Edges) -> TriangleMesh:
    """Return a mesh without what a file repeats: corners at one place, triangles without area or twice there.

    Closed parts whose sides are turned inwards are turned outwards. Vertices and triangles are in the order of their
    coordinates: the order in the file does not matter.

    Parameters
    ----------
    vertices : (v, 3) float64
        In any unit; triangles with corners that are not finite are dropped.
    faces : (m, 3) int32
        The corners of every triangle.

    Returns
    -------
    TriangleMesh
    """
    whole = faces[finite_rows(vertices)[faces].all(axis=1)]
    used, corner = np.unique(whole, return_inverse=True)
    points = vertices[used]
    if len(points) == 0:
        return TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int32))
    places, same = np.unique(points, axis=0, return_inverse=True)
    near = cKDTree(places).query_pairs(WELD * diagonal(places), output_type="ndarray")
    label = connected_components(_matrix(near[:, 0], near[:, 1], len(places)), directed=False)[1]
    first = np.unique(label, return_index=True)[1]
    triangles = label[same.ravel()][corner.ravel()].reshape(-1, 3).astype(np.int32)
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    lowest = triangles.argmin(axis=1)[:, None]  # the corner that comes first, whatever the file begins with
    triangles = np.take_along_axis(triangles, (lowest + [0, 1, 2]) % 3, axis=1)
    once = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1]
    return _turned_out(TriangleMesh(np.ascontiguousarray(places[first]), triangles[once]))


def _turned_out(mesh: TriangleMesh) -> TriangleMesh:
    """Return the mesh with closed parts turned so that their volume is positive, but for hollows inside others."""
    if len(mesh.faces) == 0:
        return mesh
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] - mesh.vertices.mean(axis=0) for corner in range(3))
    volume = np.bincount(mesh.part, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6)
    closed = np.bincount(mesh.part[mesh.halves.free // 3], minlength=len(volume)) == 0
    wrong = np.zeros(len(volume), bool)
    for part in np.flatnonzero(closed & (volume < 0)):
        others = (mesh.part != part) & closed[mesh.part]
        place = mesh.vertices[mesh.faces[mesh.part == part][0, 0]]
        wrong[part] = abs(winding_number(mesh.vertices[mesh.faces[others]] - place)) < 0.5  # not a hollow
    faces = np.where(wrong[mesh.part][:, None], mesh.faces[:, ::-1], mesh.faces)
    return TriangleMesh(mesh.vertices, np.ascontiguousarray(faces))


def winding_number(triangles: Points) -> float:
    """Return how often triangles (m, 3, 3) wind about the origin (van Oosterom and Strackee 1983)."""
    a, b, c = (triangles[:, corner] for corner in range(3))
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    over = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = [np.einsum("ij,ij->i", u, v) * w for u, v, w in ((a, b, lc), (b, c, la), (c, a, lb))]
    return float(np.arctan2(over, la * lb * lc + sum(dots)).sum() / (2 * np.pi))


def _matrix(first: Pairs | Indices, second: Pairs | Indices, count: int) -> sparse.coo_array:
    return sparse.coo_array((np.ones(len(first), bool), (first, second)), shape=(count, count))
