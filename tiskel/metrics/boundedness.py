"""Boundedness: is a place surrounded by the cloud?

beta(x) is the area of the convex hull of the unit vectors from x to all points, as a share of the sphere's. A point on
a flat, endless surface has (2 pi + pi) / 4 pi = 0.75, and bounded is what has at least that much. The definition
assumes a convex shape: a third of the places just outside a torus tube pass it; see :mod:`tiskel.geometry.oriented`
for a true inside test.

The hull costs milliseconds per place, so what is clear is settled without it. Where directions cover a share c of the
sphere, beta is hardly below c (2 - c), the value of a single cap; each point covers the cells that the disc of its
spacing meets. Outside the convex hull of the cloud all directions lie in a half-space, and beta is below 0.75. For the
rest the hull is taken: of one vector per cell, whose beta can only be too small, and where that does not do, of all
vectors along the rim of what is covered and of one in each cell further in.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from tiskel.arrays import Indices, Lists, Mask, Numbers, Points, diagonal
from tiskel.geometry.frames import unit
from tiskel.geometry.neighbours import MortonCurve, morton_curve

BOUNDED = 0.75  # beta of a point on a flat, endless surface
DISC_NEIGHBOURS = 7  # the point included; the mean distance is the radius of the disc a point stands for
CLEAR = 0.75  # covered share; of two thousand unbounded places in five clouds one per cent had more than 0.74
ENOUGH = 0.8  # covered share at which to stop looking: a single cap has beta 0.96
COVERED, OUTSIDE, HULL = 0, 1, 2  #: what settled a place
TOUCHING = 0.36  # radians between the centres of touching cells; the largest is 0.25 wide
MANY, FINE = 8192, 64  # more directions than so many are thinned to one in every cube of a side of 1 / 64
BLOCK = 8192  # places at a time, so that what each of them sees fits into memory
TOLERANCE = 1e-9  # of the diagonal, on which side of the convex hull a place is


@dataclass(frozen=True)
class Boundedness:
    """How places are surrounded.

    Attributes
    ----------
    bounded : (m,) bool
        Whether beta is at least 0.75.
    beta : (m,) float64
        Share of the sphere; where the hull settled it, exact to 0.01 below the threshold and a lower bound above;
        elsewhere that of a single cap.
    settled_by : (m,) int32
        0: coverage, 1: outside the convex hull of the cloud, 2: hull of the unit vectors.
    coincident : (m,) int32
        Points of the cloud at the very place, which have no direction and are left out.
    """

    bounded: Mask
    beta: Numbers
    settled_by: Indices
    coincident: Indices

    def __len__(self) -> int:
        return len(self.beta)

    def take(self, rows: slice) -> "Boundedness":
        """Return the same of the places in a slice of rows."""
        return Boundedness(self.bounded[rows], self.beta[rows], self.settled_by[rows], self.coincident[rows])


def boundedness(places: Points, cloud: Points) -> Boundedness:
    """Tell how places are surrounded by a cloud.

    Parameters
    ----------
    places : (m, 3) float64
        Where to look from, in the unit of the cloud.
    cloud : (n, 3) float64
        The cloud, in any unit.

    Returns
    -------
    Boundedness
        One row per place.
    """
    blocks = np.array_split(places, max(1, -(-len(places) // BLOCK)))
    curve, parts = morton_curve(cloud), []
    spacing = cKDTree(cloud).query(curve.points, min(DISC_NEIGHBOURS, len(cloud)))[0].mean(axis=1)
    for block in blocks:
        parts.append(_judged(block, coverage(block, curve, spacing), curve.points))
    return Boundedness(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


@dataclass(frozen=True)
class Coverage:
    """The directions in which places see a cloud.

    Attributes
    ----------
    shares : (m,) float64
        Covered share of the sphere; counting stops at 0.8.
    seen : (m, cells) int32
        Row of the first point in each cell of the cube map, -1 for none.
    coincident : (m,) int32
        Points at the very place.
    """

    shares: Numbers
    seen: Lists
    coincident: Indices


def coverage(places: Points, curve: MortonCurve, spacing: Numbers) -> Coverage:
    """Return how much of the sphere of directions a cloud covers.

    Parameters
    ----------
    places : (m, 3) float64
        Where to look from, in the unit of the cloud.
    curve : MortonCurve
        The points (n, 3) in the order of a Morton curve.
    spacing : (n,) float64
        Radius of the disc that each of these points stands for.
    """
    from tiskel.kernels import coverage as kernel

    shares, coincident = np.empty(len(places)), np.empty(len(places), np.int32)
    seen = np.empty((len(places), kernel.CELLS), np.int32)
    starts, areas = curve.places(places), cell_areas(kernel.SIDE)
    queries = np.ascontiguousarray(places)
    kernel.coverage(queries, starts, curve.points, spacing, areas, ENOUGH, seen, shares, coincident)
    return Coverage(shares, seen, coincident)


def _judged(places: Points, covered: Coverage, cloud: Points) -> tuple[Mask, Numbers, Indices, Indices]:
    """Return bounded, beta, what settled it, and coincident points."""
    beta = covered.shares * (2 - covered.shares)
    settled_by = np.full(len(places), COVERED, np.int32)
    doubtful = np.flatnonzero(covered.shares < CLEAR)
    outside = outside_hull(places[doubtful], cloud)
    settled_by[doubtful] = np.where(outside, OUTSIDE, HULL)
    for i in doubtful[outside]:
        beta[i] = min(beta[i], np.nextafter(BOUNDED, 0))
    for i in doubtful[~outside]:
        rows = np.unique(covered.seen[i][covered.seen[i] >= 0])
        beta[i] = _hull_area(unit(cloud[rows] - places[i])) / (4 * np.pi)
        if beta[i] < BOUNDED:  # of some of the vectors; all of them may do better
            beta[i] = hull_share(places[i], cloud)
    return beta >= BOUNDED, beta, settled_by, covered.coincident


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


def hull_share(place: Numbers, cloud: Points) -> float:
    """Return beta of one place (3,) in a cloud (n, 3), from the hull of the directions that matter."""
    vectors = unit(cloud[_that_matter(_cells(place, cloud))] - place)
    return _hull_area(_thinned(vectors) if len(vectors) > MANY else vectors) / (4 * np.pi)


def _thinned(vectors: Points) -> Points:
    """Return the first of the unit vectors in every cube of a fine grid."""
    cells = np.floor(vectors * FINE).astype(np.int64) + FINE
    keys = (cells[:, 0] * 4 * FINE + cells[:, 1]) * 4 * FINE + cells[:, 2]
    return np.asarray(vectors[np.unique(keys, return_index=True)[1]])


def _cells(place: Numbers, cloud: Points) -> Indices:
    """Return the cells in which a place sees the points of a cloud, -1 for a point at the place."""
    from tiskel.kernels import coverage as kernel

    cells = np.empty(len(cloud), np.int32)
    kernel.cells(np.ascontiguousarray(place[None]), np.ascontiguousarray(cloud), cells)
    return cells


def _that_matter(cells: Indices) -> Mask:
    """Return which points are in a cell that touches an empty one, or first in another cell."""
    touching = touching_cells()
    first = np.full(len(touching) + 1, -1)  # the last place is for points without a cell
    first[cells[::-1]] = np.arange(len(cells))[::-1]
    filled = first[:-1] >= 0
    rim = np.append(~filled[touching].all(axis=1), False)
    matter = rim[cells]
    matter[first[:-1][filled]] = True
    return np.asarray(matter)


@cache
def touching_cells() -> Lists:
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
    return unit(np.concatenate(centres))


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
