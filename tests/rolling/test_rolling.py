"""Whole runs: against a sphere driven in SE(3), closed forms, events, inputs, and what cannot begin."""

from dataclasses import dataclass, replace
from math import cos, pi
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from reference.rolling import pose_over_time
from reference.tubes import bent_tube, straight_tube, tube
from tiskel import FittedSurface, contract, extract_skeleton, fit_surface
from tiskel.arrays import Numbers, Points, Stack, Table
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.rolling.equations import local_rates
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.models import model_of
from tiskel.rolling.printed import shape_operators
from tiskel.rolling.roll import roll
from tiskel.rolling.sphere import orientation, rotation_of
from tiskel.rolling.trajectory import RollStatus
from tiskel.surfaces.analytic import Cone, EllipticCylinder, Plane, Torus, cylinder
from tiskel.surfaces.forms import forms_of
from tiskel.surfaces.jets import Jet, ParametricSurface
from tiskel.surfaces.nearest import nearest_place

SHARP: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12, "meet": False}
BENT = bent_tube()


def driven(surface: ParametricSurface, p: RollParams, times: Numbers) -> tuple[Points, Stack, Table]:
    """The same run in SE(3); see tests/reference/rolling.py."""
    u, v, u_s, v_s, psi = p.start
    jet = surface.jet(u, v)
    frame = np.array(forms_of(jet, p.sigma)[:3], float).T
    assert p.radius is not None
    centre = np.array(jet.f, float) + p.radius * frame[:, 2]
    twist = np.array(p.omega), np.array(p.velocity)
    start = centre, orientation(frame, u_s, v_s, psi), u, v
    return pose_over_time(surface, p.sigma, p.radius, start, lambda t: twist, times)


@pytest.mark.slow
@pytest.mark.parametrize("slip", [0.0, 0.06])
@pytest.mark.parametrize("side", ["outside", "inside"])
@pytest.mark.parametrize("name", ["torus", "bent"])
def test_the_pose_agrees_with_a_sphere_driven_in_space(name: str, side: Any, slip: float) -> None:
    """Contact by closest point alone, pose in SE(3); agreement to 1e-6 at all times, spin and slip included."""
    surface: ParametricSurface = Torus(5.0, 2.0) if name == "torus" else BENT
    p = RollParams(
        side=side, radius=0.3 if name == "torus" else 0.1, omega=(0.6, 0.9, 0.4), velocity=(0.0, slip, 0.0),
        start=(0.3, 1.2, 0.1, 0.1, pi / 2), duration=4.0, rate=5.0, **SHARP,
    )  # fmt: skip
    r = roll(surface, p)
    assert r.status is RollStatus.FINISHED
    centres, rotations, places = driven(surface, p, r.t)
    np.testing.assert_allclose(r.centre, centres, atol=1e-6)
    np.testing.assert_allclose(rotation_of(r.orientation), rotations, atol=1e-6)
    np.testing.assert_allclose(r.state[:, :2], places, atol=1e-6)


@pytest.mark.parametrize("side", ["outside", "inside"])
def test_both_contact_paths_are_equally_long_without_slip(side: Any) -> None:
    p = RollParams(side=side, radius=0.1, omega=(0.6, 0.9, 0.4), duration=5.0, **SHARP)
    r = roll(BENT, p)
    # Two thousand chords and arcs: relative errors of 1e-6 each.
    assert r.path_object == pytest.approx(r.path_sphere, rel=1e-5)
    slipping = roll(BENT, replace(p, velocity=(0.0, 0.05, 0.0)))
    assert abs(slipping.path_object - slipping.path_sphere) > 1e-2


def test_ways_are_measured_closely_where_the_contact_hurries() -> None:
    """A sphere wound up in the tip of a cone: even times alone measured ways that differed by 0.7 %."""
    p = RollParams(side="inside", radius=0.1, omega=(-1.0, 0.3, 0), start=(0.1, 1, 0, 0, 0), duration=60.0, **SHARP)
    r = roll(Cone(0.6), p)
    assert r.status is RollStatus.TIGHT
    assert r.path_object == pytest.approx(r.path_sphere, rel=1e-5)


