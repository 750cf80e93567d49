"""Fourier surfaces with known curves, made of splines that are exact or nearly so."""

import numpy as np

from tiskel.arrays import Points, Table
from tiskel.geometry.bspline import fit_bspline
from tiskel.surfaces.tube import V_STOP, Tube


def tube(curve: Points, series: Table, m: tuple[float, float, float] = (0, 0, 1), intervals: int = 40) -> Tube:
    """Return the surface through values of p (k, 3) and of the series (k, 2 N + 1) at even v."""
    v = np.linspace(0, V_STOP, len(curve))
    field = np.tile(np.asarray(m, float), (len(v), 1))
    axis, fixed, radii = (
        fit_bspline(v, values, np.ones(len(v)), intervals, V_STOP, penalty=1e-12) for values in (curve, field, series)
    )
    return Tube(axis, fixed, radii)


def bent_tube() -> Tube:
    """A bent tube that is neither round nor even, along a curve that is not plane."""
    v = np.linspace(0, V_STOP, 400)
    curve = np.stack([3 * np.cos(v), 2.5 * np.sin(v), 0.4 * np.sin(2 * v)], axis=1)
    series = np.stack([0.5 + 0.1 * np.sin(v), 0.03 * np.cos(v), 0.02 * v, 0.03 * np.sin(v), 0.04 + 0 * v], axis=1)
    return tube(curve, series)


def straight_tube(radius: float = 2.0, length: float = 10.0) -> Tube:
    """A round tube about the first axis."""
    v = np.linspace(0, V_STOP, 50)
    return tube(
        np.stack([length / V_STOP * v, 0 * v, 0 * v], axis=1),
        np.stack([radius + 0 * v, 0 * v, 0 * v], axis=1),
        intervals=4,
    )
