"""Centredness: is a skeleton in the middle of its cloud?"""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Indices, Mask, Numbers, Points, Table, diagonal
from tiskel.geometry.curve import CurveSamples
from tiskel.geometry.ellipse import fit_ellipse
from tiskel.geometry.frames import across
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.params import MetricParams

FEWEST = 3  # points that make a section
BLOCK = 16384  # points at a time, so that the neighbours of each fit into memory


def neighbourhood_size(count: int) -> int:
    """Return N, the number of skeletal points that are averaged, for so many in all.

    N is 1 % of them, rounded; 10 where that is below 10, 30 where it is above
    50 [T]; never more than there are.
    """
    size = int(np.floor(0.01 * count + 0.5))
    return min(count, 10 if size < 10 else 30 if size > 50 else size)


def point_centredness(points: Points, originals: Points) -> Numbers:
    """Return the centredness c of skeletal points, before boundedness is asked for.

    Among the N nearest skeletal points, itself included,
    c = 1 - |mean originals - mean skeletal| / mean |original - mean skeletal|,
    at least 0 (Wen et al. 2025, Eq 4.14): the distances are to the mean of these
    skeletal points, not each original's to its own. 1 where all originals are there.

    Parameters
    ----------
    points : (m, 3) float64
        Skeletal points, in any unit.
    originals : (m, 3) float64
        The points of the cloud that they stand for, in the same unit.

    Returns
    -------
    (m,) float64
        c from 0 to 1.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.metrics.centredness import point_centredness
    >>> ring = np.stack([np.cos(np.arange(8) * np.pi / 4), np.sin(np.arange(8) * np.pi / 4), np.zeros(8)], axis=1)
    >>> point_centredness(np.zeros((8, 3)), ring).round(6).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    near = nearest_neighbours(points, neighbourhood_size(len(points)))[0]
    apart, away = np.empty(len(points)), np.empty(len(points))
    for rows in np.array_split(np.arange(len(points)), -(-len(points) // BLOCK) or 1):
        offsets = originals[near[rows]] - points[near[rows]].mean(axis=1, keepdims=True)
        apart[rows] = np.linalg.norm(offsets.mean(axis=1), axis=1)
        away[rows] = np.linalg.norm(offsets, axis=2).mean(axis=1)
    ratio = np.divide(apart, away, out=np.zeros(len(points)), where=away > 0)
    return np.asarray(np.maximum(0, 1 - ratio))


@dataclass(frozen=True, eq=False)
class Sections:
    """What the sections across a curve say, one row per sample of the curve.

    Attributes
    ----------
    centredness : (q,) float64
        c from 0 to 1, NaN where the section is invalid.
    stand_in : (q,) bool
        Sections through which no ellipse fits, so that mean and largest distance stand in.
    directionless : (q,) bool
        Invalid, because the curve has no direction at the sample.
    sparse : (q,) bool
        Invalid, because fewer than three points lie in the section.
    """

    centredness: Numbers
    stand_in: Mask
    directionless: Mask
    sparse: Mask


def curve_centredness(samples: CurveSamples, cloud: Points, params: MetricParams) -> Sections:
    """Return c = 1 - |sample - centre| / mean semi-axis, at least 0, of the section at each sample of a curve.

    The section holds the points within a slab across the curve, projected along
    it, and, in order of distance from the sample, only those before the first
    gap: a point more than 1.5 times as far away as the one before [T].

    Parameters
    ----------
    samples : CurveSamples
        Places (q, 3) on the curve and its directions there, in the unit of the cloud.
    cloud : (n, 3) float64
        The cloud, in any unit.
    params : MetricParams
        ``slab``, half the thickness as a share of the diagonal, and ``gap`` count.

    Returns
    -------
    Sections
        One row per sample.
    """
    value = np.full(len(samples.points), np.nan)
    stand_in, sparse = np.zeros(len(value), bool), np.zeros(len(value), bool)
    directed = np.flatnonzero(samples.directed)
    members = slab_members(cloud, samples.points[directed], samples.directions[directed], params.slab * diagonal(cloud))
    for i, rows in zip(directed, members, strict=True):
        flat = in_plane(cloud[rows] - samples.points[i], samples.directions[i])
        section = before_gap(flat, params.gap)
        sparse[i] = len(section) < FEWEST
        if not sparse[i]:
            value[i], stand_in[i] = section_centredness(section)
    return Sections(value, stand_in, ~samples.directed, sparse)


def slab_members(cloud: Points, centres: Points, directions: Points, half: float) -> list[Indices]:
    """Return the points in a slab across each direction.

    Parameters
    ----------
    cloud : (n, 3) float64
        The cloud, in any unit.
    centres : (q, 3) float64
        A point in the middle plane of each slab.
    directions : (q, 3) float64
        The unit normal of each slab.
    half : float
        Half the thickness, in the unit of the cloud.

    Returns
    -------
    list of (k,) int32
        The rows of the cloud in each slab.
    """
    from tiskel.kernels.slabs import slab_counts, slab_members

    counts = np.empty(len(centres), np.int32)
    centres, directions = np.ascontiguousarray(centres), np.ascontiguousarray(directions)
    slab_counts(cloud, centres, directions, half, counts)
    ends = np.cumsum(counts, dtype=np.int64)
    rows = np.empty(int(ends[-1]) if len(ends) else 0, np.int32)
    slab_members(cloud, centres, directions, half, ends - counts, rows)
    return [np.asarray(part) for part in np.split(rows, ends[:-1])] if len(ends) else []


def in_plane(vectors: Points, direction: Numbers) -> Table:
    """Return (n, 2) the coordinates of vectors (n, 3) on the plane across a unit direction (3,)."""
    return np.asarray(vectors @ np.ascontiguousarray(across(direction).T))


def before_gap(flat: Table, gap: float) -> Table:
    """Return the points of a section before its first gap, nearest first.

    Parameters
    ----------
    flat : (n, 2) float64
        Points about the sample, which is the origin.
    gap : float
        A gap is a point more than so many times as far from the origin as the one before it.

    Returns
    -------
    (k, 2) float64
    """
    distance = np.linalg.norm(flat, axis=1)
    order = np.argsort(distance, kind="stable")
    jumps = np.flatnonzero(distance[order][1:] > gap * distance[order][:-1])
    return np.asarray(flat[order[: jumps[0] + 1]] if len(jumps) else flat[order])


def section_centredness(section: Table) -> tuple[float, bool]:
    """Return c of the origin in a section (n, 2), and whether mean and largest distance stood in for an ellipse.

    References
    ----------
    A. Fitzgibbon, M. Pilu, R. Fisher: Direct least square fitting of ellipses. PAMI 21(5), 1999.
    """
    ellipse = fit_ellipse(section)
    if ellipse is not None:
        return max(0.0, 1 - float(np.linalg.norm(ellipse.centre) / ellipse.axes.mean())), False
    mean = section.mean(axis=0)
    reach = float(np.linalg.norm(section - mean, axis=1).max())
    return (max(0.0, 1 - float(np.linalg.norm(mean)) / reach) if reach > 0 else 0.0), True
