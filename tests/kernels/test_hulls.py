"""Areas of hulls of directions against Qhull."""

import numpy as np
import pytest

from reference.quality import hull_beta
from tiskel.arrays import Points
from tiskel.metrics import hulls
from tiskel.metrics.boundedness import coverage, view_of

GENERATOR = np.random.default_rng(6)


def lattice(count: int) -> Points:
    axes = [np.arange(-count, count + 1.0)] * 3
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3) + [0.3, 0.2, 0.1]


CLOUDS = {
    "ball": GENERATOR.normal(size=(700, 3)),
    "flat": GENERATOR.normal(size=(700, 3)) * [1, 1, 0.1],
    "rod": GENERATOR.normal(size=(700, 3)) * [1, 0.1, 0.1],
    "cap": GENERATOR.normal(size=(700, 3)) + [0, 0, 3],
    "four": GENERATOR.normal(size=(4, 3)),
    "five": GENERATOR.normal(size=(5, 3)),
    "lattice": lattice(4),
    "pairs": np.repeat(GENERATOR.normal(size=(300, 3)), 2, axis=0),
    "pairs to rounding": np.repeat(GENERATOR.normal(size=(300, 3)), 3, axis=0) * (1 + GENERATOR.random((900, 1))),
    "nearly pairs": np.repeat(GENERATOR.normal(size=(300, 3)), 2, axis=0) + 1e-9 * GENERATOR.normal(size=(600, 3)),
    "cone and pole": np.concatenate(
        [np.stack([np.cos(np.arange(50.0)), np.sin(np.arange(50.0)), np.full(50, 0.2)], axis=1), [[0, 0, 1.0]]]
    ),
}


def areas(cloud: Points, slack: float, thin: bool, room: int = 4096) -> float:
    """The share of the sphere about the origin, of all directions however large it is."""
    view, place = view_of(cloud), np.zeros((1, 3))
    seen = coverage(place, view).seen
    seen[0, np.flatnonzero(seen[0] >= 0)[8:]] = -1  # most of the directions are met on the way
    return float(hulls._areas(place, seen, view, slack, thin, room)[0])


@pytest.mark.parametrize("name", CLOUDS)
def test_areas_are_those_of_qhull(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hulls, "BOUNDED", 2.0)  # never enough
    cloud = CLOUDS[name]
    # Qhull takes faces together that are flat to 1e-14 or so; a hull of near duplicates may differ by their distance.
    assert areas(cloud, 0.0, thin=False) == pytest.approx(hull_beta(np.zeros(3), cloud), abs=1e-8)


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("slack", [0.0005, 0.004, 0.02])
def test_slack_costs_no_more_than_steiner_says(name: str, slack: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hulls, "BOUNDED", 2.0)
    cloud = CLOUDS[name]
    lost = hull_beta(np.zeros(3), cloud) - areas(cloud, slack, thin=False)
    assert -1e-8 <= lost <= 2 * slack + slack**2


def test_a_hull_without_room_is_of_the_vectors_that_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hulls, "BOUNDED", 2.0)
    cloud = CLOUDS["ball"]
    some = areas(cloud, 0.0, thin=False, room=100)
    assert 0.5 < some < areas(cloud, 0.0, thin=False)


def test_directions_in_a_plane_have_two_sides() -> None:
    turn = np.arange(60) * np.pi / 30
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    assert areas(circle, 0.0, thin=False) == pytest.approx(0.5, abs=0.002)  # a polygon of 60 corners


def test_hulls_without_a_volume_count_both_sides_or_nothing() -> None:
    square = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    assert hulls.hull_area(square) == pytest.approx(2 * 2)
    assert hulls.hull_area(square[:3] @ np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]])) == pytest.approx(2 * 1)
    for nothing in (square[:0], square[:1], square[:2], np.repeat(square[:1], 5, axis=0), np.repeat(square[:2], 3, 0)):
        assert hulls.hull_area(nothing) == 0
