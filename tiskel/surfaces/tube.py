"""The Fourier surface around a skeleton curve: f_o(u, v) = p(v) + R(u, v) (cos u y + sin u z).

Wen et al. 2025, with closed forms for all first and second derivatives. The
frame is x = p'/|p'|, y = (x x m)/|x x m|, z = x x y for a field m(v), which may
be constant; R(u) = a0 + sum a_i sin(i u) + b_i cos(i u) with coefficients that
are smooth in v. Components are along (x, e_r, e_u), where e_r = cos u y + sin u z
and e_u = -sin u y + cos u z.
"""

import cmath
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any, NamedTuple

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.geometry.bspline import BSplineCurve, joined
from tiskel.geometry.frames import step_lengths
from tiskel.surfaces.jets import Jet, Scalar, Vector, combined, cross, dot, plus, scaled

V_STOP = pi  # v runs from 0 to pi along the skeleton curve


class Moving(NamedTuple):
    """The moving frame at a place of the skeleton curve, and how it turns.

    Attributes
    ----------
    p : Vector
        The place.
    l : Scalar
        |p'|.
    x : Vector
        Along the curve.
    y : Vector
        Where u is 0.
    z : Vector
        x x y.
    l_v : Scalar
        l'.
    w : (Scalar, Scalar, Scalar)
        y'.z, -x'.z and x'.y, per unit of v.
    w_v : (Scalar, Scalar, Scalar)
        Their derivatives.
    """

    p: Vector
    l: Scalar  # noqa: E741
    x: Vector
    y: Vector
    z: Vector
    l_v: Scalar
    w: tuple[Scalar, Scalar, Scalar]
    w_v: tuple[Scalar, Scalar, Scalar]


class Radius(NamedTuple):
    """R at (u, v) and its derivatives, lengths per powers of a radian.

    Attributes
    ----------
    R : Scalar
        The radius.
    u : Scalar
        Its derivative in u.
    v : Scalar
        In v.
    uu : Scalar
        Twice in u.
    uv : Scalar
        In both.
    vv : Scalar
        Twice in v.
    """

    R: Scalar
    u: Scalar
    v: Scalar
    uu: Scalar
    uv: Scalar
    vv: Scalar


@dataclass(frozen=True, eq=False)
class Tube:
    """A Fourier surface; lengths in the unit of the cloud.

    Attributes
    ----------
    axis : BSplineCurve
        p(v), three columns; all splines are on the same intervals.
    field : BSplineCurve
        m(v), three columns.
    series : BSplineCurve
        a0, then a_i and b_i in pairs, 2 N + 1 columns.
    """

    axis: BSplineCurve
    field: BSplineCurve
    series: BSplineCurve

    @property
    def closed(self) -> bool:
        """Whether the skeleton curve is a loop."""
        return self.axis.periodic

    @property
    def v_range(self) -> tuple[float, float]:
        return (-np.inf, np.inf) if self.closed else (0.0, V_STOP)

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return 2 * pi, V_STOP if self.closed else None

    @cached_property
    def _strip(self) -> BSplineCurve:
        return joined([self.axis, self.field, self.series])

    def at(self, u: Scalar, v: Scalar) -> tuple[Moving, Radius]:
        """Return frame and radius at numbers u and v, or at arrays of one shape."""
        if np.ndim(v) == 0 and np.ndim(u) == 0:
            rows: list[Any] = self._strip.at(float(v)).tolist()
            p, m = ([tuple(row[i : i + 3]) for row in rows] for i in (0, 3))
            return moving_frame(p, m), radius_of([row[6:] for row in rows], cmath.exp(1j * u))
        u, v = np.broadcast_arrays(u, v)
        every = np.moveaxis(self._strip.along(v.ravel()), 0, 2).reshape(4, -1, *v.shape)
        p, m = ([tuple(row[i : i + 3]) for row in every] for i in (0, 3))
        return moving_frame(p, m), radius_of([row[6:] for row in every], np.exp(1j * u))

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        """Return place and derivatives; see :class:`tiskel.surfaces.jets.ParametricSurface`."""
        frame, r = self.at(u, v)
        c, s = np.cos(u), np.sin(u)
        e_r, e_u = plus(scaled(frame.y, c), scaled(frame.z, s)), plus(scaled(frame.y, -s), scaled(frame.z, c))
        (w1, w2, w3), (w1_v, w2_v, w3_v) = frame.w, frame.w_v
        a, b, a_v = w3 * c - w2 * s, w3 * s + w2 * c, w3_v * c - w2_v * s
        h, h_v = frame.l - r.R * a, frame.l_v - r.v * a - r.R * a_v
        zero = 0 * h
        parts = (
            (zero, r.u, r.R),
            (h, r.v, r.R * w1),
            (zero, r.uu - r.R, 2 * r.u),
            (r.R * b - r.u * a, r.uv - r.R * w1, r.v + r.u * w1),
            (h_v - r.v * a + r.R * w1 * b, h * a + r.vv - r.R * w1 * w1, -h * b + 2 * r.v * w1 + r.R * w1_v),
        )
        f = plus(frame.p, scaled(e_r, r.R))
        return Jet(f, *(combined((frame.x, e_r, e_u), part) for part in parts))

    def spread(self, u: Scalar, v: Scalar) -> Scalar:
        """Return h / |p'|, how far apart slices are there, in their distance along the curve; 0 where they cross."""
        frame, r = self.at(u, v)
        _, w2, w3 = frame.w
        return 1 - r.R * (w3 * np.cos(u) - w2 * np.sin(u)) / frame.l

    def length(self, places: int = 400) -> float:
        """Return the length of the skeleton curve."""
        return float(step_lengths(self.curve(np.linspace(0, V_STOP, places))).sum())

    def curve(self, v: Numbers) -> Points:
        """Return (m, 3) places on the skeleton curve."""
        return self.axis.along(v)[:, 0]


