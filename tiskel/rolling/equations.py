"""The equations of rolling contact (Montana 1988; Wen et al. 2025, corrected).

Conventions. The object is fixed; z_o is the unit normal from its material to
the rolling body, sigma = 1 outside and -1 inside. (omega, V) is the twist of
the *object relative to the body* in the axes of the contact frame F = [x y z],
V at the contact. With w = (-omega_y, omega_x) and
R_psi = [[cos psi, -sin psi], [-sin psi, -cos psi]],

    M u_o' + V = R_psi M_s u_s'         K u_o' + R_psi K_s u_s' = w
    psi' = omega_z + T u_o' + T_s u_s'

where M, K, T are the forms of the object and M_s, K_s, T_s those of the body
with its outward normal; of a sphere K_s = M_s / R_s, so that u_o' follows from
(K + M / R_s) u_o' = w - V / R_s alone. Departures from print: K is not inverted,
so that planes and cylinders work; T is right (see :mod:`tiskel.surfaces.forms`);
in the local model the fifth entry of g_2, the determinant, and contact from
inside are right (:func:`local_rates`).
"""

from math import cos, sin
from typing import NamedTuple

from tiskel.surfaces.forms import Form, Forms, curvature, principal_curvatures
from tiskel.surfaces.jets import Scalar
from tiskel.surfaces.tube import Radius

Pair = tuple[Scalar, Scalar]
Triple = tuple[Scalar, Scalar, Scalar]


class Rates(NamedTuple):
    """Derivatives of the five contact coordinates, in radians per second.

    Attributes
    ----------
    u_o : float or array
        Around the object.
    v_o : float or array
        Along the object.
    u_s : float or array
        Latitude on the sphere, or u on the body.
    v_s : float or array
        Longitude on the sphere, or v on the body.
    psi : float or array
        Between both contact frames.
    """

    u_o: Scalar
    v_o: Scalar
    u_s: Scalar
    v_s: Scalar
    psi: Scalar


def object_rates(forms: Forms, radius: float, omega: Triple, velocity: Triple) -> Pair:
    """Return u_o' and v_o' of a sphere of some radius: (K + M/R_s) u_o' = w - V/R_s."""
    (m11, m12), (_, m22) = forms.M
    (k11, k12), (k21, k22) = forms.K
    a, b, c, d = k11 + m11 / radius, k12 + m12 / radius, k21, k22 + m22 / radius
    right = -omega[1] - velocity[0] / radius, omega[0] - velocity[1] / radius
    determinant = a * d - b * c
    return (d * right[0] - b * right[1]) / determinant, (a * right[1] - c * right[0]) / determinant


def travel(forms: Forms, rates: Pair) -> Pair:
    """Return M u_o': how fast the contact moves along x and y."""
    (m11, m12), (_, m22) = forms.M
    return m11 * rates[0] + m12 * rates[1], m22 * rates[1]


def frame_turn(forms: Forms, rates: Pair) -> Triple:
    """Return the angular velocity of the contact frame in its own axes: -(K u')_2, (K u')_1, T u'."""
    (k11, k12), (k21, k22) = forms.K
    u, v = rates
    return -(k21 * u + k22 * v), k11 * u + k12 * v, forms.T[0] * u + forms.T[1] * v


def sphere_rates(
    forms: Forms, radius: float, u_s: Scalar, psi: Scalar, omega: Triple, velocity: Triple
) -> Rates:  # fmt: skip
    """Return all five rates of a sphere (the global model); singular where cos u_s = 0."""
    u_o, v_o = object_rates(forms, radius, omega, velocity)
    along = travel(forms, (u_o, v_o))
    a1, a2, c, s = along[0] + velocity[0], along[1] + velocity[1], cos(psi), sin(psi)
    u_b = (c * a1 - s * a2) / radius
    v_b = -(s * a1 + c * a2) / (radius * cos(u_s))
    turn = omega[2] + forms.T[0] * u_o + forms.T[1] * v_o
    return Rates(u_o, v_o, u_b, v_b, turn - sin(u_s) * v_b)


