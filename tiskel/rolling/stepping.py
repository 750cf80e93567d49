"""The solver's steps: of Runge, Kutta, Dormand and Prince, and none goes over a row of the inputs.

Inputs are straight between their rows. A step over the kink at a row has an error
of low order, so that two of five were done in vain; one that ends there has none.
"""

from typing import Any

import numpy as np
from scipy.integrate import RK45

from tiskel.arrays import Numbers

ROUNDING = 1e-9  # of the step between rows: a step that ends nearer to one has reached it


class RowByRow(RK45):  # type: ignore[misc]
    """SciPy's RK45, for ``solve_ivp``; a step ends at the next of the times ``rows`` (k,), rising, at the latest."""

    t_bound: float

    def __init__(self, *given: Any, rows: Numbers, **options: Any) -> None:
        super().__init__(*given, **options)
        self.rows = rows

    def _step_impl(self) -> Any:
        stop = self.t_bound
        self.t_bound = self._next_stop()
        try:
            return super()._step_impl()
        finally:
            self.t_bound = stop

    def _next_stop(self) -> float:
        after = int(np.searchsorted(self.rows, self.t, side="right"))
        least = self.t + ROUNDING * self.max_step
        while after < len(self.rows) and self.rows[after] <= least:
            after += 1
        return min(self.t_bound, float(self.rows[after])) if after < len(self.rows) else self.t_bound
