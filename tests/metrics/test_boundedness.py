"""Boundedness against solid angles, against the hull of all directions, and where the definition fails."""

import numpy as np
import pytest

from reference.fixtures import Load
from reference.quality import hull_beta
from tiskel import ShapeParams, make_shape, shape_graph
from tiskel.arrays import Numbers, Points
from tiskel.geometry.oriented import oriented_cloud
from tiskel.metrics.boundedness import HULL, OUTSIDE, boundedness, coverage, view_of
from tiskel.metrics.hulls import hull_shares, outside_hull


def hull_share(place: Numbers, cloud: Points) -> float:
    """Return beta of one place by the hull, clear or not."""
    view = view_of(cloud)
    return float(hull_shares(place[None], coverage(place[None], view).seen, view)[0])


def disc(rings: int = 60) -> Points:
    """A unit disc of concentric rings, evenly spaced."""
    made = [np.zeros((1, 3))]
    for i in range(1, rings + 1):
        turn = 2 * np.pi * np.arange(6 * i) / (6 * i)
        made.append(np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * i / rings)
    return np.concatenate(made)


@pytest.mark.parametrize("height", [0.05, 0.2, 0.5, 1.0, 3.0, -0.2, -1.0])
def test_above_and_below_a_disc_beta_is_that_of_its_solid_angle(height: float) -> None:
    """The directions fill a cap of half-angle atan(1 / h): its area and that of the plane face that closes it."""
    half = np.arctan(1 / abs(height))
    exact = (2 * np.pi * (1 - np.cos(half)) + np.pi * np.sin(half) ** 2) / (4 * np.pi)
    # triangles between directions up to 1 / 60 / h apart lie below the sphere; one vector per cell costs 0.005
    assert hull_share(np.array([0.0, 0, height]), disc()) == pytest.approx(exact, abs=0.02)


def test_on_a_disc_the_directions_are_a_flat_circle_of_two_sides() -> None:
    assert hull_share(np.zeros(3), disc()) == pytest.approx(0.5, abs=0.001)  # 360 directions are a polygon
    assert hull_share(np.zeros(3), np.outer([1.0, 2, -1], [1, 0, 0])) == 0


def test_close_to_a_large_disc_beta_approaches_the_threshold() -> None:
    """A point on a flat, endless surface has (2 pi + pi) / 4 pi."""
    beta = [hull_share(np.array([0.0, 0, h]), disc(120)) for h in (0.3, 0.1, 0.05)]
    assert beta[0] < beta[1] < beta[2] < 0.75
    assert beta[2] == pytest.approx(0.75, abs=0.05)


@pytest.mark.slow
def test_classes_agree_with_the_hull_of_all_directions(toolbox: Load) -> None:
    """Clear cases and the thinned hull against the reference: 99 % of skeletal points, 95 % in the doubtful band."""
    generator = np.random.default_rng(11)
    doubtful: list[bool] = []
    for name in ("hammer", "horse", "joint", "fertility", "cave"):
        arrays = toolbox(f"{name}_lbc")
        cloud, points = arrays["points"], arrays["contracted"]
        some = points[np.sort(generator.choice(len(points), 40, replace=False))]
        agree = [
            (hull_beta(p, cloud) >= 0.75) == b for p, b in zip(some, boundedness(some, cloud).bounded, strict=True)
        ]
        assert np.mean(agree) >= 0.99
        low, high = cloud.min(axis=0), cloud.max(axis=0)
        places = (low + high) / 2 + generator.uniform(-0.6, 0.6, size=(2500, 3)) * (high - low)
        found = boundedness(places, cloud)
        for i in np.flatnonzero(np.abs(found.beta - 0.75) < 0.2)[:200]:
            beta = hull_beta(places[i], cloud)
            if 0.65 <= beta <= 0.85:
                doubtful.append((beta >= 0.75) == found.bounded[i])
    assert len(doubtful) >= 300
    assert np.mean(doubtful) >= 0.95


def test_many_directions_are_thinned_without_harm() -> None:
    """A cap of 50 000 directions about a hole: the squares are 0.02 to 0.03 wide, and so far may the rim draw back."""
    turn = np.random.default_rng(2).normal(size=(120_000, 3))
    directions = turn / np.linalg.norm(turn, axis=1)[:, None]
    cap = directions[directions[:, 2] < -0.1]
    assert hull_share(np.zeros(3), cap) == pytest.approx(hull_beta(np.zeros(3), cap), abs=0.01)


def test_clear_cases_are_settled_without_a_hull(capsule: Points) -> None:
    axis = np.stack([np.zeros(9), np.zeros(9), np.linspace(-0.6, 0.6, 9)], axis=1)
    inside, outside = boundedness(axis, capsule), boundedness(axis + [5.0, 0, 0], capsule)
    assert inside.bounded.all()
    assert not outside.bounded.any()
    assert (inside.settled_by != HULL).all()
    assert (outside.settled_by == OUTSIDE).all()
    assert (outside.beta < 0.75).all()


def test_a_place_at_a_cloud_point_is_counted_and_judged_by_the_others(capsule: Points) -> None:
    found = boundedness(capsule[:30], capsule)
    assert (found.coincident == 1).all()
    assert np.isfinite(found.beta).all()
    assert [hull_beta(p, np.delete(capsule, i, axis=0)) >= 0.75 for i, p in enumerate(capsule[:30])] == (
        found.bounded.tolist()
    )


def test_outside_a_torus_tube_beta_fails_and_the_inside_test_does_not() -> None:
    """Side by side: places 0.1 tube radii outside the tube, many of which beta calls bounded."""
    graph = shape_graph("torus")
    cloud = make_shape(graph, ShapeParams(count=4096))[0]
    turn = 2 * np.pi * np.random.default_rng(4).random((300, 2))
    ring = np.stack([np.cos(turn[:, 0]), np.sin(turn[:, 0]), np.zeros(300)], axis=1)
    away = np.cos(turn[:, 1])[:, None] * ring + np.sin(turn[:, 1])[:, None] * [0, 0, 1]
    outside, inside = 0.7 * ring + 0.22 * away, 0.7 * ring + 0.18 * away
    surface = oriented_cloud(cloud, 0.7 * cloud * [1, 1, 0] / np.linalg.norm(cloud[:, :2], axis=1)[:, None])
    assert 0.2 < boundedness(outside, cloud).bounded.mean() < 0.7  # the paper's definition assumes a convex shape
    assert boundedness(inside, cloud).bounded.mean() > 0.95
    assert surface.contains(outside).mean() < 0.02
    assert surface.contains(inside).mean() > 0.98


def test_a_flat_cloud_settles_nothing_by_its_hull() -> None:
    assert not outside_hull(np.ones((3, 3)), disc(5)).any()
