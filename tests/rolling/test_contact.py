"""The equations of rolling contact: ROLLING invariants, closed forms, and mutations that must fail."""

from dataclasses import replace
from math import cos, pi, sin, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference.tubes import bent_tube, straight_tube
from tiskel.rolling.equations import (
    Rates,
    contact_rates,
    controllability,
    local_rates,
    object_rates,
    sphere_rates,
    travel,
)
from tiskel.rolling.models import straightened
from tiskel.rolling.sphere import chart_frame, chart_of, orientation
from tiskel.surfaces.analytic import Cone, Ellipsoid, EllipticCylinder, Plane, Torus, cylinder, sphere
from tiskel.surfaces.forms import Forms, curvature, forms_of, principal_curvatures
from tiskel.surfaces.jets import ParametricSurface
from tiskel.surfaces.tube import Tube

BENT = bent_tube()
SURFACES: dict[str, ParametricSurface] = {
    "plane": Plane(), "cylinder": cylinder(2.0), "elliptic": EllipticCylinder(2.0, 1.5), "cone": Cone(0.3),
    "sphere": sphere(2.0), "torus": Torus(5.0, 2.0), "ellipsoid": Ellipsoid(2.0, 3.0, 1.8), "fitted": BENT,
}  # fmt: skip
angles = st.floats(-3.0, 3.0)
moderate = st.floats(-0.9, 0.9)
triples = st.tuples(moderate, moderate, moderate)
STEP = 1e-5  # of central differences along the flow: errors of 1e-10 times third derivatives


def place(name: str, u: float, v: float) -> tuple[float, float]:
    """Keep away from apex, poles and ends."""
    low, high = {"cone": (3.0, 6.0), "fitted": (0.4, 2.7)}.get(name, (-3.0, 3.0))
    share = (v + 3) / 6
    return (0.3 * u if name in ("sphere", "ellipsoid") else u), low + share * (high - low)


def advanced(state: Rates, rates: Rates, step: float) -> Rates:
    return Rates(*(a + step * b for a, b in zip(state, rates, strict=True)))


def pose(surface: ParametricSurface, sigma: float, radius: float, state: Rates) -> tuple[np.ndarray, np.ndarray]:
    """Return Q and c of a state."""
    forms = forms_of(surface.jet(state.u_o, state.v_o), sigma)
    frame = np.array(forms[:3], float).T
    centre = np.array(surface.jet(state.u_o, state.v_o).f, float) + radius * frame[:, 2]
    return orientation(frame, state.u_s, state.v_s, state.psi), centre


def recovered_twist(
    surface: ParametricSurface, sigma: float, radius: float, state: Rates, rates: Rates
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Return omega and V of the object relative to the sphere, by differentiating the sphere's pose."""
    (q1, c1), (q0, c0) = (pose(surface, sigma, radius, advanced(state, rates, side * STEP)) for side in (1, -1))
    q, centre = pose(surface, sigma, radius, state)
    frame = np.array(forms_of(surface.jet(state.u_o, state.v_o), sigma)[:3], float).T
    spin = (q1 - q0) / (2 * STEP) @ q.T
    turning = np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]]) / 2
    contact = np.array(surface.jet(state.u_o, state.v_o).f, float)
    material = (c1 - c0) / (2 * STEP) + np.cross(turning, contact - centre)
    return -frame.T @ turning, -frame.T @ material


def fitting(name: str, sigma: float, forms: Forms) -> bool:
    return sigma > 0 or (name not in ("plane",) and float(principal_curvatures(forms)[0]) + 1 / RADIUS > 0.3)