def contact_rates(forms: Forms, body: Forms, psi: Scalar, omega: Triple, velocity: Triple) -> Rates:
    """Return all five rates of two bodies of any shape."""
    c, s = cos(psi), sin(psi)
    turn = ((c, -s), (-s, -c))  # R_psi, its own inverse
    # u_s' = M_s^-1 R_psi (M u_o' + V), put into the second equation
    k_b = _product(_product(turn, _product(body.K, _inverse(body.M))), turn)
    (m11, m12), (_, m22) = forms.M
    left = _sum(forms.K, _product(k_b, ((m11, m12), (0.0, m22))))
    right = (
        -omega[1] - k_b[0][0] * velocity[0] - k_b[0][1] * velocity[1],
        omega[0] - k_b[1][0] * velocity[0] - k_b[1][1] * velocity[1],
    )
    u_o, v_o = _times(_inverse(left), right)
    along = travel(forms, (u_o, v_o))
    u_b, v_b = _times(_inverse(body.M), _times(turn, (along[0] + velocity[0], along[1] + velocity[1])))
    psi_rate = omega[2] + forms.T[0] * u_o + forms.T[1] * v_o + body.T[0] * u_b + body.T[1] * v_b
    return Rates(u_o, v_o, u_b, v_b, psi_rate)


def local_object_rates(
    r: Radius, alpha: Scalar, sigma: float, radius: float, omega: Triple, velocity: Triple
) -> Pair:  # fmt: skip
    """Return u_o' and v_o' of the local model: straight skeleton, radius independent of v, |p'| = alpha."""
    s1, s2 = r.R**2 + r.u**2, r.R**2 - r.R * r.uu + 2 * r.u**2
    u_o = sigma * radius * s1 / (s1**1.5 + sigma * radius * s2) * (-omega[1] - velocity[0] / radius)
    return u_o, radius / alpha * (omega[0] - velocity[1] / radius)


def local_rates(
    r: Radius, alpha: Scalar, sigma: float, radius: float, u_s: Scalar, psi: Scalar, omega: Triple, velocity: Triple
) -> Rates:
    """Return all five rates of the local model."""
    s1, s2 = r.R**2 + r.u**2, r.R**2 - r.R * r.uu + 2 * r.u**2
    share = s1**1.5 / (s1**1.5 + sigma * radius * s2)
    u_o, v_o = local_object_rates(r, alpha, sigma, radius, omega, velocity)
    b1, b2 = -omega[1] + sigma * s2 / s1**1.5 * velocity[0], omega[0]
    u_b = share * cos(psi) * b1 - sin(psi) * b2
    v_b = (-share * sin(psi) * b1 - cos(psi) * b2) / cos(u_s)
    return Rates(u_o, v_o, u_b, v_b, omega[2] - sin(u_s) * v_b)


def margin(forms: Forms, radius: Scalar) -> Scalar:
    """Return lambda_min(K_o) + 1/R_s, in 1 / length: the sphere fits where it is positive."""
    return principal_curvatures(forms)[0] + 1 / radius


def controllability(forms: Forms, radius: float, u_s: Scalar) -> Scalar:
    """Return det Q = -1 / (det(K_o + I/R_s)^2 det M R_s^2 cos u_s), with spin, of any surface."""
    xx, xy, yy = curvature(forms)
    relative = (xx + 1 / radius) * (yy + 1 / radius) - xy**2
    cosine = cos(u_s) if isinstance(u_s, float) else _cos(u_s)
    return -1 / (relative**2 * forms.M[0][0] * forms.M[1][1] * radius**2 * cosine)


def _cos(angle: Scalar) -> Scalar:
    import numpy as np

    return np.cos(angle)


def _product(a: Form, b: Form) -> Form:
    return (
        (a[0][0] * b[0][0] + a[0][1] * b[1][0], a[0][0] * b[0][1] + a[0][1] * b[1][1]),
        (a[1][0] * b[0][0] + a[1][1] * b[1][0], a[1][0] * b[0][1] + a[1][1] * b[1][1]),
    )


def _sum(a: Form, b: Form) -> Form:
    return ((a[0][0] + b[0][0], a[0][1] + b[0][1]), (a[1][0] + b[1][0], a[1][1] + b[1][1]))


def _inverse(a: Form) -> Form:
    determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0]
    return (
        (a[1][1] / determinant, -a[0][1] / determinant),
        (-a[1][0] / determinant, a[0][0] / determinant),
    )


def _times(a: Form, b: Pair) -> Pair:
    return a[0][0] * b[0] + a[0][1] * b[1], a[1][0] * b[0] + a[1][1] * b[1]
