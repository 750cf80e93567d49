"""Boxes that a cloud is cut into: planes that halve it again and again where they cross few points, and margins.

Planes lie between cells that were counted, so that every point is in exactly
one core, whatever its coordinates round to.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Indices, Mask, Points, Stack
from tiskel.errors import TiskelError
from tiskel.params import SplitParams
from tiskel.tiles.cells import CellGrid

BALANCE = (0.3, 0.7)  # share of the points on the low side of a plane, where there is a choice
UNEVEN = 0.25  # share of points in the margins that a wholly uneven plane is worth: few copies count more than balance
NARROWEST = 2.0  # overlaps that the side of a tile is long at least: narrower ones would be mostly margin


@dataclass(frozen=True)
class Plane:
    """Where a box is cut in two.

    Attributes
    ----------
    axis : int
        0, 1 or 2: the plane is across x, y or z.
    cell : int
        The first cell of the high side, in sides from the origin.
    low, high : Plane or int
        What the two sides are: cut again, or a tile by its number.
    """

    axis: int
    cell: int
    low: "Plane | int"
    high: "Plane | int"


@dataclass(frozen=True)
class Tiling:
    """Tiles that overlap; their cores share all of space.

    Attributes
    ----------
    side : float
        Of the cells that planes lie between, in the cloud's unit.
    overlap : float
        How far a tile reaches beyond its core, in the same unit.
    root : Plane or int
        The first plane; the number 0 where there is one tile only.

    Examples
    --------
    >>> from tiskel.tiles.tiling import Plane, Tiling
    >>> two = Tiling(1.0, 0.5, Plane(0, 3, 0, 1))
    >>> two.cores()[1].tolist()
    [[3.0, -inf, -inf], [inf, inf, inf]]
    """

    side: float
    overlap: float
    root: Plane | int

    def place(self, plane: Plane) -> float:
        """Return where a plane is on its axis."""
        return plane.cell * self.side

    def deal(self, points: Points) -> Iterator[tuple[int, Indices, Mask]]:
        """Yield the tiles that points (n, 3) lie in: number, rows of the points, and which of these are in its core."""
        everyone = np.arange(len(points), dtype=np.int32)
        waiting = [(self.root, everyone, np.ones(len(points), bool))]
        while waiting:
            node, rows, core = waiting.pop()
            if len(rows) == 0:
                continue
            if isinstance(node, int):
                yield node, rows, core
                continue
            x, place = points[rows, node.axis], self.place(node)
            below = np.floor(x / self.side) < node.cell
            low, high = below | (x < place + self.overlap), ~below | (x >= place - self.overlap)
            waiting.append((node.high, rows[high], (core & ~below)[high]))
            waiting.append((node.low, rows[low], (core & below)[low]))

    def cores(self) -> Stack:
        """Return (t, 2, 3) the lowest and the highest corner of every core, infinite where no plane bounds it."""
        boxes: dict[int, Points] = {}
        waiting = [(self.root, np.array([[-np.inf] * 3, [np.inf] * 3]))]
        while waiting:
            node, box = waiting.pop()
            if isinstance(node, int):
                boxes[node] = box
                continue
            low, high = box.copy(), box.copy()
            low[1, node.axis] = high[0, node.axis] = self.place(node)
            waiting += [(node.low, low), (node.high, high)]
        return np.stack([boxes[tile] for tile in range(len(boxes))])

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values."""
        return {"side": self.side, "overlap": self.overlap, "planes": _plain(self.root)}

    @staticmethod
    def from_dict(values: dict[str, Any]) -> "Tiling":
        """Return the tiling of a JSON document; raise KeyError, TypeError or ValueError where it is none."""
        return Tiling(float(values["side"]), float(values["overlap"]), _planes(values["planes"]))


def _plain(node: Plane | int) -> Any:
    if isinstance(node, int):
        return node
    return {"axis": node.axis, "cell": node.cell, "low": _plain(node.low), "high": _plain(node.high)}


