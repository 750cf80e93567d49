"""Objects of a cloud that does not fit: what hangs together by occupied cells."""

from itertools import product

import numpy as np

from tiskel.arrays import Indices, Mask, Pairs, Points
from tiskel.geometry.graph import component_labels
from tiskel.tiles.cells import CellGrid, Integers, cells_of

STEPS = [step for step in product((-1, 0, 1), repeat=3) if step > (0, 0, 0)]  # to half of the 26 neighbours
SPACINGS = 3.0  # that cells are long, about: no hole in an evenly sampled surface is as wide


def connecting(grid: CellGrid, spacing: float) -> CellGrid:
    """Return the cells, doubled until they are as long as it takes to hang together, about three spacings."""
    while 2 * grid.side <= SPACINGS * np.sqrt(2) * spacing:
        grid = grid.coarser()
    return grid


def objects_of(grid: CellGrid) -> Indices:
    """Return which object each cell is of, the one with the most points first.

    Cells that touch, be it by a corner, hang together: points up to one side
    apart surely do, points more than 3.5 sides apart never alone.

    Parameters
    ----------
    grid : CellGrid

    Returns
    -------
    (m,) int32
        From 0; of equally many points the object with the first cell comes first.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.tiles.cells import Counting
    >>> from tiskel.tiles.objects import objects_of
    >>> counting = Counting(side=1.0)
    >>> counting.add(np.array([[0.5, 0, 0], [5, 0, 0], [6, 1, 1], [5, 0, 0]]))
    >>> objects_of(counting.grid()).tolist()
    [1, 0, 0]
    """
    label = component_labels(len(grid.corners), touching(grid.corners))
    points = np.bincount(label, grid.counts)
    rank = np.empty(len(points), np.int32)
    rank[np.argsort(-points, kind="stable")] = np.arange(len(points), dtype=np.int32)
    return rank[label]


def touching(corners: Pairs) -> Pairs:
    """Return (l, 2) the pairs of cells (m, 3) that touch, as rows; the cells are in ascending order."""
    key = _Keys(corners)
    pairs = []
    for step in STEPS:
        there = key.rows(corners + np.array(step))
        here = np.flatnonzero(there >= 0)
        pairs.append(np.stack([here, there[here]], axis=1))
    return np.concatenate(pairs)


class CellLookup:
    """What each point's cell is labelled with.

    Parameters
    ----------
    grid : CellGrid
    labels : (m,) int32
        Of its cells.
    """

    def __init__(self, grid: CellGrid, labels: Indices) -> None:
        self._key, self._side, self._labels = _Keys(grid.corners), grid.side, labels

    def of(self, points: Points) -> Indices:
        """Return (n,) int32 the label of the cell of each point (n, 3), all of them among those counted."""
        return np.asarray(self._labels[self._key.rows(cells_of(points, self._side))])


class _Keys:
    """Cells by number: a coordinate counts by its rank among those that occur, so that no number is too large."""

    def __init__(self, corners: Pairs) -> None:
        self._axes = [np.unique(column) for column in corners.T]
        self._keys = self._numbers(corners)[0]

    def rows(self, corners: Pairs) -> Integers:
        """Return (n,) the row of each cell (n, 3), -1 where it is none."""
        numbers, known = self._numbers(corners)
        place = np.minimum(np.searchsorted(self._keys, numbers), len(self._keys) - 1)
        return np.where(known & (self._keys[place] == numbers), place, -1)

    def _numbers(self, corners: Pairs) -> tuple[Integers, Mask]:
        number, known = np.zeros(len(corners), np.int64), np.ones(len(corners), np.bool_)
        for values, column in zip(self._axes, corners.T, strict=True):
            place = np.minimum(np.searchsorted(values, column), len(values) - 1)
            known &= values[place] == column
            number = number * len(values) + place
        return number, known
