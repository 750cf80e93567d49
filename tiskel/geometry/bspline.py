"""Smooth curves in several columns: quintic splines on even intervals, penalised, periodic if wanted.

Quintic, so that third derivatives of the skeleton curve are continuous. The
penalty is on third differences of the coefficients (Eilers and Marx, Flexible
smoothing with B-splines and penalties, Statistical Science 1996); its weight
is chosen by generalised cross-validation unless it is given.
"""

from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np
import numpy.typing as npt
from scipy.interpolate import BSpline

from tiskel.arrays import Numbers, Stack, Table

DEGREE = 5
PENALISED = 3  # differences of this order
WEIGHTS = 10.0 ** np.arange(-9, 5)  # of the penalty, tried by cross-validation
DERIVATIVES = 4  # the value and three of them


@dataclass(frozen=True, eq=False)
class BSplineCurve:
    """A spline on even intervals.

    Attributes
    ----------
    coefficients : (b, d) array
        Of the B-splines, b = intervals + 5; if periodic, the last five rows repeat the first five.
    stop : float
        v runs from 0 to it.
    periodic : bool
        Whether it closes.
    """

    coefficients: Table
    stop: float
    periodic: bool = False

    @property
    def intervals(self) -> int:
        """How many even intervals there are."""
        return len(self.coefficients) - DEGREE

    @property
    def step(self) -> float:
        """How long each of them is, in the unit of v."""
        return self.stop / self.intervals

    @cached_property
    def pieces(self) -> Stack:
        """The polynomials (intervals, 6, d) of every interval, the constant first."""
        spline = BSpline(_knots(self.intervals, self.stop), self.coefficients, DEGREE)
        starts = np.arange(self.intervals) * self.step
        return np.stack([spline(starts, nu=order) / factorial(order) for order in range(DEGREE + 1)], axis=1)

    def at(self, v: float) -> Table:
        """Return (4, d) the values at a place and three derivatives; beyond the ends the last polynomials go on."""
        if self.periodic:
            v = v % self.stop
        piece = min(max(int(v / self.step), 0), self.intervals - 1)
        return np.asarray(_powers(v - piece * self.step) @ self.pieces[piece])

    def along(self, v: Numbers) -> Stack:
        """Return (m, 4, d) the same at many places (m,)."""
        v = np.mod(v, self.stop) if self.periodic else v
        piece = np.clip((v / self.step).astype(int), 0, self.intervals - 1)
        exponents = np.maximum(np.arange(DEGREE + 1) - np.arange(DERIVATIVES)[:, None], 0)
        powers = _powers(1.0) * (v - piece * self.step)[:, None, None] ** exponents
        return np.asarray(powers @ self.pieces[piece])


def joined(splines: "list[BSplineCurve]") -> BSplineCurve:
    """Return splines on the same intervals as one with all their columns."""
    return BSplineCurve(np.concatenate([s.coefficients for s in splines], axis=1), splines[0].stop, splines[0].periodic)


def fit_bspline(
    v: Numbers,
    values: Table,
    weights: Numbers,
    intervals: int,
    stop: float,
    *,
    periodic: bool = False,
    penalty: float | None = None,
) -> BSplineCurve:
    """Return the strip nearest to values at places, all columns alike smooth.

    Parameters
    ----------
    v : (m,) array
        Places, from 0 to stop.
    values : (m, d) array
        What to fit.
    weights : (m,) array
        Of the values.
    intervals : int
        Even ones; five at least if periodic.
    stop : float
        Where the strip ends or closes.
    periodic : bool
        Whether it closes.
    penalty : float, optional
        Weight of roughness, in the mean weight of the values; None: by generalised cross-validation.

    Returns
    -------
    BSplineCurve
    """
    intervals = max(intervals, DEGREE) if periodic else max(intervals, 1)
    wrap = np.arange(intervals + DEGREE) % (intervals if periodic else intervals + DEGREE)
    basis = _basis(v, intervals, stop, wrap)
    differences = np.diff(np.eye(len(wrap)), PENALISED, axis=0) @ np.eye(wrap.max() + 1)[wrap]
    rough = differences.T @ differences
    normal = basis.T @ (weights[:, None] * basis)
    right = basis.T @ (weights[:, None] * values)
    scale = float(np.trace(normal)) / len(normal)

    def solve(weight: float) -> tuple[Table, float]:
        matrix = normal + scale * (weight * rough + 1e-12 * np.eye(len(normal)))
        solution = np.linalg.solve(matrix, right)
        freedom = float(np.trace(np.linalg.solve(matrix, normal)))
        misfit = float((weights[:, None] * (basis @ solution - values) ** 2).sum())
        return solution, misfit / max(1 - freedom / len(v), 1e-3) ** 2

    if penalty is None:
        penalty = float(min(WEIGHTS, key=lambda weight: solve(float(weight))[1]))
    return BSplineCurve(solve(penalty)[0][wrap], stop, periodic)


def _knots(intervals: int, stop: float) -> Numbers:
    return np.asarray(np.arange(-DEGREE, intervals + DEGREE + 1) * (stop / intervals))


def _basis(v: Numbers, intervals: int, stop: float, wrap: npt.NDArray[np.intp]) -> Table:
    """Return (m, b) the B-splines at places, those that are the same function added up."""
    knots = _knots(intervals, stop)
    v = np.mod(v, stop) if wrap.max() + 1 < len(wrap) else np.clip(v, 0, stop)
    every = BSpline.design_matrix(np.minimum(v, knots[-DEGREE - 1]), knots, DEGREE).toarray()  # a rounding below stop
    return np.asarray(every @ np.eye(wrap.max() + 1)[wrap])


def _powers(t: float) -> Table:
    """Return (4, 6) what turns the coefficients of a quintic into its value and three derivatives at t."""
    t2 = t * t
    t3, t4 = t2 * t, t2 * t2
    return np.array(
        [
            [1.0, t, t2, t3, t4, t4 * t],
            [0.0, 1.0, 2 * t, 3 * t2, 4 * t3, 5 * t4],
            [0.0, 0.0, 2.0, 6 * t, 12 * t2, 20 * t3],
            [0.0, 0.0, 0.0, 6.0, 24 * t, 60 * t2],
        ]
    )