RADIUS = 0.3


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("sigma", [1.0, -1.0])
@settings(max_examples=12, deadline=None)
@given(angles, angles, moderate, angles, angles, triples, moderate, moderate)
def test_the_pose_moves_by_the_twist_that_was_given(
    name: str, sigma: float, u: float, v: float, u_s: float, v_s: float, psi: float,
    omega: tuple[float, float, float], slip_x: float, slip_y: float,
) -> None:  # fmt: skip
    """The strongest single test: rebuild the pose, differentiate it along the flow, recover (omega, V).

    A copy of the printed torsion, a wrong side or a wrong sign of slip fails it.
    """
    surface, velocity = SURFACES[name], (slip_x, slip_y, 0.0)
    u, v = place(name, u, v)
    forms = forms_of(surface.jet(u, v), sigma)
    state = Rates(u, v, u_s, v_s, psi)
    rates = sphere_rates(forms, RADIUS, u_s, psi, omega, velocity)
    found = recovered_twist(surface, sigma, RADIUS, state, rates)
    # Central differences of step 1e-5 have rounding errors of 1e-16 * 5 / 1e-5 = 5e-11, and truncation below 1e-9.
    np.testing.assert_allclose(found[0], omega, atol=1e-8)
    np.testing.assert_allclose(found[1], velocity, atol=1e-8)


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=10, deadline=None)
@given(angles, angles, moderate, angles, triples, moderate, moderate)
def test_slip_is_the_difference_of_the_two_contact_velocities(
    name: str, u: float, v: float, u_s: float, psi: float, omega: tuple[float, float, float], x: float, y: float
) -> None:
    """R_psi M_s u_s' - M u_o' = V; without slip both contact paths are equally fast."""
    forms = forms_of(SURFACES[name].jet(*place(name, u, v)), 1.0)
    for velocity in ((x, y, 0.0), (0.0, 0.0, 0.0)):
        rates = sphere_rates(forms, RADIUS, u_s, psi, omega, velocity)
        moved = np.array([RADIUS * rates.u_s, RADIUS * cos(u_s) * rates.v_s])
        turn = np.array([[cos(psi), -sin(psi)], [-sin(psi), -cos(psi)]])
        over = np.array(travel(forms, rates[:2]), float)
        np.testing.assert_allclose(turn @ moved - over, velocity[:2], atol=1e-12)


@pytest.mark.parametrize("name", ["elliptic", "cone", "torus", "ellipsoid", "fitted"])
@settings(max_examples=10, deadline=None)
@given(angles, angles, moderate, angles, triples)
def test_geodesic_curvatures_and_spin_cancel(
    name: str, u: float, v: float, u_s: float, psi: float, omega: tuple[float, float, float]
) -> None:
    """kappa_s + kappa_o + omega_z / s' = 0, each curvature from places three small steps apart."""
    surface = SURFACES[name]
    u, v = place(name, u, v)
    forms = forms_of(surface.jet(u, v), 1.0)
    rates = sphere_rates(forms, RADIUS, u_s, psi, omega, (0.0, 0.0, 0.0))
    speed = float(np.hypot(*travel(forms, rates[:2])))
    if speed < 0.05:
        return
    state, step = Rates(u, v, u_s, 0.0, psi), 1e-3
    # Along the true flow, to second order: the rates a half step away.
    ends = []
    for side in (1, -1):
        half = advanced(state, rates, side * step / 2)
        there = sphere_rates(
            forms_of(surface.jet(half.u_o, half.v_o), 1.0), RADIUS, half.u_s, half.psi, omega, (0.0, 0.0, 0.0)
        )
        ends.append(advanced(state, there, side * step))

    def geodesic(body: ParametricSurface, places: list[tuple[float, float]], normal: np.ndarray) -> float:
        a, b, c = (np.array(body.jet(*one).f, float) for one in places)
        first, second = (c - a) / (2 * step), (c - 2 * b + a) / step**2
        return float(np.cross(normal, first) @ second / (first @ first) ** 1.5)

    over = geodesic(surface, [ends[1][:2], (u, v), ends[0][:2]], np.array(forms.z, float))
    ball = sphere(RADIUS)
    on_ball = geodesic(ball, [ends[1][2:4], (u_s, 0.0), ends[0][2:4]], chart_frame(u_s, 0.0)[:, 2])
    # Second differences of step 1e-3: relative errors of 1e-6 times fourth derivatives, and curvatures up to 20.
    assert on_ball + over + omega[2] / speed == pytest.approx(0, abs=2e-3 * (1 + abs(over) + abs(on_ball)))


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("sigma", [1.0, -1.0])
def test_the_shape_operator_is_symmetric_and_its_determinant_the_gaussian_curvature(name: str, sigma: float) -> None:
    u, v = place(name, 0.7, 0.4)
    jet = SURFACES[name].jet(u, v)
    forms = forms_of(jet, sigma)
    m, k = np.array(forms.M, float), np.array(forms.K, float)
    operator = k @ np.linalg.inv(m)
    assert operator[0, 1] == pytest.approx(operator[1, 0], abs=1e-12)
    first = np.array([[np.dot(a, b) for b in (jet.f_u, jet.f_v)] for a in (jet.f_u, jet.f_v)], float)
    second = np.array([[np.dot(forms.z, jet.f_uu), np.dot(forms.z, jet.f_uv)]] * 2, float)
    second[1] = [np.dot(forms.z, jet.f_uv), np.dot(forms.z, jet.f_vv)]
    gaussian = np.linalg.det(second) / np.linalg.det(first)
    assert np.linalg.det(operator) == pytest.approx(gaussian, abs=1e-12)
    xx, xy, yy = curvature(forms)
    np.testing.assert_allclose([[xx, xy], [xy, yy]], operator, atol=1e-12)