PUBLISHED: dict[str, Any] = {"rtol": 1e-3, "atol": 1e-5}
BLADE: list[tuple[str, float, tuple[float, float, float], tuple[float, ...]]] = [
    ("inside", 0.3, (-0.1, 0.9, 0.5), (5.82, 2.67, 0.1, 0.1, 0.0)),
    ("outside", 10.0, (-0.1, -3.3, 0.7), (5.39, 0.51, 0.1, 0.1, 0.0)),
]


@pytest.mark.parametrize(("side", "radius", "omega", "start"), BLADE)
def test_the_usual_tolerances_keep_a_sphere_from_slipping(side: Any, radius: float, omega: Any, start: Any) -> None:
    """A thin blade, its edges of radius 0.005: ways that were 8 and 4 % apart at the published tolerances."""
    p = RollParams(side=side, radius=radius, omega=omega, start=start, duration=6.0)
    r = roll(EllipticCylinder(2.0, 0.1), p)
    assert r.path_object == pytest.approx(r.path_sphere, rel=1e-4)
    assert (r.as_dict()["rtol"], r.as_dict()["atol"]) == (1e-6, 1e-8)


@pytest.mark.parametrize(("side", "radius", "omega", "start"), BLADE)
def test_slip_that_nobody_asked_for_is_told(side: Any, radius: float, omega: Any, start: Any) -> None:
    surface = EllipticCylinder(2.0, 0.1)
    p = RollParams(side=side, radius=radius, omega=omega, start=start, duration=6.0)
    loose = roll(surface, replace(p, **PUBLISHED))
    apart = 100 * abs(loose.path_object - loose.path_sphere) / max(loose.path_object, loose.path_sphere)
    assert apart > 3
    (said,) = loose.warnings
    for part in (f"{loose.path_object:.6g}", f"{loose.path_sphere:.6g}", f"{apart:.2g} %", "smaller rtol than 0.001"):
        assert part in said
    assert roll(surface, p).warnings == ()


def test_slip_that_was_asked_for_is_not_told() -> None:
    side, radius, omega, start = BLADE[0]
    p = RollParams(side=side, radius=radius, omega=omega, start=start, duration=6.0, **PUBLISHED)  # type: ignore[arg-type]
    assert roll(EllipticCylinder(2.0, 0.1), replace(p, velocity=(0.0, 0.05, 0.0))).warnings == ()
    rows = Inputs(np.array([0.0, 6.0]), np.array([[*omega, 0, 0, 0], [*omega, 0, 0.05, 0]]))
    assert roll(EllipticCylinder(2.0, 0.1), p, rows).warnings == ()
    without = Inputs(rows.t, rows.values * [1, 1, 1, 0, 0, 0])
    assert "no slip" in roll(EllipticCylinder(2.0, 0.1), p, without).warnings[0]


@pytest.mark.parametrize("twist", ["object", "world"])
def test_a_spinning_sphere_has_no_ways_to_compare(twist: Any) -> None:
    start = (pi / 2, 1.0, 0.1, 0.1, 0.0)  # on top of the torus, where the normal is the third axis
    r = roll(Torus(3.0, 1.0), RollParams(radius=0.9, omega=(0.0, 0.0, 1.0), twist=twist, start=start))
    assert r.path_object < 1e-12
    assert r.warnings == ()


@pytest.mark.parametrize(("side", "sign"), [("outside", 1), ("inside", -1)])
def test_once_around_a_straight_tube_takes_its_perimeter(side: Any, sign: int) -> None:
    """T = (L/R_s + 2 pi sigma)/|omega_y|; the ellipse 2 x 1 has L = 9.688448221."""
    time = 9.688448221 / 0.4 + 2 * pi * sign
    p = RollParams(side=side, radius=0.4, start=(0.3, 0.0, 0.1, 0.1, 1.0), duration=time, **SHARP)
    r = roll(EllipticCylinder(2.0, 1.0), p)
    assert abs(r.state[-1, 0] - r.state[0, 0]) == pytest.approx(2 * pi, abs=1e-8)
    assert r.path_sphere == pytest.approx(9.688448221, abs=1e-6)
    if side == "outside":
        longer = roll(EllipticCylinder(2.0, 1.0), replace(p, radius=0.5, duration=25.660081748))
        assert abs(longer.state[-1, 0] - longer.state[0, 0]) == pytest.approx(2 * pi, abs=1e-8)


