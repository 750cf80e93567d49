"""Points on a triangle mesh: closer where the body is thin, as even as a sequence without chance, and what touches.

Uniform sampling gives most points to what is large, and thin limbs fuse. Here the
spacing is a share of the local thickness. Points follow the triangles along a
curve that fills space, evenly by what each is to have, and lie in them as the
plastic sequence says (Roberts 2018), so that they neither clump nor leave holes.

Every place of the mesh belongs to the point that is nearest along it; points whose
cells touch are linked. These are the neighbours that the mesh knows of.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Edges, Indices, Numbers, Points, Table, diagonal, finite_rows
from tiskel.errors import TiskelError
from tiskel.geometry.mesh import TriangleMesh, welded
from tiskel.geometry.mesh_facts import MeshFacts, facts_of
from tiskel.geometry.mesh_surface import MeshSurface, unique_pairs
from tiskel.geometry.neighbours import morton_curve
from tiskel.geometry.overlap import united
from tiskel.geometry.refine import refined
from tiskel.geometry.thickness import thicknesses

FEWEST, MOST = 4096, 32768  # points where no number is asked for; more cost time and change little
FINENESS = 6.0  # spacings in the thickness: three in the radius, twice what method robust calls too few
THICK = 0.9  # share of the area that is no thicker than what the spacing is largest at
CONTRAST = 10.0  # largest spacing over the least: normals and fronts stay steady
LONGEST = 1 / 40  # of the diagonal: sides of the triangles that thickness is estimated on
COARSE = 100_000  # triangles of these at most
PILOT, ROUNDS = 8192, 2  # points that thickness is estimated at, closer each time where the body is thin
FARTHEST = 0.5  # of the diagonal: what has no other side up to there counts as so thick
SPLINTER = 0.005  # of the area; smaller parts have no curve of their own, as by RobustParams.least_part
CELL = 0.6  # spacings: sides of the triangles that cells are made of
PLASTIC = 1.32471795724474602596  # x^3 = x + 1
STEPS = 1 / PLASTIC, 1 / PLASTIC**2  # of the sequence along both sides of a parallelogram


@dataclass(frozen=True, eq=False)
class SampledMesh:
    """Points on a mesh.

    Attributes
    ----------
    points : (n, 3) float64
        In the unit of the mesh.
    surface : MeshSurface or None
        What the mesh knows about each of them; None where its faces hardly hang together.
    facts : MeshFacts
        Counts of the mesh.
    wanted : int
        Points that the thickness asks for.
    hidden : int
        Points that lay inside other parts of the mesh and are left out.
    """

    points: Points
    surface: MeshSurface | None
    facts: MeshFacts
    wanted: int
    hidden: int


def sample_mesh(vertices: Points, faces: Edges, count: int | None = None, seed: int = 0) -> SampledMesh:
    """Return points on a mesh.

    Parameters
    ----------
    vertices : (v, 3) float64
        In any unit.
    faces : (m, 3) int32
        The vertices of every triangle.
    count : int, optional
        How many points; without it six in the thickness each way, but 4096 at least and 32768 at most.
    seed : int
        The same seed gives the same points.

    Returns
    -------
    SampledMesh

    Raises
    ------
    TiskelError
        Where the triangles have no area.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.mesh_sample import sample_mesh
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> found = sample_mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32), 500)
    >>> found.points.shape, found.surface.handles, found.facts.watertight
    ((500, 3), 0, True)
    """
    axes = _own_axes(vertices, faces)
    mesh = welded(np.ascontiguousarray(vertices @ axes.T), faces)
    if mesh.areas.sum() == 0:
        raise TiskelError(f"the mesh of {len(faces)} triangles has no area; check its vertices")
    facts = facts_of(mesh)
    size = diagonal(mesh.vertices)
    coarse = refined(mesh, np.full(len(mesh.faces), LONGEST * size), COARSE)[0]
    thick = _thickness(coarse, facts, FARTHEST * size, seed)
    spacing = _bounded(thick, coarse.areas) / FINENESS
    wanted = int(np.ceil((coarse.areas / spacing**2).sum()))
    number = count or int(np.clip(wanted, FEWEST, MOST))
    spacing *= np.sqrt(wanted / number)
    fine, source = refined(coarse, CELL * spacing, 16 * number + len(coarse.faces))
    spacing = spacing[source]
    points, rows = _placed(fine, 1 / spacing**2, number, seed)
    links = _links(fine, points, rows)
    normals = _averaged(fine.normals[rows], links)
    areas = spacing[rows] ** 2 * mesh.areas.sum() / (spacing[rows] ** 2).sum()
    points, normals = np.ascontiguousarray(points @ axes), normals @ axes
    surface = MeshSurface(normals, areas, links, facts.watertight, facts.handles if facts.watertight else None)
    if not _hangs_together(mesh):
        return SampledMesh(points, None, facts, wanted, 0)
    surface, left = united(points, surface, fine.part[rows])
    return SampledMesh(np.ascontiguousarray(points[left]), surface, facts, wanted, len(points) - len(left))


def _own_axes(vertices: Points, faces: Edges) -> Table:
    """Return (3, 3) principal axes of the corners of all triangles as rows, each towards its longer tail.

    In them a turned mesh lies the same and is sampled the same.
    """
    corners = vertices[faces[finite_rows(vertices)[faces].all(axis=1)]].reshape(-1, 3)
    offset = corners - (corners.mean(axis=0) if len(corners) else 0)
    axes = np.linalg.eigh(offset.T @ offset)[1].T
    return np.asarray(axes * np.where(((offset @ axes.T) ** 3).sum(axis=0) < 0, -1.0, 1.0)[:, None])


def _hangs_together(mesh: TriangleMesh) -> bool:
    """Return whether most of the area belongs to parts that are more than splinters."""
    areas = np.bincount(mesh.part, mesh.areas)
    return bool(areas[areas >= SPLINTER * areas.sum()].sum() > areas.sum() / 2)


def _thickness(mesh: TriangleMesh, facts: MeshFacts, farthest: float, seed: int) -> Numbers:
    """Return (m,) how thick the body is behind each triangle; both sides of an open surface are asked."""
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    thick = np.ones(len(centres))
    for number in range(ROUNDS):
        density = 1 / _bounded(thick, mesh.areas) ** 2
        points, rows = _placed(mesh, density, PILOT, seed + number)
        spacings = np.sqrt((mesh.areas * density).sum() / PILOT / density[rows])
        normals = mesh.normals[rows]
        found = thicknesses(points, normals, spacings, farthest)
        if not facts.watertight:
            found = np.minimum(found, thicknesses(points, -normals, spacings, farthest))
        thick = found[cKDTree(points).query(centres)[1]]
    return np.asarray(thick)


def _bounded(thick: Numbers, areas: Numbers) -> Numbers:
    """Return thicknesses (m,) within the contrast below that of what is thick; flat ends of limbs do not count."""
    order = np.argsort(thick, kind="stable")
    share = np.cumsum(areas[order])
    most = thick[order[np.searchsorted(share, THICK * share[-1])]]
    return np.asarray(np.clip(thick, most / CONTRAST, most))


def _placed(mesh: TriangleMesh, density: Numbers, count: int, seed: int) -> tuple[Points, Indices]:
    """Return points (count, 3) on a mesh with a density (m,), and the triangle of each."""
    order = morton_curve(np.ascontiguousarray(mesh.vertices[mesh.faces].mean(axis=1))).order
    share = np.cumsum((mesh.areas * density)[order])
    offset = np.random.default_rng(seed).random(3)
    places = (np.arange(count) + offset[0]) / count * share[-1]
    rows = order[np.minimum(np.searchsorted(share, places, side="right"), len(order) - 1)]
    u, v = ((offset[1 + axis] + np.arange(count) * STEPS[axis]) % 1 for axis in range(2))
    outside = u + v > 1  # the other half of the parallelogram
    u, v = np.where(outside, 1 - u, u)[:, None], np.where(outside, 1 - v, v)[:, None]
    a, b, c = (mesh.vertices[mesh.faces[rows, corner]] for corner in range(3))
    return np.ascontiguousarray(a + u * (b - a) + v * (c - a)), rows.astype(np.int32)


def _links(mesh: TriangleMesh, points: Points, rows: Indices) -> Edges:
    """Return the pairs (l, 2) of points whose cells touch, lower row first."""
    count, corners = len(points), mesh.faces[rows]
    sides = unique_pairs(np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]]))
    first = np.concatenate([count + sides[:, 0], np.repeat(np.arange(count), 3)])
    second = count + np.concatenate([sides[:, 1], corners.ravel()])
    every = np.concatenate([points, mesh.vertices])
    length = np.maximum(np.linalg.norm(every[first] - every[second], axis=1), TINY)
    graph = sparse.coo_array((length, (first, second)), shape=(len(every), len(every))).tocsr()
    cell = dijkstra(graph, directed=False, indices=np.arange(count), min_only=True, return_predecessors=True)[2]
    pairs = np.stack([cell[first], cell[second]], axis=1)
    return unique_pairs(pairs[(pairs[:, 0] != pairs[:, 1]) & (pairs.min(axis=1) >= 0)])


def _averaged(normals: Points, links: Edges) -> Points:
    """Return the mean of each normal (n, 3) and those of the points that it is linked to."""
    total = normals.copy()
    for one, other in (links.T, links[:, ::-1].T):
        for axis in range(3):
            total[:, axis] += np.bincount(one, normals[other, axis], minlength=len(normals))
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(np.where(length > TINY, total / np.maximum(length, TINY), normals))
