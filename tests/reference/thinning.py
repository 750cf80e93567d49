"""Homotopic thinning of a solid on a grid, by counting pieces."""

import heapq
import itertools

import numpy as np
from scipy import ndimage

from tiskel.arrays import Stack
from tiskel.geometry.thinning import Grid

BY_CORNERS, BY_EDGES, BY_FACES = (ndimage.generate_binary_structure(3, rank) for rank in (3, 2, 1))


def is_simple(cubes: Grid) -> bool:
    """Tell whether the middle one of 27 cubes is simple, by the definition of Bertrand and Malandain."""
    others = cubes.copy()
    others[1, 1, 1] = False
    empty = BY_EDGES & ~cubes
    pieces = ndimage.label(empty, BY_FACES)[0]
    at_faces = set(pieces[BY_FACES & empty].tolist()) - {0}
    return ndimage.label(others, BY_CORNERS)[1] == 1 and len(at_faces) == 1


def thinned(inside: Grid, order: Stack, kept: Grid) -> Grid:
    """Return what is left when cubes go one by one, always the first in order that may; ties by place."""
    left = np.pad(inside, 1)
    cells = [tuple(cell) for cell in (np.argwhere(inside)[np.argsort(order[inside], kind="stable")] + 1).tolist()]
    rank = {cell: i for i, cell in enumerate(cells)}
    waiting = list(range(len(cells)))
    while waiting:
        i, j, k = cells[heapq.heappop(waiting)]
        around = left[i - 1 : i + 2, j - 1 : j + 2, k - 1 : k + 2]
        if left[i, j, k] and not kept[i - 1, j - 1, k - 1] and is_simple(around):
            left[i, j, k] = False
            for step in itertools.product((-1, 0, 1), repeat=3):
                beside = i + step[0], j + step[1], k + step[2]
                if left[beside]:  # those that wait already are only looked at twice
                    heapq.heappush(waiting, rank[beside])
    return np.asarray(left[1:-1, 1:-1, 1:-1])
