"""What three kernels do, in NumPy and by SciPy's tree, bit for bit: for small clouds, while Taichi does not run.

Import and start of Taichi take longer than all else that ``tiskel contract`` does with a few thousand points. So what
a contraction by fronts asks of kernels is there twice. Which of the two works is no matter of the result:
tests/geometry/test_numpy_kernels.py holds them to the same bits.
"""

import numpy as np

from tiskel.arrays import Indices, Lists, Numbers, Points, Stack, Table
from tiskel.kernels.running import running
from tiskel.kernels.threads import requested_threads

MOST = 20_000  # points, for which all three take 0.2 s together; Taichi takes 0.6 s to start [measured, two cores]
SWEEPS = 8  # of cyclic Jacobi, as many as the kernel's
SPARE = 8  # neighbours that are looked at beyond those asked for, to see ties
ROUNDING = 1e-12  # of a square: what two ways to sum it may differ by
SCRATCH = 4_000_000  # numbers: where ties need more than so many, the kernel is better


def instead(count: int) -> bool:
    """Return whether so many points are to be done here: they are few, and no kernel has run yet.

    Raises TiskelError where a kernel would not start: TISKEL_NUM_THREADS is wrong.
    """
    return count <= MOST and not running() and requested_threads() > 0  # asked last: it reads files


def nearest(points: Points, k: int) -> tuple[Lists, Table] | None:
    """Return rows (n, k) and squared distances of the k nearest of each point (n, 3), by distance, then row.

    None where so many are equally near that they do not fit into memory, and where squares overflow.
    """
    from scipy.spatial import cKDTree

    tree, count = cKDTree(points), len(points)
    rows, squares = np.empty((count, k), np.int32), np.empty((count, k))
    left, width = np.arange(count), min(k + SPARE, count)
    while len(left):
        if len(left) * width > SCRATCH:
            return None
        found = tree.query(points[left], k=[*range(1, width + 1)])[1]
        if found.max() == count:  # the tree's word for no point: all others are infinitely far
            return None
        x, y, z = np.moveaxis(points[found] - points[left, None], 2, 0)
        away = x * x + y * y + z * z
        order = np.lexsort((found, away), axis=1)
        away = np.take_along_axis(away, order, axis=1)
        known = (away[:, k - 1] < (1 - ROUNDING) * away[:, -1]) | (width == count)  # no other is as near as the k-th
        rows[left[known]] = np.take_along_axis(found, order, axis=1)[known, :k]
        squares[left[known]] = away[known, :k]
        left, width = left[~known], min(2 * width, count)
    return rows, squares


def principal_axes(points: Points, neighbours: Lists) -> tuple[Table, Stack]:
    """Return eigenvalues (m, 3), descending, and eigenvectors (m, 3, 3) as rows, of points (n, 3) by rows (m, k)."""
    k = neighbours.shape[1]
    members = [np.ascontiguousarray(points[rows].T) for rows in neighbours.T]
    mean = sum(members, np.zeros((3, len(neighbours)))) / k
    covariance = np.zeros((3, 3, len(neighbours)))
    for member in members:
        away = member - mean
        covariance += away[:, None] * away[None, :]
    with np.errstate(all="ignore"):
        values, vectors = _eigenvectors(covariance / k)
    return np.ascontiguousarray(values.T), np.ascontiguousarray(vectors.transpose(2, 0, 1))


def smallest_distances(points: Points, members: Lists, sizes: Indices) -> Numbers:
    """Return (n,) the distance from each point to the nearest of its ring, members (n, w) of which sizes (n,) count."""
    smallest = np.full(len(points), np.inf)
    for column, rows in enumerate(members.T):
        there = column < sizes
        x, y, z = (points[np.where(there, rows, 0)] - points).T
        away = np.sqrt(x * x + y * y + z * z)
        smallest = np.where(there, np.minimum(smallest, away), smallest)
    return np.where(sizes == 0, 0.0, smallest)


def _eigenvectors(matrix: Stack) -> tuple[Table, Stack]:
    """Return eigenvalues (3, m) and eigenvectors (3, 3, m) of symmetric matrices (3, 3, m), by cyclic Jacobi."""
    x, y, z = matrix
    u, v, w = np.repeat(np.eye(3)[:, :, None], matrix.shape[2], axis=2)
    for _ in range(SWEEPS):
        x, y, z, u, v = _rotated(x, y, z, u, v, 0, 1)
        x, z, y, u, w = _rotated(x, z, y, u, w, 0, 2)
        y, z, x, v, w = _rotated(y, z, x, v, w, 1, 2)
    values, vectors = np.stack([x[0], y[1], z[2]]), np.stack([u, v, w])
    for i, j in ((0, 1), (0, 2), (1, 2)):
        wrong = values[i] < values[j]
        values[i], values[j] = np.where(wrong, values[j], values[i]), np.where(wrong, values[i], values[j])
        vectors[i], vectors[j] = np.where(wrong, vectors[j], vectors[i]), np.where(wrong, vectors[i], vectors[j])
    return values, vectors


def _rotated(
    a_p: Table, a_q: Table, a_r: Table, v_p: Table, v_q: Table, p: int, q: int
) -> tuple[Table, Table, Table, Table, Table]:
    """Apply the Jacobi rotations that zero a[p, q]: rows p, q and the third of matrices, each (3, m)."""
    theta = (a_q[q] - a_p[p]) / (2.0 * a_p[q])
    t = 1.0 / (np.abs(theta) + np.sqrt(theta * theta + 1.0))
    t = np.where(theta < 0.0, -t, t)
    c = 1.0 / np.sqrt(t * t + 1.0)
    turned = np.abs(a_p[q]) > 1e-300
    c, s = np.where(turned, c, 1.0), np.where(turned, t * c, 0.0)
    b_p, b_q, b_r = c * a_p - s * a_q, s * a_p + c * a_q, a_r.copy()
    for b in (b_p, b_q, b_r):
        b[p], b[q] = c * b[p] - s * b[q], s * b[p] + c * b[q]
    return b_p, b_q, b_r, c * v_p - s * v_q, s * v_p + c * v_q
