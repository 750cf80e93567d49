"""Rolling without a chart: against charts, poses in SE(3), closed forms and invariants; over joints and seams."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tiskel import Inputs, RollParams, RollStatus, TiskelError, roll, roll_on
from tiskel.arrays import Numbers, Points
from tiskel.rolling.sphere import rotation_of
from tiskel.surfaces import analytic
from tiskel.surfaces.forms import forms_of, frame_at
from tiskel.surfaces.implicit import LevelSet, projected
from tiskel.surfaces.implicit_bodies import (
    Capsule,
    Ellipsoid,
    Plane,
    RoundCylinder,
    Sphere,
    Torus,
    Union,
    y_of_capsules,
)

SHARP: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-11}
PAIRS: list[tuple[Any, Any, Any, float]] = [
    (analytic.cylinder(2.0), RoundCylinder(2.0, (1, 0, 0)), "outside", 0.5),
    (analytic.cylinder(2.0), RoundCylinder(2.0, (1, 0, 0)), "inside", 0.5),
    (analytic.Torus(1.5, 0.5), Torus(1.5, 0.5), "outside", 0.3),
    (analytic.Torus(1.5, 0.5), Torus(1.5, 0.5), "inside", 0.2),
    (analytic.Ellipsoid(1.5, 1.0, 0.7), Ellipsoid(1.5, 1.0, 0.7), "outside", 0.3),
    (analytic.Ellipsoid(1.5, 1.0, 0.7), Ellipsoid(1.5, 1.0, 0.7), "inside", 0.2),
]


def begun_as(chart: Any, run: Any) -> dict[str, Any]:
    """Start, attitude and heading of a run on a chart."""
    frame = frame_at(chart, run.params.sigma, *run.state[0, :2])
    return {
        "start_at": tuple(run.contact[0]), "attitude": tuple(run.orientation[0]), "heading": tuple(frame[:, 1]),
    }  # fmt: skip


def same_pose(one: Any, other: Any, atol: float = 1e-8) -> None:
    np.testing.assert_allclose(one.contact, other.contact, atol=atol)
    np.testing.assert_allclose(rotation_of(one.orientation), rotation_of(other.orientation), atol=atol)


@pytest.mark.parametrize("twist", ["world", "sphere"])
@pytest.mark.parametrize(("chart", "body", "side", "radius"), PAIRS)
def test_the_twist_of_the_sphere_moves_it_as_on_a_chart(
    chart: Any, body: Any, side: Any, radius: float, twist: Any
) -> None:
    p = RollParams(radius=radius, side=side, omega=(0.8, 0.5, 0.3), velocity=(0.05, -0.02, 0.03), twist=twist,
                   start=(0.3, 0.4, 0.1, 0.1, 0.4), duration=3.0, rate=20, **SHARP)  # fmt: skip
    there = roll(chart, p)
    free = roll_on(body, replace(p, **begun_as(chart, there)))
    same_pose(free, there)
    np.testing.assert_allclose(free.margin, there.margin, atol=1e-7)
    np.testing.assert_allclose(free.normal, there.normal, atol=1e-8)
    np.testing.assert_allclose(free.ways, there.ways, atol=1e-6)  # two measurements


@dataclass(frozen=True)
class Turned(Inputs):
    """A constant twist of the object in a chart's frame, in the axes of the carried one."""

    angle: Any = None

    def at(self, t: float) -> Any:
        omega, velocity = super().at(t)
        c, s = np.cos(self.angle(t)), np.sin(self.angle(t))
        turned = [(c * a - s * b, s * a + c * b, z) for a, b, z in (omega, velocity)]
        return turned[0], turned[1]


