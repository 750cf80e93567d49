"""Patches: pieces of surface over the unit square, sampled evenly by area."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points, Table
from tiskel.geometry.round_cones import even_pairs

Patch = Callable[[Numbers, Numbers], Points]  #: u (n,) and v (n,) from 0 to 1 to places (n, 3)

# Cells of the table of areas along u and v: points lie on the patch exactly, and as densely as the cell has area.
CELLS = 256, 128


def cell_areas(patch: Patch) -> Table:
    """Return the areas of the cells of a patch, half the product of their diagonals, in squares of its unit."""
    u, v = (np.linspace(0, 1, cells + 1) for cells in CELLS)
    grid = patch(np.repeat(u, len(v)), np.tile(v, len(u))).reshape(len(u), len(v), 3)
    rising, falling = grid[1:, 1:] - grid[:-1, :-1], grid[1:, :-1] - grid[:-1, 1:]
    return np.asarray(np.linalg.norm(np.cross(rising, falling), axis=2) / 2)


def sample_patch(patch: Patch, areas: Table, count: int, generator: np.random.Generator) -> Points:
    """Return points of a patch, even by area.

    Parameters
    ----------
    patch : Patch
    areas : (CELLS[0], CELLS[1]) float64
        Of its cells, as :func:`cell_areas` returns them.
    count : int
        How many points.
    generator : numpy.random.Generator
        Drawn from; the same state gives the same points.

    Returns
    -------
    (count, 3) float64

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.gallery.patches import cell_areas, disc, sample_patch
    >>> face = disc((0, 0, 0), (1, 0, 0), (0, 1, 0))
    >>> points = sample_patch(face, cell_areas(face), 10_000, np.random.default_rng(0))
    >>> round(float((np.linalg.norm(points, axis=1) < 0.5).mean()), 2)
    0.25
    """
    first, second = even_pairs(count, generator)
    rows = areas.sum(axis=1)
    row, along = _inverted(np.concatenate([[0], np.cumsum(rows / rows.sum())]), first)
    steps = np.where(rows[:, None] > 0, areas, 1.0)
    heights = np.cumsum(steps / steps.sum(axis=1)[:, None], axis=1)
    heights[:, -1] = 1
    ladder = np.concatenate([[0], (heights + np.arange(len(rows))[:, None]).ravel()])
    cell, across = _inverted(ladder, row + second)
    return patch((row + along) / CELLS[0], (cell - row * CELLS[1] + across) / CELLS[1])


def _inverted(heights: Numbers, wanted: Numbers) -> tuple[npt.NDArray[np.intp], Numbers]:
    """Return in which step of a rising line the wanted heights are, and how far through it, from 0 to 1."""
    step = np.clip(np.searchsorted(heights, wanted, side="right") - 1, 0, len(heights) - 2)
    low, high = heights[step], heights[step + 1]
    return step, np.asarray(np.clip((wanted - low) / np.maximum(high - low, np.finfo(float).tiny), 0, 1))


def rectangle(corner: npt.ArrayLike, first: npt.ArrayLike, second: npt.ArrayLike) -> Patch:
    """Return the patch of a parallelogram from a corner (3,) and its two sides (3,)."""
    at, u_side, v_side = (np.asarray(value, dtype=float) for value in (corner, first, second))
    return lambda u, v: np.asarray(at + u[:, None] * u_side + v[:, None] * v_side)


def disc(centre: npt.ArrayLike, first: npt.ArrayLike, second: npt.ArrayLike) -> Patch:
    """Return the patch of an ellipse from its centre (3,) and its two half axes (3,)."""
    at, u_axis, v_axis = (np.asarray(value, dtype=float) for value in (centre, first, second))

    def place(u: Numbers, v: Numbers) -> Points:
        x, y = u * np.cos(2 * np.pi * v), u * np.sin(2 * np.pi * v)
        return np.asarray(at + x[:, None] * u_axis + y[:, None] * v_axis)

    return place


def wall(centre: npt.ArrayLike, radius: float, axis: npt.ArrayLike) -> Patch:
    """Return the patch of a circular cylinder about z from its foot (3,), its radius, and its axis (3,) along z."""
    at, along = np.asarray(centre, dtype=float), np.asarray(axis, dtype=float)

    def place(u: Numbers, v: Numbers) -> Points:
        turn = 2 * np.pi * v
        round_about = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
        return np.asarray(at + u[:, None] * along + radius * round_about)

    return place
