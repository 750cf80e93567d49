"""Large clouds, thinned to what their surface needs: where points are many, or noisy, cells of them give one mean each.

How large the cells are is said in :mod:`.cell_sizes`.
"""

from dataclasses import dataclass, replace

import numpy as np

from tiskel.arrays import TINY, Indices, Points
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.methods.robust.axes import sums
from tiskel.methods.robust.cell_sizes import AROUND, ENOUGH, cells_of
from tiskel.methods.robust.network import own_axes
from tiskel.methods.trace import Trace
from tiskel.params import MaxPoints

SLIVER = 0.4  # of the points that the cells about a cell have in the mean; cells with fewer are no cells of their own
HARDLY = 0.5  # of the points left: thinning costs as much as it would save
DIGITS = 6  # of distances from a mean in the largest; what is alike to so many is equally far


@dataclass(frozen=True, eq=False)
class Thinned:
    """A cloud of fewer points, each the mean of some of the given ones.

    Attributes
    ----------
    points : (m, 3) float64
        The means.
    rows : (m,) int32
        The row of the given cloud that each mean goes by: the nearest of those it is made of. Ascending.
    place : (n,) int32
        The mean that each given point went into.
    """

    points: Points
    rows: Indices
    place: Indices

    def whole(self, trace: Trace, cloud: Points) -> Trace:
        """Return the trace of this cloud as one of the given cloud (n, 3), whose other points were merged into it."""
        if len(self.rows) == len(cloud):
            return trace
        into = self.rows[self.place]
        gone = into != np.arange(len(cloud))
        return replace(
            trace, cloud=cloud, rows=self.rows,
            merged_into=np.where(gone, into, -1).astype(np.int32), merged_step=np.where(gone, 1, -1).astype(np.int32),
            history=tuple((self.rows, places) for _, places in trace.history),
        )  # fmt: skip


def thinned(points: Points, most: MaxPoints) -> Thinned:
    """Return a cloud (n, 3) as its surface needs it, of so many points at most, or with all that are given."""
    everyone = np.arange(len(points), dtype=np.int32)
    if most == "all" or len(points) <= (ENOUGH if most == "auto" else min(most, ENOUGH)):
        return Thinned(points, everyone, everyone)
    own = np.ascontiguousarray((points - points.mean(axis=0)) @ own_axes(points).T)
    place = cells_of(own) if most == "auto" else cells_of(own, most)
    if most == "auto" and place.max() >= HARDLY * len(points):
        return Thinned(points, everyone, everyone)
    return _means(points, own, _without_slivers(own, place))


def told(trace: Trace) -> tuple[CurveWarning, ...]:
    """Return the note that a cloud was thinned, nothing where it was not."""
    given, left = int((trace.merged_step != 0).sum()), len(trace.rows)
    if left == given:
        return ()
    text = f"the curve was made with {left} means of the {given} points; --max-points all takes every point, and longer"
    return (CurveWarning("thinned", text, "note", share=1 - left / given),)


def remembered(trace: Trace) -> Points:
    """Return the points (m, 3) that a trace was made from: means of those that were merged, not of duplicates."""
    return _averaged(*given_to(trace), len(trace.rows))


def given_to(trace: Trace) -> tuple[Points, Indices]:
    """Return the points (n, 3) that means were made of, without duplicates, and the mean (n,) that each went into."""
    once = trace.merged_step != 0
    return trace.cloud[once], trace.survivor_of()[once]


def _without_slivers(points: Points, place: Indices) -> Indices:
    """Return (n,) the places, those of cells with far fewer points than the cells about them given to the nearest."""
    from scipy.spatial import cKDTree

    each = np.bincount(place)
    means = _averaged(points, place, len(each))
    usual = each[nearest_neighbours(means, min(AROUND, len(means)))[0]].mean(axis=1)
    kept = np.flatnonzero(each >= SLIVER * usual)
    rank = np.full(len(each), -1, np.int32)
    rank[kept] = np.arange(len(kept))
    found = rank[place]
    lost = np.flatnonzero(found < 0)
    found[lost] = cKDTree(means[kept]).query(points[lost])[1]
    return found


def _means(points: Points, own: Points, place: Indices) -> Thinned:
    """Return the means of the points by place; own (n, 3) are the points in their own axes, to break ties by."""
    means = _averaged(points, place, int(place.max()) + 1)
    away = ((points - means[place]) ** 2).sum(axis=1)
    farthest = np.zeros(len(means))
    np.maximum.at(farthest, place, away)
    away = np.round(away / np.maximum(farthest[place], TINY), DIGITS)  # two points are equally far from their mean
    least = np.full(len(means), np.inf)
    np.minimum.at(least, place, away)
    nearest = np.flatnonzero(away == least[place])
    order = nearest[np.lexsort((*own[nearest].T, place[nearest]))]
    rows = order[np.unique(place[order], return_index=True)[1]].astype(np.int32)
    by_row = np.argsort(rows, kind="stable").astype(np.int32)
    rank = np.empty(len(rows), np.int32)
    rank[by_row] = np.arange(len(rows), dtype=np.int32)
    return Thinned(np.ascontiguousarray(means[by_row]), rows[by_row], rank[place])


def _averaged(points: Points, place: Indices, count: int) -> Points:
    each = np.bincount(place, minlength=count)[:, None]
    return np.asarray(sums(points, place, count) / each)