def _planes(values: Any) -> Plane | int:
    if isinstance(values, int):
        return values
    return Plane(int(values["axis"]), int(values["cell"]), _planes(values["low"]), _planes(values["high"]))


def tiles_of(grid: CellGrid, params: SplitParams, overlap: float) -> Tiling:
    """Return tiles of about equal numbers of points, or of a size.

    Parameters
    ----------
    grid : CellGrid
        The cells of the cloud.
    params : SplitParams
        How many points a tile is to have, or how long it may be.
    overlap : float
        How far a tile reaches beyond its core, in the cloud's unit.

    Returns
    -------
    Tiling

    Raises
    ------
    TiskelError
        Where the overlap is longer than the cloud: there would be nothing but margin.
    """
    extent = (grid.corners.max(axis=0) - grid.corners.min(axis=0) + 1) * grid.side
    if overlap > extent.max():
        raise TiskelError(f"the overlap {overlap:g} is longer than the cloud, {extent.max():g}; ask for less")
    planes = _Planes(grid, params, overlap)
    return Tiling(grid.side, overlap, planes.under(np.arange(len(grid.counts))))


class _Planes:
    """The recursion of the planes; numbers tiles as it meets them, low sides first."""

    def __init__(self, grid: CellGrid, params: SplitParams, overlap: float) -> None:
        self.grid, self.params, self.overlap, self.tiles = grid, params, overlap, 0

    def under(self, cells: Any) -> Plane | int:
        """Return the planes that cut so many cells (k,), as rows of the grid."""
        found = self._best(cells) if self._too_large(cells) else None
        if found is None:
            self.tiles += 1
            return self.tiles - 1
        axis, cell = found
        below = self.grid.corners[cells, axis] < cell
        low = self.under(cells[below])
        return Plane(axis, cell, low, self.under(cells[~below]))

    def _too_large(self, cells: Any) -> bool:
        if self.params.size is None:
            return int(self.grid.counts[cells].sum()) > self.params.points
        corners = self.grid.corners[cells]
        return bool(((corners.max(axis=0) - corners.min(axis=0) + 1) * self.grid.side).max() > self.params.size)

    def _best(self, cells: Any) -> tuple[int, int] | None:
        """Return axis and cell of the plane with the fewest points about it, of those that halve well enough."""
        best: tuple[float, int, int] | None = None
        for axis in range(3):
            for balanced in self._candidates(cells, axis):
                if best is None or balanced < best:
                    best = balanced
        return best and best[1:]

    def _candidates(self, cells: Any, axis: int) -> list[tuple[float, int, int]]:
        """Return the best plane across an axis, with its price; none where both sides would be too narrow."""
        slabs, where = np.unique(self.grid.corners[cells, axis], return_inverse=True)
        summed = np.concatenate([[0.0], np.cumsum(np.bincount(where, self.grid.counts[cells]))])
        planes = np.concatenate([slabs[:1], (slabs[:-1] + 1 + slabs[1:]) // 2])  # in the middle of what is empty
        places, total = planes * self.grid.side, summed[-1]
        first, last = slabs[0] * self.grid.side, (slabs[-1] + 1) * self.grid.side
        narrow = NARROWEST * self.overlap
        allowed = (places - first >= narrow) & (last - places >= narrow)
        allowed[0] = False
        if not allowed.any():
            return []
        halves = (places - first) / (last - first)
        share = summed[:-1] / total if self.params.size is None else halves
        even = allowed & (share >= BALANCE[0]) & (share <= BALANCE[1])
        near = [summed[np.searchsorted(slabs * self.grid.side, places + way * self.overlap)] for way in (-1, 1)]
        price = (near[1] - near[0]) / total + UNEVEN * np.abs(share - 0.5)
        price = np.where(even, price, np.where(allowed, 2 + np.abs(share - 0.5), np.inf))
        chosen = int(price.argmin())
        return [(float(price[chosen]), axis, int(planes[chosen]))]