def test_principal_curvatures_of_known_surfaces() -> None:
    """A torus of tube 2 and bend 5 at its inner equator, u = 0: 1/2 and -1/3."""
    assert principal_curvatures(forms_of(sphere(2.0).jet(0.2, 1.0))) == pytest.approx((0.5, 0.5))
    assert principal_curvatures(forms_of(sphere(2.0).jet(0.2, 1.0), -1.0)) == pytest.approx((-0.5, -0.5))
    assert principal_curvatures(forms_of(Torus(5.0, 2.0).jet(0.0, 1.0))) == pytest.approx((-1 / 3, 0.5))
    assert principal_curvatures(forms_of(cylinder(4.0).jet(0.3, 1.0))) == pytest.approx((0.0, 0.25), abs=1e-15)


def test_reversed_and_doubled_twists() -> None:
    forms = forms_of(BENT.jet(0.7, 1.2))
    omega, velocity = (0.4, -0.8, 0.3), (0.1, -0.2, 0.0)
    once = np.array(sphere_rates(forms, RADIUS, 0.2, 0.5, omega, velocity))
    for factor in (-1.0, 2.0):
        times = [tuple(factor * w for w in part) for part in (omega, velocity)]
        np.testing.assert_allclose(sphere_rates(forms, RADIUS, 0.2, 0.5, *times), factor * once, rtol=1e-13)  # type: ignore[arg-type]


def test_lengths_scale() -> None:
    """Everything ten times as large, slip too: the same angles per second."""
    small, large = EllipticCylinder(2.0, 1.5), EllipticCylinder(20.0, 15.0)
    one = sphere_rates(forms_of(small.jet(0.7, 0.3)), 0.3, 0.2, 0.5, (0.4, -0.8, 0.3), (0.1, -0.2, 0.0))
    other = sphere_rates(forms_of(large.jet(0.7, 3.0)), 3.0, 0.2, 0.5, (0.4, -0.8, 0.3), (1.0, -2.0, 0.0))
    np.testing.assert_allclose(np.array(other) / [1, 10, 1, 1, 1], one, rtol=1e-12)


def test_rates_do_not_depend_on_m_or_on_how_the_object_lies() -> None:
    """The contact moves and spins alike; only the names of the angles u_o and psi change with m."""
    turned = replace(BENT, field=replace(BENT.field, coefficients=BENT.field.coefficients @ ROTATION.T),
                     axis=replace(BENT.axis, coefficients=BENT.axis.coefficients @ ROTATION.T))  # fmt: skip
    one, other = (sphere_rates(forms_of(t.jet(0.7, 1.2)), 0.3, 0.2, 0.5, (0.4, 0.8, 0.3), (0.0, 0.0, 0.0))
                  for t in (BENT, turned))  # fmt: skip
    np.testing.assert_allclose(one, other, rtol=1e-10)
    tilted = replace(
        BENT, field=replace(BENT.field, coefficients=np.tile([0.2, 0.1, 1.0], (len(BENT.field.coefficients), 1)))
    )
    where = np.array(BENT.jet(0.7, 1.2).f)
    frame = tilted.at(0.0, 1.2)[0]
    off = where - np.array(frame.p)
    u = float(np.arctan2(off @ np.array(frame.z), off @ np.array(frame.y)))
    # The series runs in u, so that the same surface has another series: compare a round one.
    round_one, round_other = (replace(t, series=replace(t.series, coefficients=np.tile([0.5, 0, 0], (45, 1))))
                              for t in (BENT, tilted))  # fmt: skip
    speeds = []
    for surface, angle in ((round_one, 0.7), (round_other, u)):
        forms = forms_of(surface.jet(angle, 1.2))
        frame_of = np.array(forms[:3], float).T
        world = frame_of.T @ np.array([0.3, -0.2, 0.5])  # the same turn of the object in fixed axes
        rates = object_rates(forms, 0.3, (world[0], world[1], world[2]), (0.0, 0.0, 0.0))
        speeds.append(frame_of[:, :2] @ np.array(travel(forms, rates), float))
    np.testing.assert_allclose(speeds[0], speeds[1], atol=1e-9)