@pytest.mark.parametrize(("chart", "body", "side", "radius"), PAIRS)
def test_the_twist_of_the_object_is_that_of_a_chart_up_to_its_torsion(
    chart: Any, body: Any, side: Any, radius: float
) -> None:
    """The chart's frame turns by T u_o' about the normal against the carried one."""
    p = RollParams(radius=radius, side=side, omega=(0.8, 0.5, 0.3), velocity=(0.05, -0.02, 0), rate=400,
                   start=(0.3, 0.4, 0.1, 0.1, 0.4), duration=2.0, **SHARP)  # fmt: skip
    there = roll(chart, p)
    u, v = there.state[:, :2].T
    jet = chart.jet(u, v)
    forms = forms_of(jet, p.sigma)
    rates = np.gradient(there.state[:, :2], there.t, axis=0, edge_order=2)
    from scipy.interpolate import CubicSpline

    turning = CubicSpline(there.t, forms.T[0] * rates[:, 0] + forms.T[1] * rates[:, 1]).antiderivative()
    still = Inputs(np.zeros(1), np.array([[*p.omega, *p.velocity]]))
    free = roll_on(body, replace(p, **begun_as(chart, there)), Turned(still.t, still.values, angle=turning))
    same_pose(free, there, atol=3e-6)  # differences of rows 2.5 ms apart


@pytest.mark.parametrize("twist", ["object", "world"])
def test_a_pose_in_space_that_only_projects_rolls_the_same_way(twist: Any) -> None:
    """SE(3) with the contact found by projection alone: c' = v + Omega x (c - x), the carried frame by differences."""
    body = Ellipsoid(1.5, 1.0, 0.7)
    p = RollParams(radius=0.3, omega=(0.7, -0.4, 0.2), velocity=(0.03, 0.02, 0), twist=twist, duration=2.0, rate=10,
                   start_at=(0.2, 0.3, 0.7), heading=(1, 0, 0), **SHARP)  # fmt: skip
    r = roll_on(body, p)

    def foot(centre: Numbers) -> Numbers:
        place = projected(body, centre[None])[0]
        for _ in range(60):
            n = body.level(place[None]).gradient[0]
            n = n / np.linalg.norm(n)
            place = projected(body, (place + (centre - place) - n * ((centre - place) @ n))[None])[0]
        return np.asarray(place)

    def rate(t: float, y: Numbers) -> Any:
        centre, q, x = y[:3], y[3:12].reshape(3, 3), y[12:]
        z = (centre - foot(centre)) / np.linalg.norm(centre - foot(centre))
        frame = np.stack([x, np.cross(z, x), z], axis=1)
        w, v = np.array(p.omega), np.array(p.velocity)
        omega, slip = (w, v - z * (z @ v)) if twist == "world" else (-frame @ w, -frame @ v)
        moved = slip + 0.3 * np.cross(omega, z)
        after, before = (
            (c - foot(c)) / np.linalg.norm(c - foot(c)) for c in (centre + 1e-5 * moved, centre - 1e-5 * moved)
        )
        turning = (after - before) / 2e-5
        cross = np.array([[0, -omega[2], omega[1]], [omega[2], 0, -omega[0]], [-omega[1], omega[0], 0]])
        return np.concatenate([moved, (cross @ q).ravel(), -(x @ turning) * z])

    z = r.normal[0]
    y = np.array([1.0, 0, 0]) - z * z[0]
    start = np.concatenate([r.centre[0], np.eye(3).ravel(), np.cross(y / np.linalg.norm(y), z)])
    solved = solve_ivp(rate, (0, 2.0), start, rtol=1e-8, atol=1e-9, t_eval=[2.0])
    np.testing.assert_allclose(solved.y[:3, -1], r.centre[-1], atol=1e-6 * 0.3)
    np.testing.assert_allclose(solved.y[3:12, -1].reshape(3, 3), rotation_of(r.orientation[-1]), atol=1e-6)


@pytest.mark.parametrize("body", [y_of_capsules(), Torus(1.5, 0.5), Ellipsoid(1.5, 1.0, 0.7)])
def test_both_ways_are_of_one_length_and_the_sphere_touches_all_along(body: Any) -> None:
    start = tuple(projected(body, np.array([[1.0, 0.1, 0.6]]))[0])
    r = roll_on(body, RollParams(radius=0.15, omega=(0.9, -0.6, 0.4), start_at=start, duration=20))
    assert r.status is RollStatus.FINISHED
    np.testing.assert_allclose(r.ways[:, 0], r.ways[:, 1], atol=1e-5 * r.path_object)
    assert np.abs(body.level(r.contact).value).max() < 1e-12
    np.testing.assert_allclose(np.linalg.norm(r.centre - r.contact, axis=1), 0.15, atol=1e-12)


