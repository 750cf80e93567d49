"""Plans: they arrive when they are rolled, keep out of what is to be avoided, and are refused for the true reason."""

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tiskel import Inputs, Plan, PlanParams, RollParams, TiskelError, plan_roll, roll_on
from tiskel.rolling.ambient import Ground, frame_about
from tiskel.rolling.courses import clock, tight_centres
from tiskel.rolling.many import Poses, roll_many
from tiskel.rolling.reachable import Standing
from tiskel.rolling.second import Surroundings
from tiskel.rolling.sphere import rotation_of
from tiskel.surfaces.implicit import projected
from tiskel.surfaces.implicit_bodies import Capsule, Plane, Sphere, Torus, Union, y_of_capsules

ROD = Capsule((-1, 0, 0), (1, 0, 0), 0.5)


def rolled_again(body: Any, plan: Plan) -> Any:
    """The plan as a user rolls it, at the usual tolerances."""
    p = plan.params
    return roll_on(
        body,
        RollParams(radius=p.radius, start_at=p.start_at, attitude=p.start_attitude, side=p.side, meet=True),
        plan.inputs,
    )


def arrives(body: Any, plan: Plan) -> None:
    """Within 1e-3 radii and a degree, rolled again, without slip, and without spin where none is allowed."""
    p, run = plan.params, rolled_again(body, plan)
    assert p.radius is not None
    assert run.status.value == "finished"
    goal = projected(body, np.array([p.goal]))[0]
    assert np.linalg.norm(run.contact[-1] - goal) < 1.5e-3 * p.radius  # the plan was made at sharper tolerances
    if p.attitude is not None:
        wanted = Rotation.from_quat(np.array(p.attitude)[[1, 2, 3, 0]])
        turned = Rotation.from_matrix(rotation_of(run.orientation[-1])) * wanted.inv()
        assert np.degrees(turned.magnitude()) < 1.05
    assert not plan.inputs.slips
    if not p.spin:
        assert not plan.inputs.values[:, 2].any()
    assert run.margin.min() > 0
    turns = np.linalg.norm(plan.inputs.values[:, :3], axis=1)
    assert turns.max() < 1.5 * p.speed
    np.testing.assert_array_equal(plan.inputs.values[[0, -1]], 0)  # from rest to rest


def test_the_way_along_a_rod_is_the_straight_one() -> None:
    plan = plan_roll(ROD, PlanParams(start_at=(-0.9, 0, 0.5), goal=(0.9, 0, 0.5), radius=0.125))
    arrives(ROD, plan)
    assert plan.run.path_object == pytest.approx(1.8, rel=1e-3)


def test_the_way_around_a_sphere_is_a_great_circle() -> None:
    plan = plan_roll(Sphere(1.0), PlanParams(start_at=(1, 0, 0), goal=(-0.6, 0.8, 0), radius=0.25))
    arrives(Sphere(1.0), plan)
    assert plan.run.path_object == pytest.approx(np.arccos(-0.6), rel=2e-3)


@pytest.mark.slow
def test_ways_are_looked_at_until_one_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    """Around what is too tight ways slide on by less than a radius a look: after eight looks there was no plan."""
    angles = np.linspace(-0.7, 0.7, 13)
    looks = iter(0.75 * np.stack([0 * angles, np.sin(angles), np.cos(angles)], axis=1))

    def tight(standing: Any, way: Any) -> Any:
        return next((one[None] for one in looks), tight_centres(standing, way))

    monkeypatch.setattr("tiskel.rolling.plan.tight_centres", tight)
    plan = plan_roll(ROD, PlanParams(start_at=(-0.9, 0, 0.5), goal=(0.9, 0, 0.5), radius=0.25))
    arrives(ROD, plan)
    assert np.abs(plan.run.contact[:, 1]).max() > 0.3  # around what was closed


QUARTER = (float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5)))


@pytest.mark.parametrize(
    ("body", "spin"),
    [
        pytest.param(ROD, False, id="capsule"),
        pytest.param(ROD, True, id="capsule with spin", marks=pytest.mark.slow),
        pytest.param(Torus(1.5, 0.5), False, id="torus", marks=pytest.mark.slow),
        pytest.param(Torus(1.5, 0.5), True, id="torus with spin"),
    ],
)
def test_an_attitude_is_reached(body: Any, spin: bool) -> None:
    start, goal = projected(body, np.array([[0.9, 0.2, 0.5], [1.2, -0.4, 0.5]]))
    p = PlanParams(start_at=tuple(start), goal=tuple(goal), attitude=QUARTER, radius=0.125, spin=spin)
    plan = plan_roll(body, p)
    arrives(body, plan)
    assert plan.loop.shape == (3, 3)


def test_an_attitude_at_the_place_itself_is_a_closed_loop_of_the_plane() -> None:
    """Half a turn about the normal without spin: three moves whose rotations have that product, and that close."""
    p = PlanParams(start_at=(0, 0, 0), goal=(0, 0, 0), attitude=(0, 0, 0, 1), radius=0.5, speed=2.0)
    plan = plan_roll(Plane(), p)
    arrives(Plane(), plan)
    moves = plan.loop
    np.testing.assert_allclose(moves.sum(axis=0), 0, atol=1e-3)
    product = np.eye(3)
    first = frame_about(np.array([0, 0, 1.0]), None)
    for move in moves:
        product = Rotation.from_rotvec(-first @ move).as_matrix() @ product
    np.testing.assert_allclose(product, np.diag([-1.0, -1, 1]), atol=1e-3)


