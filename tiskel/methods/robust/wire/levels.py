"""Sections of a cloud of wires and thick limbs: what lies in one bin of the way to the root, and hangs together.

How far links may reach within a section, and how long it is, is decided section by
section. On wires both must be short, or neighbouring twigs become one; on a tube
they must be long, or its ring falls apart. So both are made, and the long ones
stand where their points lie all about an axis, at about one distance, as those of
a tube do. What lies about an axis by chance, in a crown of noisy twigs, is told
from that by how thick the limbs of the cloud are at all.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points
from tiskel.methods.robust.axes import sums
from tiskel.methods.robust.wire.links import Links
from tiskel.methods.robust.wire.routes import Routes

# Found by trial on generated trees, in spacings unless said otherwise.
BIN = 1.5  # length of a bin about a tube
FINE, COARSE = 1.25, 2.5  # reach of links on a wire, and about a tube
FEWEST = 6  # points of a ring
WIDEST_GAP = np.radians(110)  # largest angle about the axis without a point of the ring; three twigs leave 120 degrees


@dataclass(frozen=True)
class Kind:
    """What makes one limb of points, by how thick the limbs of a cloud are.

    Attributes
    ----------
    bin : float
        Length of a bin of the way on a wire, in spacings.
    beside : float
        Reach of links, in spacings, beside a limb.
    ragged : float
        Most that the distance to the axis of a ring spreads, in its mean; of a
        filled disc it is 0.35, of points on a line 0.58.
    """

    bin: float
    beside: float
    ragged: float


RESOLVED = Kind(bin=1.5, beside=2.5, ragged=0.4)  # limbs of several points to a spacing of their length
THREADS = Kind(bin=1.0, beside=1.75, ragged=0.3)  # those of few: what lies all about an axis is seldom a ring


@dataclass(frozen=True, eq=False)
class Levels:
    """The sections and how they hang together.

    Attributes
    ----------
    section : (n,) int32
        The section of every point, -1 for points that are left out.
    centres : (s, 3) float64
        The means of their points.
    parents : (s,) int32
        The section that the way to the root leads to; -1 for that of a root.
    bridged : (s,) bool
        Whether it leads over a gap there.
    tops : (s,) float64
        The longest way of their points to the root, in spacings.
    beside : list of list of int
        The sections in the same bin, or the next ones, that are within reach.
    rings : (s,) bool
        Whether the points lie all about an axis.
    """

    section: Indices
    centres: Points
    parents: Indices
    bridged: Mask
    tops: Numbers
    beside: list[list[int]]
    rings: Mask

    @property
    def on_rings(self) -> float:
        """The share of the points that lie in sections all about an axis."""
        used = self.section[self.section >= 0]
        return float(self.rings[used].mean()) if len(used) else 0.0


def levels_of(
    points: Points, links: Links, routes: Routes, bridge: float, kind: Kind, tubes: Indices | None = None
) -> Levels:
    """Return the sections of points (n, 3).

    bridge is the length of a link, in spacings, that leads over a gap; tubes
    (n,) name the sections of points on limbs that are known, -1 for others.
    """
    count, known = len(points), np.isfinite(routes.length)
    one, other = links.first, links.second
    lengths = links.lengths / links.spacing
    wide, bins = (_bins(routes.length, length) for length in (BIN, kind.bin))
    coarse = _pieces(one, other, (wide[one] == wide[other]) & (lengths <= COARSE), count)
    fine = _pieces(one, other, (bins[one] == bins[other]) & (lengths <= FINE), count)
    rings = _rings(points[known], routes.length[known], coarse[known], int(coarse.max()) + 1, kind.ragged)
    label = np.where(rings[coarse], coarse, int(coarse.max()) + 1 + fine)
    if tubes is not None:
        label = np.where(tubes >= 0, int(label.max()) + 1 + tubes, label)
    section = np.full(count, -1, np.int32)
    section[known] = np.unique(label[known], return_inverse=True)[1].ravel()
    size = np.bincount(section[known])
    lowest = _lowest(section, routes.length)
    parents = section[routes.before[lowest]]
    parents[section[routes.roots]] = -1
    gap = np.linalg.norm(points[lowest] - points[routes.before[lowest]], axis=1)
    tops = np.zeros(len(size))
    np.maximum.at(tops, section[known], routes.length[known])
    near = (np.abs(bins[one] - bins[other]) <= 1) & (lengths <= kind.beside) & (section[one] != section[other])
    return Levels(
        section, sums(points[known], section[known], len(size)) / size[:, None], parents,
        gap > bridge * links.spacing, tops, _lists(section[one[near]], section[other[near]], len(size)),
        rings[coarse[lowest]] if tubes is None else rings[coarse[lowest]] | (tubes[lowest] >= 0),
    )  # fmt: skip


def _bins(length: Numbers, of: float) -> npt.NDArray[np.int64]:
    """Return (n,) the number of every point's bin, -1 for points without a way."""
    return np.where(np.isfinite(length), np.floor(np.nan_to_num(length) / of), -1).astype(np.int64)


