"""Closing the open ends of a tube with flat discs of points."""

import numpy as np

from tiskel.arrays import Indices, Lists, Numbers, Points
from tiskel.extras import extra
from tiskel.geometry.graph import connected_sets
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.geometry.spacing import spacings_from

NEIGHBOURS = 16
SMALLEST_RIM = 12  # points; smaller groups of boundary points are noise
OPEN_ANGLE = 0.7 * np.pi  # between the half turn of a straight edge and what chance opens inside a surface
WIDEST_GAP = np.pi / 2  # a rim goes round its centre without a larger gap


def cap_points(points: Points) -> Points:
    """Return points on the discs that close the open ends of a cloud.

    Boundary points see their neighbours on one side only. Groups of them that go
    round their centre are rims; the polygon of a rim, flattened on its best plane,
    is filled with a square grid.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.

    Returns
    -------
    (m, 3) float64
        The points to add, at the cloud's own spacing; none where no end is open.

    References
    ----------
    G. Bendels, R. Schnabel, R. Klein: Detecting holes in point set surfaces. WSCG 2006 (the angle criterion).
    """
    k = min(NEIGHBOURS, len(points))
    neighbours, squares = nearest_neighbours(points, k)
    spacing = float(np.median(spacings_from(squares)))
    boundary = np.flatnonzero(widest_gaps(points, neighbours) > OPEN_ANGLE).astype(np.int32)
    discs = [_disc(points[rim], spacing) for rim in _groups(boundary, neighbours) if len(rim) >= SMALLEST_RIM]
    return np.concatenate([np.empty((0, 3)), *discs])


def widest_gaps(points: Points, neighbours: Lists) -> Numbers:
    """Return the widest angle between successive neighbours of each point, on the plane of its neighbourhood.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud.
    neighbours : (n, k) int32
        The rows of each point's neighbours, the point itself among them.

    Returns
    -------
    (n,) float64
        In radians.
    """
    _, axes = principal_axes(points, neighbours)
    offsets = points[neighbours] - points[:, None]
    flat = np.einsum("nkc,nac->nka", offsets, axes[:, :2])
    angles = np.arctan2(flat[..., 1], flat[..., 0])
    angles[(offsets == 0).all(axis=2)] = np.nan  # the point itself; NaN sorts to the end
    angles = np.sort(angles, axis=1)
    last = np.nanmax(angles, axis=1)
    return np.asarray(np.fmax(np.nanmax(np.diff(angles, axis=1), axis=1), angles[:, 0] + 2 * np.pi - last))


def _groups(boundary: Indices, neighbours: Lists) -> list[Indices]:
    """Return the connected groups of boundary points in the neighbour graph."""
    place = np.full(len(neighbours), -1)
    place[boundary] = np.arange(len(boundary))
    linked = place[neighbours[boundary]]
    rows = np.repeat(np.arange(len(boundary)), (linked >= 0).sum(axis=1))
    links = np.stack([rows, linked[linked >= 0]], axis=1)
    return [boundary[group] for group in connected_sets(len(boundary), links)]


def _disc(rim: Points, spacing: float) -> Points:
    """Fill the polygon of a rim; nothing where the group does not go round its centre."""
    polygon = extra("matplotlib.path", "--cap").Path
    centre = rim.mean(axis=0)
    plane = np.linalg.svd(rim - centre, full_matrices=False)[2][:2]
    flat = (rim - centre) @ plane.T
    angles = np.arctan2(flat[:, 1], flat[:, 0])
    order = np.argsort(angles, kind="stable")
    gaps = np.diff(np.append(angles[order], angles[order[0]] + 2 * np.pi))
    if gaps.max() > WIDEST_GAP:
        return np.empty((0, 3))
    low, high = flat.min(axis=0), flat.max(axis=0)
    grid = np.stack(np.meshgrid(*(np.arange(a, b, spacing) for a, b in zip(low, high, strict=True))), axis=-1).reshape(
        -1, 2
    )
    inside = polygon(flat[order]).contains_points(grid, radius=-spacing / 2)
    return np.asarray(centre + grid[inside] @ plane)
