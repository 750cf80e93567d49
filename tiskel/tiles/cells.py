"""Occupied cells of a cloud that is seen piece by piece: how many points each holds, and their mean.

Sides are powers of two times a first one and the grid begins at the origin, so
that cells of one size are halves of those of the next, and a point is in the
same cell whenever it is seen. Where there are too many cells, all double.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Pairs, Points
from tiskel.errors import TiskelError
from tiskel.geometry.cells import numbered

MOST = 1 << 20  # cells kept at most, unless told otherwise: 44 bytes each, and a few times that while they are merged
START = 1 << 14  # cells along the longest side of the first piece, at first
FARTHEST = 2.0**50  # cells from the origin: beyond, neighbouring cells are not told apart by their numbers as floats
PENDING = 1 << 20  # points that wait to be counted together
ENOUGH = 4  # points that a cell holds in the median where the spacing is taken from it
FACETS = 0.85  # squares of one side that a plane fills in the cell of the median point; found on shapes of the gallery

Integers = npt.NDArray[np.integer[Any]]  #: any number of axes, as the docstring says
Flags = npt.NDArray[np.bool_]  #: the same
Counts = np.ndarray[tuple[int], np.dtype[np.int64]]  #: shape (m,)


@dataclass(frozen=True, eq=False)
class CellGrid:
    """Cells with points in them.

    Attributes
    ----------
    side : float
        Of a cell, in the cloud's unit.
    corners : (m, 3) int64
        Of each cell, in sides from the origin; ascending with x, then y, then z.
    counts : (m,) int64
        Its points.
    means : (m, 3) float64
        Their mean.
    """

    side: float
    corners: Pairs
    counts: Counts
    means: Points

    def coarser(self) -> "CellGrid":
        """Return the cells of twice the side."""
        return merged(2 * self.side, self.corners >> 1, self.counts, self.means * self.counts[:, None])

    def spacing(self) -> float:
        """Return how far the points are apart, about, where they lie on surfaces; 0 of fewer than two points.

        Half of all points are in cells that hold so many points or more, at the
        least side where these are four.
        """
        grid = self
        while len(grid.counts) > 1 and median_count(grid.counts) < ENOUGH:
            grid = grid.coarser()
        most = median_count(grid.counts)
        return grid.side / float(np.sqrt(FACETS * most)) if most > 1 else 0.0


def median_count(counts: Counts) -> int:
    """Return the count of the cell that half of all points are in or below, of cells (m,) of which there is one."""
    order = np.sort(counts)
    return int(order[np.searchsorted(np.cumsum(order), order.sum() / 2)])


def cells_of(points: Points, side: float) -> npt.NDArray[np.int64]:
    """Return (n, 3) the cell of each point, in sides from the origin."""
    return np.floor(points / side).astype(np.int64)


def merged(side: float, corners: Pairs, counts: Counts, sums: Points) -> CellGrid:
    """Return cells, each once, of corners (m, 3) that may repeat, with the counts (m,) and sums (m, 3) of points."""
    low = corners.min(axis=0)
    cells, place = numbered(corners - low)
    total = np.bincount(place, counts, len(cells)).astype(np.int64)
    means = np.stack([np.bincount(place, column, len(cells)) for column in sums.T], axis=1) / total[:, None]
    return CellGrid(side, cells + low, total, means)


class Counting:
    """Cells of points that come piece by piece.

    Parameters
    ----------
    side : float, optional
        Of the cells, which then do not grow; without it as small as their number allows.
    most : int
        Cells that are kept at most.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.tiles.cells import Counting
    >>> counting = Counting(side=1.0)
    >>> counting.add(np.array([[0.5, 0, 0], [0.7, 0, 0]]))
    >>> counting.add(np.array([[-0.5, 0, 0]]))
    >>> counting.grid().counts.tolist()
    [1, 2]
    """

    def __init__(self, side: float | None = None, most: int = MOST) -> None:
        self._side, self._fixed, self._most = side or 0.0, side is not None, most
        self._waiting: list[Points] = []
        self._grid: CellGrid | None = None

    def add(self, points: Points) -> None:
        """Count points (n, 3) float64, all finite."""
        self._waiting.append(points)
        if sum(map(len, self._waiting)) >= PENDING:
            self._count()

    def grid(self) -> CellGrid:
        """Return the cells of all points so far.

        Raises
        ------
        TiskelError
            Where there was none.
        """
        self._count()
        if self._grid is None:
            raise TiskelError("no point has finite coordinates; there is nothing to split")
        return self._grid

    def _count(self) -> None:
        waiting = [points for points in self._waiting if len(points)]
        self._waiting = []
        if not waiting:
            return
        points = np.concatenate(waiting)
        self._grow(points)
        fresh = merged(self._side, cells_of(points, self._side), np.ones(len(points), np.int64), points)
        self._grid = fresh if self._grid is None else _together(self._grid, fresh)
        while len(self._grid.counts) > self._most:
            self._double()

    def _grow(self, points: Points) -> None:
        """Choose the first side, and double it until all points are within the numbers of cells."""
        if not self._side:
            extent = float(np.ptp(points, axis=0).max()) or 1.0
            self._side = 2.0 ** np.ceil(np.log2(extent / START))
        while np.abs(points).max() > FARTHEST * self._side:
            self._double()

    def _double(self) -> None:
        if self._fixed:
            raise TiskelError(
                f"cells of {self._side:g} are more than the {self._most} that are kept in memory; "
                "ask for a larger gap, or crop the cloud"
            )
        self._side *= 2
        self._grid = self._grid and self._grid.coarser()


def _together(one: CellGrid, other: CellGrid) -> CellGrid:
    corners = np.concatenate([one.corners, other.corners])
    sums = np.concatenate([one.means * one.counts[:, None], other.means * other.counts[:, None]])
    return merged(one.side, corners, np.concatenate([one.counts, other.counts]), sums)
