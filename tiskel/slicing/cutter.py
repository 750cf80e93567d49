"""The slices of a branch: where they are, their rings, and the curve moved to the middles of their sections."""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from tiskel.arrays import TINY, Numbers, Points
from tiskel.geometry.bspline import BSplineCurve
from tiskel.geometry.frames import step_lengths
from tiskel.params import SurfaceParams
from tiskel.slicing.axis import fit_axis
from tiskel.slicing.field import fit_field
from tiskel.slicing.gaps import largest_gap
from tiskel.slicing.rings import Ring, around, cut, frames_along
from tiskel.slicing.sections import Case, Section, fit_section
from tiskel.slicing.series import without_unlike
from tiskel.surfaces.tube import V_STOP

LEAST_SLICES = 4  # fewer do not determine how a surface changes along its curve
REACH = 3.0  # radii of the curve's nearest points: how far a section looks where points have no nodes
ASTRAY = 5.0  # half slabs along the curve that a point is from its slice at most, in the bends, too
INTERVALS = 4, 200  # of the splines; one for every two slices
CENTRE_ORDER = 2  # of the series whose first terms say where the middle is
BRIDGED = 0.1  # weight of the old place of the curve where a section says nothing, and at its ends
ALL_ABOUT = np.pi / 2  # the largest angle without a point about the middle of a section without a series
FARTHEST = 0.5  # radii that the curve moves in a round


class Rejected(Exception):
    """A branch without a surface, and why."""


@dataclass(frozen=True, eq=False)
class Cutter:
    """What all slices of a branch share.

    Attributes
    ----------
    points : (n, 3) float64
        The points that may lie about it, in the input's unit.
    owned : bool
        Whether they belong to it; else slices look only as far as the curve is from its nearest points.
    half : float
        Half the thickness of a slice, in the input's unit.
    link : float
        Points no further apart hang together, in the input's unit.
    radius : float
        How thick the body is, in the input's unit.
    params : SurfaceParams
        The settings.
    """

    points: Points
    owned: bool
    half: float
    link: float
    radius: float
    params: SurfaceParams

    def field(self, axis: BSplineCurve) -> tuple[BSplineCurve, str, str]:
        """Return the field of a curve's frame, its name and a note; see :func:`tiskel.slicing.field.fit_field`."""
        return fit_field(axis, self.params.m, self.radius, axis.intervals)

    def rings(self, axis: BSplineCurve, field: BSplineCurve, places: Numbers) -> list[Ring]:
        """Return the ring of each slice at places (s,), without points whose own plane is far along the curve."""
        reach = np.full(len(places), np.inf)
        if not self.owned:
            reach = REACH * np.asarray(cKDTree(self.points).query(axis.along(places)[:, 0])[0]) + self.half
        found = cut(self.points, axis, field, places, self.half, reach, self.link)
        every, sizes = np.concatenate(found), [len(rows) for rows in found]
        all_at_once = around(self.points, every, axis, field, np.repeat(places, sizes))
        flat = every, all_at_once.u, all_at_once.v, all_at_once.r
        columns = (np.split(column, np.cumsum(sizes)[:-1]) for column in flat)
        most = ASTRAY * self.half * V_STOP / float(step_lengths(axis.along(places)[:, 0]).sum())
        rings = [Ring(*ring) for ring in zip(*columns, strict=True)]
        return [ring.part(np.abs(ring.v - v) <= most) for v, ring in zip(places, rings, strict=True)]


def places_of(count: int) -> Numbers:
    """Return (count,) v of the slices: the middles of as many even parts of the curve."""
    return np.asarray((np.arange(count) + 0.5) / count * V_STOP)


def recentred(axis: BSplineCurve, cutter: Cutter, count: int) -> tuple[BSplineCurve, Cutter]:
    """Return the curve through the middles of the sections, and the cutter with their median radius."""
    field, places = cutter.field(axis)[0], places_of(count)
    loose = replace(cutter.params, uneven=np.inf)
    rings = cutter.rings(axis, field, places)
    sections = without_unlike(
        tuple(fit_section(v, ring, CENTRE_ORDER, loose) for v, ring in zip(places, rings, strict=True))
    )  # fmt: skip
    frame = frames_along(axis, field, places)
    fitted = np.array([len(section.series) > 0 for section in sections])
    if fitted.sum() < LEAST_SLICES:
        raise Rejected(why_not(sections))
    radius = float(np.median([section.series[0] for section in sections if len(section.series)]))
    middles = [
        (section.series[2], section.series[1]) if len(section.series) else middle_of(ring)
        for section, ring in zip(sections, rings, strict=True)
    ]
    fitted |= np.array([bool(any(middle)) for middle in middles])
    across, up = np.array(middles).T
    move = across * np.array(frame.y) + up * np.array(frame.z)
    move *= np.minimum(1, FARTHEST * radius / np.maximum(np.linalg.norm(move, axis=0), TINY))
    centres, weights, v = (np.array(frame.p) + move).T, np.where(fitted, 1.0, BRIDGED), places
    if not axis.periodic:  # the ends move with the slices next to them
        v = np.concatenate([[0.0], v, [V_STOP]])
        first, last = (axis.along(v[[end]])[:, 0] + move.T[[end]] for end in (0, -1))
        centres = np.concatenate([first, centres, last])
        weights = np.concatenate([[BRIDGED], weights, [BRIDGED]])
    intervals = int(np.clip(count // 2, *INTERVALS))
    return fit_axis(centres, weights, radius, intervals, closed=axis.periodic, v=v), replace(cutter, radius=radius)


def middle_of(ring: Ring) -> tuple[float, float]:
    """Return the middle of the convex hull of a section without a series, along y and z of its frame.

    That of a flat one that the curve runs beside, say. Nothing, 0 and 0, where points do not lie all about it.
    """
    plane = np.stack([ring.r * np.cos(ring.u), ring.r * np.sin(ring.u)], axis=1)
    try:
        corners = plane[ConvexHull(plane).vertices]
    except (QhullError, ValueError):  # fewer than three points, or all on a line
        return 0.0, 0.0
    after = np.roll(corners, -1, axis=0)
    areas = corners[:, 0] * after[:, 1] - corners[:, 1] * after[:, 0]
    middle = (areas[:, None] * (corners + after)).sum(axis=0) / (3 * areas.sum())
    off = plane - middle
    if largest_gap(np.arctan2(off[:, 1], off[:, 0]))[0] > ALL_ABOUT:
        return 0.0, 0.0
    return float(middle[0]), float(middle[1])


def why_not(sections: tuple[Section, ...]) -> str:
    """Return the reason why a branch has no surface."""
    cases = Counter(section.case.value for section in sections if section.case is not Case.FITTED)
    told = ", ".join(f"{count} {case}" for case, count in cases.items())
    return f"fewer than {LEAST_SLICES} of its {len(sections)} slices can be fitted ({told})"
