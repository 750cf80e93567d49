"""The ring of points that a slice sees around the skeleton curve; other branches in its plane are left out."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Indices, Mask, Numbers, Points, Table
from tiskel.geometry.bspline import BSplineCurve
from tiskel.slicing.parts import parts_of
from tiskel.surfaces.tube import Moving, moving_frame

SECTORS = 36  # directions that a section is looked at in
ALIKE = 0.5, 1.6  # median radius of a part of the ring, in that of its largest part
PROJECTIONS = 3  # Newton steps to the plane through a point


@dataclass(frozen=True, eq=False)
class Ring:
    """The points of one section, in cylinder coordinates about the skeleton curve.

    Attributes
    ----------
    rows : (k,) int32
        Their rows in the cloud.
    u : (k,) float64
        Their angles about the curve, in radians.
    v : (k,) float64
        Their places along the curve, from 0 to pi.
    r : (k,) float64
        Their distances from the curve, in the input's unit.
    """

    rows: Indices
    u: Numbers
    v: Numbers
    r: Numbers

    def part(self, kept: Mask) -> "Ring":
        """Return the points of a mask (k,) alone."""
        return Ring(self.rows[kept], self.u[kept], self.v[kept], self.r[kept])


def frames_along(axis: BSplineCurve, field: BSplineCurve, v: Numbers) -> Moving:
    """Return the moving frame of an axis and its field at places v (k,); its vectors are tuples of arrays (k,)."""
    p, m = (list(map(tuple, np.moveaxis(strip.along(v), 0, 2))) for strip in (axis, field))
    return moving_frame(p, m)


def cut(
    points: Points, axis: BSplineCurve, field: BSplineCurve, v: Numbers, half: float, reach: Numbers, link: float
) -> list[Indices]:  # fmt: skip
    """Return the ring of points around the curve in each slice.

    Parameters
    ----------
    points : (n, 3) float64
        The points, in the input's unit.
    axis : BSplineCurve
        The skeleton curve.
    field : BSplineCurve
        The field m(v) of its frame.
    v : (s,) float64
        The places of the slices, from 0 to pi.
    half : float
        Half the thickness of a slice, in the input's unit.
    reach : (s,) float64
        How far from the curve each slice looks, in the input's unit; may be infinite.
    link : float
        Points no further apart hang together, in the input's unit.

    Returns
    -------
    list of (k,) int32
        The rows of each ring.
    """
    from tiskel.kernels.sections import section_counts, section_points

    frame = frames_along(axis, field, v)
    centres, x, y, z = (np.ascontiguousarray(np.transpose(part)) for part in (frame.p, frame.x, frame.y, frame.z))
    counts = np.empty(len(v), np.int32)
    section_counts(points, centres, x, half, reach, counts)
    offsets = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
    rows, (across, up, ahead) = np.empty(offsets[-1], np.int32), np.empty((3, offsets[-1]))
    section_points(points, centres, x, y, z, half, reach, offsets[:-1], rows, across, up, ahead)
    found = []
    for start, stop in zip(offsets[:-1], offsets[1:], strict=True):
        part = slice(start, stop)
        found.append(rows[part][ring_of(np.stack([across[part], up[part]], axis=1), link)])
    return found


def ring_of(plane: Table, link: float) -> Indices:
    """Return which points of a section are the ring around its centre.

    Of the parts that hang together, the one that is nearest in most directions,
    and those as far away that are nearest where it has a gap.

    Parameters
    ----------
    plane : (k, 2) float64
        The points of the section; its centre is the origin.
    link : float
        Points no further apart hang together, in the same unit.

    Returns
    -------
    (r,) int32
        Rows of ``plane``.
    """
    if len(plane) == 0:
        return np.zeros(0, np.int32)
    part = parts_of(plane, link)
    r, u = np.linalg.norm(plane, axis=1), np.arctan2(plane[:, 1], plane[:, 0])
    sector = np.floor((u + np.pi) / (2 * np.pi) * SECTORS).astype(int) % SECTORS
    order = np.lexsort((r, sector))
    nearest = part[order[np.unique(sector[order], return_index=True)[1]]]
    seen = np.bincount(nearest, minlength=part.max() + 1)
    main = int(seen.argmax())
    typical = float(np.median(r[part == main]))
    low, high = ALIKE
    ring = [
        number
        for number in np.flatnonzero(seen)
        if number == main or low * typical <= np.median(r[part == number]) <= high * typical
    ]
    return np.flatnonzero(np.isin(part, ring)).astype(np.int32)


def around(points: Points, rows: Indices, axis: BSplineCurve, field: BSplineCurve, start: Numbers) -> Ring:
    """Return where some points are about the curve: in the planes across it that go through them.

    Parameters
    ----------
    points : (n, 3) float64
        The points, in the input's unit.
    rows : (k,) int32
        The rows of those that are asked for.
    axis : BSplineCurve
        The skeleton curve.
    field : BSplineCurve
        The field m(v) of its frame.
    start : (k,) float64
        A v near that of each.

    Returns
    -------
    Ring
    """
    v, own = start.copy(), points[rows]
    for _ in range(PROJECTIONS):
        p = axis.along(v)
        offset = own - p[:, 0]
        ahead, slope = (offset * p[:, 1]).sum(axis=1), (offset * p[:, 2]).sum(axis=1) - (p[:, 1] ** 2).sum(axis=1)
        limit = 0.1 * axis.step * axis.intervals
        v = v - np.clip(ahead / np.where(slope < 0, slope, -np.inf), -limit, limit)
    frame = frames_along(axis, field, v)
    across, up = ((own.T - np.array(frame.p)) * np.array(side) for side in (frame.y, frame.z))
    y, z = across.sum(axis=0), up.sum(axis=0)
    return Ring(rows, np.arctan2(z, y), v, np.hypot(y, z))
