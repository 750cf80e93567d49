"""The closed surface where a function changes its sign, as triangles, found from places near it.

Cells of an even grid are followed from those that hold a seed to those beside
them, as long as the surface goes on (Wyvill et al., Data structure for soft
objects, The Visual Computer 1986), so that only cells on the surface are looked
at. Each is cut into six tetrahedra about its diagonal, the same in all cells:
the surface in a tetrahedron is one triangle or two, and closed and manifold
altogether whatever the function is (Doi and Koide 1991).
"""

from collections.abc import Callable
from itertools import permutations
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Mask, Numbers, Points
from tiskel.geometry.distinct import distinct

Cells = npt.NDArray[np.int64]  #: shape (n,), keys of grid places, or (n, 8) of the corners of cells

SIDE = 21  # bits of a key for each axis: grids of two million places along each
CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
TETRAHEDRA = np.array([[0, 4 >> a, 4 >> a | 4 >> b, 7] for a, b, _ in permutations(range(3))])
SHIFTS = np.concatenate([np.eye(3, dtype=np.int64), -np.eye(3, dtype=np.int64)])
FACES = [np.flatnonzero(CORNERS[:, axis] == side) for side in (1, 0) for axis in range(3)]  # as the shifts
NEAR_ENDS = 0.05  # of an edge: no vertex is nearer to its ends, or triangles have no area


class Found(NamedTuple):
    """Triangles, and how the function is on the edges of the grid that they cut.

    Attributes
    ----------
    vertices : (p, 3) float64
        One on each edge of a tetrahedron that is cut.
    triangles : (q, 3) int32
        Counter-clockwise seen from where the function is positive.
    whole : bool
        Whether all of the surface was followed, so that it is closed; not where there were too many cells.
    """

    vertices: Points
    triangles: Edges
    whole: bool = True


def marched(values: Callable[[Points], Numbers], seeds: Points, step: float, most: int) -> Found:
    """Return the surface that goes through the cells of seeds, and on from there.

    Parameters
    ----------
    values : callable
        The function at places (m, 3), finite; negative inside.
    seeds : (n, 3) float64
        Places near the surface, in any unit.
    step : float
        Of the grid, in the same unit.
    most : int
        Cells at which it ends, so that a surface without end does not.

    Returns
    -------
    Found
        Closed unless there are more cells.

    Examples
    --------
    >>> import numpy as np
    >>> ball = marched(lambda p: np.linalg.norm(p, axis=1) - 1, np.array([[1.0, 0, 0]]), 0.2, 10_000)
    >>> edges = 3 * len(ball.triangles) // 2
    >>> len(ball.vertices) - edges + len(ball.triangles)
    2
    """
    origin = seeds.min(axis=0) - step * 2 ** (SIDE - 2)
    grid = _Grid(values, origin, step)
    nearest = np.rint((seeds - origin) / step).astype(np.int64)
    cells = distinct(grid.keys(nearest[:, None] - CORNERS))  # the eight about the nearest place of the grid
    done = cells[:0]
    while len(cells) and len(done) < most:
        inside = grid.inside(cells)
        crossed = inside.any(axis=1) & ~inside.all(axis=1)
        done = np.union1d(done, cells)
        mixed, place = inside[crossed], grid.places(cells[crossed])
        beside = [
            grid.keys(place[mixed[:, face].any(axis=1) & ~mixed[:, face].all(axis=1)] + shift)
            for face, shift in zip(FACES, SHIFTS, strict=True)
        ]
        cells = np.setdiff1d(distinct(np.concatenate(beside)), done, assume_unique=True)
    return _triangles(grid, done)._replace(whole=not len(cells))


class _Grid:
    """Values at the places of a grid that were asked for."""

    def __init__(self, values: Callable[[Points], Numbers], origin: Numbers, step: float) -> None:
        self.values, self.origin, self.step = values, origin, step
        self.known, self.at = np.zeros(0, np.int64), np.zeros(0)

    def keys(self, places: npt.NDArray[np.int64]) -> Cells:
        """Return a number for each place (..., 3) of the grid."""
        return np.asarray((places[..., 0] << 2 * SIDE) | (places[..., 1] << SIDE) | places[..., 2])

    def places(self, keys: Cells) -> npt.NDArray[np.int64]:
        """Return the places (..., 3) of keys."""
        low = (1 << SIDE) - 1
        return np.stack([keys >> 2 * SIDE, keys >> SIDE & low, keys & low], axis=-1)

    def corners(self, cells: Cells) -> Cells:
        """Return the keys (n, 8) of the corners of cells (n,)."""
        return self.keys(self.places(cells)[:, None] + CORNERS)

    def inside(self, cells: Cells) -> npt.NDArray[np.bool_]:
        """Return (n, 8) which corners of cells (n,) are inside; those not yet known are looked up."""
        corners = self.corners(cells)
        new = np.setdiff1d(distinct(corners), self.known, assume_unique=True)
        if len(new):
            found = self.values(self.origin + self.step * self.places(new))
            order = np.argsort(known := np.concatenate([self.known, new]), kind="stable")
            self.known, self.at = known[order], np.concatenate([self.at, found])[order]
        return self.value(corners) < 0

    def value(self, keys: Cells) -> Numbers:
        """Return the values at places that are known."""
        return np.asarray(self.at[np.searchsorted(self.known, keys)])


def _triangles(grid: _Grid, cells: Cells) -> Found:
    corners = grid.corners(cells)[:, TETRAHEDRA].reshape(-1, 4)
    value = grid.value(corners)
    inside = value < 0
    cut = inside.any(axis=1) & ~inside.all(axis=1)
    corners, inside = corners[cut], inside[cut]
    order = np.argsort(~inside, axis=1, kind="stable")  # those inside first
    corners, count = np.take_along_axis(corners, order, axis=1), inside.sum(axis=1)
    sides = [_sides(corners[count == n], n) for n in (1, 2, 3)]
    ends = np.concatenate(sides).reshape(-1, 2)
    edges, number = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    first, last = grid.value(edges[:, 0]), grid.value(edges[:, 1])
    share = np.clip(first / (first - last), NEAR_ENDS, 1 - NEAR_ENDS)[:, None]
    a, b = (grid.origin + grid.step * grid.places(edges[:, end]) for end in (0, 1))
    triangles = number.reshape(-1, 3).astype(np.int32)
    outward = _outward(grid, ends.reshape(-1, 3, 2))
    triangles[~outward] = triangles[~outward][:, ::-1]
    return Found((1 - share) * a + share * b, triangles)


def _sides(corners: Cells, count: int) -> Cells:
    """Return the edges (t, 3, 2) that the triangles cut, of tetrahedra (m, 4) with so many corners inside, first."""
    a, b, c, d = corners.T
    cuts = {
        1: [((a, b), (a, c), (a, d))],
        2: [((a, c), (a, d), (b, d)), ((a, c), (b, d), (b, c))],
        3: [((a, d), (b, d), (c, d))],
    }[count]
    return np.concatenate([np.stack([np.stack(edge, axis=1) for edge in triangle], axis=1) for triangle in cuts])


def _outward(grid: _Grid, ends: Cells) -> Mask:
    """Return (t,) which triangles look outward where they cut edges (t, 3, 2), inner end first, in the middle."""
    inner, outer = (grid.places(ends[:, :, end]).astype(float) for end in (0, 1))
    a, b, c = np.moveaxis(inner + outer, 1, 0)
    return np.asarray((np.cross(b - a, c - a) * (outer - inner).sum(axis=1)).sum(axis=1) > 0)