def test_there_and_back_is_where_it_began() -> None:
    body = y_of_capsules()
    p = RollParams(radius=0.15, omega=(0.9, -0.3, 0.2), start_at=(1.0, 0.0, 0.4), heading=(-1, 0, 0), twist="world",
                   duration=8, **SHARP)  # fmt: skip
    there = roll_on(body, p)
    back = roll_on(body, replace(p, omega=(-0.9, 0.3, -0.2), start_at=tuple(there.contact[-1]),
                                 attitude=tuple(there.orientation[-1])))  # fmt: skip
    np.testing.assert_allclose(back.contact[-1], there.contact[0], atol=1e-7)
    np.testing.assert_allclose(rotation_of(back.orientation[-1]), np.eye(3), atol=1e-7)


@dataclass(frozen=True)
class Moved:
    """A body, turned and shifted."""

    body: Any
    turn: Any
    by: Numbers

    def level(self, points: Points) -> LevelSet:
        value, gradient, hessian = self.body.level((points - self.by) @ self.turn)
        return LevelSet(value, gradient @ self.turn.T, self.turn @ hessian @ self.turn.T)


def test_turning_and_shifting_the_object_turns_and_shifts_the_run() -> None:
    """A shift of a thousand radii as well: the state is scaled about the start."""
    turn = Rotation.from_rotvec([0.4, -1.0, 0.7]).as_matrix()
    by = np.array([100.0, -50.0, 20.0])
    p = RollParams(
        radius=0.1, omega=(0.9, -0.3, 0.2), start_at=(1.0, 0.0, 0.4), heading=(-1, 0, 0), duration=8, **SHARP
    )
    one = roll_on(y_of_capsules(), p)
    moved = roll_on(
        Moved(y_of_capsules(), turn, by), replace(p, start_at=tuple(turn @ p.start_at + by), heading=tuple(-turn[:, 0]))
    )
    np.testing.assert_allclose(moved.contact, one.contact @ turn.T + by, atol=1e-6)
    np.testing.assert_allclose(moved.state[:, 2:].shape, one.state[:, 2:].shape)
    np.testing.assert_allclose(moved.ways, one.ways, atol=1e-6)


def test_without_spin_and_slip_the_centre_goes_along_a_geodesic() -> None:
    """On a sphere along a great circle, at R_s |omega|, wherever it began; on a cylinder along a helix."""
    r = roll_on(Sphere(1.0), RollParams(radius=0.25, omega=(0.6, -0.8, 0), start_at=(0.3, 0.5, 0.7), **SHARP))
    across = np.cross(r.centre[0], r.centre[100])
    assert np.abs(r.centre @ across).max() < 1e-8
    angle = np.arccos(r.normal[0] @ r.normal[300])
    assert angle == pytest.approx(0.25 * 3 / 1.25, abs=1e-8)
    helix = roll_on(RoundCylinder(1.0), RollParams(radius=0.25, omega=(0.6, -0.8, 0), start_at=(1, 0, 0), **SHARP))
    np.testing.assert_allclose(helix.contact[:, 2], 0.25 * 0.6 * helix.t, atol=1e-8)
    np.testing.assert_allclose(
        np.unwrap(np.arctan2(*helix.contact[:, 1::-1].T)), 0.25 * 0.8 * helix.t / 1.25, atol=1e-8
    )


def rows(moves: Sequence[tuple[float, ...]]) -> Inputs:
    """Turn by rotation vectors one after the other, each with a rise and a fall: exact for rows that are straight."""
    t, values = [0.0], [[0.0] * 6]
    for move in moves:
        t += [t[-1] + 1.0, t[-1] + 2.0]
        values += [[*move, 0, 0, 0], [0.0] * 6]
    return Inputs(np.array(t), np.array(values))