def test_the_joint_of_a_y_is_crossed() -> None:
    body = y_of_capsules()
    far = 1.1 * np.array([np.cos(2 * pi / 3), np.sin(2 * pi / 3), 0]) + [0, 0, 0.4]
    plan = plan_roll(body, PlanParams(start_at=(1.1, 0, 0.4), goal=tuple(far), radius=0.18))
    arrives(body, plan)
    assert np.linalg.norm(plan.run.contact, axis=1).min() < 1


def test_a_ball_to_avoid_is_gone_around() -> None:
    """A ball on the straight way along the top of the rod."""
    p = PlanParams(start_at=(-0.9, 0, 0.5), goal=(0.9, 0, 0.5), radius=0.125)
    ball = (0.0, 0.0, 0.7, 0.2)
    plan = plan_roll(ROD, replace(p, avoid=(ball,)))
    arrives(ROD, plan)
    assert np.linalg.norm(plan.run.centre - ball[:3], axis=1).min() > 0.2 + 0.125 - 1e-6
    assert plan.run.path_object > 1.85


@pytest.mark.parametrize(
    ("body", "changed", "said"),
    [
        (Union((Sphere(1.0), Sphere(0.5, (1.5, 0, 0)))), {"goal": (0.999, 0.01, 0.02)}, "cannot stand at the goal"),
        (Union((Sphere(1.0), Sphere(1.0, (5.0, 0, 0)))), {"goal": (5.0, 0, 1.0)}, "not connected"),
        (Sphere(1.0), {"goal": (0, 0, 9.0)}, "the goal .* is 8 from the surface"),
        (Sphere(1.0), {"goal": (0, 1.0, 0), "avoid": ((0, 1.3, 0, 0.3),)}, "cannot stand at the goal .* to be avoided"),
        (Torus(1.5, 0.5), {"side": "inside", "radius": 0.6, "start_at": (2, 0, 0), "goal": (-2, 0, 0)},
         "cannot stand at the start .* bends as sharply"),
        (Sphere(1.0), {"goal": (-1.0, 0, 0), "most_places": 100}, "100 places|limit"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_for_the_true_reason(body: Any, changed: dict[str, Any], said: str) -> None:
    p: dict[str, Any] = {"start_at": (0, 0, 1.0), "goal": (1.0, 0, 0), "radius": 0.1}
    with pytest.raises(TiskelError, match=said) as told:
        plan_roll(body, PlanParams(**{**p, **changed}))
    assert len(str(told.value)) <= 300


def test_the_sphere_that_would_fit_does() -> None:
    """In a tunnel of radius 1, of 0.97: it was told that less than 1 would fit."""
    for radius, fits in ((0.97, False), (0.935, True)):
        ground = Ground(Torus(5.0, 1.0), -1.0, radius)
        why = Standing(ground, Surroundings.of(ground), np.zeros((0, 4))).why_not(np.array([6.0, 0, 0]))
        assert (why == "") == fits
        assert fits or "one of less than 0.94 would fit" in why


@pytest.mark.parametrize("wrong", [{"speed": 0.0}, {"radius": -1.0}, {"attitude": (0, 0, 0, 0)}, {"avoid": ((1, 2),)}])
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(TiskelError, match=next(iter(wrong))):
        PlanParams(**{"start_at": (0, 0, 0), "goal": (1, 0, 0), **wrong})


def test_many_spheres_at_once_roll_as_one_does() -> None:
    """Steps of 0.02 s of the fourth order against the solver, on a torus."""
    body = Torus(1.5, 0.5)
    ground = Ground(body, 1.0, 0.2)
    start = projected(body, np.array([[1.8, 0.3, 0.3]]))
    frame = frame_about(ground.touches(start)[1][0], None)
    poses = Poses(start, np.array([[1.0, 0, 0, 0]]), frame[None, :, 0]).of(0, 2)
    t = np.linspace(0, 4, 201)
    omega = np.stack([np.column_stack([np.sin(t), a + 0 * t, 0.3 * np.cos(t)]) for a in (0.5, -0.4)], axis=1)
    flown = roll_many(ground, poses, omega, 0.02)
    for number in range(2):
        inputs = Inputs(t, np.column_stack([omega[:, number], np.zeros((201, 3))]))
        r = roll_on(body, RollParams(radius=0.2, start_at=tuple(start[0]), rtol=1e-9, atol=1e-11), inputs)
        np.testing.assert_allclose(flown.poses.place[number], r.contact[-1], atol=1e-6)
        np.testing.assert_allclose(rotation_of(flown.poses.q[number]), rotation_of(r.orientation[-1]), atol=1e-6)


@pytest.mark.parametrize("angle", [0.05, 0.7, 5.0, 40.0])
def test_the_clock_of_a_way_begins_and_ends_at_rest(angle: float) -> None:
    shares, step = clock(angle)
    assert (shares[0], shares[-1]) == (0, pytest.approx(1, abs=1e-12))
    speeds = np.diff(shares) * angle / step
    assert speeds.min() > 0
    assert speeds.max() < 1 + 1e-9
    assert speeds[[0, -1]].max() < 0.3 * speeds.max()
