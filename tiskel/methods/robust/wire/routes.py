"""Routes: from every point the way to the root that keeps to the points.

With the squared length as weight a long step costs more than the same way in
short ones, so that routes do not cut corners through the air.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Mask, Numbers, Points
from tiskel.geometry.cells import numbered
from tiskel.methods.robust.axes import sums
from tiskel.methods.robust.wire.links import Links

# Found by trial on generated trees; 1.5 to 3 all work, 1 cuts corners.
POWER = 2.0  # exponent of the length of a link in its weight
STEP = 1e-6  # spacings: a step counts as no less, so that ways grow with every one, by more than sums are rounded
FINER = 4  # cells of its reach that count the most a crowd may be
CROWD = 0.03  # share of the diagonal about a point: the root has most points so near, which finds trunks and somas


@dataclass(frozen=True, eq=False)
class Routes:
    """The shortest ways to the roots, one of each connected part.

    Attributes
    ----------
    roots : (p,) int32
        The points where they end, the largest part's first.
    before : (n,) int32
        The next point on the way; roots name themselves, points that are left out -1.
    length : (n,) float64
        The length of the way, in spacings, more than that of the next point; NaN for points that are left out.
    """

    roots: Indices
    before: Indices
    length: Numbers


def routes_of(points: Points, links: Links, root: Numbers | None) -> Routes:
    """Return the routes of points (n, 3), to the point nearest to a given root (3,) in its part."""
    count = len(points)
    lengths = links.lengths / links.spacing
    graph = sparse.csr_array((lengths**POWER, (links.first, links.second)), shape=(count, count))
    part = sparse.csgraph.connected_components(graph, directed=False)[1]
    part = np.where(links.kept, part, -1)
    roots = _roots(points, part, root)
    cost, before, _ = dijkstra(graph, directed=False, indices=roots, return_predecessors=True, min_only=True)
    before = before.astype(np.int32)
    before[roots], before[~links.kept] = roots, -1
    return Routes(roots, before, _lengths(points / links.spacing, before, cost, links.kept))


def _roots(points: Points, part: Indices, root: Numbers | None) -> Indices:
    diagonal = float(np.linalg.norm(np.ptp(points[part >= 0], axis=0)))
    crowd = np.zeros(len(points), int)
    crowd[part >= 0] = _crowds(points[part >= 0], part[part >= 0], CROWD * diagonal)
    nearest = -1 if root is None else int(((points - root) ** 2).sum(axis=1).argmin())
    roots = []
    for number in np.argsort(-np.bincount(part[part >= 0]), kind="stable"):
        rows: Indices = np.flatnonzero(part == number).astype(np.int32)
        if len(rows):
            given = nearest >= 0 and part[nearest] == number
            roots.append(nearest if given else _most_crowded(points, rows, crowd[rows]))
    return np.array(roots, np.int32)


def _crowds(points: Points, part: Indices, reach: float) -> Indices:
    """Return (n,) how many points are within reach of each, 0 where a part's largest number cannot be.

    In every cell, of a share of the reach, one point of each part is asked: in the next few as many are about. And no
    more are within reach than in the cells about: those with most there are asked first, then all that may have as
    many as the best of these.
    """
    corner, cell = numbered(np.floor((points - points.min(axis=0)) * (FINER / reach)).astype(np.int64))
    tree, centres = cKDTree(points), cKDTree(corner)
    near = centres.query_pairs(FINER + np.sqrt(3), output_type="ndarray")  # no point beyond is within reach
    held = np.bincount(cell)
    most = (
        held
        + np.bincount(near[:, 0], held[near[:, 1]], len(held))
        + np.bincount(near[:, 1], held[near[:, 0]], len(held))
    )
    bound, crowd = most[cell], np.zeros(len(points), int)
    asked = _one_of_each(points, part * np.int64(len(held)) + cell)
    largest = np.zeros(int(part.max()) + 1)
    np.maximum.at(largest, part, bound)
    first = asked[bound[asked] >= largest[part[asked]]]
    crowd[first] = tree.query_ball_point(points[first], reach, return_length=True)
    best = np.zeros_like(largest)
    np.maximum.at(best, part, crowd)
    rest = asked[(bound[asked] >= best[part[asked]]) & (bound[asked] < largest[part[asked]])]
    crowd[rest] = tree.query_ball_point(points[rest], reach, return_length=True)
    return crowd


def _one_of_each(points: Points, group: npt.NDArray[np.int64]) -> Indices:
    """Return of every group the point (g,) that is nearest to the mean of all of it, whatever their order."""
    number = np.unique(group, return_inverse=True)[1].ravel().astype(np.int32)
    sizes = np.bincount(number)
    means = sums(points, number, len(sizes)) / sizes[:, None]
    away = ((points - means[number]) ** 2).sum(axis=1)
    order = np.lexsort((*points.T, away, number))
    return order[np.searchsorted(number[order], np.arange(len(sizes)))].astype(np.int32)


def _most_crowded(points: Points, rows: Indices, crowd: Indices) -> int:
    """Return the row with the largest crowd; of several the one nearest to the mean of all, whatever their order."""
    most = rows[crowd == crowd.max()]
    return int(most[((points[most] - points[rows].mean(axis=0)) ** 2).sum(axis=1).argmin()])


def _lengths(places: Points, before: Indices, cost: Numbers, kept: Mask) -> Numbers:
    """Return the length of every way, by doubling: after r rounds 2^r steps have been added up."""
    on = np.where(before >= 0, before, 0)
    length = np.maximum(np.linalg.norm(places - places[on], axis=1), STEP)
    length[(before < 0) | (before == np.arange(len(before)))] = 0
    while True:
        further = length[on]
        if not (further > 0).any():
            break
        length, on = length + further, on[on]
    return np.where(kept & np.isfinite(cost), length, np.nan)
