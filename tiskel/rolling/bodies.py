"""Two bodies of any shape: the same equations with both sides general.

The state is the five contact coordinates themselves; where a chart is
singular (the poles of an ellipsoid) a run ends and says so, where a sphere in
:func:`tiskel.roll` goes on. It ends where the contact leaves either of both.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points, Table
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import RollSettings
from tiskel.progress import Report, Span
from tiskel.rolling.endings import Ending, ends_of_branch, poles
from tiskel.rolling.equations import contact_rates
from tiskel.rolling.inputs import Inputs, constant
from tiskel.rolling.reading import arcs, columns, fine_times
from tiskel.rolling.solution import Solution, duration_of, solve, told_of
from tiskel.rolling.sphere import quaternions_of, turn_of
from tiskel.rolling.trajectory import RollStatus, told_inputs, told_slip
from tiskel.shown import Brief
from tiskel.surfaces.forms import Forms, curvature, forms_of
from tiskel.surfaces.jets import ParametricSurface

TOUCHING = 1e-6  # of the relative curvature at the start: less is none


@dataclass(frozen=True, eq=False, repr=False)
class BodyTrajectory(Brief):
    """A body's way over a surface; units as in :class:`tiskel.Trajectory`.

    Attributes
    ----------
    t : (n,) array
        Times, in seconds.
    state : (n, 5) array
        u_o and v_o on the object, u_s and v_s on the body, psi between the frames, in radians.
    contact : (n, 3) array
        Where both touch.
    position : (n, 3) array
        Where the origin of the body is.
    orientation : (n, 4) array
        Unit quaternions w, x, y, z of the body.
    margin : (n,) array
        Least eigenvalue of the relative curvature K_o + R_psi K_s R_psi, in 1 / length.
    status : RollStatus
        Why the run ended.
    reason : str
        The same as a sentence, with the time.
    path_object : float
        Length of the contact's way over the object, measured from places along it, not from rates.
    path_body : float
        The same over the body; without slip both are equal.
    warnings : tuple of str
        What a user should know: of the inputs, and of slip that nobody asked for.

    Examples
    --------
    >>> from tiskel import RollParams, roll_body
    >>> from tiskel.surfaces.analytic import Ellipsoid, Torus
    >>> p = RollParams(omega=(0.5, 0.3, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4), duration=1, rate=10)
    >>> r = roll_body(Torus(5.0, 2.0), Ellipsoid(0.3, 0.4, 0.25), p)
    >>> r.t.shape, r.contact.shape, r.orientation.shape, r.status.value
    ((11,), (11, 3), (11, 4), 'finished')
    >>> f"{r.path_object:.5f} {r.path_body:.5f}", r.warnings
    ('0.23287 0.23287', ())
    """

    _said = ("t", "status", "reason")

    t: Numbers
    state: Table
    contact: Points
    position: Points
    orientation: Table
    margin: Numbers
    status: RollStatus
    reason: str
    path_object: float
    path_body: float
    warnings: tuple[str, ...] = ()


def roll_body(
    surface: ParametricSurface, body: ParametricSurface, params: RollParams | None = None, inputs: Inputs | None = None,
    *, progress: Report | None = None, **settings: Unpack[RollSettings],
) -> BodyTrajectory:  # fmt: skip
    """Roll a body over a surface, both of any shape (Montana 1988; see :mod:`tiskel.rolling.equations`).

    Parameters
    ----------
    surface : ParametricSurface
        The object, which is fixed; f_u x f_v points out of it.
    body : ParametricSurface
        What rolls over it, in its own axes.
    params : RollParams, optional
        side, omega, velocity, duration, rate, start and the tolerances count; the twist is that of the object.
    inputs : Inputs, optional
        omega and V over time, in place of those of the settings.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the run.
    **settings
        Those of :class:`tiskel.RollParams` by name; over those of params.

    Returns
    -------
    BodyTrajectory
        Contact, pose and margin over time, and why the run ended.

    Raises
    ------
    TiskelError
        Where the bodies would meet beside their contact at the start, and for another twist than that of the object.

    Examples
    --------
    >>> from tiskel import RollParams, roll_body
    >>> from tiskel.surfaces.analytic import Ellipsoid, Torus
    >>> p = RollParams(omega=(0.5, 0.3, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4), duration=3, rate=10)
    >>> r = roll_body(Torus(5.0, 2.0), Ellipsoid(0.3, 0.4, 0.25), p)
    >>> r.status.value, r.state.shape, bool(r.margin.min() > 0)
    ('finished', (31, 5), True)
    """
    params, span = settled(RollParams, params, settings), Span(progress, "roll")
    span.at(0, "start")
    if params.twist != "object":
        raise TiskelError(f"two bodies take the twist of the object, got twist {params.twist!r}")
    inputs = inputs or constant(params)
    pair = _Pair(surface, body, params.sigma)
    start = np.array(params.start)
    ends = [*poles(surface, "object", 0), *poles(body, "body", 2), *ends_of_branch(surface), *ends_of_branch(body, 2)]
    for ending in ends:
        if not ending(0.0, start) >= 0:
            raise TiskelError(f"the start lies outside: {ending.what}; start elsewhere")
    least = pair.margin(*params.start)
    if least <= 0:
        raise TiskelError(f"the body does not fit at the start: relative curvature {least:.4g}; start elsewhere")

    def rate(t: float, y: Numbers) -> Any:
        u, v, u_s, v_s, psi = y.tolist()
        return contact_rates(*pair.forms(u, v, u_s, v_s), psi, *inputs.at(t))

    tight = Ending(
        RollStatus.TIGHT, "the bodies bend alike and would meet beside their contact",
        lambda *place: pair.margin(*place) - TOUCHING * least,
    )  # fmt: skip
    told = rate if progress is None else told_of(rate, duration_of(params, inputs), span)
    solution = solve(told, start, params, inputs, np.inf, [*ends, tight])
    span.at(1)
    return pair.read(solution, inputs, params)


@dataclass(frozen=True)
class _Pair:
    """A surface and a body on one side of it."""

    surface: ParametricSurface
    body: ParametricSurface
    sigma: float

    def forms(self, u: float, v: float, u_s: float, v_s: float) -> tuple[Forms, Forms]:
        return forms_of(self.surface.jet(u, v), self.sigma), forms_of(self.body.jet(u_s, v_s))

    def margin(self, u: float, v: float, u_s: float, v_s: float, psi: float) -> float:
        """Return the least eigenvalue of the relative curvature, in 1 / length."""
        over, own = self.forms(u, v, u_s, v_s)
        turn = turn_of(psi)[:2, :2]
        parts = [np.array([[xx, xy], [xy, yy]], float) for xx, xy, yy in (curvature(over), curvature(own))]
        return float(np.linalg.eigvalsh(parts[0] + turn @ parts[1] @ turn)[0])

    def ways(self, solution: Solution) -> tuple[float, float]:
        """Return how far the contact has come over the object and over the body, from places along both."""
        u, v, u_s, v_s, _ = solution.at(fine_times(solution.steps))
        over, own = columns(self.surface.jet(u, v).f), columns(self.body.jet(u_s, v_s).f)
        return float(arcs(over).sum()), float(arcs(own).sum())

    def read(self, solution: Solution, inputs: Inputs, params: RollParams) -> BodyTrajectory:
        """Return the trajectory of a solution: Q F_s = F R3, Q f_s + c = f_o."""
        contact, position, rotations = [], [], []
        for u, v, u_s, v_s, psi in solution.states.tolist():
            over, own = self.surface.jet(u, v), self.body.jet(u_s, v_s)
            frame, body_frame = (np.array(forms_of(*one)[:3], float).T for one in ((over, self.sigma), (own, 1.0)))
            rotations.append(frame @ turn_of(psi) @ body_frame.T)
            contact.append(np.array(over.f, float))
            position.append(contact[-1] - rotations[-1] @ np.array(own.f, float))
        ways, size = self.ways(solution), float(np.linalg.norm(contact[0] - position[0]))
        return BodyTrajectory(
            solution.t, solution.states, np.array(contact), np.array(position), quaternions_of(np.array(rotations)),
            np.array([self.margin(*one) for one in solution.states.tolist()]), solution.status, solution.reason,
            *ways, (*told_inputs(inputs), *told_slip(inputs, ways, size, params, "body")),
        )  # fmt: skip
