"""The member order that the published toolbox gives to a ring.

A ring is the same ring wherever it starts, but the toolbox depends on the
start: the repeated first member of a closed ring counts twice in the first
contraction weight, and the curve stage joins samples by the *first* foreign
member. The order follows from how the toolbox reads its triangulation: Qhull's
triangles about the point, in Qhull's order but for those that have the point
as their third corner, which come last (the toolbox searches column by column),
walked from the smaller label of the first one; the labels are ranks among the
neighbours, the coordinates the neighbours' own (not centred) on LAPACK's
singular vectors. Done so, all rings of the reference clouds start and turn as
in the toolbox.

Qhull takes two thirds of the time, and holds on to the interpreter, so that threads
do not help. What is read from its triangles is read of many points at once: where
the ring starts, and which of the two members beside the start comes next.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import Delaunay, QhullError

from tiskel.arrays import Indices, Lists, Masks, Points, Table
from tiskel.geometry.rings import Rings

BATCH = 16384  # points whose triangles are read at once: 30 MB with 30 neighbours


def in_published_order(points: Points, neighbours: Lists, rings: Rings) -> Rings:
    """Return the same rings, each starting and turning as in the toolbox.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    neighbours : (n, k) int32
        The nearest of every point, itself first.
    rings : Rings
        Of all points.

    Returns
    -------
    Rings
        Those that Qhull triangulates otherwise stay as they are.
    """
    members = rings.members.copy()
    for first in range(0, len(rings), BATCH):
        rows = slice(first, first + BATCH)
        clouds = points[neighbours[rows]]
        axes = np.linalg.svd(clouds - clouds.mean(axis=1, keepdims=True), full_matrices=False)[2]
        flat = np.einsum("nkc,nac->nka", clouds, axes[:, :2])
        members[rows] = _walked(members[rows], rings.sizes[rows], neighbours[rows], list(map(_delaunay, flat)))
    return Rings(members, rings.sizes, rings.closed)


def _delaunay(flat: Table) -> Lists:
    """Return the Delaunay triangles (t, 3) of points (k, 2), in the order of Qhull; none of points on a line."""
    try:
        return np.asarray(Delaunay(flat, qhull_options="Qt Qbb Qc").simplices)
    except QhullError:
        return np.zeros((0, 3), np.int32)


def _walked(members: Lists, sizes: Indices, neighbours: Lists, triangles: Sequence[Lists]) -> Lists:
    """Return the members of rings (n, w), each from where the toolbox starts, in its direction."""
    owner: Indices = np.repeat(np.arange(len(members), dtype=np.int32), [len(one) for one in triangles])
    every = np.concatenate(triangles)
    about = np.flatnonzero((every == 0).any(axis=1))
    about = about[np.argsort(2 * owner[about] + (every[about, 2] == 0), kind="stable")]
    owner, sides = owner[about], np.sort(every[about], axis=1)[:, 1:]  # labels are ranks; 0 is the point itself
    start, second, held = _starts(owner, sides, neighbours.shape)
    rank = (members[:, :, None] == neighbours[:, None, :]).argmax(axis=2)
    filled = np.arange(members.shape[1]) < sizes[:, None]
    wanted = np.zeros(held.shape, bool)
    wanted[np.nonzero(filled)[0], rank[filled]] = True
    same = np.flatnonzero((wanted == held).all(axis=1) & (sizes > 1))
    out = np.array(members, np.int32)
    out[same] = _turned(members[same], rank[same], sizes[same], start[same], second[same])
    return out


def _starts(owner: Indices, sides: Lists, shape: tuple[int, ...]) -> tuple[Indices, Indices, Masks]:
    """Return the first and the second label of every walk, and which labels (n, k) it has.

    An open ring is walked from the end of lower rank, a closed one along its first side.
    """
    count, width = shape
    keys = owner[:, None] * width + sides
    times = np.bincount(keys.ravel(), minlength=count * width).reshape(count, width)
    start, second = np.full(count, -1), np.full(count, -1)
    rows, first = np.unique(owner, return_index=True)
    start[rows], second[rows] = sides[first].T
    lone = times == 1
    ends = lone.argmax(axis=1)
    at_end = (sides == ends[owner][:, None]) & lone.any(axis=1)[owner][:, None]
    found, place = np.nonzero(at_end)
    start[owner[found]], second[owner[found]] = sides[found, place], sides[found, 1 - place]
    return start, second, times > 0


def _turned(members: Lists, rank: Lists, sizes: Indices, start: Indices, second: Indices) -> Lists:
    """Return rings (m, w) turned and, where they run the other way, reversed."""
    place = np.arange(members.shape[1])
    filled = place < sizes[:, None]
    at = ((rank == start[:, None]) & filled).argmax(axis=1)
    onward = rank[np.arange(len(rank)), (at + 1) % sizes] == second
    turn = np.where(onward, 1, -1)
    order = (at[:, None] + turn[:, None] * place) % sizes[:, None]
    return np.where(filled, np.take_along_axis(members, order, axis=1), members)