ROTATION = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
ROTATION *= np.linalg.det(ROTATION)


@pytest.mark.parametrize("sigma", [1.0, -1.0])
def test_closed_forms_of_cylinder_and_torus(sigma: float) -> None:
    omega, none = (0.7, 0.4, 0.0), (0.0, 0.0, 0.0)
    u, v = object_rates(forms_of(cylinder(2.0).jet(0.4, 1.0), sigma), 0.5, omega, none)
    assert u == pytest.approx(-sigma * 0.5 * 0.4 / (2.0 + sigma * 0.5), abs=1e-14)
    assert v == pytest.approx(0.5 * 0.7, abs=1e-14)
    u, v = object_rates(forms_of(Torus(5.0, 2.0).jet(0.4, 1.0), sigma), 0.5, omega, none)
    assert u == pytest.approx(-sigma * 0.5 * 0.4 / (2.0 + sigma * 0.5), abs=1e-14)
    assert v == pytest.approx(0.5 * 0.7 / (5.0 - (2.0 + sigma * 0.5) * cos(0.4)), abs=1e-14)


def test_closed_form_of_a_plane() -> None:
    """A ball on a plane runs at R_s omega; f = (v, u), x along u: u' = -R_s omega_y, v' = R_s omega_x."""
    rates = object_rates(forms_of(Plane().jet(0.4, 1.0)), 0.5, (0.7, 0.4, 0.9), (0.0, 0.0, 0.0))
    forms = forms_of(Plane().jet(0.4, 1.0))
    np.testing.assert_allclose(travel(forms, rates), (-0.5 * 0.4, 0.5 * 0.7), atol=1e-15)


def test_closed_form_of_a_cone() -> None:
    """Around a cone the curvature is cos(half-angle) / radius; along it there is none."""
    half, v = 0.3, 4.0
    forms = forms_of(Cone(half).jet(0.4, v))
    along = travel(forms, object_rates(forms, 0.5, (0.7, 0.4, 0.0), (0.0, 0.0, 0.0)))
    around = cos(half) / (v * tan(half))
    np.testing.assert_allclose(along, (-0.4 / (around + 2.0), 0.7 * 0.5), rtol=1e-13)


def test_a_ball_on_a_ball_runs_along_a_loxodrome() -> None:
    """(1/R + 1/R_s) M u' = w: constant speed at a constant angle to the frame, on a sphere of radius 2."""
    for u in (-0.8, 0.1, 0.9):
        forms = forms_of(sphere(2.0).jet(u, 0.7))
        along = travel(forms, object_rates(forms, 0.5, (0.7, 0.4, 0.0), (0.0, 0.0, 0.0)))
        np.testing.assert_allclose(along, (-0.4 / 2.5, 0.7 / 2.5), rtol=1e-13)


def test_a_tunnel_seen_from_inside() -> None:
    """R = 2, R_s = 0.5, omega_y = 1: u' = +1/3, where the printed formula gives -0.2."""
    tunnel = straight_tube(2.0)
    u = object_rates(forms_of(tunnel.jet(0.3, 1.0), -1.0), 0.5, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0))[0]
    assert u == pytest.approx(1 / 3, abs=1e-9)
    frame, r = tunnel.at(0.3, 1.0)
    local = local_rates(r, frame.l, -1.0, 0.5, 0.1, 0.2, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0))
    assert local.u_o == pytest.approx(1 / 3, abs=1e-9)


