"""The surface of a whole body as a closed triangle mesh, with what it is like at every vertex."""

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Edges, Numbers, Points, Stack, Table
from tiskel.geometry.graph import component_labels
from tiskel.geometry.marching import Found, marched
from tiskel.geometry.oriented import OrientedCloud
from tiskel.geometry.spacing import spacings_from
from tiskel.slicing.fitted import Surfaces
from tiskel.slicing.mesh import Mesh, fields_of, joined_mesh, surface_mesh
from tiskel.surfaces.implicit import Tangency, tangency
from tiskel.surfaces.patches import BodySurface

EDGE = 0.25  # local radii from vertex to vertex: twenty-five around a limb
THIN = 0.1  # share of the surface that may be thinner than what the grid is made for
MOST = 60_000  # cells, about 250 000 triangles; the grid is coarser where there would be more
BEYOND = 1.2  # times as many end the search; more is what closes a body where no patch reaches, not its known surface
COARSER = 2**0.5  # the step of the next search: half as many cells
SURE = 0.5  # of a support, from its centre's surface: beyond, the winding number says what is inside
STEPS, FARTHEST = 4, 0.7  # Newton steps of vertices onto the surface, and how far they go, in steps of the grid
ROUNDS, SHARE = 3, 0.5  # of evening out, and how much of the way vertices go to the middle of their neighbours
FEWEST, BUBBLE = 10, 0.005  # patches of a closed part, and share of them: below, it is none of the body
AROUND = 4  # neighbours that say how far patches are apart
TOLD = 0.002  # of the surface: more that the mesh lacks is told
LOST = 1.0  # steps of the grid from the nearest vertex: what of the surface is farther away the mesh does not have


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyMesh(Mesh):
    """A closed mesh and the surface at its vertices.

    Attributes
    ----------
    normals : (p, 3) float64
        Unit vectors out of the body.
    curvatures : (p, 2) float64
        The smaller and the larger principal curvature, in 1 / length; NaN beyond all patches.
    edge : float
        About how long sides of triangles are, in the cloud's unit.
    lost : float
        The share of the surface that is not in the mesh, from 0 to 1: twigs that are thinner than its triangles.
    """

    normals: Points
    curvatures: Table
    edge: float
    lost: float

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user should know."""
        if self.lost < TOLD:
            return ()
        return (
            f"the mesh lacks {self.lost:.1%} of the surface, thinner than its triangles of {self.edge:.3g} show; "
            "give shorter ones (--edge), or parts of the cloud alone",
        )


def body_mesh(body: BodySurface, edge: float | None = None) -> BodyMesh:
    """Return the surface of a whole body as triangles.

    Closed and manifold: where no patch reaches, at gaps and open ends, the winding
    number of the patches closes it, and the vertices are marked as bridged.

    Parameters
    ----------
    body : BodySurface
        The surface.
    edge : float, optional
        About how long sides of triangles are, in the cloud's unit; not given: a quarter of the local radius of thin
        parts, or more where there would be over 250 000 triangles. Then twigs beside a trunk may be thinner than
        triangles are long, and not be there: see ``lost``.

    Returns
    -------
    BodyMesh
    """
    seen = _seen(body)
    step = edge or step_of(body, seen)
    most = int(BEYOND * MOST) if edge is None else int(4 * max(MOST, 2 * seen.areas.sum() / edge**2))
    found = _followed(body, seen, step, most)
    while edge is None and not found.whole:
        step *= COARSER
        found = _followed(body, seen, step, most)
    found = _without_bubbles(body, found)
    vertices = _settled(body, found, step)
    there = np.isfinite(body.level(vertices).value)
    at = tangency(body, vertices[there])
    normals, curvatures = _vertex_normals(vertices, found.triangles), np.full((len(vertices), 2), np.nan)
    normals[there], curvatures[there] = at.normal, _principal(at)
    far = cKDTree(vertices).query(body.patches.centres)[0] > LOST * step
    return BodyMesh(
        vertices, found.triangles, body.trust(vertices), normals=normals, curvatures=curvatures, edge=step,
        lost=float(seen.areas[far].sum() / seen.areas.sum()),
    )  # fmt: skip


def _followed(body: BodySurface, seen: OrientedCloud, step: float, most: int) -> Found:
    """Return the triangles of the surface on a grid of this step."""
    return marched(lambda places: _values(body, seen, places, step), body.patches.centres, step, most)


def mesh_of(surfaces: Surfaces, edge: float | None = None) -> Mesh:
    """Return the mesh of the whole body, or of the tubes where it has no surface; see :func:`body_mesh`."""
    return tubes_mesh(surfaces) if surfaces.body is None else body_mesh(surfaces.body, edge)


def tubes_mesh(surfaces: Surfaces, caps: bool = False) -> Mesh:
    """Return the meshes of all tubes as one, their ends closed or open, with branch, u, v, radius and curvatures."""
    return joined_mesh(
        [
            replace(surface_mesh(tube, caps=caps), fields=fields_of(tube, number, caps=caps))
            for number, tube in enumerate(surfaces)
        ]
    )


def _without_bubbles(body: BodySurface, found: Found) -> Found:
    """Return the mesh without small closed parts that hardly a patch belongs to."""
    part = component_labels(len(found.vertices), found.triangles[:, [0, 1, 1, 2]].reshape(-1, 2))
    owned = np.bincount(part[cKDTree(found.vertices).query(body.patches.centres)[1]], minlength=part.max() + 1)
    kept = owned >= min(max(FEWEST, BUBBLE * len(body.patches)), owned.max())
    number = np.cumsum(kept[part]) - 1
    triangles = found.triangles[kept[part[found.triangles[:, 0]]]]
    return Found(found.vertices[kept[part]], number[triangles].astype(np.int32))


def step_of(body: BodySurface, seen: OrientedCloud) -> float:
    """Return the step of a grid that resolves thin parts of a body, as far as there are not too many cells."""
    order = np.argsort(body.patches.radii)
    share = np.cumsum(seen.areas[order]) / seen.areas.sum()
    thin = float(body.patches.radii[order][np.searchsorted(share, THIN)])
    return float(max(EDGE * thin, np.sqrt(2 * seen.areas.sum() / MOST)))


def _seen(body: BodySurface) -> OrientedCloud:
    """Return the centres of the patches as oriented points."""
    patches = body.patches
    squares = cKDTree(patches.centres).query(patches.centres, min(AROUND + 1, len(patches)))[0] ** 2
    normals = patches.gradients / np.linalg.norm(patches.gradients, axis=1)[:, None]
    return OrientedCloud(np.ascontiguousarray(patches.centres), normals, spacings_from(squares) ** 2)


def _values(body: BodySurface, seen: OrientedCloud, places: Points, step: float) -> Numbers:
    """Return the function at places (m, 3); where it knows nothing, a step times what the winding number lacks."""
    found = body.patches.blended(places)
    values: Numbers = found[:, 0].copy()
    patch = found[:, 10].astype(int)
    unsure = ~(np.abs(values) < SURE * body.patches.supports[patch])
    values[unsure] = step * (0.5 - seen.winding_numbers(np.ascontiguousarray(places[unsure])))
    return values


def _settled(body: BodySurface, found: Found, step: float) -> Points:
    """Return vertices on the surface, as even as a few rounds make them."""
    vertices = _onto(body, found.vertices, step)
    mean = _neighbours(found.triangles, len(vertices))
    for _ in range(ROUNDS):
        normal = _vertex_normals(vertices, found.triangles)
        way = mean @ vertices - vertices
        known = np.isfinite(body.patches.blended(vertices)[:, 0])
        way[known] -= (way[known] * normal[known]).sum(axis=1)[:, None] * normal[known]
        vertices = _onto(body, vertices + SHARE * way, step)
    return vertices


def _onto(body: BodySurface, places: Points, step: float) -> Points:
    """Return places (m, 3) moved onto the surface, those that know nothing of it or would go far where they are."""
    at = places
    for _ in range(STEPS):
        found = body.patches.blended(at)
        slope = found[:, 1:4]
        way = slope * (found[:, 0] / np.maximum((slope**2).sum(axis=1), TINY))[:, None]
        at = at - np.where(np.isfinite(way), way, 0.0)
    far = np.linalg.norm(at - places, axis=1)
    return np.where((far < FARTHEST * step)[:, None], at, places)


def _neighbours(triangles: Edges, count: int) -> sparse.csr_array:
    """Return the matrix (count, count) that takes values at vertices to the means of those beside them."""
    first, second = triangles[:, [0, 1, 2]].ravel(), triangles[:, [1, 2, 0]].ravel()
    beside = sparse.coo_array((np.ones(len(first)), (first, second)), shape=(count, count)).tocsr()
    mean: sparse.csr_array = sparse.diags_array(1 / np.maximum(beside.sum(axis=1), 1)).tocsr() @ beside
    return mean


def _vertex_normals(vertices: Points, triangles: Edges) -> Points:
    """Return (p, 3) the unit sums of the cross products of the triangles about each vertex."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    cross = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    total = np.stack([np.bincount(triangles.ravel(), column, len(vertices)) for column in cross.T], axis=1)
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1), TINY)[:, None])


def _principal(at: Tangency) -> Table:
    """Return (m, 2) the principal curvatures, the smaller first."""
    shape: Stack = at.shape
    mean = np.trace(shape, axis1=1, axis2=2) / 2
    half = np.sqrt(np.maximum((shape**2).sum(axis=(1, 2)) / 2 - mean**2, 0.0))
    return np.stack([mean - half, mean + half], axis=1)
