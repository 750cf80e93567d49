"""Which regime a cloud is given to: by itself, as it is told, and both in one graph."""

from typing import Any

import numpy as np
import pytest

from tiskel import (
    RadiusSource,
    RobustParams,
    ShapeParams,
    Skeleton,
    TiskelError,
    contract,
    extract_skeleton,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Points
from tiskel.gallery.trees import thickened, tree
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.network import prepared
from tiskel.methods.robust.regimes import surely_wires

TRUNK, TWIG = 0.5, 0.03  # radii
STEP = 0.07  # between the points of a twig


def skeleton_of(points: Points, **settings: Any) -> Skeleton:
    return extract_skeleton(contract(points, RobustParams(**settings)))


def tube(radius: float, length: float, around: int, ratio: float) -> Points:
    """Return scan lines along a tube, on which points are closer than the lines are apart by a ratio."""
    step = 2 * np.pi * radius / around
    angle, z = np.meshgrid(2 * np.pi * np.arange(around) / around, np.arange(0, length, step / ratio))
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1).reshape(-1, 3)
    return points + np.random.default_rng(0).normal(0, 0.02 * step, points.shape)


def trunk_with_twigs() -> Points:
    """Return a trunk, 4 long, and ten twigs of 3 about its top, thinner than their points are apart."""
    rng = np.random.default_rng(0)
    number, parts = np.arange(700), []
    angle = np.pi * (3 - 5**0.5) * number
    parts.append(np.stack([TRUNK * np.cos(angle), TRUNK * np.sin(angle), 4 * (number + 0.5) / 700], axis=1))
    for twig in range(10):
        turn = 2 * np.pi * twig / 10
        heading = np.array([np.cos(turn), np.sin(turn), 0.9]) / np.hypot(1, 0.9)
        along = np.arange(STEP / 2, 3, STEP)
        off = rng.normal(size=(len(along), 3))
        off -= (off @ heading)[:, None] * heading
        start = np.array([TRUNK * np.cos(turn), TRUNK * np.sin(turn), 3 + 0.05 * twig])
        parts.append(start + along[:, None] * heading + TWIG * off / np.linalg.norm(off, axis=1)[:, None])
    return np.concatenate(parts)


def test_a_thick_trunk_and_thin_twigs_are_one_graph_of_two_regimes() -> None:
    s = skeleton_of(trunk_with_twigs())
    assert (s.components, s.loops, s.ends) == (1, 0, 11)
    away = np.linalg.norm(s.nodes[:, :2], axis=1)
    below, above = (s.nodes[:, 2] > 0.4) & (s.nodes[:, 2] < 2.6), away > 2 * TRUNK
    assert (s.regimes[below] == Regime.TUBE).all()
    assert (s.radius_sources[below] == RadiusSource.MEASURED).all()
    np.testing.assert_allclose(s.radius[below], TRUNK, rtol=0.1)
    assert (s.regimes[above] == Regime.WIRE).all()
    assert (s.radius_sources[above] == RadiusSource.BOUNDED).all()
    assert s.radius[above].min() >= TWIG
    assert np.median(s.radius[above]) < 3 * TWIG


def generated() -> Points:
    shape = thickened(tree("spreading", tips=25, seed=3), 1000, 0.3)
    return make_shape(shape, ShapeParams(count=1000, noise=0.1))[0]


@pytest.mark.parametrize("name", ["y", "torus", "dog", "mug"])
def test_tubes_are_not_surely_wires(name: str) -> None:
    for degraded in (ShapeParams(count=1024), ShapeParams(count=2048, noise=0.25), ShapeParams(count=2048, uneven=10)):
        assert not surely_wires(prepared(make_shape(shape_graph(name), degraded)[0], 14))


def test_a_tree_of_twigs_is_surely_wires() -> None:
    assert surely_wires(prepared(generated(), 14))


@pytest.mark.parametrize("seed", [0, 1, 3])
def test_the_rungs_of_a_coarse_ladder_are_tubes(seed: int) -> None:
    """Its limbs are a spacing thick, and wires are nearer to the points; they run across the rungs."""
    s = extract_skeleton(contract(make_shape("ladder", 512, seed=seed)[0]))
    assert (s.components, s.loops) == (1, 4)


@pytest.mark.parametrize("ratio", [2.0, 4.0])
def test_a_scan_in_lines_is_a_tube(ratio: float) -> None:
    s = skeleton_of(tube(0.3, 3.0, 14, ratio))
    assert (s.components, s.loops, s.ends) == (1, 0, 2)
    assert (s.regimes == Regime.TUBE).all()


def test_a_regime_can_be_forced() -> None:
    crown, y = generated(), make_shape(shape_graph("y"), ShapeParams(count=1000))[0]
    assert (skeleton_of(crown, regime="wire").regimes != Regime.UNKNOWN).all()
    assert (skeleton_of(y).regimes == Regime.TUBE).all()
    assert Regime.WIRE in skeleton_of(crown).regimes
    assert Regime.WIRE not in skeleton_of(crown, regime="tube").regimes
    forced = skeleton_of(y, regime="wire", topology="tree")
    assert set(forced.regimes) == {Regime.TUBE, Regime.WIRE}
    assert (forced.components, forced.loops) == (1, 0)


def test_places_are_given_in_any_coordinates() -> None:
    moved = RobustParams(root=(1, 2, 3), seen_from=(0, 0, 0)).placed(lambda p: (2 * p[0], p[1] + 1, p[2]))
    assert moved.root == (2, 3, 3)
    assert moved.seen_from == (0, 1, 0)
    assert RobustParams().placed(lambda p: p) == RobustParams()


@pytest.mark.parametrize(
    "wrong", [{"regime": "sheet"}, {"topology": "ring"}, {"root": (1.0, 2.0)}, {"seen_from": (0.0, np.nan, 1.0)}]
)
def test_a_wrong_choice_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(TiskelError, match=next(iter(wrong))):
        RobustParams(**wrong)
