"""Centredness: is a skeleton in the middle of its cloud?"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Mask, Numbers, Points, diagonal
from tiskel.geometry.curve import CurveSamples
from tiskel.geometry.ellipse import fit_ellipse
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.params import MetricParams

FEWEST = 3  # points that make a section


def neighbourhood_size(count: int) -> int:
    """Return N for so many skeletal points: 1 % of them, 10 where that is below 10, 30 where it is above 50 [T]."""
    size = int(np.floor(0.01 * count + 0.5))
    return min(count, 10 if size < 10 else 30 if size > 50 else size)


def point_centredness(points: Points, originals: Points) -> Numbers:
    """Return c (m,) of skeletal points (m, 3) and their originals (m, 3), before boundedness is asked for.

    Among the N nearest skeletal points, itself included,
    c = 1 - |mean originals - mean skeletal| / mean |original - skeletal|, at
    least 0. Where nothing moved, c is 1 if the means agree.
    """
    near = nearest_neighbours(points, neighbourhood_size(len(points)))[0]
    apart = np.linalg.norm((originals[near] - points[near]).mean(axis=1), axis=1)
    moved = np.linalg.norm(originals - points, axis=1)[near].mean(axis=1)
    ratio = np.divide(apart, moved, out=np.zeros(len(points)), where=moved > 0)
    return np.asarray(np.maximum(0, 1 - ratio))


@dataclass(frozen=True)
class Sections:
    """What the sections across a curve say.

    Attributes
    ----------
    centredness : (q,), NaN where invalid.
    stand_in : (q,) which have no ellipse, so that mean and largest distance stand in.
    directionless, sparse : (q,) why others are invalid: no direction, fewer than three points.
    """

    centredness: Numbers
    stand_in: Mask
    directionless: Mask
    sparse: Mask


def curve_centredness(samples: CurveSamples, cloud: Points, params: MetricParams) -> Sections:
    """Return c = 1 - |sample - centre| / mean semi-axis, at least 0, of the section at each place on a curve.

    Of the cloud (n, 3) what lies within the slab across the curve, projected
    along it, and, in order of distance from the place, only what comes before
    the first gap: a point more than 1.5 times as far away as the one before [T].
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
    """Return the rows of the cloud within half of the plane through each centre (q, 3) across its direction (q, 3)."""
    from tiskel.kernels.slabs import slab_counts, slab_members

    counts = np.empty(len(centres), np.int32)
    centres, directions = np.ascontiguousarray(centres), np.ascontiguousarray(directions)
    slab_counts(cloud, centres, directions, half, counts)
    ends = np.cumsum(counts, dtype=np.int64)
    rows = np.empty(int(ends[-1]) if len(ends) else 0, np.int32)
    slab_members(cloud, centres, directions, half, ends - counts, rows)
    return [np.asarray(part) for part in np.split(rows, ends[:-1])] if len(ends) else []


def in_plane(vectors: Points, direction: npt.NDArray[np.float64]) -> Numbers:
    """Return (n, 2) coordinates across a unit direction (3,)."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    u = np.cross(direction, helper)
    u /= np.linalg.norm(u)
    return np.asarray(vectors @ np.stack([u, np.cross(direction, u)], axis=1))


def before_gap(flat: Numbers, gap: float) -> Numbers:
    """Return the points (n, 2) before the first that is more than gap times as far from the origin as the last."""
    distance = np.linalg.norm(flat, axis=1)
    order = np.argsort(distance, kind="stable")
    jumps = np.flatnonzero(distance[order][1:] > gap * distance[order][:-1])
    return np.asarray(flat[order[: jumps[0] + 1]] if len(jumps) else flat[order])


def section_centredness(section: Numbers) -> tuple[float, bool]:
    """Return c of the origin in a section (n, 2), and whether mean and largest distance stood in for an ellipse."""
    ellipse = fit_ellipse(section)
    if ellipse is not None:
        return max(0.0, 1 - float(np.linalg.norm(ellipse.centre) / ellipse.axes.mean())), False
    mean = section.mean(axis=0)
    reach = float(np.linalg.norm(section - mean, axis=1).max())
    return (max(0.0, 1 - float(np.linalg.norm(mean)) / reach) if reach > 0 else 0.0), True
