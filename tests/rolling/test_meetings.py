"""Contacts that change: a ball that is wedged, one that rattles, and one that comes to where it does not fit."""

from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
import pytest

from tiskel import RollParams, RollStatus, roll_on
from tiskel.rolling.ambient import AmbientRate, Ground, frame_about
from tiskel.rolling.free_solution import _at_second
from tiskel.rolling.inputs import constant
from tiskel.rolling.second import Surroundings
from tiskel.surfaces.implicit import LevelSet
from tiskel.surfaces.implicit_bodies import Plane, Union

RADIUS = 0.3
AHEAD = RollParams(radius=RADIUS, start_at=(0, 0, 0), heading=(1, 0.0, 0), omega=(1, 0, 0), duration=6.0,
                   on_meeting="follow")  # fmt: skip


def valley(angle: float) -> Union:
    """A floor and a wall that rises from x = 1 by an angle."""
    return Union((Plane(), Plane((-np.sin(angle), 0, np.cos(angle)), -float(np.sin(angle)))))


@dataclass(frozen=True)
class Bent:
    """A floor and a wall, upright at x = 1, that is said to bend by this radius where a ball meets it."""

    radius: float

    def level(self, points: Any) -> LevelSet:
        found = valley(pi / 2).level(points)
        there = np.linalg.norm(points - [1, 0, RADIUS], axis=1) < 0.02 * RADIUS
        return found._replace(hessian=found.hessian - there[:, None, None] * np.diag([0.0, 1, 0]) / self.radius)


def test_a_ball_that_slips_under_a_slope_is_wedged() -> None:
    """Without turning it is pushed along the floor; along the slope above it that would take it into the floor."""
    pushed = replace(AHEAD, omega=(0, 0, 0), velocity=(0.3, 0, 0), twist="world")
    r = roll_on(valley(2.0), pushed)
    assert r.status is RollStatus.MET
    assert r.reason.startswith("it is wedged between two places, at t = ")
    met = 1 - RADIUS * np.tan(1.0)  # where both touch: the centre is on the bisector
    assert r.contact[-1] == pytest.approx([met, 0, 0], abs=1e-6)
    assert r.t[-1] == pytest.approx(met / 0.3, abs=1e-5)
    up = roll_on(valley(1.0), pushed)  # a slope that rises: it is pushed up
    assert up.status is RollStatus.FINISHED
    assert up.contact[-1, 2] > 0.3


def test_a_contact_that_changes_too_often_ends_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tiskel.rolling.free_solution.CHANGES", 1)
    r = roll_on(valley(pi / 2), AHEAD)
    assert r.status is RollStatus.MET
    assert r.reason.startswith("the contact changed 1 times, at t = ")
    assert r.contact[-1, 0] == pytest.approx(1 - RADIUS, abs=1e-6)


@pytest.mark.parametrize(("bend", "status"), [(RADIUS, RollStatus.TIGHT), (100 * RADIUS, RollStatus.FINISHED)])
def test_a_second_place_that_is_too_tight_ends_the_run_there(bend: float, status: RollStatus) -> None:
    r = roll_on(Bent(bend), AHEAD)
    assert r.status is status
    if status is RollStatus.TIGHT:
        assert r.reason.startswith("lambda_min(K_o) + 1/R_s is 0: the surface bends as sharply as the sphere, at t = ")
        assert r.t[-1] == pytest.approx((1 - RADIUS) / RADIUS, abs=1e-4)
    else:
        assert r.contact[-1] == pytest.approx([1, 0, RADIUS + 1.8 - 0.7], abs=1e-3)


@pytest.mark.parametrize("surface", [Plane(), valley(pi / 2)])
def test_a_ball_changes_to_the_second_place_only_where_there_is_one(surface: Any) -> None:
    """Where it touches floor and wall; on the floor alone there is nothing to change to."""
    ground = Ground(surface, 1.0, RADIUS)
    place = np.array([1 - RADIUS, 0, 0])
    rate = AmbientRate(ground, constant(AHEAD), "object", place)
    y = np.concatenate([np.zeros(3), [1, 0, 0, 0], frame_about(ground.touch(place).z, (1, 0, 0))[:, 0]])
    changed = _at_second(rate, Surroundings.of(ground), 0.0, y)
    if isinstance(surface, Plane):
        assert changed is None
    else:
        assert changed is not None
        np.testing.assert_allclose(rate.place(changed), [1, 0, RADIUS], atol=1e-9)
        np.testing.assert_array_equal(changed[3:7], y[3:7])  # its pose stays
