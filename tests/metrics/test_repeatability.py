"""Two curves of one body, alike in ways that are known."""

from dataclasses import replace

import numpy as np
import pytest

from tiskel import CurveGraph, ShapeParams, contract, extract_skeleton, make_shape, shape_graph
from tiskel.arrays import diagonal
from tiskel.metrics.repeatability import repeatability

Y = shape_graph("y")  # arms of about 0.9, all of radius 0.14, its joint first
NOTHING = CurveGraph(np.zeros((0, 3)), np.zeros((0, 2), np.int32))


def moved(by: float) -> CurveGraph:
    """Across the plane of the Y."""
    return CurveGraph(Y.nodes + [0, by, 0], Y.edges, Y.radii)


def test_a_curve_is_like_itself() -> None:
    for name in ("y", "mug", "two-holed-torus"):
        same = repeatability(shape_graph(name), shape_graph(name))
        assert same.same_graph
        assert same.radii_95 == pytest.approx(0, abs=1e-9)
        assert same.tips_share in (1, None)
    assert repeatability(shape_graph("torus"), shape_graph("torus")).tips_share is None


def test_a_shift_is_so_many_radii() -> None:
    far = repeatability(Y, moved(0.07))
    assert far.radii_95 == pytest.approx(0.5)
    both = np.concatenate([Y.nodes, Y.nodes + [0, 0.07, 0]])
    assert far.diagonals_95 == pytest.approx(0.07 / diagonal(both))
    assert far.tips == 3
    assert repeatability(Y, moved(0.15)).tips == 0


def test_radii_of_both_count() -> None:
    thick = CurveGraph(Y.nodes + [0, 0.07, 0], Y.edges, 3 * Y.radii)
    assert repeatability(Y, thick).radii_95 == pytest.approx(0.25)
    assert repeatability(Y, replace(moved(0.07), radii=np.full(4, np.nan))).radii_95 is None
    assert repeatability(Y, replace(moved(0.15), radii=3 * Y.radii)).tips == 3  # within a radius of the thicker


def test_an_arm_that_only_one_has_is_far_from_the_other() -> None:
    two = CurveGraph(Y.nodes[:3], Y.edges[:2], Y.radii[:3])
    forth, back = repeatability(Y, two), repeatability(two, Y)
    assert not forth.same_graph
    assert (forth.ends, forth.joints) == (-1, -1)
    assert (back.ends, back.joints) == (1, 1)
    assert forth.tips == 2
    assert forth.tips_share == pytest.approx(2 / 3)
    assert forth.radii_95 == pytest.approx(back.radii_95)
    # Square to one arm and beyond the joint from the other: the joint is nearest, all along the third.
    assert forth.radii_95 == pytest.approx((Y.lengths[2] - 0.05 * Y.length) / 0.14, rel=0.01)


def test_two_tips_do_not_share_one() -> None:
    nodes = np.concatenate([Y.nodes, Y.nodes[1:2] + 0.01])
    double = CurveGraph(nodes, np.concatenate([Y.edges, [[0, 4]]]).astype(np.int32), np.append(Y.radii, 0.14))
    assert repeatability(Y, double).tips == repeatability(double, Y).tips == 3


def test_nothing_is_like_nothing() -> None:
    none = repeatability(NOTHING, NOTHING)
    assert none.same_graph
    assert none.tips_share is none.radii_95 is none.diagonals_95 is None
    some = repeatability(Y, NOTHING)
    assert (some.components, some.tips_share, some.radii_95) == (-1, 0, None)
    assert some.as_dict()["same_graph"] is False


def test_a_tube_sampled_twice_has_one_curve() -> None:
    curves = []
    for seed in (0, 1):
        cloud = make_shape(Y, ShapeParams(count=1500, seed=seed))[0]
        curves.append(extract_skeleton(contract(cloud)))
    found = repeatability(*curves)
    assert found.same_graph
    assert found.tips == 3
    assert found.radii_95 is not None
    assert found.radii_95 < 0.5