def test_there_and_back_is_where_it_began() -> None:
    p = RollParams(radius=0.1, omega=(0.5, 0.8, 0.3), start=(0.3, 1.2, 0.1, 0.1, 1.0), duration=3.0, **SHARP)
    there = roll(BENT, p)
    back = roll(BENT, replace(p, omega=(-0.5, -0.8, -0.3), start=tuple(there.state[-1].tolist())))
    np.testing.assert_allclose(back.state[-1], p.start, atol=1e-8)


def test_twice_the_twist_takes_half_the_time() -> None:
    p = RollParams(radius=0.1, omega=(0.5, 0.8, 0.3), velocity=(0.01, 0.02, 0), duration=3.0, **SHARP)
    once = roll(BENT, p)
    twice = roll(BENT, replace(p, omega=(1.0, 1.6, 0.6), velocity=(0.02, 0.04, 0), duration=1.5))
    np.testing.assert_allclose(twice.state[-1], once.state[-1], atol=1e-8)


def test_the_centre_stays_a_radius_away_from_the_surface() -> None:
    r = roll(BENT, RollParams(radius=0.1, omega=(0.5, 0.8, 0.3), duration=3.0, rate=5, **SHARP))
    for centre in r.centre:
        near = np.array(BENT.jet(*nearest_place(BENT, centre)).f, float)
        assert np.linalg.norm(centre - near) == pytest.approx(0.1, abs=1e-10)


def test_the_poles_of_the_chart_are_places_like_others() -> None:
    """Straight over the pole of the sphere on a plane: few steps, and no jump of the pose."""
    p = RollParams(radius=0.5, omega=(0.0, 1.0, 0.0), start=(0.0, 0.0, 0.0, 0.0, 0.0), duration=8.0)
    r = roll(Plane(), p)
    assert np.abs(r.state[:, 2]).max() > 1.5  # over it
    assert r.evaluations < 300
    assert np.abs(np.diff(r.orientation, axis=0)).max() < 0.01


def test_the_local_model_is_exact_on_a_straight_even_tube_and_wrong_on_a_bent_one() -> None:
    straight = straight_tube(2.0)
    p = RollParams(radius=0.5, omega=(0.3, 0.8, 0.2), start=(0.1, 1.0, 0.1, 0.1, 1.0), duration=3.0, **SHARP)
    ours, local = roll(straight, p), roll(straight, replace(p, model="local"))
    np.testing.assert_allclose(local.state, ours.state, atol=1e-8)
    p = replace(p, radius=0.1)
    assert np.abs(roll(BENT, p).state[-1] - roll(BENT, replace(p, model="local")).state[-1]).max() > 0.01


def test_the_local_model_runs_ahead_inside_and_behind_outside_a_bend() -> None:
    """Bend 3, tube 0.5: v' of the local over that of the global model is 1 - (R + R_s) cos u / bend around u."""
    v = np.linspace(0, pi, 400)
    arc = tube(3 * np.stack([np.cos(v), -np.sin(v), 0 * v], axis=1), np.tile([0.5, 0.0, 0.0], (400, 1)))
    for u in (0.0, 1.0, pi):
        rates = []
        for kind in ("local", "global"):
            model = model_of(arc, RollParams(model=kind), 0.3)
            rates.append(model.rates(u, 1.5, model.forms(u, 1.5), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))[1])
        assert rates[0] / rates[1] == pytest.approx(1 - 0.8 * cos(u) / 3, abs=1e-6)