def moving_frame(p: "list[Vector]", m: "list[Vector]") -> Moving:
    """Return the frame from p and m with derivatives up to the third (of m the second): its turns, exactly."""
    _, p1, p2, p3 = p
    l = dot(p1, p1) ** 0.5  # noqa: E741
    x = scaled(p1, 1 / l)
    l_v = dot(p2, x)
    x_v = scaled(plus(p2, scaled(x, -l_v)), 1 / l)
    l_vv = dot(p3, x) + dot(p2, x_v)
    x_vv = scaled(plus(p3, plus(scaled(x_v, -2 * l_v), scaled(x, -l_vv))), 1 / l)
    n = cross(x, m[0])
    n_v = plus(cross(x_v, m[0]), cross(x, m[1]))
    n_vv = plus(plus(cross(x_vv, m[0]), scaled(cross(x_v, m[1]), 2)), cross(x, m[2]))
    size = dot(n, n) ** 0.5
    y = scaled(n, 1 / size)
    z = cross(x, y)
    w1, w2, w3 = dot(n_v, z) / size, -dot(x_v, z), dot(x_v, y)
    z_v = plus(scaled(y, -w1), scaled(x, w2))
    w1_v = (dot(n_vv, z) + dot(n_v, z_v) - w1 * dot(n, n_v) / size) / size
    w2_v = -dot(p3, z) / l - 2 * w2 * l_v / l + w1 * w3
    w3_v = dot(p3, y) / l - 2 * w3 * l_v / l - w1 * w2
    return Moving(p[0], l, x, y, z, l_v, (w1, w2, w3), (w1_v, w2_v, w3_v))


def radius_of(rows: "list[list[Scalar]]", turn: Scalar) -> Radius:
    """Return R and its derivatives from the coefficients with two derivatives in v, and e^(iu)."""
    (r, r_u, r_uu), (r_v, r_uv, _), (r_vv, _, _) = (_series(row, turn) for row in rows[:3])
    return Radius(r, r_u, r_v, r_uu, r_uv, r_vv)


def _series(row: "list[Scalar]", turn: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Return a0 + sum a_i sin(i u) + b_i cos(i u) and two derivatives in u, by Horner's rule in e^(iu)."""
    value = first = second = 0 * turn
    for i in range(len(row) // 2, 0, -1):
        c = row[2 * i] - 1j * row[2 * i - 1]
        value, first, second = (value + c) * turn, (first + i * c) * turn, (second + i * i * c) * turn
    return row[0] + value.real, -first.imag, -second.real
