"""Two bodies of any shape: the same equations with both sides general.

The state is the five contact coordinates themselves; where the chart of the
body is singular (the poles of an ellipsoid) a run cannot pass, which a sphere
in :func:`tiskel.roll` can.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.rolling.equations import contact_rates
from tiskel.rolling.inputs import Inputs, constant
from tiskel.rolling.roll import duration_of, longest_step
from tiskel.rolling.sphere import quaternions_of, turn_of
from tiskel.rolling.trajectory import RollStatus
from tiskel.surfaces.forms import Forms, curvature, forms_of
from tiskel.surfaces.jets import ParametricSurface

TOUCHING = 1e-6  # of the relative curvature at the start: less is none


@dataclass(frozen=True)
class BodyTrajectory:
    """A body's way over a surface; units as in :class:`tiskel.Trajectory`.

    Attributes
    ----------
    t : (n,). state : (n, 5), u_o, v_o, u_s, v_s, psi.
    contact : (n, 3). position : (n, 3), where the origin of the body is. orientation : (n, 4), unit quaternions.
    margin : (n,), the least eigenvalue of the relative curvature K_o + R_psi K_s R_psi.
    status, reason : why the run ended.
    """

    t: Numbers
    state: Numbers
    contact: Points
    position: Points
    orientation: Numbers
    margin: Numbers
    status: RollStatus
    reason: str


def roll_body(
    surface: ParametricSurface, body: ParametricSurface, params: RollParams | None = None, inputs: Inputs | None = None
) -> BodyTrajectory:
    """Roll a body over a surface, both of any shape (Montana 1988; see :mod:`tiskel.rolling.equations`).

    Of the settings side, omega, velocity, duration, rate, start and the
    tolerances count; the twist is that of the object. Raises TiskelError where
    the bodies would meet beside their contact at the start.
    """
    params = params or RollParams()
    if params.twist != "object":
        raise TiskelError(f"two bodies take the twist of the object, got twist {params.twist!r}")
    inputs = inputs or constant(params)
    pair = _Pair(surface, body, params.sigma)
    start = np.array(params.start)
    least = pair.margin(0.0, start)
    if least <= 0:
        raise TiskelError(f"the body does not fit at the start: relative curvature {least:.4g}; start elsewhere")

    def rate(t: float, y: Numbers) -> Any:
        u, v, u_s, v_s, psi = y.tolist()
        return contact_rates(*pair.forms(u, v, u_s, v_s), psi, *inputs.at(t))

    def tight(t: float, y: Numbers) -> float:
        return pair.margin(t, y) - TOUCHING * least

    def left(t: float, y: Numbers) -> float:
        low, high = surface.v_range
        return float(min(y[1] - low, high - y[1], 1.0))

    tight.terminal = left.terminal = True  # type: ignore[attr-defined]
    solution = solve_ivp(
        rate, (0.0, duration_of(params, inputs)), start, rtol=params.rtol, atol=params.atol, dense_output=True,
        max_step=longest_step(inputs, np.inf), events=[tight, left],
    )  # fmt: skip
    stop = float(solution.t[-1])
    t = np.append(np.arange(0, stop - 0.5 / params.rate, 1 / params.rate), stop)
    return pair.read(t, solution.sol(t).T, *_ending(solution, stop))


@dataclass(frozen=True)
class _Pair:
    """A surface and a body on one side of it."""

    surface: ParametricSurface
    body: ParametricSurface
    sigma: float

    def forms(self, u: float, v: float, u_s: float, v_s: float) -> tuple[Forms, Forms]:
        return forms_of(self.surface.jet(u, v), self.sigma), forms_of(self.body.jet(u_s, v_s))

    def margin(self, t: float, y: Numbers) -> float:
        """Return the least eigenvalue of the relative curvature."""
        over, own = self.forms(*y[:4].tolist())
        turn = turn_of(float(y[4]))[:2, :2]
        parts = [np.array([[xx, xy], [xy, yy]], float) for xx, xy, yy in (curvature(over), curvature(own))]
        return float(np.linalg.eigvalsh(parts[0] + turn @ parts[1] @ turn)[0])

    def read(self, t: Numbers, y: Numbers, status: RollStatus, reason: str) -> BodyTrajectory:
        """Return the trajectory of solved states: Q F_s = F R3, Q f_s + c = f_o."""
        contact, position, rotations = [], [], []
        for u, v, u_s, v_s, psi in y.tolist():
            over, own = self.surface.jet(u, v), self.body.jet(u_s, v_s)
            frame, body_frame = (np.array(forms_of(*one)[:3], float).T for one in ((over, self.sigma), (own, 1.0)))
            rotations.append(frame @ turn_of(psi) @ body_frame.T)
            contact.append(np.array(over.f, float))
            position.append(contact[-1] - rotations[-1] @ np.array(own.f, float))
        margins = np.array([self.margin(0.0, one) for one in y])
        orientation = quaternions_of(np.array(rotations))
        return BodyTrajectory(t, y, np.array(contact), np.array(position), orientation, margins, status, reason)


def _ending(solution: Any, stop: float) -> tuple[RollStatus, str]:
    """Return why the solver stopped, in one word and in a sentence."""
    if solution.status == 0:
        return RollStatus.FINISHED, f"all of {stop:g} s"
    if solution.status == 1:
        fits = len(solution.t_events[0]) == 0
        why = "v reached the end of the branch" if fits else "the bodies bend alike and would meet beside their contact"
        return RollStatus.LEFT if fits else RollStatus.TIGHT, f"{why}, at t = {stop:.4g} s"
    return RollStatus.STUCK, f"{solution.message}, at t = {stop:.4g} s"