def test_the_three_conventions_of_a_twist_are_one_motion() -> None:
    """The same pose over time, driven by the object's, the sphere's and the world's twist, sampled densely."""
    p = RollParams(radius=0.1, omega=(0.5, 0.8, 0.3), velocity=(0.02, -0.01, 0), duration=2.0, rate=200.0, **SHARP)
    r = roll(BENT, p)
    world, own = [], []
    for (u, v), pose in zip(r.state[:, :2], rotation_of(r.orientation), strict=True):
        frame = np.array(forms_of(BENT.jet(float(u), float(v)))[:3], float).T
        parts = np.array([p.omega, p.velocity])
        world.append((-frame @ parts.T).T.ravel())
        own.append((-pose.T @ frame @ parts.T).T.ravel())
    conventions: list[tuple[Any, Any]] = [("world", world), ("sphere", own)]
    for twist, rows in conventions:
        again = roll(BENT, replace(p, twist=twist), Inputs(r.t, np.array(rows)))
        # Straight between rows 5 ms apart: second differences of a twist that turns once in seconds.
        np.testing.assert_allclose(again.state[-1], r.state[-1], atol=2e-5)


def test_the_local_model_is_its_chart_integrated() -> None:
    """The published five equations, integrated as they stand, away from the poles; R depends on v here."""
    p = RollParams(model="local", radius=0.1, omega=(0.3, 0.8, 0.2), velocity=(0.01, 0.02, 0), duration=1.0, **SHARP)
    r = roll(BENT, p)

    def rate(t: float, y: Numbers) -> Any:
        frame, radius = BENT.at(float(y[0]), float(y[1]))
        return local_rates(radius, frame.l, 1.0, 0.1, float(y[2]), float(y[4]), p.omega, p.velocity)

    chart = solve_ivp(rate, (0, 1.0), p.start, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(r.state[-1], chart.y[:, -1], atol=1e-8)


def test_inputs_over_time_are_straight_between_their_rows() -> None:
    inputs = Inputs(np.array([0.0, 2.0]), np.array([[0, 0, 0, 0, 0, 0], [2.0, 0, 0, 0, 0, 0]]))
    assert inputs.at(0.5) == ((0.5, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert inputs.at(9.0)[0][0] == 2.0
    r = roll(cylinder(2.0), RollParams(radius=0.5, start=(0, 0, 0, 0, 0), **SHARP), inputs)
    assert r.t[-1] == 2.0
    assert r.state[-1, 1] == pytest.approx(0.5 * 2.0, abs=1e-9)  # R_s times the integral of omega_x


def test_a_run_ends_at_the_end_of_the_branch() -> None:
    r = roll(straight_tube(), RollParams(radius=0.5, omega=(1.0, 0, 0), duration=60.0, **SHARP))
    assert r.status is RollStatus.LEFT
    assert r.state[-1, 1] == pytest.approx(pi, abs=1e-9)
    assert "t = " in r.reason


def narrowing() -> Any:
    """A tube whose waist has a radius of curvature of about 0.4 along it."""
    v = np.linspace(0, pi, 400)
    return tube(np.stack([v, 0 * v, 0 * v], axis=1), np.stack([1 - 0.5 * np.sin(v) ** 8, 0 * v, 0 * v], axis=1))


def test_a_run_ends_where_the_sphere_no_longer_fits() -> None:
    r = roll(narrowing(), RollParams(radius=1.0, omega=(1.0, 0, 0), start=(0.1, 0.3, 0, 0, 0), duration=60.0, **SHARP))
    assert r.status is RollStatus.TIGHT
    assert r.margin[-1] == pytest.approx(1e-4, abs=1e-6)  # of 1/R_s: the event is just before the singular place


def test_a_sphere_that_cannot_begin_is_told_what_to_do() -> None:
    tunnel = straight_tube(2.0)
    with pytest.raises(TiskelError, match="fits nowhere, a sphere of less than 2 somewhere"):
        roll(tunnel, RollParams(side="inside", radius=2.5))
    with pytest.raises(TiskelError, match=r"start at u = .*, v = "):
        roll(narrowing(), RollParams(radius=1.0))
    with pytest.raises(TiskelError, match=r"v = 4 lies outside the branch, where v is from 0 to 3.14159"):
        roll(tunnel, RollParams(start=(0, 4.0, 0, 0, 0)))
    with pytest.raises(TiskelError, match="radius of the sphere is missing"):
        roll(Torus(5, 2))
    with pytest.raises(TiskelError, match="needs a Fourier surface"):
        roll(Torus(5, 2), RollParams(model="local", radius=0.1))


def test_zero_inputs_leave_the_sphere_where_it_is_and_say_so() -> None:
    r = roll(BENT, RollParams(omega=(0, 0, 0), duration=1.0))
    np.testing.assert_array_equal(r.state[0], r.state[-1])
    assert r.status is RollStatus.FINISHED
    assert "stays" in r.warnings[0]


@pytest.mark.parametrize(
    ("t", "hole", "said"),
    [([0, 2, 1], False, "row 3 has t = 1 after 2"), ([0, 1, 1], False, "times must rise"), ([0, 1, 2], True, "row 2")],
)
def test_inputs_that_make_no_sense_name_their_row(t: list[float], hole: bool, said: str) -> None:
    values = np.zeros((3, 6))
    values[1, 2] = np.nan if hole else 0
    with pytest.raises(TiskelError, match=said):
        Inputs(np.array(t, float), values)


@pytest.mark.parametrize(
    "wrong",
    [{"radius": -1.0}, {"omega": (1, 2)}, {"omega": (1, 2, np.nan)}, {"velocity": (0, 0, 1.0)}, {"model": "own"},
     {"duration": 0.0}, {"rate": np.inf}, {"start": (0, 0)}],
)  # fmt: skip
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(TiskelError, match=next(iter(wrong))):
        RollParams(**wrong)


def test_the_run_starts_at_the_surface_point_nearest_to_a_place() -> None:
    target = np.array(BENT.jet(0.8, 1.7).f, float)
    outward = np.array(forms_of(BENT.jet(0.8, 1.7)).z, float)
    r = roll(BENT, RollParams(radius=0.1, duration=0.1, start_at=tuple((target + 0.2 * outward).tolist())))
    np.testing.assert_allclose(r.contact[0], target, atol=1e-9)
    assert r.warnings == ()
    away = roll(BENT, RollParams(radius=0.1, duration=0.1, start_at=tuple((target + 5 * outward).tolist())))
    assert "the place to start at is" in away.warnings[0]


def test_the_summary_holds_plain_finite_numbers() -> None:
    import json

    document = json.loads(json.dumps(roll(BENT, RollParams(duration=0.5)).as_dict(), allow_nan=False))
    assert document["status"] == "finished"
    assert document["least_margin"] > 0
    assert document["least_determinant"] > 0


@pytest.fixture(scope="module")
def capsule_surface(capsule: Points) -> FittedSurface:
    return fit_surface(extract_skeleton(contract(capsule)))[0]


def test_a_run_ends_where_the_sphere_meets_another_part_of_the_cloud(capsule_surface: FittedSurface) -> None:
    """A wall across a rod of radius 0.2 at z = 0.3: the sphere of 0.1 stops about 0.1 before it."""
    x, y = np.meshgrid(np.linspace(-0.6, 0.6, 61), np.linspace(-0.6, 0.6, 61))
    wall = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.3)], axis=1)
    wall = wall[np.hypot(wall[:, 0], wall[:, 1]) > 0.2]
    walled = replace(capsule_surface, cloud=np.concatenate([capsule_surface.cloud, wall]))
    up = 1.0 if capsule_surface.tube.curve(np.array([1.0]))[0, 2] < 0 else -1.0
    p = RollParams(radius=0.1, omega=(up, 0, 0), start=(0.3, pi / 2, 0, 0, 0), duration=30.0)
    r = roll(walled, p)
    assert r.status is RollStatus.MET
    # Met is what is deeper in than 5 % of the radius; the event is found to a step of the root finder.
    assert r.centre[-1, 2] == pytest.approx(0.3 - 0.095, abs=0.005)
    assert roll(walled, replace(p, meet=False)).status is RollStatus.LEFT
    with pytest.raises(TiskelError, match="points away from the contact lie in it; start at u = "):
        roll(walled, replace(p, start_at=(0.2, 0.0, 0.28)))
    poor = replace(walled, error=4.24)  # a misfit that says nothing of the surface here: the run ends all the same
    assert roll(poor, p).status is RollStatus.MET


