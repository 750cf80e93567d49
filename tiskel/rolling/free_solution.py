"""How a run without a chart is solved: stretches between contacts, each a solution of its own."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from tiskel.arrays import Numbers, Table
from tiskel.params import RollParams
from tiskel.rolling.ambient import AmbientRate, frame_of
from tiskel.rolling.free_endings import Watch
from tiskel.rolling.second import Surroundings
from tiskel.rolling.solution import stops
from tiskel.rolling.stepping import RowByRow
from tiskel.rolling.trajectory import RollStatus

SCALED = 0.1  # of the tolerances: places are in radii of the sphere here, and ways are to be of one length to 1e-5
CHANGES = 200  # of contact in one run: more are a ball that rattles in a groove
RISING = -1e-9  # radii per radian: a centre that sinks faster towards the contact it leaves is wedged


@dataclass(eq=False)
class Stretches:
    """A solved run, stretch by stretch.

    Attributes
    ----------
    times : list of (k,) float64
        Between the solver's steps, of every stretch.
    solutions : list of callable
        The states (10, m) at times (m,) within a stretch.
    status : RollStatus
        Why the run ended.
    reason : str
        The same as a sentence.
    evaluations : int
        Of the right-hand side.
    """

    times: list[Numbers] = field(default_factory=list)
    solutions: list[Callable[[Numbers], Table]] = field(default_factory=list)
    status: RollStatus = RollStatus.FINISHED
    reason: str = ""
    evaluations: int = 0

    @property
    def stop(self) -> float:
        """When the run ended, in seconds."""
        return float(self.times[-1][-1])

    def at(self, t: Numbers) -> Table:
        """Return the states (m, 10) at times (m,); where the contact changes that before it."""
        ends = np.array([times[-1] for times in self.times])
        which = np.minimum(np.searchsorted(ends, t), len(ends) - 1)
        out = np.empty((len(t), 10))
        for stretch in np.unique(which):
            out[which == stretch] = self.solutions[stretch](t[which == stretch]).T
        return out

    def end(self, status: RollStatus, reason: str) -> "Stretches":
        """Return the same, ended for a reason."""
        self.status, self.reason = status, reason
        return self


def solve_stretches(
    rate: AmbientRate, told: Callable[[float, Numbers], Numbers], start: Numbers, duration: float, longest: float,
    params: RollParams, around: Surroundings, watched: Sequence[Watch],
) -> Stretches:  # fmt: skip
    """Integrate a run until its duration is over or something ends it, changing the contact where that is followed.

    ``told`` is the right-hand side as the solver calls it.
    """
    found, y, t = Stretches(), start, 0.0
    for _ in range(CHANGES):
        solved: Any = solve_ivp(
            told, (t, duration), y, method=RowByRow, rows=stops(rate.inputs, rate.ground.radius),
            rtol=SCALED * params.rtol, atol=SCALED * params.atol, max_step=longest, events=list(watched),
            dense_output=True,
        )  # fmt: skip
        found.evaluations += int(solved.nfev)
        t, y = float(solved.t[-1]), solved.y[:, -1]
        found.times.append(solved.t)
        found.solutions.append(solved.sol)
        if solved.status == 0:
            return found.end(RollStatus.FINISHED, f"all of {t:g} s")
        why = next((w for w, times in zip(watched, solved.t_events, strict=True) if len(times)), None)
        if solved.status != 1 or why is None:
            return found.end(RollStatus.ENDED, f"the surface ends or is not known further on, at t = {t:.4g} s")
        if not why.follows:
            return found.end(why.status, f"{why.what}, at t = {t:.4g} s")
        changed = _at_second(rate, around, t, y)
        if changed is None:
            return found.end(RollStatus.MET, f"it is wedged between two places, at t = {t:.4g} s")
        y = changed
        tight = next((w for w in watched if w.status is RollStatus.TIGHT and not w(t, y) > 0), None)
        if tight is not None:
            return found.end(tight.status, f"{tight.what}, at t = {t:.4g} s")
    return found.end(RollStatus.MET, f"the contact changed {CHANGES} times, at t = {t:.4g} s")


def _at_second(rate: AmbientRate, around: Surroundings, t: float, y: Numbers) -> Numbers | None:
    """Return the state at the second contact of a sphere that has two; None where it would sink into the first.

    Its pose stays, but for the event's rounding; the frame is turned by the least rotation that takes one normal to
    the other.
    """
    ground = rate.ground
    place = rate.place(y)
    z = ground.touch(place).z
    other = around.second(place, place + ground.radius * z).place
    if other is None:
        return None
    new = ground.touch(other).z
    axis, cosine = np.cross(z, new), float(z @ new)
    x = frame_of(y[7:10], z)[:, 0]
    x = x * cosine + np.cross(axis, x) + axis * (axis @ x) / max(1 + cosine, 1e-12)  # Rodrigues
    changed = np.concatenate([(other - rate.origin) / ground.radius, y[3:7], x])
    turning, slip = rate.turning(t, changed, new)
    rising = float((slip / ground.radius + np.cross(turning, new)) @ z)
    return changed if rising > RISING * max(float(np.linalg.norm(turning)), 1e-300) else None
