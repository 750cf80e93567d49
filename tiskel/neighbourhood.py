"""Neighbours, principal axes and one-rings of a cloud: the kernels, with their arrays laid out."""

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.rings import Rings

Axes = Numbers  #: shape (n, 3, 3), rows by descending eigenvalue


def nearest_neighbours(points: Points, k: int) -> tuple[Indices, Numbers]:
    """Return the k nearest of each point, itself included.

    Parameters
    ----------
    points : (n, 3), in any unit, k <= n.

    Returns
    -------
    neighbours : (n, k) int32, by distance, ties by index.
    squares : (n, k), squared distances.
    """
    from tiskel.kernels import neighbours as kernel

    low = points.min(axis=0)
    finest = (float(np.ptp(points, axis=0).max()) or 1.0) / (2**kernel.LEVELS - 1)
    codes = np.empty(len(points), np.int64)
    kernel.morton_codes(points, low, 1 / finest, codes)
    order = np.argsort(codes, kind="stable").astype(np.int32)
    nearest = np.empty((len(points), k), np.int32)
    squares = np.empty((len(points), k))
    kernel.nearest(np.ascontiguousarray(points[order]), order, codes[order], low, 1 / finest, k, nearest, squares)
    return nearest, squares


def principal_axes(points: Points, neighbours: Indices) -> tuple[Numbers, Axes]:
    """Return eigenvalues (n, 3), descending, and eigenvectors (n, 3, 3), as rows, of neighbourhood covariances."""
    from tiskel.kernels import axes as kernel

    values = np.empty((len(neighbours), 3))
    axes = np.empty((len(neighbours), 3, 3))
    kernel.principal_axes(points, neighbours, values, axes)
    return values, axes


def one_rings(points: Points, centres: Indices, candidates: Indices, planes: Numbers) -> Rings:
    """Return the Delaunay one-ring of each centre among its candidates, projected on a plane.

    Parameters
    ----------
    points : (n, 3).
    centres : (m,) rows of points.
    candidates : (m, w) rows of points, -1 pads; the centre and points projected onto it are ignored.
    planes : (m, 2, 3), two orthonormal directions each.

    Notes
    -----
    Counter-clockwise seen in the plane; a closed ring starts at its nearest
    member, an open one at its end. Of points in exactly one direction the
    nearest counts; of points exactly on one empty circle only those that every
    triangulation has.
    """
    from tiskel.kernels import rings as kernel

    shape = candidates.shape
    members, sizes, closed = (
        np.empty(shape, np.int32),
        np.empty(len(centres), np.int32),
        np.empty(len(centres), np.int32),
    )
    flat, order = np.empty((*shape, 2)), np.empty(shape, np.int32)
    kernel.one_rings(points, centres, candidates, planes, flat, order, members, sizes, closed)
    width = max(1, int(sizes.max(initial=1)))
    return Rings(np.ascontiguousarray(members[:, :width]), sizes, closed)


def surroundings(points: Points, k: int) -> tuple[Indices, Axes, Rings]:
    """Return the k nearest neighbours of every point, their principal axes, and the one-rings on the leading two."""
    neighbours, _ = nearest_neighbours(points, k)
    _, axes = principal_axes(points, neighbours)
    everyone = np.arange(len(points), dtype=np.int32)
    return neighbours, axes, one_rings(points, everyone, neighbours, np.ascontiguousarray(axes[:, :2]))


def cloud_rings(points: Points, k: int) -> Rings:
    """Return the one-ring of every point among its k nearest, on the plane of their two leading axes."""
    return surroundings(points, k)[2]
