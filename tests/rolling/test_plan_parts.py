"""Parts of plans one by one: loops, segments and shooting, and what each says where it does not come to its end."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from tiskel import PlanParams, RollParams, TiskelError, plan_roll, roll_on
from tiskel.rolling.ambient import Ground, frame_about
from tiskel.rolling.courses import tracked
from tiskel.rolling.loops import Loop, loop_to
from tiskel.rolling.many import Poses
from tiskel.rolling.plan import _drafts, _rolled
from tiskel.rolling.reachable import Standing
from tiskel.rolling.second import Surroundings
from tiskel.rolling.segments import TAIL, Shooting, joined, of_way
from tiskel.rolling.trajectory import RollStatus
from tiskel.surfaces.implicit import LevelSet
from tiskel.surfaces.implicit_bodies import Capsule, Plane, Sphere, Torus

ROD = Capsule((-1, 0, 0), (1, 0, 0), 0.5)
QUARTER = (float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5)))
LAST = -1
HALF = 0.5  # radius of most spheres here


@dataclass(frozen=True)
class Ending:
    """A plane of which nothing is known beyond x = 1, or only in a gap from there on."""

    width: float = np.inf

    def level(self, points: Any) -> LevelSet:
        found = Plane().level(points)
        known = (points[:, 0] < 1) | (points[:, 0] > 1 + self.width)
        return LevelSet(np.where(known, found.value, np.nan), np.where(known[:, None], found.gradient, np.nan),
                        found.hessian)  # fmt: skip


def on(surface: Any, place: Any, radius: float, sigma: float = 1.0, balls: Any = ()) -> tuple[Standing, Poses]:
    """What a sphere needs to stand on a surface, and the pose of one at a place of it."""
    ground = Ground(surface, sigma, radius)
    at = np.array([place], float)
    frame = frame_about(ground.touches(at)[1][0], None)
    standing = Standing(ground, Surroundings.of(ground), np.array(balls, float).reshape(-1, 4))
    return standing, Poses(at, np.array([[1.0, 0, 0, 0]]), frame[None, :, 0])


def loop_at(standing: Standing, pose: Poses, place: Any) -> Loop:
    return loop_to(standing, pose, np.array(place, float), np.array(QUARTER), False, np.random.default_rng(0))


def test_no_loop_fits_where_every_place_is_too_tight() -> None:
    """A ball of 0.97 in a tunnel of radius 1 has 0.03 of the room that 0.06 is wanted of."""
    standing, pose = on(Torus(5.0, 1.0), (6.0, 0, 0), 0.97, sigma=-1.0)
    loop = loop_at(standing, pose, (6.0, 0, 0))
    assert not loop.free
    assert loop.off == np.inf
    assert not loop.moves.any()


def test_a_loop_through_what_is_closed_is_exact_and_not_free() -> None:
    """All loops begin where the sphere is: closed, none of them is free, and what is left is told all the same."""
    standing, pose = on(Plane(), (0, 0, 0), HALF)
    assert loop_at(standing, pose, (0, 0, 0)).free
    closed = loop_at(standing.without(np.array([[0, 0, HALF]])), pose, (0, 0, 0))
    assert not closed.free
    assert closed.off < 1e-5
    np.testing.assert_allclose(closed.moves.sum(axis=0), 0, atol=1e-4)


def test_a_loop_to_a_place_that_is_too_far_is_as_near_as_its_steps_come() -> None:
    """Ten steps of at most 0.7 radians go no further than 7 of the 40 radii."""
    standing, pose = on(Plane(), (0, 0, 0), HALF)
    loop = loop_at(standing, pose, (40 * HALF, 0, 0))
    assert not loop.free
    assert 40 - 3 * 7 < loop.off < 40


@pytest.mark.parametrize(
    ("surface", "at", "radius", "sigma", "said"),
    [
        (Torus(5.0, 1.0), (6.0, 0, 0), 0.97, -1.0, "no loop fits; try spin"),
        (Ending(0.1), (0.61, 0, 0), 0.25, 1.0, "leads through a place that is too tight"),
    ],
)
def test_ways_without_a_draft_say_why(surface: Any, at: Any, radius: float, sigma: float, said: str) -> None:
    """The second way leads over a gap in what is known, which lies between its places."""
    standing, pose = on(surface, at, radius, sigma)
    way = np.array(at) + np.linspace(0, 1, 9)[:, None] * np.array([1.0, 0, 0]) * (sigma > 0)
    p = PlanParams(start_at=at, goal=tuple(way[LAST]), attitude=QUARTER, radius=radius)
    reasons: list[str] = []
    assert not list(_drafts(standing, pose, way, way[LAST], p, reasons))
    assert reasons
    assert all(said in reason for reason in reasons)


def test_a_draft_whose_loop_is_not_free_says_what_it_leaves() -> None:
    standing, pose = on(Plane(), (0, 0, 0), HALF)
    way = np.zeros((2, 3))
    p = PlanParams(start_at=(0, 0, 0), goal=(0, 0, 0), attitude=QUARTER, radius=HALF)
    reasons: list[str] = []
    assert not list(_drafts(standing.without(np.array([[0, 0, HALF]])), pose, way, way[LAST], p, reasons))
    assert all("the best loop tried leaves" in reason and "radians" in reason for reason in reasons)
    assert len(reasons) == 2  # at the goal and at the start


def test_a_way_through_a_ball_to_avoid_is_given_up() -> None:
    standing, pose = on(Plane(), (0, 0, 0), HALF, balls=[(1.0, 0, HALF, 0.1)])
    way = np.linspace([0, 0, 0], [2.0, 0, 0], 9)
    omega, step, _ = tracked(standing, pose, way)
    p = PlanParams(start_at=(0, 0, 0), goal=(2, 0, 0), radius=HALF)
    for balls, said in ((standing.balls, ["its way cannot be kept out of the balls to avoid; make them smaller"]),
                        (standing.balls[:0], [])):  # fmt: skip
        reasons: list[str] = []
        there = replace(standing, balls=balls)
        found: Any = _rolled(Plane(), there, pose, of_way(omega, step), way, np.zeros((0, 3)), p, reasons)
        assert reasons == said
        assert (np.shape(found) == (0, 3)) == bool(said)


@pytest.mark.parametrize(
    ("attitude", "rounds", "said"),
    [(None, 6, r"it arrives \S+ radii off after 6 corr"), (QUARTER, 2, r"radii off and \S+ degrees after 2 corr")],
)
def test_a_plan_that_never_arrives_says_by_how_much(
    monkeypatch: pytest.MonkeyPatch, attitude: Any, rounds: int, said: str
) -> None:
    monkeypatch.setattr("tiskel.rolling.plan.ROUNDS", rounds)
    goal = (0, 0, 0) if attitude else (1.0, 0, 0)
    with pytest.raises(TiskelError, match=rf"no plan found for a sphere of radius 0\.5: .*{said}"):
        plan_roll(Plane(), PlanParams(start_at=(0, 0, 0), goal=goal, attitude=attitude, radius=HALF, near=1e-300))


def test_a_place_where_a_run_ends_early_is_gone_around(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first run ends on the top of the rod; the next plan keeps away from there."""
    runs = []

    def ending(*given: Any) -> Any:
        run = roll_on(*given)
        runs.append(run)
        if len(runs) > 1:
            return run
        half = len(run.t) // 2
        return replace(run, status=RollStatus.MET, reason="it meets a fly", centre=run.centre[:half])

    monkeypatch.setattr("tiskel.rolling.plan.roll_on", ending)
    plan = plan_roll(ROD, PlanParams(start_at=(-0.9, 0, 0.5), goal=(0.9, 0, 0.5), radius=0.25))
    assert len(runs) > 1
    end = runs[0].centre[len(runs[0].t) // 2 - 1]
    assert np.linalg.norm(plan.run.centre - end, axis=1).min() > 0.29 * 0.25  # closed about it: 0.3 radii


def test_after_some_runs_that_end_early_no_plan_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def ending(*given: Any) -> Any:
        run = roll_on(*given)
        half = len(run.t) // 2
        return replace(run, status=RollStatus.MET, reason="it meets a fly", centre=run.centre[:half])

    monkeypatch.setattr("tiskel.rolling.plan.roll_on", ending)
    monkeypatch.setattr("tiskel.rolling.plan.TRIES", 2)
    with pytest.raises(TiskelError, match="rolled, it ends early: it meets a fly; take a smaller one"):
        plan_roll(ROD, PlanParams(start_at=(-0.9, 0, 0.5), goal=(0.9, 0, 0.5), radius=0.25))


def test_where_all_ways_are_too_tight_the_search_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    looked = []

    def tight(standing: Standing, way: Any) -> Any:
        looked.append(len(standing.closed))
        return np.array([[0, 9.0, 9.0]])

    monkeypatch.setattr("tiskel.rolling.plan.tight_centres", tight)
    monkeypatch.setattr("tiskel.rolling.plan.LOOKS", 3)
    with pytest.raises(TiskelError, match="every way that was tried leads through places that are too tight"):
        plan_roll(ROD, PlanParams(start_at=(0, 0, 0.5), goal=(0.5, 0, 0.5), radius=0.25))
    assert looked == [0, 1, 2]


def test_only_the_tail_of_a_long_way_is_bent() -> None:
    """The head is rolled once; the whole arrives where it should, though the tail was set a little off."""
    standing, pose = on(Plane(), (0, 0, 0), HALF)
    way = np.linspace([0, 0, 0], [25.0, 0, 0], 99)  # 50 radians
    omega, step, _ = tracked(standing, pose, way)
    segments = of_way(omega, step)
    head, tail = segments
    assert len(head.shapes) == 0
    assert (len(tail.omega) - 1) * step == pytest.approx(TAIL, abs=2 * step)
    goal = way[LAST] + [0.2, 0.3, 0]
    shooting = Shooting(standing.ground, pose, segments, goal, None)
    assert (shooting.size, len(shooting.head)) == (4, 1)
    off = [np.linalg.norm(shooting.off(by[None])) for by in (np.zeros(4), shooting.solved(np.zeros(4)))]
    assert off[0] == pytest.approx(np.hypot(0.2, 0.3) / HALF, abs=1e-3)
    assert off[1] < 1e-5
    by = shooting.solved(np.zeros(4))
    run = roll_on(Plane(), RollParams(radius=HALF, start_at=(0, 0, 0)), joined(shooting.with_shapes(by), 1.0))
    np.testing.assert_allclose(run.contact[LAST], goal, atol=1e-3)


def test_shooting_comes_as_near_as_its_steps_allow() -> None:
    """Eight steps of half a radian in each of two halves do not make good forty."""
    standing, pose = on(Sphere(100.0), (0, 0, 100.0), HALF)
    way = 100 * np.array([[np.sin(a), 0, np.cos(a)] for a in np.linspace(0, 0.02, 9)])
    omega, step, _ = tracked(standing, pose, way)
    shooting = Shooting(standing.ground, pose, of_way(omega, step), np.array([20.0, 0, 98.0]), None)
    off = [float(np.linalg.norm(shooting.off(by[None]))) for by in (np.zeros(4), shooting.solved(np.zeros(4)))]
    assert off[0] - 9 < off[1] < off[0] - 3


def test_at_the_end_of_what_is_known_a_way_is_left_as_it_is() -> None:
    """Of a nudge to and fro one ends in nothing: no slope is known, so no step is taken."""
    standing, pose = on(Ending(), (0, 0, 0), HALF)
    way = np.linspace([0, 0, 0], [0.9999, 0, 0], 9)
    omega, step, _ = tracked(standing, pose, way)
    shooting = Shooting(standing.ground, pose, of_way(omega, step), np.array([0.9, 0.1, 0]), None)
    assert np.isfinite(shooting.off(np.zeros((1, 4)))).all()
    assert not shooting.step(np.zeros(4), np.array([0.2, -0.2])).any()
    assert not shooting.solved(np.zeros(4)).any()
