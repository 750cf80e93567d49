"""The smooth skeleton curve p(v) of a path, v from 0 to pi in proportion to its length."""

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.geometry.bspline import WEIGHTS, Strip, fit_strip
from tiskel.surfaces.tube import V_STOP

DENSE = 8  # places that the length is measured at, per interval
CROSSING = 0.85  # radius times curvature that a smooth curve is kept below, so that slices do not cross
LEAST_PENALTY = 1e-7  # tried where cross-validation leaves bends too sharp
ASTRAY = 1.0  # radii that a smooth curve may be off its places
EXACT = 1e-9  # penalty of a fit to what is smooth already
ROUNDS = 3  # of evening out the speed


def fit_axis(
    places: Points, weights: Numbers, radius: float, intervals: int, *, closed: bool, v: Numbers | None = None
) -> Strip:
    """Return the curve nearest to places (k, 3) in order, as smooth as cross-validation finds it has to be.

    Smoother where its bends are sharper than the body is thick, as far as it stays inside. Without v the
    places are in proportion to their distance, and a closed path repeats its
    first place, which counts once.
    """
    if v is None:
        v = arc_share(places) * V_STOP
        if closed:
            places, weights, v = places[:-1], weights[:-1], v[:-1]
    for penalty in (None, *(float(weight) for weight in WEIGHTS if weight >= LEAST_PENALTY)):
        rough = fit_strip(v, places, weights, intervals, V_STOP, periodic=closed, penalty=penalty)
        if penalty is not None and np.linalg.norm(rough.along(v)[:, 0] - places, axis=1).max() > ASTRAY * radius:
            break  # smoother only by leaving the body
        axis = evened(rough, intervals)
        if sharpest(axis) * radius < CROSSING:
            break
    return axis


def arc_share(places: Points) -> Numbers:
    """Return (k,) the share of the length of a polyline at its places."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    return np.asarray(along / max(along[-1], np.finfo(float).tiny))


def sharpest(axis: Strip) -> float:
    """Return the largest curvature of a curve."""
    rows = axis.along(np.linspace(0, V_STOP, DENSE * axis.intervals))
    speed = np.linalg.norm(rows[:, 1], axis=1)
    return float((np.linalg.norm(np.cross(rows[:, 1], rows[:, 2]), axis=1) / speed**3).max())


def evened(axis: Strip, intervals: int, start: float = 0.0, stop: float = V_STOP) -> Strip:
    """Return the same curve, or its part from start to stop, on so many intervals, in proportion to its length."""
    for _ in range(ROUNDS):
        v = np.linspace(start, stop, DENSE * max(intervals, axis.intervals) + 1)
        places = axis.along(v)[:, 0]
        if axis.periodic:
            places[-1] = places[0]
        at = arc_share(places) * V_STOP
        keep = slice(None, -1) if axis.periodic else slice(None)
        axis = fit_strip(
            at[keep], places[keep], np.ones(len(at[keep])), intervals, V_STOP, periodic=axis.periodic, penalty=EXACT
        )
        start, stop = 0.0, V_STOP
    return axis
