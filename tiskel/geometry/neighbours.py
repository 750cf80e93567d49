"""Neighbours, principal axes and one-rings of a cloud: the kernels, with their arrays laid out."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Lists, Numbers, Points, Stack, Table
from tiskel.geometry import numpy_kernels
from tiskel.geometry.rings import Rings

ALONE = 8192  # points that one thread halves by itself, in a millisecond: as long as a few calls of a kernel
Axes = Stack  #: shape (n, 3, 3), rows by descending eigenvalue


def nearest_neighbours(points: Points, k: int) -> tuple[Lists, Table]:
    """Return the k nearest of each point, itself included.

    Parameters
    ----------
    points : (n, 3) float64
        C-contiguous, in any unit.
    k : int
        From 1 to n.

    Returns
    -------
    neighbours : (n, k) int32
        Rows of points by distance, ties by index.
    squares : (n, k) float64
        Squared distances to them, in the squared unit.
    """
    if numpy_kernels.instead(len(points)) and (found := numpy_kernels.nearest(points, k)) is not None:
        return found
    from tiskel.kernels import neighbours as kernel

    tree = _tree(points)
    nearest = np.empty((len(points), k), np.int32)
    squares = np.empty((len(points), k))
    for first in range(0, k, kernel.LISTED):
        kernel.nearest(*tree, first, min(first + kernel.LISTED, k), nearest, squares)
    return nearest, squares


def _tree(points: Points) -> tuple[Points, Indices, int, Points, Points]:
    """Return the points (n, 3) in the order of a k-d tree, their rows, its depth, and the corners of its boxes."""
    from tiskel.kernels import neighbours as kernel

    count = len(points)
    depth = ((count - 1) // kernel.BUCKET).bit_length()
    ordered, rows = np.array(points, order="C"), np.arange(count, dtype=np.int32)
    low, high = np.empty((2, 2 << depth, 3))
    level = 0
    while level < depth and count >> level > ALONE:
        kernel.halve(level, level, depth, ordered, rows, low, high)
        level += 1
    kernel.halve(level, depth, depth, ordered, rows, low, high)
    return ordered, rows, depth, low, high


@dataclass(frozen=True, eq=False)
class MortonCurve:
    """A cloud along the Morton curve, where neighbours in the order are mostly neighbours in space.

    Attributes
    ----------
    points : (n, 3) float64
        The points in this order, in any unit.
    order : (n,) int32
        Their rows in the cloud.
    codes : (n,) int64
        Their Morton codes, ascending.
    low : (3,) float64
        The corner of the finest grid, in the unit of the points.
    per_length : float
        How many of its cells go on a unit of length.
    """

    points: Points
    order: Indices
    codes: npt.NDArray[np.int64]
    low: Numbers
    per_length: float

    def places(self, queries: Points) -> Indices:
        """Return where in the order places would stand.

        Parameters
        ----------
        queries : (m, 3) float64
            Places in the unit of the points; those outside their bounding box count at its border.

        Returns
        -------
        (m,) int32
            From 0 to n.
        """
        from tiskel.kernels import morton as kernel

        codes = np.empty(len(queries), np.int64)
        inside = np.clip(queries, self.points.min(axis=0), self.points.max(axis=0))
        kernel.morton_codes(np.ascontiguousarray(inside), self.low, self.per_length, codes)
        return np.searchsorted(self.codes, codes).astype(np.int32)


def morton_curve(points: Points) -> MortonCurve:
    """Return the points (n, 3) along the Morton curve."""
    from tiskel.kernels import morton as kernel

    low = points.min(axis=0)
    per_length = (2**kernel.LEVELS - 1) / (float(np.ptp(points, axis=0).max()) or 1.0)
    codes = np.empty(len(points), np.int64)
    kernel.morton_codes(points, low, per_length, codes)
    order = np.argsort(codes, kind="stable").astype(np.int32)
    return MortonCurve(np.ascontiguousarray(points[order]), order, codes[order], low, per_length)


def principal_axes(points: Points, neighbours: Lists) -> tuple[Table, Axes]:
    """Return the principal axes of neighbourhoods: eigenvalues and eigenvectors of their covariances.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    neighbours : (m, k) int32
        The rows that make up each neighbourhood.

    Returns
    -------
    values : (m, 3) float64
        Eigenvalues, descending, in the squared unit of the points.
    axes : (m, 3, 3) float64
        Unit eigenvectors as rows, in the same order; their signs mean nothing.
    """
    if numpy_kernels.instead(max(len(points), len(neighbours))):
        return numpy_kernels.principal_axes(points, neighbours)
    from tiskel.kernels import axes as kernel

    values = np.empty((len(neighbours), 3))
    axes = np.empty((len(neighbours), 3, 3))
    kernel.principal_axes(points, neighbours, values, axes)
    return values, axes


def one_rings(points: Points, centres: Indices, candidates: Lists, planes: Stack) -> Rings:
    """Return the Delaunay one-ring of each centre among its candidates, projected on a plane.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    centres : (m,) int32
        Rows of points.
    candidates : (m, w) int32
        Rows of points, -1 pads; the centre and points projected onto it are ignored.
    planes : (m, 2, 3) float64
        Two orthonormal directions each.

    Returns
    -------
    Rings
        One for each centre; members are rows of points.

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


def surroundings(points: Points, k: int) -> tuple[Lists, Axes, Rings]:
    """Return the k nearest neighbours of every point, their principal axes, and the one-rings on the leading two.

    Parameters
    ----------
    points : (n, 3) float64
        C-contiguous, in any unit.
    k : int
        From 1 to n; every point is the first of its neighbours.

    Returns
    -------
    neighbours : (n, k) int32
        Rows by distance.
    axes : (n, 3, 3) float64
        Unit vectors as rows by descending eigenvalue; the last is the normal, up to its sign.
    rings : Rings
        Of all points.
    """
    neighbours, _ = nearest_neighbours(points, k)
    _, axes = principal_axes(points, neighbours)
    everyone = np.arange(len(points), dtype=np.int32)
    return neighbours, axes, one_rings(points, everyone, neighbours, np.ascontiguousarray(axes[:, :2]))


def cloud_rings(points: Points, k: int) -> Rings:
    """Return the one-ring of every point among its k nearest, on the plane of their two leading axes."""
    return surroundings(points, k)[2]
