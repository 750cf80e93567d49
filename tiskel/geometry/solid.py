"""The solid that an oriented cloud encloses, and its handles.

The winding number on a grid of the cloud's own spacing. Where it exceeds a level
there are cubes; their loops follow from the Euler characteristic,
components - loops + cavities = vertices - edges + faces - cubes. Thin parts and
open ends have low winding numbers, so several levels are tried, and what they do
not agree on is not decided.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from tiskel.arrays import Numbers, Stack
from tiskel.geometry.body import Body, body_of
from tiskel.geometry.oriented import OrientedCloud, checked

LEVELS = (0.25, 0.3, 0.4)  # winding numbers; noise outside stays below, tubes of one spacing's radius rise above
STEP = 1.2  # of the grid, in spacings
UNDECIDED = (0.1, 0.6)  # winding numbers about the levels, with what they change within a cell
MAX_CELLS = 1_000_000
RIM = 1.5  # cells between the points and the first places of the grid
COARSEST = 2.5  # spacings; on a coarser grid thin parts would be missed
PROBED = 16384  # points; of larger clouds so many are taken
PARTS = 2  # of a larger cloud: what one counts by chance, the other does not

Grid = np.ndarray[tuple[int, int, int], np.dtype[np.bool_]]


@dataclass(frozen=True, eq=False)
class WindingGrid:
    """Winding numbers on a grid.

    Attributes
    ----------
    values : (i, j, k) float64
        The winding number at every place, axes as those of the points; nothing is inside at the rim.
    origin : (3,) float64
        The first place, in the unit of the points.
    step : float
        From place to place, in the same unit.
    """

    values: Stack
    origin: Numbers
    step: float


@dataclass(frozen=True, eq=False)
class Solid:
    """What an oriented cloud encloses.

    Attributes
    ----------
    oriented : OrientedCloud
        The cloud.
    trusted : bool
        Whether there is an inside to speak of.
    handles : int or None
        How many there are, None where they cannot be told.
    grid : WindingGrid or None
        What they were counted on; None where there is no inside to speak of, or too many cells for it.
    closed : bool
        Whether a watertight mesh says that its surface has no hole.
    level : float
        Winding number above which the body is inside: the middle one of those with these handles, or fewest.
    """

    oriented: OrientedCloud
    trusted: bool
    handles: int | None
    grid: WindingGrid | None = None
    closed: bool = False
    level: float = LEVELS[1]

    @cached_property
    def body(self) -> Body | None:
        """The cells of the grid inside, None where there is no grid."""
        if self.grid is None:
            return None
        return body_of(self.grid.values, self.grid.origin, self.grid.step, self.oriented.points, self.level)


def solid_of(surface: OrientedCloud, handles: int | None = None, closed: bool = False) -> Solid:
    """Return the solid inside an oriented cloud, with its handles where a mesh knows them; closed where one says so.

    Of a large cloud, what two parts of its points agree on.
    """
    step = -(-len(surface.points) // PROBED)
    order = np.lexsort(surface.points.T)  # parts that do not hang on the order of the rows
    thinned = [_thinned(surface, order[start::step], step) for start in range(min(step, PARTS))]
    grid, _ = _grid_of(thinned[0])
    trusted = thinned[0].trusted or closed
    if grid is None:
        return Solid(surface, trusted, handles, None, closed)
    found = _loops(grid)
    if handles is None:
        counts = {_handles(found)[0], *(solid_handles(part)[0] for part in thinned[1:])}
        handles = counts.pop() if len(counts) == 1 else None
    off = [abs(loops - (handles or 0)) for loops in found]
    level = LEVELS[min(range(len(LEVELS)), key=lambda i: (off[i], abs(i - 1)))]
    return Solid(surface, trusted, handles, grid, closed, level)


def _thinned(surface: OrientedCloud, rows: npt.NDArray[np.intp], step: int) -> OrientedCloud:
    points, normals = np.ascontiguousarray(surface.points[rows]), np.ascontiguousarray(surface.normals[rows])
    return checked(OrientedCloud(points, normals, step * surface.areas[rows]), seed=0)


def solid_handles(surface: OrientedCloud) -> tuple[int | None, str]:
    """Return the handles of the solid inside a surface, or None and why they cannot be told.

    Parameters
    ----------
    surface : OrientedCloud
        With its ``consistency`` checked.

    Returns
    -------
    handles : int or None
        None where they cannot be told.
    reason : str
        Why not; empty where they can.
    """
    grid, reason = _grid_of(surface)
    return (None, reason) if grid is None else _handles(_loops(grid))


def _loops(grid: WindingGrid) -> list[int]:
    """Return the loops at every level of the inside."""
    return [betti_numbers(grid.values > level)[1] for level in LEVELS]


def _handles(found: list[int]) -> tuple[int | None, str]:
    """Return the handles that all levels agree on, or None and why there are none."""
    if len(set(found)) > 1:
        return None, f"{' or '.join(map(str, sorted(set(found))))} handles, depending on the level of the inside"
    return found[0], ""


def _grid_of(surface: OrientedCloud) -> tuple[WindingGrid | None, str]:
    """Return winding numbers on a grid, or None and why there is none."""
    if not surface.trusted:
        share = f"{surface.consistency:.0%}"
        return None, f"the normals agree on an inside at {share} of the points only; the cloud is too sparse or open"
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    step = _grid_step(high - low, surface.spacing)
    if step > COARSEST * surface.spacing:
        return None, f"a grid of {MAX_CELLS} cells is too coarse for the spacing of the points; thin the cloud"
    return WindingGrid(_winding_grid(surface, low, high, step), low - RIM * step, step), ""


def _grid_step(extent: Numbers, spacing: float) -> float:
    """Return the side of the cells: the spacing's multiple, or what keeps the grid within its limit."""
    step = STEP * spacing
    cells = float(np.prod(extent / step + 4))
    return step * float(np.cbrt(max(1.0, cells / MAX_CELLS)))


