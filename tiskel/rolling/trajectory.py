"""What a run returns: the state over time, what follows from it, and why the run ended."""

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points, Table
from tiskel.params import RollParams
from tiskel.rolling.inputs import Inputs
from tiskel.shown import Shown

SLIPLESS = 1e-3  # of a way: without slip the two ways are not farther apart
STANDING = 1e-6  # of the sphere's radius: shorter ways are rounding


class RollStatus(str, Enum):
    """Why a run ended; a word to compare and to print.

    Attributes
    ----------
    FINISHED
        The duration is over.
    LEFT
        v reached the end of the branch.
    TIGHT
        The surface bends as sharply as the sphere, which would touch it twice.
    CROSSED
        Slices cross: the surface folds there.
    CLOSED
        The radius of the surface is zero.
    MET
        Points away from the contact lie in the sphere.
    OFF
        Points about the contact lie deep in the sphere: the surface is not where the body is.
    POLE
        The contact came to a pole of a chart, where u and v are no coordinates; of two bodies alone.
    STUCK
        The solver found no step small enough, as at the pole of a chart.
    ENDED
        Nothing is known of the surface further on.
    DOUBTFUL
        The surface is worth less there than was asked for.

    Examples
    --------
    >>> from tiskel import RollParams, RollStatus, roll
    >>> from tiskel.surfaces.analytic import Cone
    >>> r = roll(Cone(0.3), RollParams(radius=0.1, omega=(-1, 0, 0), start=(0, 1, 0, 0, 0), duration=60))
    >>> r.status is RollStatus.LEFT, r.status.value
    (True, 'left the branch')
    >>> r.reason
    'v reached the end of the branch, at t = 10.47 s'
    """

    FINISHED = "finished"
    LEFT = "left the branch"
    TIGHT = "the sphere no longer fits"
    CROSSED = "slices cross"
    CLOSED = "the radius of the surface is zero"
    MET = "the sphere meets another part of the cloud"
    OFF = "the surface is off the cloud"
    POLE = "a pole of the chart"
    STUCK = "the solver gave up"
    ENDED = "the surface ends"
    DOUBTFUL = "the surface is not trusted"


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Shown):
    """A sphere's way over a surface; lengths in the surface's unit, angles in radians, times in seconds.

    Attributes
    ----------
    t : (n,) array
        Times, evenly ``params.rate`` per second; the last is where the run ended.
    state : (n, 5) array
        u_o and v_o on the object, u_s and v_s on the sphere, psi between the frames, without jumps of a turn; u_o and
        v_o are NaN on surfaces without a chart.
    contact : (n, 3) array
        Where sphere and object touch.
    centre : (n, 3) array
        Of the sphere.
    orientation : (n, 4) array
        Unit quaternions w, x, y, z of the sphere, without jumps of sign.
    object_radius : (n,) array
        R at the contact, on surfaces without a chart how thick the body is; NaN where neither is known.
    margin : (n,) array
        lambda_min(K_o) + 1/R_s, in 1 / length: the sphere fits while it is positive.
    determinant : (n,) array
        det Q of the controllability with spin, in 1 / length^2 (Wen et al. 2025, corrected).
    path_object : float
        Length of the contact's way over the object, measured from places along it, not from rates.
    path_sphere : float
        The same over the sphere; without slip both are equal.
    status : RollStatus
        Why the run ended.
    reason : str
        The same as a sentence, with the time.
    evaluations : int
        Of the right-hand side.
    radius : float
        Of the sphere.
    params : RollParams
        The settings of the run.
    normal : (n, 3) array
        From the material to the sphere, of unit length.
    inputs : (n, 6) array
        omega and V as they were given, rad/s and lengths per second.
    ways : (n, 2) array
        How far the contact has come over the object and over the sphere.
    warnings : tuple of str
        What a user should know: of the inputs, and of slip that nobody asked for.

    Examples
    --------
    >>> from tiskel import RollParams, roll
    >>> from tiskel.surfaces.analytic import cylinder
    >>> r = roll(cylinder(2.0), RollParams(radius=0.5, omega=(0, 1, 0), start=(0, 0, 0, 0, 0), duration=5, rate=10))
    >>> r.t.shape, r.state.shape, r.orientation.shape
    ((51,), (51, 5), (51, 4))
    >>> r.status.value, r.reason
    ('finished', 'all of 5 s')
    >>> f"{r.path_object:.4f} {r.path_sphere:.4f} {r.margin.min():.4f}"
    '2.0000 2.0000 2.0000'
    """

    _said = ("t", "radius", "path_object", "status", "reason", "warnings")

    t: Numbers
    state: Table
    contact: Points
    centre: Points
    orientation: Table
    object_radius: Numbers
    margin: Numbers
    determinant: Numbers
    path_object: float
    path_sphere: float
    status: RollStatus
    reason: str
    evaluations: int
    radius: float
    params: RollParams
    normal: Points
    inputs: Table
    ways: Table
    warnings: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return the summary as plain values, ready for JSON; lengths, radians and seconds as above."""
        p = self.params
        return {
            "status": self.status.value,
            "reason": self.reason,
            "model": p.model,
            "normals": p.normals,
            "side": p.side,
            "twist": p.twist,
            "radius": self.radius,
            "rtol": p.rtol,
            "atol": p.atol,
            "start": _finite(self.state[0]),
            "end": _finite(self.state[-1]),
            "start_at": self.contact[0].tolist(),
            "end_at": self.contact[-1].tolist(),
            "time": float(self.t[-1]),
            "rows": len(self.t),
            "path_object": self.path_object,
            "path_sphere": self.path_sphere,
            "path_difference": self.path_object - self.path_sphere,
            "least_margin": float(self.margin.min()),
            "least_determinant": float(np.abs(self.determinant).min()),
            "evaluations": self.evaluations,
            "warnings": list(self.warnings),
        }


def _finite(values: Numbers) -> list[float | None]:
    """Return values as JSON has them: None where there is none."""
    return [value if np.isfinite(value) else None for value in values.tolist()]


def told_inputs(inputs: Inputs) -> tuple[str, ...]:
    """Return the warnings of inputs, and that they are zero."""
    still = () if inputs.values.any() else ("the inputs are zero: what should roll stays where it is",)
    return (*inputs.warnings, *still)


def told_slip(
    inputs: Inputs, lengths: tuple[float, float], size: float, params: RollParams, body: str = "sphere"
) -> tuple[str, ...]:
    """Return a warning where the ways over the surface and over the body differ though there is no slip.

    Of every kind of run: of spheres with and without a chart, and of other bodies.
    """
    longer, apart = max(lengths), abs(lengths[0] - lengths[1])
    if inputs.slips or not longer > STANDING * size or not apart > SLIPLESS * longer:
        return ()
    return (
        f"the contact's way is {lengths[0]:.6g} over the surface and {lengths[1]:.6g} over the {body}, "
        f"{100 * apart / longer:.2g} % apart though there is no slip; take a smaller rtol than {params.rtol:g} "
        f"and a smaller atol than {params.atol:g} (--rtol, --atol)",
    )
