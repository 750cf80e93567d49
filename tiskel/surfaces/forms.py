"""The contact frame of a surface and its forms (Montana, The kinematics of contact and grasp, IJRR 1988).

z is the normal from the material to the other body, x along f_u; M is the
metric, K the curvature form and T the torsion form in coordinates: a contact
that moves by (du, dv) moves by M (du, dv) along (x, y), the normal turns by
K (du, dv), the frame about the normal by T (du, dv). Departures from Wen et al.
2025: T is y.[x_u x_v] (in print a row of K stands there), and the place of the
contact has the skeleton's point in it.
"""

from typing import NamedTuple

import numpy as np

from tiskel.arrays import Table
from tiskel.surfaces.jets import Jet, ParametricSurface, Scalar, Vector, cross, dot, scaled

Form = tuple[tuple[Scalar, Scalar], tuple[Scalar, Scalar]]


class Forms(NamedTuple):
    """Frame and forms at a place of a surface (Montana 1988).

    Attributes
    ----------
    x : Vector
        Unit vector along f_u.
    y : Vector
        z x x.
    z : Vector
        Unit normal from the material to the other body.
    M : Form
        Metric, upper triangular, in length per unit of u and v.
    K : Form
        Curvature form, in radians per unit of u and v.
    T : (Scalar, Scalar)
        Torsion form, in radians per unit of u and v.
    """

    x: Vector
    y: Vector
    z: Vector
    M: Form
    K: Form
    T: tuple[Scalar, Scalar]


def forms_of(jet: Jet, sigma: float = 1.0) -> Forms:
    """Return frame and forms; sigma is 1 for the normal f_u x f_v, -1 for contact from inside."""
    normal = cross(jet.f_u, jet.f_v)
    length_u = dot(jet.f_u, jet.f_u) ** 0.5
    x, z = scaled(jet.f_u, sigma / length_u), scaled(normal, sigma / dot(normal, normal) ** 0.5)
    y = cross(z, x)
    m11, m12, m22 = dot(x, jet.f_u), dot(x, jet.f_v), dot(y, jet.f_v)
    uu, uv, vv = dot(z, jet.f_uu), dot(z, jet.f_uv), dot(z, jet.f_vv)  # the second fundamental form
    k11, k12 = -uu / m11, -uv / m11
    k21, k22 = (-uv - m12 * k11) / m22, (-vv - m12 * k12) / m22  # K = -M^-T II
    torsion = sigma * dot(y, jet.f_uu) / length_u, sigma * dot(y, jet.f_uv) / length_u
    return Forms(x, y, z, ((m11, m12), (0 * m11, m22)), ((k11, k12), (k21, k22)), torsion)


def curvature(forms: Forms) -> tuple[Scalar, Scalar, Scalar]:
    """Return xx, xy and yy of K_o = K M^-1, the shape operator in (x, y), in 1 / length; positive where convex."""
    (m11, m12), (_, m22) = forms.M
    (k11, _), (k21, k22) = forms.K
    return k11 / m11, k21 / m11, (k22 - k21 * m12 / m11) / m22


def principal_curvatures(forms: Forms) -> tuple[Scalar, Scalar]:
    """Return the smaller and the larger eigenvalue of K_o, in 1 / length.

    Examples
    --------
    >>> from tiskel.surfaces.analytic import Torus
    >>> low, high = principal_curvatures(forms_of(Torus(5.0, 2.0).jet(0.0, 0.0)))
    >>> f"{low:.4f} {high:.4f}"
    '-0.3333 0.5000'
    """
    xx, xy, yy = curvature(forms)
    mean, spread = (xx + yy) / 2, (((xx - yy) / 2) ** 2 + xy**2) ** 0.5
    return mean - spread, mean + spread


def frame_at(surface: ParametricSurface, sigma: float, u: float, v: float) -> Table:
    """Return the contact frame (3, 3), x, y and z as columns."""
    return np.asarray(np.array(forms_of(surface.jet(u, v), sigma)[:3], float).T)
