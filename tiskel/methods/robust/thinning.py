"""Large clouds, thinned to what their surface needs: where points are many, or noisy, cells of them give one mean each.

Cells of doubling size, from a few points to whole limbs, are looked at
together with the eleven nearest of their size: the ratio of the two lesser
variances of all their points says how flat the surface is at that size. Of a
clean tube it is a sixteenth of the squared ratio of the neighbourhood's radius to
the tube's, so it grows with the size of the cells; of noise it is near one and
falls, until the surface emerges. Every place takes the largest cells that are
still flat, or, where noise leaves none flat, the smallest that are nearly as flat
as any. A gap between two sheets, a twig, an edge are not flat at cells of their
own size, so that smaller cells keep them, or single points.
"""

from dataclasses import dataclass, replace

import numpy as np

from tiskel.arrays import TINY, Indices, Lists, Numbers, Points, Table
from tiskel.geometry.cells import numbered
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.geometry.spacing import SAMPLED, spacing_of
from tiskel.methods.robust.axes import sums
from tiskel.methods.robust.network import own_axes
from tiskel.methods.trace import Trace
from tiskel.params import MaxPoints

# Found by trial on a half torus, trunks with noise of a tenth and a quarter, and shapes of the gallery, 30 000 to
# 262 144 points.
ENOUGH = 20_000  # points; clouds of no more are taken as they are, they cost little
AROUND = 12  # cells whose points are looked at together, the cell itself included
FINEST = 1.75  # spacings: side of the smallest cells [2: fingers of a hand touch at 100 000; 1.5: noisy trunks wobble]
FLAT = 0.015  # ratio of the lesser variances; flatter cells may be larger: their side is a quarter of a tube's radius
NEARLY = 2.2  # times the least ratio of all sizes, for a size to be as good as any
SHAPELESS = 0.6  # ratio that no size of cells is below, as where there is no surface: nothing is thinned
VOLUME = 0.8  # ratio above which cells show a volume of noise, not yet the surface in it
FEW = 3.2  # a volume of N points seems flatter than it is, by 1 + FEW / sqrt(N); measured on 12 to 700 points
SLIVER = 0.4  # of the points that the cells about a cell have in the mean; cells with fewer are no cells of their own
LINEAR = 0.6  # (s1 - s2) / s1 of the root variances: larger is a wire, of which nothing is thinned
MOSTLY = 0.5  # share of the cells about a cell that are linear, from which on it is of a wire
SIZES = 12  # of cells at most, each twice as large as the last
FEWEST = 40  # cells of a size; with fewer they are larger than limbs
HARDLY = 0.5  # of the points left: thinning costs as much as it would save
CREASE = 0.3  # ratio at a crease, whatever the size of the cells, at most; a right angle has 0.25
FINER = 2  # sizes that the cells at a crease may be smaller than those about them
DIGITS = 6  # of distances from a mean in the largest; what is alike to so many is equally far
CHUNK = 65_536  # cells whose neighbourhoods are summed at once, to bound memory


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
    ratios, doubt, cells = _sizes(own)
    size = _levelled(_chosen(ratios, doubt), ratios, cells)
    while True:
        key = np.take_along_axis(cells, size[None], axis=0)[0] * (len(cells) + 1) + size
        place = np.unique(key, return_inverse=True)[1]
        if most == "auto" and place.max() >= HARDLY * len(points):
            return Thinned(points, everyone, everyone)
        if most == "auto" or place.max() < most or size.min() == len(cells) - 1:
            return _means(points, own, _without_slivers(own, place.ravel().astype(np.int32)))
        size = np.minimum(size + 1, len(cells) - 1)


def told(trace: Trace) -> tuple[CurveWarning, ...]:
    """Return the note that a cloud was thinned, nothing where it was not."""
    given, left = int((trace.merged_step != 0).sum()), len(trace.rows)
    if left == given:
        return ()
    text = f"the curve was made with {left} means of the {given} points; --max-points all takes every point, and longer"
    return (CurveWarning("thinned", text, "note", share=1 - left / given),)


def remembered(trace: Trace) -> Points:
    """Return the points (m, 3) that a trace was made from: means of those that were merged, not of duplicates."""
    once = trace.merged_step != 0
    return _averaged(trace.cloud[once], trace.survivor_of()[once], len(trace.rows))


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


