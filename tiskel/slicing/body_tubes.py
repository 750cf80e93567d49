"""Where a fitted tube explains the points of a body: there its curvatures, which are ten times less noisy, count."""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Mask, Numbers, Points, Table
from tiskel.geometry.quadrics import PAIRS
from tiskel.params import BodyParams
from tiskel.slicing.body_points import BodyPoints
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.slicing.rings import around
from tiskel.surfaces.forms import Forms, curvature, forms_of
from tiskel.surfaces.tube import V_STOP

PLACES = 400  # of the skeleton curve, for first guesses
MARGIN = 0.02  # of the curve at both ends, where nothing holds the curvatures of a spline
AROUND = 12  # nearest points that are asked whether the tube is theirs
OWN = 0.9  # share of a point's nearest that are the tube's
BETWEEN = 0.5  # the same of a point that no slice saw: it is the tube's, too, as those outside bends between two slabs
BIASED = 3.0  # deviations of a mean of residuals that chance allows


class OnTubes(NamedTuple):
    """Points of a body that a tube explains, and the tube about each.

    Attributes
    ----------
    there : (n,) bool
        Whether one does.
    places : (n, 3) float64
        The place of the tube that stands for the point.
    normals : (n, 3) float64
        Unit normals there, out of the body.
    hessians : (n, 6) float64
        xx, yy, zz, xy, xz and yz of the signed distance's quadric, in 1 / length.
    bends : (n,) float64
        The largest curvature there, in 1 / length.
    """

    there: Mask
    places: Points
    normals: Points
    hessians: Table
    bends: Numbers


def on_tubes(body: BodyPoints, surfaces: Surfaces | None, params: BodyParams) -> OnTubes:
    """Return which points of a body are on tubes, as far as noise can tell, and what the tubes are like there.

    Parameters
    ----------
    body : BodyPoints
        The points.
    surfaces : Surfaces or None
        The tubes, fitted to the same cloud.
    params : BodyParams
        ``tubes`` and ``noise`` count.

    Returns
    -------
    OnTubes
    """
    size = len(body.points)
    out = OnTubes(np.zeros(size, bool), np.zeros((size, 3)), np.zeros((size, 3)), np.zeros((size, 6)), np.zeros(size))
    for tube in surfaces or ():
        own = _own(body, tube)
        rows = np.flatnonzero(own).astype(np.int32)
        if len(rows) == 0:
            continue
        u, v = _places(tube, body.points[rows])
        forms, places = forms_of(tube.jet(u, v)), np.stack(tube.jet(u, v).f, axis=1)
        normals = np.stack(forms.z, axis=1)
        off = np.full(size, np.nan)
        off[rows] = ((body.points[rows] - places) * normals).sum(axis=1)
        inside = tube.tube.closed | ((v > MARGIN * V_STOP) & (v < (1 - MARGIN) * V_STOP))
        alike = (normals * body.normals[rows]).sum(axis=1) > 0
        good = _explains(body, off, own, params)[rows] & inside & alike
        hessians, bends = quadric_of(forms)
        parts = np.ones(len(rows), bool), places, normals, hessians, bends
        for column, values in zip(out, parts, strict=True):
            column[rows[good]] = values[good]
    return out


def _own(body: BodyPoints, tube: FittedSurface) -> Mask:
    """Return (n,) which points a tube was fitted to, with those that lie between them: slabs spread outside bends."""
    seen = np.isin(body.rows, tube.rows)
    return np.asarray(seen | (seen[body.near[:, :AROUND]].mean(axis=1) >= BETWEEN))


def _places(tube: FittedSurface, points: Points) -> tuple[Numbers, Numbers]:
    """Return u and v of points (n, 3): in the planes across the skeleton curve that go through them."""
    guesses = np.linspace(0, V_STOP, PLACES)
    start = guesses[cKDTree(tube.tube.curve(guesses)).query(points)[1]]
    ring = around(points, np.arange(len(points), dtype=np.int32), tube.tube.axis, tube.tube.field, start)
    return ring.u, ring.v


def _explains(body: BodyPoints, off: Numbers, own: Mask, params: BodyParams) -> Mask:
    """Return (n,) whether a tube, that points are so far off (n,), is as near to what is around as a quadric is."""
    near = body.near[:, :AROUND]
    there = own[near]
    count = np.maximum(there.sum(axis=1), 1)
    residual = np.where(there, off[near], 0.0)
    mean = residual.sum(axis=1) / count
    spread = np.sqrt((residual**2).sum(axis=1) / count)
    within = params.noise * body.error + params.tubes * body.radii
    biased = np.abs(mean) > np.maximum(BIASED * spread / np.sqrt(count), params.tubes * body.radii)
    return np.asarray((there.mean(axis=1) >= OWN) & (spread <= within) & ~biased & own)


def quadric_of(forms: Forms) -> tuple[Table, Numbers]:
    """Return the Hessian (n, 6) of a quadric that is near to the signed distance, and the largest curvature (n,).

    Along the surface it is the shape operator; along the normal, where that of the
    distance is 0, it is so that spheres and cylinders are met exactly, and other
    surfaces to the third power of the distance.
    """
    x, y, z = (np.stack(side, axis=1) for side in forms[:3])
    xx, xy, yy = curvature(forms)
    mean, half = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    one, other = mean - half, mean + half
    along = (one**3 + other**3) / np.maximum(one**2 + other**2, TINY)
    columns = [
        xx * x[:, a] * x[:, b] + xy * (x[:, a] * y[:, b] + x[:, b] * y[:, a]) + yy * y[:, a] * y[:, b]
        + along * z[:, a] * z[:, b]
        for a, b in PAIRS
    ]  # fmt: skip
    return np.stack(columns, axis=1), np.maximum(np.abs(one), np.abs(other))
