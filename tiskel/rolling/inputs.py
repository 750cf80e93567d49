"""What drives the sphere: a twist that is constant, or given over time."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Numbers, Table
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.rolling.equations import Triple
from tiskel.shown import Brief

PAUSE = 10.0  # times the median step between rows: a longer one is told


@dataclass(frozen=True, eq=False, repr=False)
class Inputs(Brief):
    """omega and V over time, straight between the rows, held before the first and after the last.

    Attributes
    ----------
    t : (k,) array
        Times in seconds, rising.
    values : (k, 6) array
        omega in rad/s, then V in lengths per second.
    warnings : tuple of str
        What a user should know.

    Raises
    ------
    TiskelError
        Where a row has not six values, one that is not finite, or a time that does not rise.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import Inputs
    >>> inputs = Inputs(np.array([0.0, 2.0]), np.array([[0.0, 0, 0, 0, 0, 0], [2.0, 0, 0, 0.1, 0, 0]]))
    >>> inputs.at(1.0)
    ((1.0, 0.0, 0.0), (0.05, 0.0, 0.0))
    >>> inputs.slips
    True
    """

    _said = ("t", "slips")

    t: Numbers
    values: Table
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.values.shape != (len(self.t), 6) or len(self.t) == 0:
            raise TiskelError(f"inputs need six values at every time, got {self.values.shape} at {len(self.t)} times")
        if not (np.isfinite(self.t).all() and np.isfinite(self.values).all()):
            row = int(np.flatnonzero(~np.isfinite(np.column_stack([self.t, self.values])).all(axis=1))[0])
            raise TiskelError(f"inputs: row {row + 1} has a value missing; fill it or leave the row out")
        back = np.flatnonzero(np.diff(self.t) <= 0)
        if len(back):
            row = int(back[0])
            raise TiskelError(
                f"inputs: times must rise, row {row + 2} has t = {self.t[row + 1]:g} after {self.t[row]:g}; sort them"
            )

    def at(self, t: float) -> tuple[Triple, Triple]:
        """Return omega in rad/s and V in lengths per second at a time in seconds."""
        if len(self.t) == 1:
            w = self.values[0].tolist()
        else:
            after = min(max(int(np.searchsorted(self.t, t)), 1), len(self.t) - 1)
            step = self.t[after] - self.t[after - 1]
            share = min(max((t - self.t[after - 1]) / step, 0.0), 1.0)
            w = ((1 - share) * self.values[after - 1] + share * self.values[after]).tolist()
        return (w[0], w[1], w[2]), (w[3], w[4], w[5])

    def over(self, t: Numbers) -> Table:
        """Return omega and V (n, 6) at times (n,)."""
        return np.column_stack([np.interp(t, self.t, column) for column in self.values.T])

    @property
    def slips(self) -> bool:
        """Whether there is a slip velocity at any time."""
        return bool(self.values[:, 3:].any())

    @property
    def longest_step(self) -> float:
        """The longest step in seconds that a solver may take without missing a row."""
        return float(2 * np.median(np.diff(self.t))) if len(self.t) > 1 else np.inf


def constant(params: RollParams) -> Inputs:
    """Return the inputs that the settings hold."""
    return Inputs(np.zeros(1), np.array([[*params.omega, *params.velocity]], float))


def pauses(t: Numbers) -> tuple[str, ...]:
    """Return a warning for the longest pause between times (k,), where it is long."""
    steps = np.diff(t)
    if len(steps) < 2 or steps.max() <= PAUSE * np.median(steps):
        return ()
    row = int(steps.argmax())
    return (f"inputs: no row between t = {t[row]:g} and {t[row + 1]:g}; values there are straight in between",)


def of_the_object(turn: Table, omega: Triple, velocity: Triple) -> tuple[Triple, Triple]:
    """Return omega and V of the object relative to the sphere from those of the sphere relative to the object.

    ``turn`` (3, 3) takes the axes that these are given in to those of the contact frame.
    """
    w, v = -turn @ np.array(omega), -turn @ np.array(velocity)
    return (float(w[0]), float(w[1]), float(w[2])), (float(v[0]), float(v[1]), 0.0)