def test_twice_as_sharp_bends_of_the_local_model_are_its_known_error() -> None:
    """On a cone of half-angle 10 degrees the local model is 1 / cos = 1.5 % fast along the axis."""
    half = np.radians(10)
    forms = forms_of(Cone(half).jet(0.4, 4.0))
    v = object_rates(forms, 0.5, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))[1]
    assert 0.5 / v == pytest.approx(1 / cos(half), rel=1e-12)
    assert 1 / cos(half) == pytest.approx(1.0154, abs=1e-4)


@pytest.mark.parametrize("sigma", [1.0, -1.0])
@settings(max_examples=25, deadline=None)
@given(angles, st.floats(0.4, 2.7), moderate, angles, triples, moderate, moderate)
def test_the_local_model_is_the_global_one_on_a_straightened_surface(
    sigma: float, u: float, v: float, u_s: float, psi: float, omega: tuple[float, float, float], x: float, y: float
) -> None:
    """All five entries, slip and spin included; a wrong entry of g_1 or g_2 fails this."""
    frame, r = BENT.at(u, v)
    found = local_rates(r, frame.l, sigma, 0.1, u_s, psi, omega, (x, y, 0.0))
    expected = sphere_rates(forms_of(straightened(BENT, u, v), sigma), 0.1, u_s, psi, omega, (x, y, 0.0))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-11)


def wrong_fifth_entry(tube: Tube, u: float, v: float, radius: float, u_s: float, psi: float) -> float:
    """The same with the cosine of psi: near the right one, and wrong."""
    r = tube.at(u, v)[1]
    s1, s2 = r.R**2 + r.u**2, r.R**2 - r.R * r.uu + 2 * r.u**2
    return float(-(s1**1.5) * tan(u_s) * cos(psi) / (s1**1.5 + radius * s2))


def test_the_fifth_entry_of_g_2() -> None:
    """-S1^(3/2) tan u_s sin psi / D; another entry does not satisfy the twist."""
    frame, r = BENT.at(0.6, 1.3)
    u_s, psi, radius = 0.6, 0.8, 0.2
    s1, s2 = r.R**2 + r.u**2, r.R**2 - r.R * r.uu + 2 * r.u**2
    right = -(s1**1.5) * tan(u_s) * sin(psi) / (s1**1.5 + radius * s2)
    found = local_rates(r, frame.l, 1.0, radius, u_s, psi, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)).psi
    assert found == pytest.approx(right, rel=1e-12)
    assert abs(found - wrong_fifth_entry(BENT, 0.6, 1.3, radius, u_s, psi)) > 1e-2


@pytest.mark.parametrize("mutation", ["torsion", "side", "slip"])
def test_mutations_do_not_satisfy_the_twist(mutation: str) -> None:
    """The printed torsion (a row of K), the wrong side and a reversed slip each miss the twist by far."""
    omega, velocity, radius = (0.4, -0.8, 0.3), (0.1, -0.2, 0.0), 0.3
    jet = BENT.jet(0.7, 1.2)
    forms = forms_of(jet)
    wrong = {
        "torsion": forms._replace(T=forms.K[0]),
        "side": forms._replace(K=tuple(tuple(-k for k in row) for row in forms.K)),  # type: ignore[arg-type]
        "slip": forms,
    }[mutation]
    slip = (-0.1, 0.2, 0.0) if mutation == "slip" else velocity
    state = Rates(0.7, 1.2, 0.4, 0.2, 0.5)
    off = []
    for one, with_slip in ((forms, velocity), (wrong, slip)):
        rates = sphere_rates(one, radius, state.u_s, state.psi, omega, with_slip)
        found = recovered_twist(BENT, 1.0, radius, state, rates)
        off.append(max(np.abs(found[0] - omega).max(), np.abs(found[1] - velocity).max()))
    assert off[0] < 1e-8
    assert off[1] > 1e-2


@settings(max_examples=25, deadline=None)
@given(angles, angles, moderate, angles, triples, moderate, moderate)
def test_two_general_bodies_are_a_sphere_on_a_surface_where_one_is_a_sphere(
    u: float, v: float, u_s: float, psi: float, omega: tuple[float, float, float], x: float, y: float
) -> None:
    forms = forms_of(SURFACES["ellipsoid"].jet(*place("ellipsoid", u, v)))
    one = sphere_rates(forms, RADIUS, u_s, psi, omega, (x, y, 0.0))
    other = contact_rates(forms, forms_of(sphere(RADIUS).jet(u_s, v)), psi, omega, (x, y, 0.0))
    np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-11)