def test_a_rectangle_on_a_plane_turns_the_sphere_by_four_quarter_turns_in_turn() -> None:
    """Closed: the pose is the product of the rotations about the fixed axes -omega."""
    sides = [(0.7, 0, 0), (0, 1.1, 0), (-0.7, 0, 0), (0, -1.1, 0)]
    p = RollParams(radius=0.5, start_at=(0, 0, 0), heading=(0, 1, 0), **SHARP)
    r = roll_on(Plane(), p, rows(sides))
    np.testing.assert_allclose(r.contact[-1], 0, atol=1e-7)
    expected = np.eye(3)
    for side in sides:
        expected = Rotation.from_rotvec(-np.array(side)).as_matrix() @ expected
    np.testing.assert_allclose(rotation_of(r.orientation[-1]), expected, atol=1e-7)
    assert np.abs(expected - np.eye(3)).max() > 0.5


def test_a_sphere_around_an_eighth_of_another_turns_by_its_excess() -> None:
    """Three sides of a right angle each, after each a right angle to the left: the carried frame turns by pi/2.

    In that frame the sphere turns as far as the contact comes over it, pi/2 R/r a side.
    """
    size = 0.3
    ways = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0)]) * pi / 2
    p = RollParams(radius=size, start_at=(1, 0, 0), heading=(0, 1, 0), **SHARP)
    r = roll_on(Sphere(1.0), p, rows([tuple(way) for way in ways * (1 + size) / size]))
    np.testing.assert_allclose(r.contact[-1], [1, 0, 0], atol=1e-8)
    seen = np.eye(3)
    for way in ways / size:
        seen = Rotation.from_rotvec(-way).as_matrix() @ seen
    first = np.stack([[0, 0, -1.0], [0, 1, 0], [1, 0, 0]], axis=1)
    excess = Rotation.from_rotvec([pi / 2, 0, 0]).as_matrix()
    np.testing.assert_allclose(rotation_of(r.orientation[-1]), excess @ first @ seen @ first.T, atol=1e-8)


@pytest.mark.parametrize("heading", [(-1.0, 0.1, 0.0), (-1.0, -0.3, 0.0), (-1.0, 0.6, 0.0)])
def test_the_joint_of_a_y_is_a_place_like_others(heading: tuple[float, float, float]) -> None:
    body = y_of_capsules()
    r = roll_on(body, RollParams(radius=0.1, start_at=(1.0, 0, 0.4), heading=heading, omega=(1, 0, 0), duration=25))
    assert r.status is RollStatus.FINISHED
    along = np.arctan2(r.contact[:, 1], r.contact[:, 0]) / (2 * pi / 3)
    assert len({round(a) % 3 for a in along[np.linalg.norm(r.contact, axis=1) > 0.9]}) > 1  # more than one branch
    assert r.path_object == pytest.approx(r.path_sphere, rel=2e-5)


def valley(angle: float) -> Union:
    """A floor and a wall that rises from x = 1 by an angle."""
    return Union((Plane(), Plane((-np.sin(angle), 0, np.cos(angle)), -float(np.sin(angle)))))


@pytest.mark.parametrize("angle", [pi / 2, pi / 3, 2.0])
def test_a_second_contact_is_followed_or_ends_the_run(angle: float) -> None:
    """Both touch where the centre is on the bisector: the contact at 1 - R_s tan(angle / 2)."""
    p = RollParams(radius=0.3, start_at=(0, 0, 0), heading=(1, 0.0, 0), omega=(1, 0, 0), duration=6.0)
    body, before = valley(angle), 1 - 0.3 * np.tan(angle / 2)
    stopped = roll_on(body, p)
    assert stopped.status is RollStatus.MET
    assert before < stopped.contact[-1, 0] < before + 0.1  # 5 % of the radius deep
    r = roll_on(body, replace(p, on_meeting="follow"))
    assert r.status is RollStatus.FINISHED
    assert body.level(r.centre).value.min() > 0.3 - 1e-9  # never in it
    # As far up the wall as what was left of the way, the two places being as far from the edge.
    left = 0.3 * 6.0 - before
    end = (left + 1 - before) * np.array([np.cos(angle), 0, np.sin(angle)]) + [1, 0, 0]
    np.testing.assert_allclose(r.contact[-1], end, atol=1e-6)
    assert r.path_object == pytest.approx(r.path_sphere, rel=1e-5)
    np.testing.assert_allclose(np.diff(r.centre, axis=0)[:, 0].max(), 0.3 / 100, atol=1e-6)  # no jump of the centre


