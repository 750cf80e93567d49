"""Surfaces given by a function that is negative in the material and positive outside, with two derivatives.

Nothing here needs a chart. With f the function, n = grad f / |grad f| and
P = I - n n^T, the shape operator of the surface f = 0 is S = P Hess(f) P / |grad f|,
symmetric, zero along n, and positive where the body is convex (Goldman,
Curvature formulas for implicit curves and surfaces, CAGD 2005).
"""

from typing import NamedTuple, Protocol

import numpy as np

from tiskel.arrays import TINY, Numbers, Points, Stack

ROUNDS = 30  # steps to the surface; from nearby three or four do
ENOUGH = 1e-13  # of the largest coordinate: a step that is shorter is rounding


class LevelSet(NamedTuple):
    """A function at n points, in the surface's unit of length.

    Attributes
    ----------
    value : (n,) float64
        Negative in the material; near the surface the signed distance to first order where the gradient is a unit.
    gradient : (n, 3) float64
        Towards the outside.
    hessian : (n, 3, 3) float64
        Symmetric.
    """

    value: Numbers
    gradient: Points
    hessian: Stack


class ImplicitSurface(Protocol):
    """A closed surface without chart; joints and ends are places like others."""

    def level(self, points: Points) -> LevelSet:
        """Return function, gradient and Hessian at points (n, 3); NaN where the surface knows nothing."""


class Tangency(NamedTuple):
    """A surface at n places on it.

    Attributes
    ----------
    place : (n, 3) float64
        On the surface.
    normal : (n, 3) float64
        Unit vectors out of the material.
    shape : (n, 3, 3) float64
        Shape operators in ambient axes, in 1 / length; positive where convex.
    """

    place: Points
    normal: Points
    shape: Stack


def tangency(surface: ImplicitSurface, places: Points) -> Tangency:
    """Return normals and shape operators at places (n, 3) of the surface.

    Examples
    --------
    The unit sphere has the shape operator I - n n^T.

    >>> class Sphere:
    ...     def level(self, points):
    ...         far = np.linalg.norm(points, axis=1)
    ...         n = points / far[:, None]
    ...         flat = np.eye(3) - n[:, :, None] * n[:, None, :]
    ...         return LevelSet(far - 1, n, flat / far[:, None, None])
    >>> np.linalg.eigvalsh(tangency(Sphere(), np.array([[0.0, 0.6, 0.8]])).shape).round(12).tolist()
    [[0.0, 1.0, 1.0]]
    """
    _, gradient, hessian = surface.level(places)
    slope = np.linalg.norm(gradient, axis=1)
    normal = gradient / np.maximum(slope, TINY)[:, None]
    flat = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    return Tangency(places, normal, flat @ hessian @ flat / np.maximum(slope, TINY)[:, None, None])


def projected(surface: ImplicitSurface, points: Points) -> Points:
    """Return where points (n, 3) come to along the gradient, by Newton's method on f along it.

    From points on the surface but for rounding or an integrator's error this is
    the nearest place to second order of that error; NaN where the surface knows nothing.
    """
    places = np.array(points, dtype=float)
    scale = max(float(np.abs(places).max(initial=0.0)), TINY)
    for _ in range(ROUNDS):
        value, gradient, _ = surface.level(places)
        step = gradient * (value / np.maximum((gradient**2).sum(axis=1), TINY))[:, None]
        places = places - step
        if not np.nanmax(np.abs(step), initial=0.0) > ENOUGH * scale:
            break
    return places