def test_a_run_ends_where_points_about_the_contact_lie_deep_in_the_sphere(capsule_surface: FittedSurface) -> None:
    """A ridge 0.05 high around the rod at z = 0.3, which the surface does not follow: half a radius of the sphere."""
    turn = np.linspace(0, 2 * np.pi, 400)
    ridge = np.stack([0.25 * np.cos(turn), 0.25 * np.sin(turn), np.full(400, 0.3)], axis=1)
    ridged = replace(capsule_surface, cloud=np.concatenate([capsule_surface.cloud, ridge]))
    up = 1.0 if capsule_surface.tube.curve(np.array([1.0]))[0, 2] < 0 else -1.0
    p = RollParams(radius=0.1, omega=(up, 0, 0), start=(0.3, pi / 2, 0, 0, 0), duration=30.0)
    r = roll(ridged, p)
    assert r.status in (RollStatus.OFF, RollStatus.MET)
    deep = 1 - np.linalg.norm(r.centre[:, None] - ridge, axis=2).min(axis=1) / 0.1
    assert deep.max() < 0.21
    with pytest.raises(TiskelError, match="points about the contact lie deep in it"):
        roll(ridged, replace(p, start_at=(0.2, 0.0, 0.3)))


def test_rolling_over_a_fitted_surface_is_rolling_over_the_body(capsule_surface: FittedSurface) -> None:
    """Around a rod of radius 0.2: u' = -R_s omega_y / (R + R_s), to the accuracy of the fit."""
    r = roll(capsule_surface, RollParams(radius=0.1, omega=(0, 1, 0), duration=5.0, **SHARP))
    assert r.state[-1, 0] - r.state[0, 0] == pytest.approx(-0.1 * 5 / 0.3, rel=5e-3)
    np.testing.assert_allclose(np.hypot(*r.contact[:, :2].T), 0.2, rtol=5e-3)


