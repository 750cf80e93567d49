"""Which points of a plane hang together: chains of steps no longer than a link, in a time that grows with their number.

Cells of half a link's diagonal hold points that hang together whatever they are, so that only
neighbouring cells need a look: first at the extreme points of both, which settle nearly all,
then at all their points where two parts are still apart. The answer is exact.
"""

from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Table
from tiskel.geometry.graph import component_labels

SIDE = 0.7071  # of a link: the side of a cell, whose diagonal is then no longer than the link
NEAR = [(i, j) for i in range(3) for j in range(-2, 3) if (i, j) > (0, 0) and abs(i) + abs(j) < 4]  # cells within reach
FULL = 4  # points in a cell, in the mean; of fewer all pairs within a link are looked at, which are few then


def parts_of(plane: Table, link: float) -> Indices:
    """Return (k,) the number of the part that each point (k, 2) is in, from 0 in the order of their first points.

    Parameters
    ----------
    plane : (k, 2) float64
        The points.
    link : float
        Points no further apart hang together, in the same unit.

    Examples
    --------
    >>> import numpy as np
    >>> parts_of(np.array([[0.0, 0.0], [0.9, 0.0], [1.8, 0.0], [5.0, 0.0]]), 1.0).tolist()
    [0, 0, 0, 1]
    """
    cell, count = _cells(plane, SIDE * link)
    if len(plane) < FULL * count:
        return component_labels(len(plane), cKDTree(plane).query_pairs(link, output_type="ndarray"))
    order = np.argsort(cell, kind="stable")
    starts = np.searchsorted(cell[order], np.arange(count + 1))
    close = _neighbours((plane - plane.min(axis=0))[order[starts[:-1]]], SIDE * link)
    tips = _extremes(plane, cell, starts)
    gaps = np.linalg.norm(plane[tips[close[:, 0]]][:, :, None] - plane[tips[close[:, 1]]][:, None], axis=-1)
    touching = gaps.min(axis=(1, 2)) <= link
    label = component_labels(count, close[touching])
    for a, b in close[~touching].tolist():
        own, other = (plane[order[starts[i] : starts[i + 1]]] for i in (a, b))
        if label[a] != label[b] and cKDTree(own).query(other)[0].min() <= link:
            label[label == label[b]] = label[a]
    _, first, part = np.unique(label[cell], return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[part.ravel()].astype(np.int32)


def _cells(plane: Table, side: float) -> tuple[Indices, int]:
    """Return the number of every point's cell, and how many cells hold points."""
    place = np.floor((plane - plane.min(axis=0)) / side).astype(np.int64)
    cell = np.unique(place[:, 0] * (place[:, 1].max() + 1) + place[:, 1], return_inverse=True)[1].ravel()
    return cell.astype(np.int32), int(cell.max()) + 1


def _neighbours(inside: Table, side: float) -> Edges:
    """Return (m, 2) pairs of cells within reach, given a point (c, 2) in each."""
    place = np.floor(inside / side).astype(np.int64)
    place -= place.min(axis=0) - 2
    width = int(place[:, 1].max()) + 3
    key = place[:, 0] * width + place[:, 1]
    order = np.argsort(key)
    found = []
    for i, j in NEAR:
        wanted = key + i * width + j
        at = np.minimum(np.searchsorted(key[order], wanted), len(key) - 1)
        there = np.flatnonzero(key[order[at]] == wanted)
        found.append(np.stack([there, order[at[there]]], axis=1))
    return np.concatenate(found).astype(np.int32)


def _extremes(plane: Table, cell: Indices, starts: Any) -> Any:
    """Return (c, 8) rows of the points of every cell that are outermost in eight directions."""
    angles = np.arange(4) * np.pi / 4
    ends = []
    for way in np.stack([np.cos(angles), np.sin(angles)], axis=1):
        sorted_ = np.lexsort((plane @ way, cell))
        ends += [sorted_[starts[:-1]], sorted_[starts[1:] - 1]]
    return np.stack(ends, axis=1)