def test_an_ellipsoid_on_a_torus_moves_by_the_twist_that_was_given() -> None:
    body, surface, step = Ellipsoid(0.3, 0.4, 0.25), Torus(5.0, 2.0), 1e-5
    omega, velocity = np.array([0.4, -0.8, 0.3]), np.array([0.1, -0.2, 0.0])
    state = Rates(0.7, 1.2, 0.3, 0.4, 0.5)

    def posed(s: Rates) -> tuple[np.ndarray, np.ndarray]:
        """Q F_s = F R3 and Q f_s + c = f_o."""
        over, own = surface.jet(s.u_o, s.v_o), body.jet(s.u_s, s.v_s)
        frame, body_frame = (np.array(forms_of(jet)[:3], float).T for jet in (over, own))
        turn = np.array([[cos(s.psi), -sin(s.psi), 0], [-sin(s.psi), -cos(s.psi), 0], [0, 0, -1.0]])
        q = frame @ turn @ body_frame.T
        return q, np.array(over.f, float) - q @ np.array(own.f, float)

    forms, body_forms = forms_of(surface.jet(0.7, 1.2)), forms_of(body.jet(0.3, 0.4))
    rates = contact_rates(forms, body_forms, state.psi, tuple(omega), tuple(velocity))
    (q1, c1), (q0, c0) = (posed(advanced(state, rates, side * step)) for side in (1, -1))
    q, centre = posed(state)
    spin = (q1 - q0) / (2 * step) @ q.T
    turning = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
    contact = np.array(surface.jet(0.7, 1.2).f, float)
    material = (c1 - c0) / (2 * step) + np.cross(turning, contact - centre)
    frame = np.array(forms[:3], float).T
    np.testing.assert_allclose(-frame.T @ turning, omega, atol=1e-8)  # as for the sphere
    np.testing.assert_allclose(-frame.T @ material, velocity, atol=1e-8)


@given(moderate, angles, angles)
def test_the_chart_is_read_off_the_orientation(u_s: float, v_s: float, psi: float) -> None:
    frame = ROTATION
    found = chart_of(frame, orientation(frame, u_s, v_s, psi))
    np.testing.assert_allclose(found, (u_s, v_s, psi), atol=1e-12)


def test_controllability_of_the_local_model_as_derived() -> None:
    """det Q = -R_s^2 S1^(5/2) / (alpha cos u_s D^2); the one of any surface agrees on the straightened one."""
    radius, u_s = 0.2, 0.4
    frame, r = BENT.at(0.6, 1.3)
    s1, s2 = r.R**2 + r.u**2, r.R**2 - r.R * r.uu + 2 * r.u**2
    d = s1**1.5 + radius * s2
    derived = -(radius**2) * s1**2.5 / (frame.l * cos(u_s) * d**2)
    found = controllability(forms_of(straightened(BENT, 0.6, 1.3)), radius, u_s)
    assert found == pytest.approx(derived, rel=1e-9)


@pytest.mark.parametrize("radius", [0.2, 0.7])
def test_controllability_has_the_determinant_of_the_relative_curvature(radius: float) -> None:
    """det(K_o + I/R_s) is the product of the principal relative curvatures, however the frame stands to them."""
    for u, v in ((0.3, 0.6), (1.2, 1.3), (4.0, 2.2)):
        forms = forms_of(BENT.jet(u, v))
        assert abs(curvature(forms)[1]) > 1e-3
        low, high = principal_curvatures(forms)
        determinant = (low + 1 / radius) * (high + 1 / radius)
        expected = -1 / (determinant**2 * forms.M[0][0] * forms.M[1][1] * radius**2 * cos(0.4))
        assert controllability(forms, radius, 0.4) == pytest.approx(expected, rel=1e-12)


def test_period_of_a_full_turn_about_an_ellipse_needs_its_perimeter() -> None:
    """Perimeter of the ellipse 2 x 1: 9.688448221, by the trapezoidal rule, which is exact here to rounding."""
    u = np.linspace(0, 2 * pi, 4096, endpoint=False)
    assert np.hypot(2 * np.sin(u), np.cos(u)).mean() * 2 * pi == pytest.approx(9.688448221, abs=1e-9)