def _winding_grid(surface: OrientedCloud, low: Numbers, high: Numbers, step: float) -> Stack:
    """Return winding numbers on a grid: at every eighth place, and at all places where it matters.

    These are the ones near the surface, and those between an inside and an
    outside, as in the holes of a scan; elsewhere it is that of the place before.
    """
    axes = [np.arange(a - RIM * step, b + (RIM + 1) * step, step) for a, b in zip(low, high, strict=True)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    coarse = places[::2, ::2, ::2]
    known = surface.winding_numbers(coarse.reshape(-1, 3)).reshape(coarse.shape[:3])
    grid = np.kron(known, np.ones((2, 2, 2)))[tuple(slice(len(axis)) for axis in axes)]
    near = np.zeros(grid.shape, bool)
    near[tuple(np.round((surface.points - places[0, 0, 0]) / step).astype(int).T)] = True
    needed = ndimage.binary_dilation(near, np.ones((3, 3, 3)), iterations=2)
    needed |= ndimage.binary_dilation((grid > UNDECIDED[0]) & (grid < UNDECIDED[1]), np.ones((3, 3, 3)))
    grid[needed] = surface.winding_numbers(places[needed])
    return np.asarray(grid)


def betti_numbers(cubes: Grid) -> tuple[int, int, int]:
    """Return the Betti numbers of a union of closed unit cubes.

    Parameters
    ----------
    cubes : (i, j, k) bool
        Which cubes of a grid belong to it.

    Returns
    -------
    components : int
        Pieces; cubes that share a corner hang together.
    loops : int
        Handles, all pieces together.
    cavities : int
        Hollows that no way leads out of.
    """
    padded = np.pad(cubes, 1)
    edges = sum(int(_touched(padded, axes).sum()) for axes in ((0, 1), (0, 2), (1, 2)))
    faces = sum(int(_touched(padded, (axis,)).sum()) for axis in range(3))
    euler = int(_touched(padded, (0, 1, 2)).sum()) - edges + faces - int(padded.sum())
    components = int(ndimage.label(padded, np.ones((3, 3, 3)))[1])
    cavities = int(ndimage.label(~padded)[1]) - 1
    return components, components + cavities - euler, cavities


def _touched(cubes: Grid, axes: tuple[int, ...]) -> Grid:
    """Return which faces, edges or vertices between cubes, across the given axes, belong to a cube."""
    for axis in axes:
        cubes = np.take(cubes, range(1, cubes.shape[axis]), axis) | np.take(cubes, range(cubes.shape[axis] - 1), axis)
    return cubes