def test_the_printed_curvature_is_a_coarse_one(capsule_surface: FittedSurface) -> None:
    """Normals by principal components of 20 of 800 points: right to a tenth or so, and labelled."""
    p = RollParams(radius=0.1, normals="pca", duration=2.0)
    r, ours = roll(capsule_surface, p), roll(capsule_surface, replace(p, normals="surface"))
    assert r.as_dict()["normals"] == "pca"
    moved, true = (abs(one.state[-1, 0] - one.state[0, 0]) for one in (r, ours))
    assert moved == pytest.approx(true, rel=0.15)
    assert moved != true
    with pytest.raises(TiskelError, match="fitted to a cloud"):
        roll(BENT, p)


def test_operators_of_neighbours_find_the_curvature_of_a_dense_sphere() -> None:
    directions = np.random.default_rng(1).normal(size=(20000, 3))
    ball = 2 * directions / np.linalg.norm(directions, axis=1)[:, None]
    frames = np.broadcast_to(np.eye(3), (1, 3, 3))
    operator = shape_operators(ball, np.array([[0.0, 0, 2.0]]), frames, 30)[0]
    np.testing.assert_allclose(operator, np.diag([0.5, 0.5, 0]), atol=0.03)  # normals of 30 neighbours vary by 1e-2


def test_the_usual_sphere_is_a_quarter_of_the_branch(capsule_surface: FittedSurface) -> None:
    assert roll(capsule_surface, RollParams(duration=0.1)).radius == pytest.approx(0.05, rel=0.02)


