"""Smoothness in closed form."""

import numpy as np
import pytest

from tiskel import MetricParams
from tiskel.arrays import Points
from tiskel.geometry.graph import CurveGraph
from tiskel.metrics.smoothness import curve_smoothness, hairpins, nearest_others, point_smoothness, vertex_smoothness


def chain(nodes: Points) -> np.ndarray:
    return np.stack([np.arange(len(nodes) - 1), np.arange(1, len(nodes))], axis=1).astype(np.int32)


def zigzag(turn: float, corners: int = 9) -> Points:
    """Unit edges that turn left and right by an angle in turn."""
    heading = np.where(np.arange(corners + 1) % 2 == 0, turn / 2, -turn / 2)
    steps = np.stack([np.cos(heading), np.sin(heading), 0 * heading], axis=1)
    return np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, np.pi / 2, 2.5])
def test_a_zigzag_scores_its_closed_form(turn: float) -> None:
    """Between edges there are pi - turn, so s = |1 - 2 (1 - turn / pi)|; nine of ten edges' length are weighed."""
    nodes = zigzag(turn)
    s = abs(1 - 2 * (1 - turn / np.pi))
    np.testing.assert_allclose(vertex_smoothness(CurveGraph(nodes, chain(nodes)))[1], s, atol=1e-7)  # arccos near 1
    assert curve_smoothness(CurveGraph(nodes, chain(nodes))) == pytest.approx(1 - 0.9 * (1 - s), abs=1e-7)


def test_a_right_angle_is_the_worst_and_a_hairpin_scores_like_a_line_but_is_reported() -> None:
    line, corner, hairpin = (
        np.array([[1.0, 0, 0], [0, 0, 0], end]) for end in ([-1.0, 0, 0], [0.0, 1, 0], [1, 1e-6, 0])
    )
    edges = chain(line)
    assert curve_smoothness(CurveGraph(line, edges)) == pytest.approx(1)
    assert curve_smoothness(CurveGraph(corner, edges)) == pytest.approx(0.5)  # the vertex weighs half the length
    assert curve_smoothness(CurveGraph(hairpin, edges)) == pytest.approx(1, abs=1e-5)
    assert [hairpins(CurveGraph(nodes, edges)) for nodes in (line, corner, hairpin)] == [0, 0, 1]


def test_joints_and_ends_are_left_out() -> None:
    star = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    edges = np.array([[0, 1], [0, 2], [0, 3]], np.int32)
    assert len(vertex_smoothness(CurveGraph(star, edges))[0]) == 0
    assert curve_smoothness(CurveGraph(star, edges)) == 1


def test_a_curve_without_length_has_no_smoothness() -> None:
    assert curve_smoothness(CurveGraph(np.ones((3, 3)), chain(np.ones((3, 3))))) is None
    doubled = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [2, 0, 0]])
    assert np.isnan(vertex_smoothness(CurveGraph(doubled, chain(doubled)))[1]).all()
    assert curve_smoothness(CurveGraph(doubled, chain(doubled))) == pytest.approx(1)


def points_along(line: Points, per_edge: int = 40) -> Points:
    share = np.linspace(0, 1, per_edge, endpoint=False)[:, None]
    return np.concatenate([a + share * (b - a) for a, b in zip(line[:-1], line[1:], strict=True)])


def test_a_straight_row_of_points_is_smooth() -> None:
    assert point_smoothness(points_along(zigzag(0.0)), MetricParams()) == pytest.approx(1, abs=1e-7)


def test_a_bend_lowers_smoothness_there_alone_and_waves_lower_it_all_along() -> None:
    """The chapter's demonstration; its pictures come from benchmarks/demonstrations.py."""
    bent = point_smoothness(points_along(np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0]])), MetricParams())
    x = np.linspace(0, 4, 160)
    wavy = point_smoothness(np.stack([x, 0.15 * np.sin(12 * x), 0 * x], axis=1), MetricParams())
    straight = np.abs(np.arange(80) - 40) > 12
    assert bent[straight].min() > 0.999
    assert bent[35:45].min() < 0.7
    assert np.median(wavy) < 0.95
    assert wavy.mean() < bent.mean()


def test_coincident_points_have_no_tangent_and_are_never_their_own_neighbours() -> None:
    points = np.concatenate([np.zeros((12, 3)), np.outer(np.arange(1, 9.0), [1, 0, 0])])
    others = nearest_others(points, 8)
    assert not (others == np.arange(20)[:, None]).any()
    s = point_smoothness(points, MetricParams())
    assert np.isnan(s[:9]).any()
    assert np.isfinite(s[-1])
