"""Stray points: what no scanner meant to measure, and what must not set a scale.

A point that stands alone stretches the bounding box, and with it every length
that is a share of the box: the scale inside the methods, slices, slabs, pictures.
Two kinds are told from parts of a body, whatever the unit and however uneven the
density:

- few points far from all others. Points are linked where they are at most eight
  local spacings apart, of the denser of both. A group of k < 10 points is stray
  where it is more than 8 k spacings away from what is around: the more points say
  that there is something, the farther off it has to be;
- a place that is in the file ten times as often as places usually are, and at
  least ten times: rows at 0 0 0 for rays that did not come back.

A cloud without such points keeps its plain box, to the last bit.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Lists, Mask, Numbers, Points, Table, finite_rows, first_of_duplicates
from tiskel.geometry.cells import cell_numbers
from tiskel.geometry.spacing import NEIGHBOURS, SAMPLED, spacing_of, spacings_from
from tiskel.kernels.threads import requested_threads

# By reasoning: along a wire sampled at random a gap of 8 spacings (16 mean gaps) is there once in ten million points.
GAP = 8.0  # local spacings, per point of a group, between it and what is around
FEW = 10  # points from which on a group is a part of the body; as many as keep a part in method robust
PILE = 10  # times that a place is repeated at least, and as a multiple of what is usual in the file
USUAL = 0.9  # quantile of the repetitions that says what is usual
MANY = 32_768  # points; of more, those in crowded cells are not asked, and the median spacing is that of a sample
MOST = 0.05  # share of the places that may be stray; where more stand alone, that is what the cloud is like


def stray_points(points: Points, first: Indices | None = None) -> Mask:
    """Return which points are stray.

    Parameters
    ----------
    points : (n, 3) float64
        Finite, in any unit; duplicates count once.
    first : (n,) int32, optional
        The first row at each point's place, see :func:`tiskel.arrays.first_of_duplicates`, where it is known.

    Returns
    -------
    (n,) bool
        With all its duplicates, each stray point.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.strays import stray_points
    >>> square = np.mgrid[:9, :9, :1].reshape(3, -1).T.astype(float)
    >>> stray_points(np.concatenate([square, [[0, 0, 90]], np.zeros((50, 3))])).sum()
    np.int64(52)
    """
    none = np.zeros(len(points), bool)
    if len(points) < 2 * FEW:
        return none
    first = first_of_duplicates(points) if first is None else first
    counts = np.bincount(first, minlength=len(points))
    places = np.flatnonzero(counts)
    piled = counts[places] >= PILE * max(1, int(np.quantile(counts[places], USUAL, method="lower")))
    stray = piled.copy()
    stray[~piled] = _alone(np.ascontiguousarray(points[places[~piled]]))
    if not 0 < stray.sum() <= max(1, MOST * len(places)):
        return none
    none[places[stray]] = True
    return np.asarray(none[first])


def body_rows(points: Points) -> Mask:
    """Return (n,) which of points (n, 3) are finite and not stray."""
    kept = finite_rows(points)
    kept[kept] = ~stray_points(points[kept])
    return kept


def body_of(points: Points) -> Points:
    """Return the points (n, 3), finite, without those that are stray; the argument itself where none is."""
    stray = stray_points(points)
    return np.ascontiguousarray(points[~stray]) if stray.any() else points


def _alone(points: Points) -> Mask:
    """Return (n,) which of the distinct points belong to small groups far from all others."""
    alone = np.zeros(len(points), bool)
    if len(points) < 2 * FEW:
        return alone
    tree = cKDTree(points)
    few, spacings, links = (_lonely if len(points) > MANY else _linked)(points, tree)
    if len(few) in {0, len(points)}:
        return alone
    # With four neighbours a group may fall apart; with ten it sees all its members and someone outside.
    distances, neighbours = tree.query(points[few], FEW + 1)
    links = links + _links(few, distances, neighbours, spacings)
    group = connected_components(links, directed=False)[1]
    sizes = np.bincount(group)
    outside = group[neighbours] != group[few][:, None]
    nearest = outside.argmax(axis=1)  # the lists are by distance
    rows = np.arange(len(few))
    gaps = np.where(outside.any(axis=1), distances[rows, nearest], 0.0)
    ratio = np.full(len(sizes), np.inf)
    np.minimum.at(ratio, group[few], gaps / (GAP * sizes[group[few]] * spacings[neighbours[rows, nearest]]))
    alone[few] = (sizes < FEW)[group[few]] & (ratio[group[few]] > 1)
    return alone


def _linked(points: Points, tree: cKDTree) -> tuple[Indices, Numbers, sparse.coo_array]:
    """Return the rows in groups of few, the spacings (n,), and the links of all points to their next."""
    distances, neighbours = tree.query(points, NEIGHBOURS + 1)
    spacings = spacings_from(distances**2)
    spacings = np.maximum(spacings, np.median(spacings))
    links = _links(np.arange(len(points), dtype=np.int32), distances, neighbours, spacings)
    group = connected_components(links, directed=False)[1]
    return np.flatnonzero(np.bincount(group)[group] < FEW).astype(np.int32), spacings, links


def _lonely(points: Points, tree: cKDTree) -> tuple[Indices, Numbers, sparse.coo_array]:
    """Return the same of many points without asking most of them: who is one of ten in a small cell is not alone.

    The rows are those of other cells, and only they and what is next to them have a spacing.
    """
    usual = spacing_of(points, tree, SAMPLED)
    cell = cell_numbers(points, GAP * usual / np.sqrt(3))  # whose diagonal is the shortest gap
    crowded = np.bincount(cell)[cell] >= FEW
    rows, rest = np.flatnonzero(~crowded).astype(np.int32), np.flatnonzero(crowded)
    workers = requested_threads()
    distances, neighbours = tree.query(points[rows], FEW + 1, workers=workers)
    beside = np.zeros(len(points), bool)
    beside[neighbours] = True
    next_to = np.flatnonzero(beside & crowded)
    distances, neighbours = distances[:, : NEIGHBOURS + 1], neighbours[:, : NEIGHBOURS + 1]
    spacings = np.full(len(points), usual)
    spacings[rows] = np.maximum(spacings_from(distances**2), usual)
    apart = tree.query(points[next_to], NEIGHBOURS + 1, workers=workers)[0]
    spacings[next_to] = np.maximum(spacings_from(apart**2), usual)
    chain = (np.ones(max(len(rest) - 1, 0)), (rest[:-1], rest[1:]))
    links = _links(rows, distances, neighbours, spacings) + sparse.coo_array(chain, shape=(len(points), len(points)))
    group = connected_components(links, directed=False)[1]
    return rows[np.bincount(group)[group[rows]] < FEW], spacings, links


def _links(rows: Indices, distances: Table, neighbours: Lists, spacings: Numbers) -> sparse.coo_array:
    """Return the matrix (n, n) of the links between rows and their neighbours that are short for the denser of both."""
    short = distances <= GAP * np.minimum(spacings[rows][:, None], spacings[neighbours])
    first, second = np.repeat(rows, short.sum(axis=1)), neighbours[short]
    return sparse.coo_array((np.ones(len(first)), (first, second)), shape=(len(spacings), len(spacings)))
