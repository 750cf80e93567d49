"""Cells of a grid, numbered by what is in them."""

import numpy as np

from tiskel.arrays import Indices, Pairs, Points


def cell_numbers(points: Points, side: float) -> Indices:
    """Return the number of the cell that each point is in, from 0 without gaps, ascending with x, then y, then z.

    Parameters
    ----------
    points : (n, 3) float64
        In any unit; the grid begins at the corner of their bounding box.
    side : float
        Of a cell, in the same unit.

    Returns
    -------
    (n,) int32

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.cells import cell_numbers
    >>> cell_numbers(np.array([[5.0, 0, 0], [0, 0, 0], [5.5, 0.5, 0]]), 1.0).tolist()
    [1, 0, 1]
    """
    return numbered(np.floor((points - points.min(axis=0)) / side).astype(np.int64))[1]


def numbered(corners: Pairs) -> tuple[Pairs, Indices]:
    """Return the distinct cells (m, 3) of corners (n, 3), from 0, ascending, and which of them (n,) each is."""
    sizes = [int(size) + 1 for size in corners.max(axis=0)]
    if sizes[0] * sizes[1] * sizes[2] >= 2**62:  # almost all of the grid is empty: number what is there of each axis
        ranks = [np.unique(column, return_inverse=True) for column in corners.T]
        cells, number = numbered(np.stack([rank.ravel() for _, rank in ranks], axis=1))
        return np.stack([values[cells[:, i]] for i, (values, _) in enumerate(ranks)], axis=1), number
    x, y, z = corners.T
    keys, into = np.unique((x * sizes[1] + y) * sizes[2] + z, return_inverse=True)
    rows, z = np.divmod(keys, sizes[2])
    x, y = np.divmod(rows, sizes[1])
    return np.stack([x, y, z], axis=1), into.ravel().astype(np.int32)
