"""Two general bodies: a sphere among them, equal ways, the body where its contact is."""

from dataclasses import replace

import numpy as np
import pytest

from reference.tubes import tube
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.rolling.bodies import roll_body
from tiskel.rolling.roll import roll
from tiskel.rolling.sphere import rotation_of
from tiskel.rolling.trajectory import RollStatus
from tiskel.surfaces.analytic import Cone, Ellipsoid, EllipticCylinder, Plane, Torus, sphere

SHARP = RollParams(radius=0.3, omega=(0.5, 0.3, 0.4), velocity=(0.02, 0.01, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4),
                   duration=3.0, rate=20.0, rtol=1e-10, atol=1e-12)  # fmt: skip
TORUS = Torus(5.0, 2.0)


@pytest.mark.parametrize("side", ["outside", "inside"])
def test_a_sphere_as_a_body_is_the_rolling_sphere(side: str) -> None:
    params = RollParams(**{**SHARP.__dict__, "side": side})
    ours, theirs = roll(TORUS, params), roll_body(TORUS, sphere(0.3), params)
    np.testing.assert_allclose(theirs.state, ours.state, atol=1e-7)
    np.testing.assert_allclose(theirs.position, ours.centre, atol=1e-7)
    np.testing.assert_allclose(rotation_of(theirs.orientation), rotation_of(ours.orientation), atol=1e-7)
    np.testing.assert_allclose(theirs.margin, ours.margin, atol=1e-6)


def test_an_ellipsoid_touches_the_torus_where_both_have_their_contact() -> None:
    """The place on the body, posed, is the place on the object; no other place of the body is below the surface."""
    body = Ellipsoid(0.3, 0.4, 0.25)
    r = roll_body(TORUS, body, SHARP)
    assert r.status is RollStatus.FINISHED
    u, v = np.meshgrid(np.linspace(-1.5, 1.5, 41), np.linspace(-np.pi, np.pi, 81))
    places = np.stack(np.broadcast_arrays(*body.jet(u, v).f), axis=-1).reshape(-1, 3)
    for i in range(0, len(r.t), 10):
        turned = rotation_of(r.orientation[i])
        on_body = turned @ np.array(body.jet(*r.state[i, 2:4].tolist()).f, float) + r.position[i]
        np.testing.assert_allclose(on_body, r.contact[i], atol=1e-12)
        posed = places @ turned.T + r.position[i]
        # Distance to a torus of bend 5 and tube 2 about the third axis.
        outside = np.hypot(np.hypot(posed[:, 0], posed[:, 1]) - 5.0, posed[:, 2]) - 2.0
        assert outside.min() > -1e-9


def test_both_contact_ways_are_equally_long_without_slip() -> None:
    body = Ellipsoid(0.3, 0.4, 0.25)
    r = roll_body(TORUS, body, RollParams(**{**SHARP.__dict__, "velocity": (0.0, 0.0, 0.0), "rate": 500.0}))
    own = np.array([np.array(body.jet(*one).f, float) for one in r.state[:, 2:4].tolist()])
    ways = [np.linalg.norm(np.diff(way, axis=0), axis=1).sum() for way in (r.contact, own)]
    assert ways[0] == pytest.approx(ways[1], rel=1e-5)  # 1500 chords of bends of a radian in all


def test_a_body_that_slips_though_nobody_asked_for_it_is_told() -> None:
    """A ball over a thin blade, at the published tolerances: as a sphere it was told, as a body it was not."""
    p = RollParams(omega=(-0.1, -3.3, 0.7), start=(5.39, 0.51, 0.1, 0.1, 0.0), duration=6.0)
    blade, ball = EllipticCylinder(2.0, 0.1), Ellipsoid(10.0, 10.0, 10.0)
    loose, close = roll_body(blade, ball, replace(p, rtol=1e-3, atol=1e-5)), roll_body(blade, ball, p)
    apart = 100 * abs(loose.path_object - loose.path_body) / max(loose.path_object, loose.path_body)
    assert apart > 0.3
    assert any(f"over the body, {apart:.2g} % apart though there is no slip" in said for said in loose.warnings)
    assert close.warnings == ()
    assert close.path_object == pytest.approx(close.path_body, rel=1e-4)
    assert roll_body(blade, ball, replace(p, rtol=1e-3, atol=1e-5, velocity=(0, 0.05, 0))).warnings == ()


def test_a_body_that_bends_less_than_the_surface_does_not_fit() -> None:
    with pytest.raises(TiskelError, match="does not fit at the start: relative curvature -"):
        roll_body(Torus(5.0, 2.0), sphere(2.5), RollParams(side="inside", start=(0.3, 1.0, 0.1, 0.1, 0.4)))
    with pytest.raises(TiskelError, match="twist of the object"):
        roll_body(TORUS, sphere(0.3), RollParams(twist="world"))


def test_a_run_ends_at_the_apex_of_a_cone() -> None:
    r = roll_body(Cone(0.3), Ellipsoid(0.1, 0.1, 0.12), RollParams(omega=(-1, 0, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4),
                                                                  duration=60.0))  # fmt: skip
    assert r.status in (RollStatus.LEFT, RollStatus.STUCK)
    assert r.state[-1, 1] < 0.1


def test_a_body_stops_at_the_end_of_its_own_branch() -> None:
    """A barrel rolled along itself over a plane: it ran on over what its series says beyond its end."""
    v = np.linspace(0, np.pi, 200)
    barrel = tube(np.stack([v, 0 * v, 0 * v], axis=1), np.stack([1 + 0.3 * np.sin(v), 0 * v, 0 * v], axis=1))
    for way in (1.0, -1.0):
        p = RollParams(side="inside", omega=(way, 0, 0), start=(0, 0, 0.3, 1.0, 0), duration=60.0)
        r = roll_body(Plane(), barrel, p)
        assert r.status is RollStatus.LEFT
        assert "the body came to the end of its own branch" in r.reason
        assert min(abs(r.state[-1, 3]), abs(r.state[-1, 3] - np.pi)) < 1e-6


def test_a_pole_of_the_chart_is_named() -> None:
    """Straight over the pole of an ellipsoid: this was told as bodies that bend alike."""
    p = RollParams(side="inside", omega=(0.0, -1.0, 0.0), start=(0.0, 0, 0, 0, 0), duration=10)
    r = roll_body(Plane(), Ellipsoid(0.3, 0.4, 0.25), p)
    assert r.status is RollStatus.POLE
    assert r.reason.startswith("the contact came to a pole of the chart of the body, at u = +-pi/2")
    for way in (1.0, -1.0):
        q = RollParams(omega=(0.0, way, 0.0), start=(way * -1.56, 0, 0, 0, 0))
        over = roll_body(Ellipsoid(3, 4, 2.5), sphere(0.3), q)
        assert over.status is RollStatus.POLE
        assert "of the chart of the object" in over.reason
    with pytest.raises(
        TiskelError, match="the start lies outside: the contact came to a pole of the chart of the body"
    ):
        roll_body(Plane(), sphere(0.3), RollParams(side="inside", start=(0.0, 0, 1.5707963, 0, 0)))