def test_following_between_two_capsules_never_sinks_into_either() -> None:
    body = Union((Capsule((-3, 0, 0), (3, 0, 0), 0.5), Capsule((0, -3, 0.9), (0, 3, 0.9), 0.5)))
    p = RollParams(radius=0.2, start_at=(-1.5, 0, 0.5), heading=(1, 0.0, 0), omega=(1, 0.05, 0), duration=20.0)
    assert roll_on(body, p).status is RollStatus.MET
    r = roll_on(body, replace(p, on_meeting="follow"))
    assert body.level(r.centre).value.min() > 0.2 - 1e-6
    assert r.contact[:, 2].max() > 1.0  # over the other one


def test_a_smooth_hollow_that_is_too_sharp_ends_the_run() -> None:
    r = roll_on(Ellipsoid(2.0, 1.0, 1.0), RollParams(side="inside", radius=0.55, start_at=(0, 0, 1), heading=(1, 0, 0),
                                                    omega=(1, 0, 0), duration=40))  # fmt: skip
    assert r.status is RollStatus.TIGHT
    assert r.margin[-1] == pytest.approx(1e-4 / 0.55, abs=1e-6)


@dataclass(frozen=True)
class Known:
    """A plane of which nothing is known beyond x = 1, little beyond x = 0.5."""

    cloud: Points
    radius: float = 1.0

    def level(self, points: Points) -> LevelSet:
        found = Plane().level(points)
        return LevelSet(np.where(points[:, 0] < 1, found.value, np.nan), found.gradient, found.hessian)

    def trust(self, points: Points) -> Any:
        return np.where(points[:, 0] < 0.5, 2, 1)


def test_runs_end_where_the_surface_does_where_it_is_not_trusted_and_where_points_lie_in_the_sphere() -> None:
    away = Known(np.array([[9.0, 9.0, 9.0]] * 12) + np.eye(12, 3))
    p = RollParams(start_at=(0, 0, 0), heading=(1, 0.0, 0), omega=(1, 0, 0), duration=6.0)
    r = roll_on(away, p)
    assert r.radius == 0.25
    assert r.status is RollStatus.ENDED
    assert r.contact[-1, 0] == pytest.approx(1, abs=0.01)
    assert any("little seen" in warning for warning in r.warnings)
    seen = roll_on(away, replace(p, trusted="measured"))
    assert seen.status is RollStatus.DOUBTFUL
    assert seen.contact[-1, 0] == pytest.approx(0.5, abs=1e-6)
    x, y = np.meshgrid(np.linspace(-1, 2, 61), np.linspace(-1, 1, 41))
    floor = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    pole = np.array([[0.8, 0, z] for z in np.linspace(0.05, 0.5, 30)])
    met = roll_on(Known(np.concatenate([floor, pole])), p)
    assert met.status is RollStatus.MET
    assert met.contact[-1, 0] == pytest.approx(0.8 - sqrt(0.2**2 - 0.01**2), abs=0.01)  # 0.2 radii deep
    assert roll_on(Known(np.concatenate([floor, pole])), replace(p, meet=False)).status is RollStatus.ENDED


@pytest.mark.parametrize(
    ("wrong", "said"),
    [({"start_at": None}, "needs the start as a point"), ({"start_at": (0, 0, 9)}, "from the surface"),
     ({"radius": None}, "radius of the sphere is missing"), ({"heading": (0, 0, 1)}, "along the normal"),
     ({"side": "inside", "radius": 1.1}, "cannot stand inside")],
)  # fmt: skip
def test_a_start_that_makes_no_sense_is_told(wrong: dict[str, Any], said: str) -> None:
    p: dict[str, Any] = {"radius": 0.2, "start_at": (0, 0, 1.0), "duration": 1.0}
    with pytest.raises(TiskelError, match=said):
        roll_on(Sphere(1.0), RollParams(**{**p, **wrong}))


def test_a_chart_does_not_take_the_model_of_a_body() -> None:
    with pytest.raises(TiskelError, match="roll_on"):
        roll(analytic.Torus(5, 2), RollParams(model="body", radius=0.1))
