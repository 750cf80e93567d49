"""How a run is solved: duration, steps, the even grid of its rows, and why it ended; of spheres and other bodies."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from scipy.integrate import solve_ivp

from tiskel.arrays import Numbers, Table
from tiskel.params import RollParams
from tiskel.progress import Span
from tiskel.rolling.endings import Ending
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.stepping import RowByRow
from tiskel.rolling.trajectory import RollStatus

R = TypeVar("R")
USUAL_DURATION = 10.0  # seconds
STRIDE = 0.4  # radians that the body turns in a step of the solver at most: endings are looked for between steps
CLOSE = 0.08  # radians from a row of the inputs to the next but one: of closer ones the kinks are less than tolerances


@dataclass(frozen=True, eq=False)
class Solution:
    """A solved run, before its states are read.

    Attributes
    ----------
    t : (n,) array
        Times on an even grid and the end, in seconds.
    states : (n, d) array
        The integrated states at these times.
    steps : (k,) array
        Times between the solver's steps, from 0 to the end.
    at : callable
        The states (d, m) at any times (m,).
    status : RollStatus
        Why the run ended.
    reason : str
        The same as a sentence.
    evaluations : int
        Of the right-hand side.
    """

    t: Numbers
    states: Table
    steps: Numbers
    at: Callable[[Numbers], Table]
    status: RollStatus
    reason: str
    evaluations: int


def solve(
    rate: Callable[[float, Numbers], Any], start: Numbers, params: RollParams, inputs: Inputs, radius: float,
    watched: Sequence[Ending],
) -> Solution:  # fmt: skip
    """Integrate a run until its duration is over or something ends it.

    Parameters
    ----------
    rate : callable
        The derivatives of a state (d,) at a time.
    start : (d,) array
        The state to begin with.
    params : RollParams
        Tolerances, duration and rate are read.
    inputs : Inputs
        No row of theirs is stepped over.
    radius : float
        What turns slip into radians; infinite for bodies without one.
    watched : sequence of Ending
        The first of those that occur at one time is told.
    """
    solved = solve_ivp(
        rate, (0.0, duration_of(params, inputs)), start, method=RowByRow, rows=stops(inputs, radius), rtol=params.rtol,
        atol=params.atol, max_step=longest_step(inputs, radius), events=list(watched), dense_output=True,
    )  # fmt: skip
    t = even_times(float(solved.t[-1]), params.rate)
    status, reason = _ending(solved, watched)
    return Solution(t, solved.sol(t).T, solved.t, solved.sol, status, reason, int(solved.nfev))


def even_times(stop: float, rate: float) -> Numbers:
    """Return times (n,) from 0, ``rate`` of them per second, and ``stop``; none within half a step before it."""
    return np.append(np.arange(0, stop - 0.5 / rate, 1 / rate), stop)


def duration_of(params: RollParams, inputs: Inputs) -> float:
    """Return the duration asked for, else that of the inputs, else the usual one, in seconds."""
    if params.duration is not None:
        return params.duration
    return float(inputs.t[-1]) if len(inputs.t) > 1 and inputs.t[-1] > 0 else USUAL_DURATION


def longest_step(inputs: Inputs, radius: float) -> float:
    """Return the longest step in time that misses neither a row of the inputs nor a place where the run should end."""
    fastest = _fastest(inputs, radius)
    return min(inputs.longest_step, STRIDE / fastest) if fastest > 0 else inputs.longest_step


def stops(inputs: Inputs, radius: float) -> Numbers:
    """Return times (k,) at which a step of the solver has to end: rows, every second one of those close together."""
    close = len(inputs.t) > 2 and _fastest(inputs, radius) * inputs.longest_step < CLOSE
    return inputs.t[::2] if close else inputs.t


def _fastest(inputs: Inputs, radius: float) -> float:
    """Return how fast the body turns at most, in radians per second; slip counts as the radians that it takes."""
    turning, slip = (np.linalg.norm(part, axis=1) for part in np.hsplit(inputs.values, [3]))
    return float((turning + slip / radius).max())


def _ending(solved: Any, watched: Sequence[Ending]) -> tuple[RollStatus, str]:
    """Return why the solver stopped, in one word and in a sentence."""
    stop = float(solved.t[-1])
    if solved.status == 0:
        return RollStatus.FINISHED, f"all of {stop:g} s"
    for ending, times in zip(watched, solved.t_events or (), strict=False):
        if solved.status == 1 and len(times):
            return ending.status, f"{ending.what}, at t = {times[-1]:.4g} s"
    return RollStatus.STUCK, f"{solved.message}, at t = {stop:.4g} s"


def told_of(rate: Callable[[float, Numbers], R], duration: float, span: Span) -> Callable[[float, Numbers], R]:
    """Return the right-hand side, telling how much of the duration is solved, a hundred times at most."""
    reached = 0.0

    def call(t: float, y: Numbers) -> R:
        nonlocal reached
        if (share := min(1.0, t / duration)) >= reached:
            span.at(share, "motion")
            reached = share + 0.01
        return rate(t, y)

    return call
