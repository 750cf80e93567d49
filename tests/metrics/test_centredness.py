"""Centredness: cylinders, ellipses and their failure cases, sections."""

import numpy as np
import pytest

from tiskel import MetricParams, evaluate
from tiskel.arrays import Points
from tiskel.geometry.curve import curve_samples, vertex_tangents
from tiskel.geometry.ellipse import fit_ellipse
from tiskel.geometry.graph import CurveGraph
from tiskel.metrics.centredness import before_gap, neighbourhood_size, point_centredness, section_centredness

RADIUS, HALF = 0.3, 1.0


def cylinder(count: int = 2500, capped: bool = True) -> Points:
    """A cylinder along z: a golden spiral on its wall, every point at a height of its own; even discs at its ends."""
    i = np.arange(count)
    turn = i * np.pi * (3 - 5**0.5)
    wall = np.stack([RADIUS * np.cos(turn), RADIUS * np.sin(turn), HALF * (2 * (i + 0.5) / count - 1)], axis=1)
    radius = RADIUS * np.sqrt(np.arange(200) / 200)
    flat = np.stack([radius * np.cos(turn[:200]), radius * np.sin(turn[:200])], axis=1)
    ends = [np.column_stack([flat, np.full(200, z)]) for z in (-HALF, HALF)]
    return np.asarray(np.concatenate([wall, *ends]) if capped else wall)


def axis(shift: float = 0.0) -> tuple[Points, np.ndarray]:
    """The axis, shortened by the radius at both ends, moved sideways."""
    z = np.linspace(-HALF + RADIUS, HALF - RADIUS, 15)
    nodes = np.stack([np.full(15, shift), np.zeros(15), z], axis=1)
    return nodes, np.stack([np.arange(14), np.arange(1, 15)], axis=1)


def ellipse_points(turn: np.ndarray, a: float = 3.0, b: float = 1.0, tilt: float = 0.4) -> np.ndarray:
    rotation = np.array([[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]])
    return np.asarray(np.stack([a * np.cos(turn), b * np.sin(turn)], axis=1) @ rotation.T + [5.0, -2.0])


@pytest.mark.parametrize("capped", [True, False])
def test_the_axis_of_a_cylinder_scores_one_everywhere(capped: bool) -> None:
    cloud = cylinder(capped=capped)
    middle = cloud[np.abs(cloud[:, 2]) <= HALF - RADIUS]
    q = evaluate(cloud, middle * [1e-3, 1e-3, 1], *axis(), origin=middle).as_dict()
    for measure in ("boundedness", "inside", "centredness", "smoothness"):
        assert q[measure]["curve"] == pytest.approx(1, abs=1e-9)
    for measure in ("boundedness", "inside", "centredness"):
        assert q[measure]["points"] == 1
    assert q["smoothness"]["points"] == pytest.approx(1, abs=0.01)  # a thread of a thousandth of the radius


@pytest.mark.parametrize("d", [0.03, 0.1, 0.2])
def test_an_axis_moved_by_d_has_curve_centredness_one_minus_d_over_r(d: float) -> None:
    curve = evaluate(cylinder(), None, *axis(d)).curve
    assert curve is not None
    # the sections are exact circles, so the fit is exact to rounding
    np.testing.assert_allclose(curve.centredness, 1 - d / RADIUS, atol=1e-6)


def test_points_that_contract_to_one_side_are_off_centre_by_that_much() -> None:
    """c = 1 - |mean originals - mean skeletal| / mean |original - skeletal| of one ring."""
    turn = 2 * np.pi * np.arange(12) / 12
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    centred, aside = np.zeros((12, 3)), np.full((12, 3), [0.5, 0, 0])
    assert (neighbourhood_size(12), neighbourhood_size(4096), neighbourhood_size(9769)) == (10, 41, 30)
    near = [np.argsort(np.zeros(12), kind="stable")[:10]]  # all coincide: ties by index, the first ten
    expected = (
        1 - np.linalg.norm((ring - aside)[near[0]].mean(axis=0)) / np.linalg.norm(ring - aside, axis=1)[near[0]].mean()
    )
    assert point_centredness(aside, ring)[0] == pytest.approx(expected, abs=1e-12)
    assert point_centredness(centred, np.concatenate([ring[:6], -ring[:6]])).max() > 0.6


def test_distances_are_to_the_mean_of_the_skeletal_points_not_to_each_ones_own() -> None:
    generator = np.random.default_rng(0)
    points, originals = generator.random((30, 3)), generator.random((30, 3))
    found = point_centredness(points, originals)
    for i in range(30):
        near = np.argsort(np.linalg.norm(points - points[i], axis=1))[: neighbourhood_size(30)]
        middle = points[near].mean(axis=0)
        away = np.linalg.norm(originals[near] - middle, axis=1).mean()
        c = max(0, 1 - np.linalg.norm(originals[near].mean(axis=0) - middle) / away)
        assert found[i] == pytest.approx(c, abs=1e-12)


def test_points_that_did_not_move_are_centred() -> None:
    points = np.random.default_rng(0).random((30, 3))
    assert point_centredness(points, points) == pytest.approx(1, abs=1e-12)
    assert point_centredness(np.zeros((30, 3)), np.zeros((30, 3))).tolist() == [1.0] * 30


