"""Thinning of a solid on a grid to curves, without a change of topology."""

from functools import cache

import numpy as np

from tiskel.arrays import Indices, Stack

Grid = np.ndarray[tuple[int, int, int], np.dtype[np.bool_]]

SIDES = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)  # (27, 3) steps to neighbours


def thinned(inside: Grid, order: Stack, kept: Grid) -> Grid:
    """Return what is left of a solid when every cube has gone whose absence leaves its topology.

    Distance-ordered homotopic thinning (Pudney 1998): cubes go in ascending
    order, each as soon as it can. What is left are curves that join the kept
    cubes and close about the handles, and surfaces about hollows.

    Parameters
    ----------
    inside : (i, j, k) bool
        The solid; cubes that share a corner hang together.
    order : (i, j, k) float64
        Cubes with less go first.
    kept : (i, j, k) bool
        Cubes that stay whatever happens.

    Returns
    -------
    (i, j, k) bool

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.thinning import thinned
    >>> bar, ends = np.ones((9, 3, 3), bool), np.zeros((9, 3, 3), bool)
    >>> ends[[0, -1], 1, 1] = True
    >>> middle = np.zeros((9, 3, 3))
    >>> middle[:, 1, 1] = 1
    >>> left = thinned(bar, middle, ends)
    >>> int(left[:, 1, 1].sum()), int(left.sum())
    (9, 9)
    """
    from tiskel.kernels.thinning import thin

    padded = np.pad(inside, 1)
    state = padded.astype(np.int32) + np.pad(kept & inside, 1)
    cells = np.flatnonzero(padded)
    if len(cells) == 0:
        return np.zeros(inside.shape, bool)
    cubes = cells[np.argsort(order[inside], kind="stable")].astype(np.int32)
    rank = np.full(state.size, -1, np.int32)
    rank[cubes] = np.arange(len(cubes), dtype=np.int32)
    flat = np.ascontiguousarray(state.ravel())
    strides = np.array([padded.shape[1] * padded.shape[2], padded.shape[2], 1])
    heap, waiting = np.zeros(len(cubes), np.int32), np.zeros(len(cubes), np.int32)
    thin(cubes, rank, (SIDES @ strides).astype(np.int32), *_adjacency(), flat, heap, waiting)
    return np.asarray(flat.reshape(padded.shape)[1:-1, 1:-1, 1:-1] > 0)


@cache
def _adjacency() -> tuple[Indices, Indices, Indices]:
    """Return bits of the neighbours that touch each neighbour, that share a face, and those within edges and faces."""
    far = np.abs(SIDES[:, None] - SIDES[None])
    away = np.abs(SIDES).sum(axis=1)
    bit = 1 << np.arange(27)
    middle = away == 0
    others = ~(middle[:, None] | middle[None])
    touching = ((far.max(axis=2) == 1) & others) @ bit
    beside = ((far.sum(axis=2) == 1) & others) @ bit
    masks = np.array([bit[(away == 1) | (away == 2)].sum(), bit[away == 1].sum()])
    return touching.astype(np.int32), beside.astype(np.int32), masks.astype(np.int32)