def test_a_twist_in_axes_fixed_in_the_sphere_is_no_trap() -> None:
    """A constant one turns the sphere about one of its own axes: of a plane a straight way, and few steps."""
    p = RollParams(radius=0.5, twist="sphere", omega=(0.6, -0.9, 0.4), duration=10.0, start=(0, 0, 0.1, 0.1, 0.3))
    r = roll(Plane(), replace(p, **SHARP))
    assert r.status is RollStatus.FINISHED
    assert roll(Plane(), p).evaluations < 2000
    turned = rotation_of(r.orientation[-1]).T @ rotation_of(r.orientation[0])
    np.testing.assert_allclose(turned, Rotation.from_rotvec(-10 * np.array(p.omega)).as_matrix(), atol=1e-8)


def test_local_curvature_is_not_that_of_neighbours() -> None:
    with pytest.raises(TiskelError, match="the local model has its curvature from the Fourier series"):
        RollParams(model="local", normals="pca")


@pytest.mark.parametrize(("a", "b"), [(pi / 2, pi / 2), (1.0, 0.7), (2.5, 0.3)])
def test_a_rectangle_turns_the_sphere_by_its_holonomy(a: float, b: float) -> None:
    """Rolled by the angles a, b, -a, -b without spin: cos(turn / 2) = 1 - 2 sin^2(a / 2) sin^2(b / 2).

    Of four turns about two fixed axes across each other (T. Honein, O. O'Reilly, on reorienting a sphere by rolling it
    along a rectangle).
    """
    p = RollParams(radius=0.5, start=(0.0, 0.0, 0.3, 0.2, 0.4), meet=False, rtol=1e-12, atol=1e-14)
    poses, start, place = [], p.start, np.zeros(3)
    for axis, angle in ((1, a), (0, b), (1, -a), (0, -b)):
        omega = tuple(np.sign(angle) * (np.arange(3) == axis))
        r = roll(Plane(), replace(p, omega=omega, duration=abs(angle), start=start))
        start = tuple(r.state[-1].tolist())
        poses += [rotation_of(r.orientation[0]), rotation_of(r.orientation[-1])]
        place = r.contact[-1]
    np.testing.assert_allclose(place, 0, atol=1e-9)
    turn = Rotation.from_matrix(poses[-1] @ poses[0].T).magnitude()
    assert np.cos(turn / 2) == pytest.approx(1 - 2 * np.sin(a / 2) ** 2 * np.sin(b / 2) ** 2, abs=1e-9)


@dataclass(frozen=True)
class PolarPlane:
    """f = (v cos u, v sin u, 0): circles about the origin are lines of u."""

    v_range = (0.0, np.inf)
    periods = (2 * pi, None)

    def jet(self, u: Any, v: Any) -> Jet:
        c, s, zero = np.cos(u), np.sin(u), 0 * (u + v)
        return Jet(
            (v * c, v * s, zero), (-v * s, v * c, zero), (c + zero, s + zero, zero),
            (-v * c, -v * s, zero), (-s + zero, c + zero, zero), (zero, zero, zero),
        )  # fmt: skip


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_a_circle_on_a_plane_turns_the_sphere_as_it_should(ratio: float) -> None:
    """Once around a circle of so many radii, without spin: a turn by 2 pi sqrt(1 + ratio^2), about a tilted axis."""
    radius = 0.5
    p = RollParams(
        radius=radius, omega=(0.0, -1.0, 0.0), duration=2 * pi * ratio, start=(0.0, ratio * radius, 0.3, 0.2, 0.4),
        meet=False, rtol=1e-12, atol=1e-14,
    )  # fmt: skip
    r = roll(PolarPlane(), p)
    assert abs(r.state[-1, 0]) == pytest.approx(2 * pi, abs=1e-9)
    assert r.state[-1, 1] == pytest.approx(ratio * radius, abs=1e-9)
    turned = rotation_of(r.orientation[-1]) @ rotation_of(r.orientation[0]).T
    turn = 2 * pi * np.sqrt(1 + ratio**2)
    assert np.trace(turned) == pytest.approx(1 + 2 * np.cos(turn), abs=1e-9)
    axis = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
    tilt = np.abs(axis / np.linalg.norm(axis))
    np.testing.assert_allclose(tilt[2], 1 / np.sqrt(1 + ratio**2), atol=1e-6)
