"""The smooth skeleton curve p(v) of a path, v from 0 to pi in proportion to its length."""

import numpy as np

from tiskel.arrays import TINY, Numbers, Points
from tiskel.geometry.bspline import WEIGHTS, BSplineCurve, fit_bspline
from tiskel.geometry.frames import step_lengths
from tiskel.surfaces.tube import V_STOP

DENSE = 8  # places that the length is measured at, per interval
CROSSING = 0.85  # radius times curvature that a smooth curve is kept below, so that slices do not cross
LEAST_PENALTY = 1e-7  # tried where cross-validation leaves bends too sharp
ASTRAY = 1.0  # radii that a smooth curve may be off its places
EXACT = 1e-9  # penalty of a fit to what is smooth already
ROUNDS = 3  # of evening out the speed


def fit_axis(
    places: Points, weights: Numbers, radius: float, intervals: int, *, closed: bool, v: Numbers | None = None
) -> BSplineCurve:
    """Return the curve nearest to places in order, as smooth as cross-validation finds it has to be.

    Smoother where its bends are sharper than the body is thick, as far as it
    stays inside.

    Parameters
    ----------
    places : (k, 3) float64
        Places that the curve follows, in the input's unit. Without ``v`` a closed path repeats its first place, which
        counts once.
    weights : (k,) float64
        How much each place counts.
    radius : float
        How thick the body is, in the input's unit.
    intervals : int
        Of the spline.
    closed : bool
        Whether the curve is a loop.
    v : (k,) float64, optional
        The parameter of each place, from 0 to pi; without it in proportion to the length.

    Returns
    -------
    BSplineCurve
        The curve p(v), v from 0 to pi.
    """
    if v is None:
        v = arc_share(places) * V_STOP
        if closed:
            places, weights, v = places[:-1], weights[:-1], v[:-1]
    for penalty in (None, *(float(weight) for weight in WEIGHTS if weight >= LEAST_PENALTY)):
        rough = fit_bspline(v, places, weights, intervals, V_STOP, periodic=closed, penalty=penalty)
        if penalty is not None and np.linalg.norm(rough.along(v)[:, 0] - places, axis=1).max() > ASTRAY * radius:
            break  # smoother only by leaving the body
        axis = evened(rough, intervals)
        if sharpest(axis) * radius < CROSSING:
            break
    return axis


def arc_share(places: Points) -> Numbers:
    """Return (k,) the share of the length of a polyline (k, 3) at its vertices, from 0 to 1."""
    along = np.concatenate([[0.0], np.cumsum(step_lengths(places))])
    return np.asarray(along / max(along[-1], TINY))


def sharpest(axis: BSplineCurve) -> float:
    """Return the largest curvature of a curve, in 1 / length."""
    rows = axis.along(np.linspace(0, V_STOP, DENSE * axis.intervals))
    speed = np.linalg.norm(rows[:, 1], axis=1)
    return float((np.linalg.norm(np.cross(rows[:, 1], rows[:, 2]), axis=1) / speed**3).max())


def evened(axis: BSplineCurve, intervals: int, start: float = 0.0, stop: float = V_STOP) -> BSplineCurve:
    """Return a curve, or a part of it, with v in proportion to its length.

    Parameters
    ----------
    axis : BSplineCurve
        The curve.
    intervals : int
        Of the result.
    start : float
        v where the part begins.
    stop : float
        v where the part ends.

    Returns
    -------
    BSplineCurve
        The same places, v from 0 to pi.
    """
    for _ in range(ROUNDS):
        v = np.linspace(start, stop, DENSE * max(intervals, axis.intervals) + 1)
        places = axis.along(v)[:, 0]
        if axis.periodic:
            places[-1] = places[0]
        at = arc_share(places) * V_STOP
        keep = slice(None, -1) if axis.periodic else slice(None)
        axis = fit_bspline(
            at[keep], places[keep], np.ones(len(at[keep])), intervals, V_STOP, periodic=axis.periodic, penalty=EXACT
        )
        start, stop = 0.0, V_STOP
    return axis
