"""Boundedness: is a place surrounded by the cloud?

beta(x) is the area of the convex hull of the unit vectors from x to all points, as a share of the sphere's. A point on
a flat, endless surface has (2 pi + pi) / 4 pi = 0.75, and bounded is what has at least that much. The definition
assumes a convex shape: a third of the places just outside a torus tube pass it; see :mod:`tiskel.geometry.oriented`
for a true inside test.

What is clear is settled without a hull. Where directions cover a share c of the sphere, beta is hardly below
c (2 - c), the value of a single cap; each point covers the cells that the disc of its spacing meets. Outside the convex
hull of the cloud all directions lie in a half-space, and beta is below 0.75. For the rest the hull is taken, see
:mod:`tiskel.metrics.hulls`. Departure from print, which triangulates a flat map of the
sphere: :mod:`tiskel.metrics.betas` has that, and what the toolbox makes of it.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Lists, Mask, Numbers, Points
from tiskel.geometry.neighbours import morton_curve
from tiskel.metrics.betas import betas
from tiskel.metrics.hulls import BOUNDED, View, hull_shares, outside_hull
from tiskel.params import BetaRule

DISC_NEIGHBOURS = 7  # the point included; the mean distance is the radius of the disc a point stands for
CLEAR = 0.75  # covered share; of two thousand unbounded places in five clouds one per cent had more than 0.74
ENOUGH = 0.8  # covered share at which to stop looking: a single cap has beta 0.96
COVERED, OUTSIDE, HULL, MAP = 0, 1, 2, 3  #: what settled a place
BLOCK = 8192  # places at a time, so that what each of them sees fits into memory


@dataclass(frozen=True, eq=False)
class Boundedness:
    """How places are surrounded.

    Attributes
    ----------
    bounded : (m,) bool
        Whether beta is at least 0.75, or what was asked for.
    beta : (m,) float64
        Share of the sphere; where the hull settled it, exact to 0.01 below the threshold and a lower bound above;
        elsewhere that of a single cap.
    settled_by : (m,) int32
        0: coverage, 1: outside the convex hull of the cloud, 2: hull of the unit vectors, 3: triangles of their map.
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
    view = view_of(cloud)
    parts = [_judged(block, view) for block in np.array_split(places, max(1, -(-len(places) // BLOCK)))]
    return Boundedness(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def boundedness_by(places: Points, cloud: Points, rule: BetaRule, least: float = BOUNDED) -> Boundedness:
    """Tell how places are surrounded by another rule or threshold than the usual one, with beta in full.

    Parameters
    ----------
    places : (m, 3) float64
        Where to look from, in normalised coordinates.
    cloud : (n, 3) float64
        The cloud, in normalised coordinates.
    rule : str
        "hull", "print" or "toolbox", see :mod:`tiskel.metrics.betas`.
    least : float
        beta*, of what is bounded.

    Returns
    -------
    Boundedness
        One row per place; one hull or triangulation each, so a thousand places of 4096 points take ten seconds.
    """
    if rule == "hull" and least == BOUNDED:
        return boundedness(places, cloud)
    beta = betas(places, cloud, rule)
    coincident = np.array([np.count_nonzero((cloud == place).all(axis=1)) for place in places], np.int32)
    settled_by = np.full(len(places), HULL if rule == "hull" else MAP, np.int32)
    return Boundedness(beta >= least, beta, settled_by, coincident)


def view_of(cloud: Points) -> View:
    """Return a cloud (n, 3) laid out for being looked at; each point stands for a disc of its spacing."""
    curve = morton_curve(cloud)
    if (curve.codes[1:] != curve.codes[:-1]).all():
        return View(curve, _disc_radii(curve.points, np.ones(len(cloud), np.intp)))
    places, which, counts = np.unique(curve.points, axis=0, return_inverse=True, return_counts=True)
    return View(curve, _disc_radii(places, counts)[which.ravel()])


def _disc_radii(places: Points, counts: npt.NDArray[np.intp]) -> Numbers:
    """Return (n,) the mean distance of the nearest points to each place, of which so many are there."""
    wanted = min(DISC_NEIGHBOURS, int(counts.sum()))
    distances, near = cKDTree(places).query(places, np.arange(1, min(DISC_NEIGHBOURS, len(places)) + 1))
    found = np.cumsum(counts[near], axis=1)
    which = np.stack([(found < number).sum(axis=1) for number in range(1, wanted + 1)], axis=1)
    return np.asarray(np.take_along_axis(distances, which, axis=1).mean(axis=1))


@dataclass(frozen=True, eq=False)
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


def coverage(places: Points, view: View) -> Coverage:
    """Return how much of the sphere of directions a cloud covers, for places (m, 3) in its unit."""
    from tiskel.kernels import coverage as kernel

    shares, coincident = np.empty(len(places)), np.empty(len(places), np.int32)
    seen = np.empty((len(places), kernel.CELLS), np.int32)
    queries, starts, areas = np.ascontiguousarray(places), view.curve.places(places), cell_areas(kernel.SIDE)
    kernel.coverage(
        queries, starts, view.points, view.spacing, *view.boxes, areas, ENOUGH, seen, shares, coincident
    )  # fmt: skip
    return Coverage(shares, seen, coincident)


def _judged(places: Points, view: View) -> tuple[Mask, Numbers, Indices, Indices]:
    """Return bounded, beta, what settled it, and coincident points."""
    covered = coverage(places, view)
    beta = covered.shares * (2 - covered.shares)
    settled_by = np.full(len(places), COVERED, np.int32)
    doubtful = np.flatnonzero(covered.shares < CLEAR)
    outside = outside_hull(places[doubtful], view.points)
    settled_by[doubtful] = np.where(outside, OUTSIDE, HULL)
    beyond, within = doubtful[outside], doubtful[~outside]
    beta[beyond] = np.minimum(beta[beyond], np.nextafter(BOUNDED, 0))
    beta[within] = hull_shares(places[within], covered.seen[within], view)
    return beta >= BOUNDED, beta, settled_by, covered.coincident


def cell_areas(side: int) -> Numbers:
    """Return (6 side^2,) the share of the sphere of each cell of the cube map.

    The solid angle from the face's centre to a corner (x, y) is atan(x y / sqrt(x^2 + y^2 + 1)).
    """
    x = np.linspace(-1, 1, side + 1)
    corner = np.arctan(x[:, None] * x / np.sqrt(x[:, None] ** 2 + x**2 + 1))
    face = np.diff(np.diff(corner, axis=0), axis=1)
    return np.tile(face.ravel(), 6) / (4 * np.pi)
