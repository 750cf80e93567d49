"""Curve in the air: places that are neither at the points of a cloud nor between them.

A measure of a curve that needs no surface, no normals and no truth. It asks the
points alone: the axis of a pipe of which less than 160 degrees of its turn were
seen has points on one side only and counts as in the air, right as it may be,
unless it is within three spacings of them. So does a line over a gap in a scan.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Mask, Numbers, Points
from tiskel.geometry.curve import CurveSamples
from tiskel.geometry.frames import across, unit
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.spacing import NEIGHBOURS, spacings_from

NEAR = 3.0  # spacings; what is nearer to a point is at the points
HALF_SLAB = 2.0  # spacings on either side of the plane across the curve: points that count as being in it
AS_FAR = 2.0  # times the distance of the nearest point in the slab; what is farther does not surround a place
SURROUNDED = np.deg2rad(200.0)  # radians; the widest gap in angle is less where points stand about a place
EVEN = 0.95  # quantile of the spacings that those of sparser points count as: a stray point is near to nothing
ANY_WAY = np.array([0.0, 0.0, 1.0])  # direction of a place on an edge without length, which counts for nothing
BLOCK = 4096  # places at a time, so that what is seen from them fits into memory


def point_spacings(cloud: Points) -> Numbers:
    """Return (n,) the spacing about each point of a cloud (n, 3), in its unit; see :mod:`tiskel.geometry.spacing`."""
    distances = cKDTree(cloud).query(cloud, k=min(NEIGHBOURS + 1, len(cloud)))[0]
    return spacings_from(np.reshape(distances, (len(cloud), -1)) ** 2)


@dataclass(frozen=True, eq=False)
class Air:
    """Which of q places on a curve are in the air.

    Attributes
    ----------
    places : (q,) bool
        Whether each is.
    distance : (q,) float64
        How far each is from the nearest point, in the unit of the curve.
    weight : (q,) float64
        The length of the curve that each stands for, in its unit.
    """

    places: Mask
    distance: Numbers
    weight: Numbers

    @property
    def share(self) -> float | None:
        """The share of the curve's length that is in the air; None for a curve without length."""
        return self.share_of(np.ones_like(self.places)) if self.weight.any() else None

    def share_of(self, places: Mask) -> float:
        """Return the share of the curve's length that is in the air at some of the places (q,), 0 without length."""
        total = float(self.weight.sum())
        return float(self.weight[self.places & places].sum()) / total if total > 0 else 0.0


def in_the_air(
    curve: CurveGraph,
    samples: CurveSamples,
    cloud: Points,
    spacings: Numbers | None = None,
    half: Numbers | None = None,
) -> Air:
    """Tell which places on a curve are in the air.

    They have no point of the cloud within 3 spacings, and are not between
    points: of those in a slab across the curve, 2 spacings to either side, and
    no farther than twice the nearest of them, the widest gap in angle is 200
    degrees or more. The spacing is that about the nearest point.

    Parameters
    ----------
    curve : CurveGraph
        In the unit of the cloud.
    samples : CurveSamples
        Places (q, 3) on it.
    cloud : (n, 3) float64
        Distinct points, in any unit.
    spacings : (n,) float64, optional
        How far the points are apart about each, where that is known already.
    half : (q,) float64, optional
        Half the thickness of the slab at each place where it is more than 2 spacings; a slab that is thicker than a
        hole in the scan is long sees the points before and behind it.

    Returns
    -------
    Air

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import CurveGraph
    >>> from tiskel.geometry.air import in_the_air
    >>> from tiskel.geometry.curve import curve_samples
    >>> turn, along = np.meshgrid(np.arange(40) * np.pi / 20, np.arange(40) * 0.15)
    >>> tube = np.stack([np.cos(turn), np.sin(turn), along], axis=-1).reshape(-1, 3)
    >>> axis = CurveGraph(np.array([[0, 0, 1.0], [0, 0, 5]]), np.array([[0, 1]], np.int32))
    >>> beside = CurveGraph(axis.nodes + [3, 0, 0], axis.edges)
    >>> [in_the_air(curve, curve_samples(curve, 9), tube).share for curve in (axis, beside)]
    [0.0, 1.0]
    """
    apart = point_spacings(cloud) if spacings is None else spacings
    distance, nearest = cKDTree(cloud).query(samples.points)
    spacing = np.minimum(apart, np.quantile(apart, EVEN))[nearest]
    air = np.asarray(distance > NEAR * spacing)
    ends = curve.nodes[curve.edges[samples.edges]]
    along = np.where(samples.directed[:, None], samples.directions, unit(ends[:, 1] - ends[:, 0]))
    along[~along.any(axis=1)] = ANY_WAY
    slab = np.maximum(HALF_SLAB * spacing, 0.0 if half is None else half)
    for rows in np.array_split(np.flatnonzero(air), -(-int(air.sum()) // BLOCK) or 1):
        air[rows] = widest_gaps(samples.points[rows], along[rows], slab[rows], cloud) >= SURROUNDED
    return Air(air, np.asarray(distance), lengths_of(curve, samples))


def widest_gaps(places: Points, directions: Points, half: Numbers, cloud: Points) -> Numbers:
    """Return the widest angle without points about each place, in the plane across its direction.

    Parameters
    ----------
    places : (m, 3) float64
        In the unit of the cloud.
    directions : (m, 3) float64
        Unit vectors.
    half : (m,) float64
        How far from the plane points count.
    cloud : (n, 3) float64
        Of these, points no farther than twice the nearest count.

    Returns
    -------
    (m,) float64
        Radians, up to a whole turn where there is at most one point.
    """
    from tiskel.kernels.slab_views import BINS, nearest_in_slab, seen_around

    count = len(places)
    frames = across(directions)
    places, directions, y, z = map(np.ascontiguousarray, (places, directions, frames[:, 0], frames[:, 1]))
    nearest, (lowest, highest) = np.empty(count), np.empty((2, count, BINS))
    nearest_in_slab(cloud, places, directions, half, nearest)
    reach = np.where(np.isfinite(nearest), AS_FAR * nearest, 0.0)
    seen_around(cloud, places, directions, y, z, half, reach, lowest, highest)
    before = np.concatenate([np.full((count, 1), -np.inf), np.maximum.accumulate(highest, axis=1)[:, :-1]], axis=1)
    inner = np.where(np.isfinite(lowest) & np.isfinite(before), lowest - before, 0.0).max(axis=1, initial=0.0)
    whole = lowest.min(axis=1, initial=np.inf) + 2 * np.pi - highest.max(axis=1, initial=-np.inf)
    return np.asarray(np.minimum(np.maximum(inner, whole), 2 * np.pi))


def lengths_of(curve: CurveGraph, samples: CurveSamples) -> Numbers:
    """Return (q,) the length that each place on a curve stands for, in its unit; all of an edge's make up the edge."""
    each = np.bincount(samples.edges, minlength=len(curve.edges))
    return np.asarray((curve.lengths / np.maximum(each, 1))[samples.edges])