def _sizes(points: Points) -> tuple[Table, Table, Lists]:
    """Return (s, n) for every size of cells how flat it is about each point, its doubt, and each point's cell.

    Linear is inf; the doubt is what few points in a volume would have to be
    multiplied by. The first size, points alone, is looked at only where the
    next is not flat; elsewhere it counts as no flatter than that.
    """
    side = FINEST * spacing_of(points, most=SAMPLED)
    corner = np.floor((points - points.min(axis=0)) / side).astype(np.int64)
    totals = np.concatenate([np.ones((len(points), 1)), points, _products(points)], axis=1)
    cell: Indices = np.arange(len(points), dtype=np.int32)
    ratios, cells, many = list[Numbers](), [cell], list[Numbers]()
    for number in range(SIZES):
        corner, into = numbered(corner)
        if len(corner) < FEWEST and number:
            break
        totals = sums(totals, into, len(corner))
        cell = into[cell]
        around = min(AROUND, len(corner))
        nearest = nearest_neighbours(np.ascontiguousarray(totals[:, 1:4] / totals[:, :1]), around)[0]
        flatness, inside = _flatness(_variances(totals, nearest), nearest), totals[nearest, 0].sum(axis=1)
        if number == 0:
            ratios, many = [_alone(points, cell, flatness, nearest)], [np.where(flatness > FLAT, AROUND, inside)[cell]]
        ratios.append(flatness[cell])
        cells.append(cell)
        many.append(inside[cell])
        corner //= 2
    return np.array(ratios), 1 + FEW / np.sqrt(np.array(many)), np.array(cells)


def _alone(points: Points, cell: Indices, flatness: Numbers, nearest: Lists) -> Numbers:
    """Return (n,) how flat the surface is about each point alone; in flat cells as flat as they are.

    flatness (m,) is that of the cells, nearest (m, k) are the cells about each.
    """
    out, bent = flatness[cell], flatness > FLAT
    about = np.zeros(len(bent), bool)
    about[nearest[bent]] = True  # a point's neighbours are there
    rows = np.flatnonzero(about[cell])
    if len(rows) < AROUND:
        return out
    few = np.ascontiguousarray(points[rows])
    next_to = nearest_neighbours(few, AROUND)[0]
    own = bent[cell[rows]]
    out[rows[own]] = _flatness(principal_axes(few, next_to)[0], next_to)[own]
    return out


def _products(points: Points) -> Table:
    return np.asarray((points[:, :, None] * points[:, None, :]).reshape(-1, 9))


def _variances(totals: Table, nearest: Lists) -> Table:
    """Return (m, 3) the descending variances of all points in the cells (m, k) about each; totals (m, 13) of each."""
    found = []
    for start in range(0, len(nearest), CHUNK):
        total = totals[nearest[start : start + CHUNK]].sum(axis=1)
        mean = total[:, 1:] / total[:, :1]
        found.append(np.linalg.eigvalsh((mean[:, 3:] - _products(mean[:, :3])).reshape(-1, 3, 3))[:, ::-1])
    return np.asarray(np.maximum(np.concatenate(found), 0))


def _flatness(variances: Table, nearest: Lists) -> Numbers:
    """Return (m,) the ratio of the lesser variances, in the mean over the cells about each; inf where linear."""
    ratio = variances[:, 2] / np.maximum(variances[:, 1], TINY)
    root = np.sqrt(np.maximum(variances[:, :2], 0))
    linear = root[:, 1] < (1 - LINEAR) * root[:, 0]
    ratio = ratio[nearest].mean(axis=1)
    ratio[linear[nearest].mean(axis=1) > MOSTLY] = np.inf
    return np.asarray(ratio)


def _chosen(ratios: Table, doubt: Table) -> Indices:
    """Return (n,) the size of the cells that each point goes into, 0 for itself alone."""
    known = np.cumprod(np.isfinite(ratios), axis=0).astype(bool)  # what is linear stays so at larger sizes
    ratios = np.where(known, ratios, np.inf)
    flat = ratios <= FLAT
    first = flat.argmax(axis=0)
    after = np.arange(len(ratios))[:, None] >= first
    last = first + np.cumprod(np.where(after, flat, True), axis=0).sum(axis=0) - first - 1
    ratios = ratios * doubt
    least = ratios.min(axis=0)
    nearly = (ratios <= np.minimum(NEARLY * least, VOLUME)).argmax(axis=0)
    chosen = np.where(flat.any(axis=0), last, np.where(least < SHAPELESS, nearly, 0))
    return np.asarray(chosen, np.int64)


def _levelled(size: Indices, ratios: Table, cells: Lists) -> Indices:
    """Return the sizes (n,), not much smaller at creases than about them: bands of single points look like wires."""
    about = cells[min(int(np.median(size)) + 1, len(cells) - 1)]
    usual = (np.bincount(about, size) / np.bincount(about))[about]
    least = np.maximum(np.floor(usual).astype(np.int64) - FINER, 0)
    there = np.take_along_axis(ratios, least[None], axis=0)[0]
    return np.where(there < CREASE, np.maximum(size, least), size)
