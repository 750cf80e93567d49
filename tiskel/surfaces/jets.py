"""What every surface offers: a place and its first and second derivatives in u and v.

Vectors are tuples of three components, numbers or arrays of one shape, so that
one formula serves the right-hand side of an ODE and a whole grid.
"""

from typing import Any, NamedTuple, Protocol

Scalar = Any  # a float, or an array of any shape
Vector = tuple[Scalar, Scalar, Scalar]


class Jet(NamedTuple):
    """A surface f at (u, v): vectors in the surface's unit of length, u and v in radians or without unit.

    Attributes
    ----------
    f : Vector
        The place.
    f_u : Vector
        Its derivative in u.
    f_v : Vector
        In v.
    f_uu : Vector
        Twice in u.
    f_uv : Vector
        In both.
    f_vv : Vector
        Twice in v.
    """

    f: Vector
    f_u: Vector
    f_v: Vector
    f_uu: Vector
    f_uv: Vector
    f_vv: Vector


class ParametricSurface(Protocol):
    """A regular surface; f_u x f_v points outward, from the material.

    Attributes
    ----------
    v_range : (float, float)
        Where v lives; infinite where there is no end.
    periods : (float or None, float or None)
        Of u and v; None where it is not periodic.
    """

    @property
    def v_range(self) -> tuple[float, float]: ...

    @property
    def periods(self) -> tuple[float | None, float | None]: ...

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        """Return place and derivatives; u and v are numbers, or arrays of one shape."""


def dot(a: Vector, b: Vector) -> Scalar:
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def scaled(a: Vector, factor: Scalar) -> Vector:
    """Return a vector times a number."""
    return factor * a[0], factor * a[1], factor * a[2]


def plus(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def combined(basis: tuple[Vector, Vector, Vector], parts: Vector) -> Vector:
    """Return the vector that has these parts along a basis."""
    (a, b, c), (x, y, z) = basis, parts
    return x * a[0] + y * b[0] + z * c[0], x * a[1] + y * b[1] + z * c[1], x * a[2] + y * b[2] + z * c[2]
