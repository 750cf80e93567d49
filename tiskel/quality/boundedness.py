"""Boundedness: is a place surrounded by the cloud?

beta(x) is the area of the convex hull of the unit vectors from x to all points,
as a share of the sphere's. A point on a flat, endless surface has
(2 pi + pi) / 4 pi = 0.75, and bounded is what has at least that much. The
definition assumes a convex shape: a third of the places just outside a torus
tube pass it; see :mod:`tiskel.quality.surface` for a true inside test.

The hull costs milliseconds per place, so what is clear is settled without it.
Where directions cover a share c of the sphere, beta is hardly below c (2 - c), the
value of a single cap. Each point covers the cells that the disc of its spacing
meets. Outside the convex hull of the cloud all directions lie in
a half-space, and beta is below 0.75. For the rest the hull is taken, of the
vectors along the rim of what is covered and of one in each cell further in.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from tiskel.arrays import Indices, Mask, Numbers, Points, diagonal
from tiskel.neighbourhood import morton_curve

BOUNDED = 0.75  # beta of a point on a flat, endless surface
DISC_NEIGHBOURS = 7  # the point included; the mean distance is the radius of the disc a point stands for
CLEAR = 0.75  # covered share; of two thousand unbounded places in five clouds one per cent had more than 0.74
ENOUGH = 0.8  # covered share at which to stop looking: a single cap has beta 0.96
COVERED, OUTSIDE, HULL = 0, 1, 2  #: what settled a place
TOUCHING = 0.36  # radians between the centres of touching cells; the largest is 0.25 wide
TOLERANCE = 1e-9  # of the diagonal, on which side of the convex hull a place is


@dataclass(frozen=True)
class Boundedness:
    """How places are surrounded.

    Attributes
    ----------
    bounded : (m,).
    beta : (m,), exact to 0.01 where the hull settled it; elsewhere that of a single cap.
    settled_by : (m,) 0 coverage, 1 outside the convex hull of the cloud, 2 hull of the unit vectors.
    coincident : (m,) points of the cloud at the very place, which have no direction and are left out.
    """

    bounded: Mask
    beta: Numbers
    settled_by: Indices
    coincident: Indices

    def __len__(self) -> int:
        return len(self.beta)

    def take(self, rows: slice) -> "Boundedness":
        """Return the same of some places."""
        return Boundedness(self.bounded[rows], self.beta[rows], self.settled_by[rows], self.coincident[rows])


def boundedness(places: Points, cloud: Points) -> Boundedness:
    """Return how places (m, 3) are surrounded by a cloud (n, 3); both in one unit, any."""
    covered, coincident = coverage(places, cloud)
    beta = covered * (2 - covered)
    settled_by = np.full(len(places), COVERED, np.int32)
    open_to_doubt = np.flatnonzero(covered < CLEAR)
    outside = outside_hull(places[open_to_doubt], cloud)
    settled_by[open_to_doubt] = np.where(outside, OUTSIDE, HULL)
    for i in open_to_doubt[outside]:
        beta[i] = min(beta[i], np.nextafter(BOUNDED, 0))
    for i in open_to_doubt[~outside]:
        beta[i] = hull_share(places[i], cloud)
    return Boundedness(beta >= BOUNDED, beta, settled_by, coincident)


def coverage(places: Points, cloud: Points) -> tuple[Numbers, Indices]:
    """Return the share (m,) of the sphere of directions that a cloud covers, up to 0.8, and coincident points (m,)."""
    from tiskel.kernels import coverage as kernel

    covered, coincident = np.empty(len(places)), np.empty(len(places), np.int32)
    marks = np.empty((len(places), kernel.CELLS), np.int8)
    curve = morton_curve(cloud)
    spacing = cKDTree(cloud).query(curve.points, min(DISC_NEIGHBOURS, len(cloud)))[0].mean(axis=1)
    starts, areas = curve.places(places), cell_areas(kernel.SIDE)
    kernel.coverage(places, starts, curve.points, spacing, areas, ENOUGH, marks, covered, coincident)
    return covered, coincident


def cell_areas(side: int) -> Numbers:
    """Return (6 side^2,) the share of the sphere of each cell of the cube map.

    The solid angle from the face's centre to a corner (x, y) is atan(x y / sqrt(x^2 + y^2 + 1)).
    """
    x = np.linspace(-1, 1, side + 1)
    corner = np.arctan(x[:, None] * x / np.sqrt(x[:, None] ** 2 + x**2 + 1))
    face = np.diff(np.diff(corner, axis=0), axis=1)
    return np.tile(face.ravel(), 6) / (4 * np.pi)


def outside_hull(places: Points, cloud: Points) -> Mask:
    """Return (m,) which places (m, 3) lie outside the convex hull of a cloud (n, 3)."""
    try:
        faces = ConvexHull(cloud).equations
    except QhullError:  # a flat cloud: its hull has no inside, and nothing is settled
        return np.zeros(len(places), bool)
    margin = TOLERANCE * diagonal(cloud)
    blocks = np.array_split(places, max(1, len(places) * len(faces) // 4_000_000))
    return np.concatenate([(block @ faces[:, :3].T + faces[:, 3] > margin).any(axis=1) for block in blocks])


def hull_share(place: Points, cloud: Points) -> float:
    """Return beta of one place, from the hull of the directions that matter."""
    vectors, cells = _directions(place, cloud)
    return _hull_area(vectors[_that_matter(cells)]) / (4 * np.pi)


def _directions(place: Points, cloud: Points) -> tuple[Points, Indices]:
    """Return unit vectors to the points that are not at the place, and the cells they are in."""
    from tiskel.kernels import coverage as kernel

    cells = np.empty(len(cloud), np.int32)
    kernel.cells(np.ascontiguousarray(place[None]), cloud, cells)
    away = (cloud - place)[cells >= 0]
    return away / np.linalg.norm(away, axis=1)[:, None], cells[cells >= 0]


def _that_matter(cells: Indices) -> Indices:
    """Return all rows whose cell touches an empty one, and the first row of every other cell."""
    touching = touching_cells()
    filled = np.zeros(len(touching), bool)
    filled[cells] = True
    rim = np.asarray(~filled[touching].all(axis=1))
    matter = rim[cells]
    matter[np.unique(cells, return_index=True)[1]] = True
    return np.flatnonzero(matter).astype(np.int32)


@cache
def touching_cells() -> Indices:
    """Return (6 side^2, w) the cells that touch each cell of the cube map, itself among them and again as padding."""
    from tiskel.kernels.coverage import SIDE

    centres = cell_centres(SIDE)
    found = cKDTree(centres).query_ball_point(centres, 2 * np.sin(TOUCHING / 2), return_sorted=True)
    table = np.repeat(np.arange(len(centres), dtype=np.int32)[:, None], max(map(len, found)), axis=1)
    for row, others in zip(table, found, strict=True):
        row[: len(others)] = others
    return table


def cell_centres(side: int) -> Points:
    """Return (6 side^2, 3) unit vectors to the centres of the cells of the cube map, in the kernel's order."""
    middle = (np.arange(side) + 0.5) * 2 / side - 1
    v, u = np.meshgrid(middle, middle, indexing="ij")
    centres = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            face = np.empty((side * side, 3))
            face[:, axis], face[:, (axis + 1) % 3], face[:, (axis + 2) % 3] = sign, u.ravel(), v.ravel()
            centres.append(face)
    stacked = np.concatenate(centres)
    return np.asarray(stacked / np.linalg.norm(stacked, axis=1)[:, None])


def _hull_area(vectors: Points) -> float:
    """Return the surface area of the convex hull of unit vectors (n, 3); of a flat one both sides count."""
    try:
        return float(ConvexHull(vectors).area)
    except (QhullError, ValueError):
        return _flat_area(vectors)


def _flat_area(vectors: Points) -> float:
    """Return twice the area of the polygon around vectors (n, 3) in a plane; 0 where they are on a line."""
    if len(vectors) < 3:
        return 0.0
    centred = vectors - vectors.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2][:2]
    try:
        return 2 * float(ConvexHull(centred @ axes.T).volume)
    except QhullError:
        return 0.0
