"""The inside of a body on a grid: how far from the surface, how far through the body, and where it ends."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import ndimage, sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Lists, Numbers, Points, Stack
from tiskel.geometry.frames import unit
from tiskel.geometry.thinning import SIDES, Grid

# Found by trial on generated bodies: blocks and plates with holes, torsos, flat tubes, rings of rings.
MOST_CELLS = 100_000  # inside; of a finer grid every other place in each direction is taken
LEAST_PART = 0.005  # of the largest part's cells; smaller ones are left out
SIDEWAYS = 0.7  # weight of the mean length of rays, as logarithm, against that of the clearance
TIP_WINDOW = 2.5  # cells about a tip, in which no other is deeper in the body's dead end
TURN = np.arange(12) * (np.pi / 6)  # directions across a curve to climb in
CLIMBS = 10  # steps, half as long wherever they lead no higher
TOUCHING = np.ones((3, 3, 3))


@dataclass(frozen=True, eq=False)
class Body:
    """The cells of a grid that lie inside.

    Attributes
    ----------
    inside : (i, j, k) bool
        The cells, without hollows.
    level : float
        Winding number above which they are inside.
    winding : (i, j, k) float64
        The winding number at each.
    origin : (3,) float64
        The place of the first cell of the grid.
    step : float
        From cell to cell.
    cells : (m, 3) int
        Those inside.
    clearance : (m,) float64
        How far they are from the surface.
    """

    inside: Grid
    level: float
    winding: Stack
    origin: Numbers
    step: float
    cells: Lists
    clearance: Numbers

    @cached_property
    def places(self) -> Points:
        """(m, 3) where the cells are."""
        return np.asarray(self.origin + self.cells * self.step)

    def on_grid(self, values: Numbers, elsewhere: float = 0.0) -> Stack:
        """Return values (m,) of the cells on the grid (i, j, k)."""
        grid = np.full(self.inside.shape, elsewhere)
        grid[self.inside] = values
        return grid

    @cached_property
    def links(self) -> sparse.csr_array:
        """The upper triangle (m, m) of the lengths between cells that touch."""
        number = np.pad(
            self.on_grid(np.arange(len(self.cells), dtype=float), -1).astype(np.int32), 1, constant_values=-1
        )
        here = number[1:-1, 1:-1, 1:-1]
        first, second, lengths = [], [], []
        for side in SIDES[14:]:
            window = tuple(slice(1 + s, n - 1 + s) for s, n in zip(side.tolist(), number.shape, strict=True))
            both = (here >= 0) & (number[window] >= 0)
            first.append(here[both])
            second.append(number[window][both])
            lengths.append(np.full(len(first[-1]), self.step * float(np.linalg.norm(side))))
        rows, columns = np.concatenate(first), np.concatenate(second)
        shape = (len(self.cells), len(self.cells))
        return sparse.coo_array((np.concatenate(lengths), (rows, columns)), shape=shape).tocsr()

    @cached_property
    def _clearances(self) -> Stack:
        return self.on_grid(self.clearance)

    def clearance_at(self, places: Points) -> Numbers:
        """Return how far any places (q, 3) are from the surface, 0 outside."""
        return self._between(self._clearances, places)

    def winding_at(self, places: Points) -> Numbers:
        """Return the winding number at any places (q, 3)."""
        return self._between(self.winding, places)

    def _between(self, values: Stack, places: Points) -> Numbers:
        where = (places - self.origin) / self.step
        return np.asarray(ndimage.map_coordinates(values, where.T, order=1, mode="constant"))

    @cached_property
    def parts(self) -> Indices:
        """(m,) the part that each cell belongs to, from 0."""
        return np.asarray(ndimage.label(self.inside, TOUCHING)[0][self.inside] - 1, np.int32)

    @cached_property
    def order(self) -> Stack:
        """(i, j, k) the order to thin in: by clearance, and by the room in all directions where that says little.

        In a plate all places of the middle sheet are as far from the surface; the
        rays along the sheet tell its middle.
        """
        clear = np.log(np.maximum(self.clearance, 0.25 * self.step))
        return self.on_grid(clear) + SIDEWAYS * _mean_rays(self.inside)

    @cached_property
    def tips(self) -> Grid:
        """(i, j, k) where dead ends of the body end: farthest from its ends, or from its middle, for cells about."""
        parts = range(int(self.parts.max()) + 1)
        starts = [int(np.where(self.parts == part, self.clearance, -1).argmax()) for part in parts]
        out = np.zeros(self.inside.shape, bool)
        reach = np.arange(-int(TIP_WINDOW), int(TIP_WINDOW) + 1)
        window = (np.stack(np.meshgrid(reach, reach, reach)) ** 2).sum(axis=0) <= TIP_WINDOW**2
        for _ in range(2):
            distance = dijkstra(self.links, directed=False, indices=starts, min_only=True)
            starts = [int(np.where(self.parts == part, distance, -1).argmax()) for part in parts]
            grid = self.on_grid(distance, -1.0)
            found = self.inside & (grid >= ndimage.maximum_filter(grid, footprint=window))
            out |= found & ~ndimage.binary_dilation(out, window)
        return out


def body_of(winding: Stack, origin: Numbers, step: float, points: Points, level: float) -> Body | None:
    """Return the inside of a surface, None where there is none.

    Parameters
    ----------
    winding : (i, j, k) float64
        Winding numbers on a grid.
    origin : (3,) float64
        Its first place, in the unit of the points.
    step : float
        From place to place, in the same unit.
    points : (n, 3) float64
        Of the surface.
    level : float
        Winding number above which places are inside.

    Returns
    -------
    Body or None
    """
    from tiskel.kernels.threads import requested_threads

    if int((winding > level).sum()) > MOST_CELLS:
        winding, step = winding[::2, ::2, ::2], 2 * step
    inside = _whole(np.pad(winding > level, 1))[1:-1, 1:-1, 1:-1]
    if not inside.any():
        return None
    cells = np.argwhere(inside)
    to_points = cKDTree(points).query(origin + cells * step, workers=requested_threads())[0]
    to_outside = step * ndimage.distance_transform_edt(np.pad(inside, 1))[1:-1, 1:-1, 1:-1][inside]
    winding = np.where(inside & (winding <= level), 1.0, winding)
    return Body(inside, level, winding, origin, step, cells.astype(np.int32), np.minimum(to_points, to_outside))


def shares_of_depth(body: Body, places: Points, directions: Points) -> Numbers:
    """Return how deep places are in a body, in the greatest depth that climbing across a curve finds.

    Parameters
    ----------
    body : Body
    places : (q, 3) float64
        On a curve, in the unit of the body.
    directions : (q, 3) float64
        Unit tangents of the curve.

    Returns
    -------
    (q,) float64
        From 0 outside to 1 in the middle.
    """
    u = unit(np.cross(directions, np.eye(3)[np.abs(directions).argmin(axis=1)]))
    v = np.cross(directions, u)
    around = np.cos(TURN)[:, None] * u[:, None] + np.sin(TURN)[:, None] * v[:, None]  # (q, 12, 3)
    own = body.clearance_at(places)
    best, at, length, rows = own, places, np.maximum(own, body.step) / 2, np.arange(len(places))
    for _ in range(CLIMBS):
        ring = at[:, None] + length[:, None, None] * around
        clear = body.clearance_at(ring.reshape(-1, 3)).reshape(len(places), len(TURN))
        to = clear.argmax(axis=1)
        better = clear[rows, to] > best
        best = np.where(better, clear[rows, to], best)
        at = np.where(better[:, None], ring[rows, to], at)
        length = np.where(better, length, length / 2)
    return np.asarray(own / np.maximum(best, TINY))


def _whole(inside: Grid) -> Grid:
    """Return a solid without its small parts and its hollows."""
    part = ndimage.label(inside, TOUCHING)[0]
    sizes = np.bincount(part.ravel())
    sizes[0] = 0
    large = sizes > LEAST_PART * sizes.max()
    outside = ndimage.label(~large[part])[0]
    return np.asarray(outside != outside[0, 0, 0])


def _mean_rays(inside: Grid) -> Stack:
    """Return the mean logarithm of how many cells it is to the surface, over the 26 directions of the grid."""
    there = np.pad(inside, 1).astype(float)
    total = np.zeros(there.shape)
    for side in SIDES[np.abs(SIDES).any(axis=1)]:
        axis = int(np.flatnonzero(side)[0])
        across = tuple(np.delete(side, axis).tolist())
        length = np.zeros(there.shape)
        slabs, cells = np.moveaxis(length, axis, 0), np.moveaxis(there, axis, 0)
        forward = side[axis] > 0
        for i in range(1, len(slabs) - 1) if forward else range(len(slabs) - 2, 0, -1):
            slabs[i] = (np.roll(slabs[i - side[axis]], across, (0, 1)) + 1) * cells[i]
        total += np.log(np.where(length > 0, length * float(np.linalg.norm(side)), 1.0))
    return np.asarray(total[1:-1, 1:-1, 1:-1] / (len(SIDES) - 1))
