"""Surfaces with closed forms, for teaching and for tests; lengths in any unit, angles in radians."""

from dataclasses import dataclass
from math import inf, pi, tan

import numpy as np

from tiskel.surfaces.jets import Jet, Scalar

Periods = tuple[float | None, float | None]


@dataclass(frozen=True)
class Plane:
    """f = (v, u, 0); its normal f_u x f_v points down the third axis."""

    v_range = (-inf, inf)
    periods: Periods = (None, None)

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        zero, one = 0 * (u + v), 1 + 0 * (u + v)
        none = (zero, zero, zero)
        return Jet((v, u, zero), (zero, one, zero), (one, zero, zero), none, none, none)


@dataclass(frozen=True)
class EllipticCylinder:
    """f = (v, a cos u, b sin u).

    Attributes
    ----------
    a : float
        Half-axis where u = 0.
    b : float
        The other one.

    Examples
    --------
    >>> EllipticCylinder(2.0, 1.0).jet(0.0, 3.0).f == (3.0, 2.0, 0.0)
    True
    """

    a: float
    b: float
    v_range = (-inf, inf)
    periods: Periods = (2 * pi, None)

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        c, s, zero = np.cos(u), np.sin(u), 0 * (u + v)
        a, b, none = self.a, self.b, (zero, zero, zero)
        around = (zero, -a * s, b * c)
        return Jet((v, a * c, b * s), around, (1 + zero, zero, zero), (zero, -a * c, -b * s), none, none)


@dataclass(frozen=True)
class Rod:
    """A round cylinder about the first axis that ends at half its length either way.

    Attributes
    ----------
    radius : float
        Around the axis.
    length : float
        Along it.

    Examples
    --------
    >>> Rod(2.0, 3.0).v_range
    (-1.5, 1.5)
    """

    radius: float
    length: float
    periods: Periods = (2 * pi, None)

    @property
    def v_range(self) -> tuple[float, float]:
        return -self.length / 2, self.length / 2

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        return cylinder(self.radius).jet(u, v)


def cylinder(radius: float) -> EllipticCylinder:
    """Return the round cylinder about the first axis."""
    return EllipticCylinder(radius, radius)


@dataclass(frozen=True)
class Cone:
    """f = (v, v t cos u, v t sin u) with t the tangent of the half-angle; v > 0 from the apex along the axis.

    Attributes
    ----------
    half_angle : float
        In radians.
    """

    half_angle: float
    v_range = (0.0, inf)
    periods: Periods = (2 * pi, None)

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        c, s, zero, t = np.cos(u), np.sin(u), 0 * (u + v), tan(self.half_angle)
        return Jet(
            (v, v * t * c, v * t * s), (zero, -v * t * s, v * t * c), (1 + zero, t * c, t * s),
            (zero, -v * t * c, -v * t * s), (zero, -t * s, t * c), (zero, zero, zero),
        )  # fmt: skip


@dataclass(frozen=True)
class Torus:
    """A tube about a circle; u = 0 is where it looks at the centre.

    Attributes
    ----------
    bend : float
        Radius of the circle.
    tube : float
        Radius of the tube.
    """

    bend: float
    tube: float
    v_range = (-inf, inf)
    periods: Periods = (2 * pi, 2 * pi)

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        c, s, cv, sv = np.cos(u), np.sin(u), np.cos(v), np.sin(v)
        zero, r = 0 * (u + v), self.tube
        out = self.bend - r * c
        return Jet(
            (out * cv, -out * sv, -r * s), (r * s * cv, -r * s * sv, -r * c), (-out * sv, -out * cv, zero),
            (r * c * cv, -r * c * sv, r * s), (-r * s * sv, -r * s * cv, zero), (-out * cv, out * sv, zero),
        )  # fmt: skip


@dataclass(frozen=True)
class Ellipsoid:
    """f = (a cos u cos v, -b cos u sin v, c sin u), in the chart of the rolling sphere; poles at u = +-pi/2.

    Attributes
    ----------
    a : float
        First half-axis.
    b : float
        Second half-axis.
    c : float
        Third half-axis, through the poles.
    """

    a: float
    b: float
    c: float
    v_range = (-inf, inf)
    periods: Periods = (2 * pi, 2 * pi)

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        cu, su, cv, sv = np.cos(u), np.sin(u), np.cos(v), np.sin(v)
        a, b, c, zero = self.a, self.b, self.c, 0 * (u + v)
        return Jet(
            (a * cu * cv, -b * cu * sv, c * su),
            (-a * su * cv, b * su * sv, c * cu), (-a * cu * sv, -b * cu * cv, zero),
            (-a * cu * cv, b * cu * sv, -c * su), (a * su * sv, b * su * cv, zero), (-a * cu * cv, b * cu * sv, zero),
        )  # fmt: skip


def sphere(radius: float) -> Ellipsoid:
    """Return the sphere as a surface."""
    return Ellipsoid(radius, radius, radius)