def _pieces(one: Indices, other: Indices, chosen: Mask, count: int) -> Indices:
    graph = sparse.coo_array((np.ones(int(chosen.sum())), (one[chosen], other[chosen])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], np.int32)


def _lowest(section: Indices, length: Numbers) -> Indices:
    """Return for each section its point with the shortest way."""
    rows: Indices = np.flatnonzero(section >= 0).astype(np.int32)
    order = rows[np.lexsort((length[rows], section[rows]))]
    return order[np.unique(section[order], return_index=True)[1]]


def _lists(one: Indices, other: Indices, count: int) -> list[list[int]]:
    graph = sparse.coo_array((np.ones(len(one)), (one, other)), shape=(count, count)).tocsr()
    graph.sort_indices()
    rows, starts = graph.indices.tolist(), graph.indptr.tolist()
    return [rows[start:stop] for start, stop in zip(starts, starts[1:], strict=False)]


def _rings(points: Points, length: Numbers, label: Indices, count: int, ragged: float) -> Mask:
    """Tell of every labelled set of points (n, 3) whether they lie all about an axis, at about one distance."""
    size = np.maximum(np.bincount(label, minlength=count), 1)
    offset = points - (sums(points, label, count) / size[:, None])[label]
    # The direction in which the way to the root grows.
    growth = length - (np.bincount(label, length, minlength=count) / size)[label]
    axis = sums(offset * growth[:, None], label, count)
    axis /= np.maximum(np.linalg.norm(axis, axis=1), TINY)[:, None]
    offset -= np.einsum("ij,ij->i", offset, axis[label])[:, None] * axis[label]
    away = np.linalg.norm(offset, axis=1)
    mean = np.bincount(label, away, minlength=count) / size
    spread = np.sqrt(np.maximum(np.bincount(label, away**2, minlength=count) / size - mean**2, 0))
    gaps = widest_gaps(offset, axis, label)
    return np.asarray((size >= FEWEST) & (gaps < WIDEST_GAP) & (spread < ragged * mean))


def widest_gaps(offset: Points, axis: Points, label: Indices) -> Numbers:
    """Return (c,) the widest angle without a point about each axis (c, 3), of offsets (n, 3) from it by label."""
    count = len(axis)
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin(axis=1)])
    first /= np.maximum(np.linalg.norm(first, axis=1), TINY)[:, None]
    second = np.cross(axis, first)
    angle = np.arctan2(np.einsum("ij,ij->i", offset, second[label]), np.einsum("ij,ij->i", offset, first[label]))
    order = np.lexsort((angle, label))
    angle, owner = angle[order], label[order]
    starts = np.flatnonzero(np.r_[True, owner[1:] != owner[:-1]])
    stops = np.r_[starts[1:], len(owner)] - 1
    gaps = np.full(count, 2 * np.pi)
    gaps[owner[starts]] = 2 * np.pi - (angle[stops] - angle[starts])
    inner = owner[1:] == owner[:-1]
    np.maximum.at(gaps, owner[1:][inner], (angle[1:] - angle[:-1])[inner])
    return gaps
