"""Steps of the solver: none goes over a row of the inputs, and so none is done in vain."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tiskel.params import RollParams
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.roll_on import roll_on
from tiskel.rolling.solution import stops
from tiskel.rolling.stepping import RowByRow
from tiskel.surfaces.implicit_bodies import Capsule

ROWS = np.array([0.0, 0.3, 0.31, 1.0, 1.0 + 1e-13, 2.0])


def test_steps_end_at_rows_and_polygons_are_integrated_exactly() -> None:
    """The area under a polygon, piece by piece a parabola, which the solver's order has exactly."""
    values = np.array([0.0, 2.0, -1.0, 5.0, 5.0, 0.0])
    solved = solve_ivp(
        lambda t, y: [np.interp(t, ROWS, values)], (0, 2.5), [0.0], method=RowByRow, rows=ROWS, max_step=0.6, rtol=1e-3
    )
    assert solved.status == 0
    assert np.abs(solved.t[:, None] - ROWS).min(axis=0).max() < 1e-12
    assert np.diff(solved.t).min() > 1e-6  # no step of its own for rows that rounding parts
    assert solved.t[-1] == 2.5
    assert solved.y[0, -1] == pytest.approx(np.trapezoid(values, ROWS), rel=1e-14)


def test_rows_close_together_are_passed_in_twos() -> None:
    for gap, every in ((0.1, 1), (0.01, 2)):
        t = np.arange(0, 1, gap)
        inputs = Inputs(t, np.tile([1.0, 0, 0, 0, 0, 0], (len(t), 1)))
        np.testing.assert_array_equal(stops(inputs, np.inf), t[::every])


def test_wavy_inputs_cost_no_more_than_one_step_a_row() -> None:
    """Ten rows a second: a step over their kinks was refused two times of five, with 3680 evaluations in all."""
    t = np.linspace(0, 10, 101)
    inputs = Inputs(t, np.column_stack([np.sin(t), np.cos(2 * t), 0.3 * np.sin(3 * t), *np.zeros((3, 101))]))
    r = roll_on(Capsule((-1, 0, 0), (1, 0, 0), 0.5), RollParams(radius=0.125, start_at=(0, 0, 0.5)), inputs)
    assert r.evaluations < 14 * (len(t) - 1)
    assert r.path_object == pytest.approx(r.path_sphere, rel=1e-6)
