"""The field m(v) that a frame is made of: y = (x x m)/|x x m|.

The rotation-minimising frame is that of W. Wang, B. Jüttler, D. Zheng, Y. Liu: Computation of rotation minimizing
frames. ACM TOG 27(1), 2008.
"""

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.geometry.bspline import BSplineCurve, fit_bspline
from tiskel.geometry.frames import across, unit
from tiskel.slicing.axis import EXACT
from tiskel.surfaces.tube import V_STOP

PARALLEL = 0.2  # sine of the angle between tangent and m that is too small
STRAIGHT = 1e-3  # radius times curvature; straighter has no normal to speak of
DENSE = 16  # places per interval


def fit_field(
    axis: BSplineCurve, m: tuple[float, float, float] | str, radius: float, intervals: int
) -> tuple[BSplineCurve, str, str]:
    """Return the field along a curve, the name of the frame it gives, and why it is not the one asked for.

    A direction that comes near the tangent, and normals of what is straight
    somewhere, fall back to the rotation-minimising frame.

    Parameters
    ----------
    axis : BSplineCurve
        The skeleton curve.
    m : (float, float, float) or str
        A direction, "normal" or "rotation-minimising".
    radius : float
        How thick the body is, in the input's unit.
    intervals : int
        Of the spline of the field.

    Returns
    -------
    field : BSplineCurve
        m(v).
    frame : str
        "m", "normal" or "rotation-minimising".
    note : str
        Why it is not the frame asked for; empty where it is.
    """
    v = np.linspace(0, V_STOP, DENSE * intervals, endpoint=not axis.periodic)
    rows = axis.along(v)
    tangent = unit(rows[:, 1])
    if m == "normal":
        bend = np.cross(rows[:, 1], rows[:, 2])
        if np.linalg.norm(bend, axis=1).min() * radius > STRAIGHT * np.linalg.norm(rows[:, 1], axis=1).min() ** 3:
            return _strip(axis, v, unit(np.cross(bend, rows[:, 1])), intervals), "normal", ""
        why = "the curve is straight somewhere and has no normal there"
    elif isinstance(m, str):
        why = ""
    else:
        direction = np.asarray(m, float) / np.linalg.norm(m)
        if np.linalg.norm(np.cross(tangent, direction), axis=1).min() > PARALLEL:
            return _strip(axis, v, np.tile(direction, (len(v), 1)), intervals), "m", ""
        why = f"m = {','.join(f'{x:g}' for x in m)} is parallel to the tangent"
    return (
        _strip(axis, v, _rotation_minimising(rows[:, 0], tangent, axis.periodic), intervals),
        "rotation-minimising",
        why,
    )


def _rotation_minimising(places: Points, tangents: Points, closed: bool) -> Points:
    """Return -z (k, 3) of the frame that turns least, by double reflection (Wang et al., TOG 2008).

    Of a loop, what is left to turn when it closes is shared out evenly.
    """
    field = [across(tangents[0])[0]]
    following = [(places[-1], tangents[-1], places[0], tangents[0])] if closed else []
    steps = [*zip(places[:-1], tangents[:-1], places[1:], tangents[1:], strict=True), *following]
    for place, tangent, after, tangent_after in steps:
        field.append(_reflected(field[-1], tangent, after - place, tangent_after))
    if not closed:
        return np.array(field)
    left = np.arctan2(np.cross(field[0], field[-1]) @ tangents[0], field[0] @ field[-1])
    turn = -left * np.arange(len(places)) / len(places)
    m = np.array(field[:-1])
    return np.asarray(np.cos(turn)[:, None] * m + np.sin(turn)[:, None] * np.cross(tangents, m))


def _reflected(vector: Numbers, tangent: Numbers, step: Numbers, tangent_after: Numbers) -> Numbers:
    def mirrored(a: Numbers, normal: Numbers) -> Numbers:
        square = normal @ normal
        return a if square == 0 else np.asarray(a - 2 * (normal @ a) / square * normal)

    return mirrored(mirrored(vector, step), tangent_after - mirrored(tangent, step))


def _strip(axis: BSplineCurve, v: Numbers, values: Points, intervals: int) -> BSplineCurve:
    return fit_bspline(v, values, np.ones(len(v)), intervals, V_STOP, periodic=axis.periodic, penalty=EXACT)