@pytest.mark.parametrize("span", [2 * np.pi, np.pi, 1.5])
def test_an_ellipse_is_found_from_a_part_of_it(span: float) -> None:
    found = fit_ellipse(ellipse_points(np.linspace(0, span, 25)))
    assert found is not None
    np.testing.assert_allclose(found.centre, [5, -2], atol=1e-6)  # exact points; the arc amplifies rounding
    np.testing.assert_allclose(found.axes, [3, 1], atol=1e-6)


def test_an_ellipse_keeps_its_centre_where_the_mean_does_not() -> None:
    """Points crowd on one side, as in a scan from one direction: the barycentre drifts, the fit does not."""
    turn = np.sort(np.random.default_rng(1).vonmises(0, 1.5, 80))
    ring = ellipse_points(turn) + np.random.default_rng(2).normal(size=(80, 2)) * 0.01
    found = fit_ellipse(ring)
    assert found is not None
    assert np.linalg.norm(found.centre - [5, -2]) < 0.02  # about the noise
    assert np.linalg.norm(ring.mean(axis=0) - [5, -2]) > 1


FAILURES = {
    "four points": np.random.default_rng(0).random((4, 2)),
    "one place": np.ones((9, 2)),
    "line": np.outer(np.arange(9.0), [1, 2]),
    "nearly a line": np.outer(np.arange(9.0), [1, 2]) + np.random.default_rng(0).random((9, 2)) * 1e-9,
}


@pytest.mark.parametrize("name", FAILURES)
def test_what_has_no_ellipse_says_so(name: str) -> None:
    assert fit_ellipse(FAILURES[name]) is None
    value, stand_in = section_centredness(FAILURES[name])
    assert stand_in
    assert 0 <= value <= 1


def test_mean_and_largest_distance_stand_in_for_three_points() -> None:
    value, stand_in = section_centredness(np.array([[1.0, 0], [-1, 0], [0, 0.3]]))
    reach = np.linalg.norm([1, 0 - 0.1])
    assert value == pytest.approx(1 - 0.1 / reach)
    assert stand_in


def test_a_section_ends_at_the_first_gap() -> None:
    flat = np.array([[1.0, 0], [0, 1.4], [-2.0, 0], [0, -3.1], [4, 0]])
    assert before_gap(flat, 1.5).tolist() == [[1, 0], [0, 1.4], [-2, 0]]
    assert len(before_gap(flat[:3], 1.5)) == 3
    assert before_gap(np.zeros((0, 2)), 1.5).shape == (0, 2)


def test_another_limb_does_not_reach_into_a_section() -> None:
    """Two parallel cylinders: the section of one is a circle, not an ellipse around both."""
    cloud = np.concatenate([cylinder(), cylinder() + [1.2, 0, 0]])
    curve = evaluate(cloud, None, *axis()).curve
    assert curve is not None
    assert np.nanmin(curve.centredness) > 0.99


def test_samples_follow_the_rule() -> None:
    """Each edge its share of 200, at least one, the first vertex excluded and the last included."""
    nodes = np.array([[0.0, 0, 0], [3, 0, 0], [3, 1, 0], [3.001, 1, 0]])
    edges = np.array([[0, 1], [1, 2], [2, 3]], np.int32)
    s = curve_samples(CurveGraph(nodes, edges), 200)
    assert np.bincount(s.edges).tolist() == [150, 50, 1]
    np.testing.assert_allclose(s.points[0], [3 / 150, 0, 0])
    np.testing.assert_array_equal(s.points[[149, 199, 200]], nodes[1:])
    np.testing.assert_allclose(s.directions[10], [1, 0, 0])
    np.testing.assert_allclose(s.directions[-1], [1, 0, 0])  # at an end, the edge's


def test_at_a_vertex_the_direction_is_the_tangent_of_the_circle() -> None:
    turn = np.array([0.1, 0.5, 1.3])
    nodes = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    tangent = vertex_tangents(CurveGraph(nodes, np.array([[0, 1], [1, 2]], np.int32)))
    np.testing.assert_allclose(tangent[1], [-np.sin(0.5), np.cos(0.5), 0], atol=1e-12)
    assert not tangent[[0, 2]].any()


def test_joints_and_edges_without_length_have_no_direction() -> None:
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]])
    s = curve_samples(CurveGraph(nodes, np.array([[1, 0], [2, 0], [3, 0], [3, 4]], np.int32)), 30)
    at_joint = (s.points == 0).all(axis=1)
    assert at_joint.sum() == 3
    assert not s.directed[at_joint].any()
    assert not s.directed[-1]
    assert s.directed[~at_joint][:-1].all()


def test_sections_are_counted_as_they_are() -> None:
    nodes, edges = axis()
    far = np.concatenate([nodes, nodes[-1:] + [0, 0, 5.0]])
    q = evaluate(cylinder(), None, far, np.concatenate([edges, [[14, 15]]]), params=MetricParams()).as_dict()
    counts = q["counts"]
    assert counts["curve_sparse_sections"] > 0
    unbounded = round((1 - q["boundedness"]["curve"]) * counts["curve_measured"])
    invalid = counts["curve_sparse_sections"] + counts["curve_without_direction"]
    # what is unbounded counts as 0, as in the toolbox, also where it has no section
    assert counts["curve_measured"] - counts["curve_valid_sections"] >= invalid - unbounded >= 0
    assert q["centredness"]["curve"] < 1
