"""Trees against the truth that their cloud shows: every number against a case that is known in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from reference.path_tree import path_tree
from tiskel import CurveGraph, RadiusSource, ShapeParams, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.geometry.feet import feet_on, parts_of
from tiskel.metrics.matching import matched_joints, matched_tips, stub_ends
from tiskel.metrics.observable import observable
from tiskel.metrics.tree_truth import tree_agreement

RADIUS = 0.05
ABOUT = 0.012  # of a share of length: the tolerance of 1 % of the diagonal reaches over an end, and a part of it


def way(*places: tuple[float, float, float], radius: float = RADIUS) -> CurveGraph:
    """A polyline."""
    count = len(places)
    edges = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1).astype(np.int32)
    return CurveGraph(np.array(places, float), edges, np.full(count, radius))


def tube(curve: CurveGraph, count: int = 4000, upto: float = np.inf) -> Points:
    """Points on tubes about the edges of a curve, up to a first coordinate."""
    rng = np.random.default_rng(0)
    parts = parts_of(curve, curve.length / count)
    axis = curve.nodes[curve.edges[parts.edges, 1]] - curve.nodes[curve.edges[parts.edges, 0]]
    out = np.cross(axis, rng.normal(size=axis.shape))
    radii = curve.radii[curve.edges[parts.edges, 0]]
    points = parts.points + radii[:, None] * out / np.linalg.norm(out, axis=1)[:, None]
    return np.ascontiguousarray(points[parts.points[:, 0] <= upto])


LINE = way((0, 0, 0), (1, 0, 0))
CLOUD = tube(LINE)
FORK = CurveGraph(  # a joint in the middle, arms of 1, the third across
    np.array([[0.0, 0, 0], [-1, 0, 0], [1, 0, 0], [0, 1, 0]]),
    np.array([[0, 1], [0, 2], [0, 3]], np.int32),
    np.full(4, RADIUS),
)
NOTHING = CurveGraph(np.zeros((0, 3)), np.zeros((0, 2), np.int32))


def moved(curve: CurveGraph, by: float) -> CurveGraph:
    return CurveGraph(curve.nodes + [0, 0, by], curve.edges, curve.radii)


def test_the_truth_agrees_with_itself() -> None:
    tree, ladder = shape_graph("tree"), shape_graph("ladder")
    for shape, cloud in ((FORK, tube(FORK)), (tree, make_shape(tree)[0]), (ladder, make_shape(ladder)[0])):
        a = tree_agreement(shape, shape, cloud)
        assert a.precision == a.recall == a.f == 1
        assert a.area == pytest.approx(1, abs=0.01)
        assert a.tips.recall == a.joints.recall == 1
        assert a.tips.precision == a.joints.precision == 1
        assert (a.components, a.loops) == (0, 0)
        assert a.length_ratio == pytest.approx(1, abs=0.03)
        assert a.to_truth == pytest.approx(0, abs=1e-3)


def test_half_a_curve_is_half_recalled() -> None:
    a = tree_agreement(way((0, 0, 0), (0.5, 0, 0)), LINE, CLOUD)
    assert a.precision == 1
    assert a.recall == pytest.approx(0.5, abs=ABOUT)
    assert a.f == pytest.approx(2 / 3, abs=ABOUT)
    assert a.length_ratio == pytest.approx(0.5, abs=0.01)
    assert (a.tips.recall, a.tips.precision) == (0.5, 0.5)
    assert a.from_truth == pytest.approx(0.5 * 0.25, abs=0.01)  # 0 along one half, 0 to 0.5 along the other


def test_a_curve_twice_as_long_is_half_right() -> None:
    a = tree_agreement(way((0, 0, 0), (2, 0, 0)), LINE, CLOUD)
    assert a.precision == pytest.approx(0.5, abs=ABOUT)
    assert a.recall == 1
    assert a.length_ratio == pytest.approx(2, abs=0.02)


def test_a_curve_beyond_the_tolerance_is_all_wrong() -> None:
    """The diagonal is 1, so the tolerance is 0.01; tips have a local radius, 0.05."""
    inside, outside = (tree_agreement(moved(LINE, by), LINE, CLOUD) for by in (0.0095, 0.0105))
    assert (inside.precision, inside.recall, inside.f) == (1, 1, 1)
    assert (outside.precision, outside.recall, outside.f) == (0, 0, 0)
    assert outside.tips.recall == 1
    assert tree_agreement(moved(LINE, 0.06), LINE, CLOUD).tips.matched == 0


@pytest.mark.parametrize("share", [0.25, 0.5, 0.75])
def test_the_area_is_one_minus_the_distance_in_radii(share: float) -> None:
    """At one distance everywhere F steps from 0 to 1 where the tolerance reaches it."""
    a = tree_agreement(moved(LINE, share * RADIUS), LINE, CLOUD)
    assert a.area == pytest.approx(1 - share, abs=0.02)
    assert a.to_truth == pytest.approx(share * RADIUS, rel=0.02)


def test_nothing_found_and_nothing_to_see() -> None:
    a = tree_agreement(NOTHING, LINE, CLOUD)
    assert (a.precision, a.recall, a.f, a.to_truth, a.length_ratio) == (None, 0, 0, None, 0)
    assert (a.tips.recall, a.tips.precision, a.components) == (0, None, -1)
    b = tree_agreement(LINE, LINE, CLOUD + [0, 0, 9])
    assert (b.precision, b.recall, b.f, b.length, b.length_ratio) == (None, None, None, 0, None)
    assert b.tips.recall is None
    assert b.as_dict()["radii"] == []


def test_the_truth_ends_where_the_cloud_does() -> None:
    seen = observable(LINE, tube(LINE, upto=0.6))
    assert seen.nodes[:, 0].max() == pytest.approx(0.6, abs=0.02)  # spacings of a hundredth
    assert seen.nodes[:, 0].min() == pytest.approx(0, abs=0.02)
    a = tree_agreement(way((0, 0, 0), (0.6, 0, 0)), LINE, tube(LINE, upto=0.6))
    assert a.recall == 1
    assert a.tips.recall == a.tips.precision == 1


def test_a_gap_between_witnesses_is_asked_for() -> None:
    cloud = CLOUD[(CLOUD[:, 0] < 0.3) | (CLOUD[:, 0] > 0.7)]
    assert observable(LINE, cloud).length == pytest.approx(1, abs=0.03)


def test_a_branch_without_points_is_not_asked_for() -> None:
    """Points about the joint are nearer to the arms that have them, and witness nothing of the third."""
    arms = CurveGraph(FORK.nodes[:3], FORK.edges[:2], FORK.radii[:3])
    seen = observable(FORK, tube(arms))
    assert seen.length == pytest.approx(2, abs=2 * RADIUS)
    a = tree_agreement(arms, FORK, tube(arms))
    assert (a.tips.true, a.tips.recall, a.tips.precision) == (2, 1, 1)
    assert (a.joints.true, a.joints.found) == (0, 0)


def test_points_on_a_trunk_do_not_witness_a_twig_inside_it() -> None:
    """A twig that ends a little below the bark: its axis is nearer than that of the trunk."""
    trunk, twig = way((0, 0, -1), (0, 0, 0), (0, 0, 1), radius=0.3), np.array([[0.01, 0, 0], [0.28, 0, 0]])
    both = CurveGraph(
        np.concatenate([trunk.nodes, twig]),
        np.concatenate([trunk.edges, [[1, 3], [3, 4]]]).astype(np.int32),
        np.append(trunk.radii, [0.01, 0.01]),
    )
    assert observable(both, tube(trunk)).ends == 2


def test_points_far_from_the_truth_witness_nothing() -> None:
    stray = np.concatenate([tube(LINE, upto=0.6), [[1.0, 0.3, 0]]])
    assert observable(LINE, stray).nodes[:, 0].max() == pytest.approx(0.6, abs=0.02)


def test_found_tips_are_matched_one_to_one() -> None:
    nodes = np.concatenate([FORK.nodes, [[1, 0.02, 0]]])
    double = CurveGraph(nodes, np.concatenate([FORK.edges, [[0, 4]]]).astype(np.int32))
    tips, joints = matched_tips(double, FORK, 0.02), matched_joints(double, FORK, 0.02)
    assert (tips.true, tips.found, tips.matched) == (3, 4, 3)
    assert (joints.true, joints.found, joints.matched) == (1, 2, 1)


def test_a_joint_of_four_is_two_of_three() -> None:
    cross = np.array([[-1.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 0]])
    four = CurveGraph(cross, np.array([[0, 4], [1, 4], [2, 4], [3, 4]], np.int32), np.full(5, RADIUS))
    apart = np.concatenate([cross, [[0.03, 0, 0]]])
    two = CurveGraph(apart, np.array([[0, 4], [2, 4], [4, 5], [1, 5], [3, 5]], np.int32), np.full(6, RADIUS))
    for found, truth in ((four, two), (two, four)):
        joints = matched_joints(found, truth, 0.02)
        assert (joints.true, joints.found, joints.matched) == (2, 2, 2)


def test_stubs_are_neither_asked_for_nor_counted_against() -> None:
    """A third arm of 0.04 on a joint of radius 0.05."""
    nodes = FORK.nodes.copy()
    nodes[3] = [0, 0.04, 0]
    stubby = CurveGraph(nodes, FORK.edges, FORK.radii)
    straight = CurveGraph(nodes[:3], FORK.edges[:2], FORK.radii[:3])
    assert stub_ends(stubby, 0.01).tolist() == [3]
    for found in (stubby, straight):
        tips, joints = matched_tips(found, stubby, 0.01), matched_joints(found, stubby, 0.01)
        assert (tips.true, tips.found, tips.matched) == (2, 2, 2)
        assert (joints.true, joints.found, joints.matched) == (0, 0, 0)
    assert matched_tips(stubby, straight, 0.01).found == 3  # a spur of the found curve counts against it


def test_a_fork_of_two_stubs_keeps_one_end() -> None:
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [1.03, 0.01, 0], [1.02, -0.01, 0]])
    fork = CurveGraph(nodes, np.array([[0, 1], [1, 2], [1, 3]], np.int32), np.full(4, RADIUS))
    assert stub_ends(fork, 0.01).tolist() == [3]


def test_radii_are_held_against_true_ones_by_thickness_and_source() -> None:
    """From 1.2 times too thick and measured to half as thick and bounded: each half is worth what its end is."""
    sources = np.array([RadiusSource.MEASURED, RadiusSource.BOUNDED], np.uint8)
    found = CurveGraph(LINE.nodes, LINE.edges, np.array([1.2, 0.5]) * RADIUS, radius_sources=sources)
    measured, bounded = tree_agreement(found, LINE, CLOUD).radii
    assert (measured.source, bounded.source) == (RadiusSource.MEASURED, RadiusSource.BOUNDED)
    assert (measured.ratio, bounded.ratio) == pytest.approx((1.025, 0.675), abs=2e-3)
    assert (measured.error, bounded.error) == pytest.approx((0.0875, 0.325), abs=2e-3)  # of 0.2 to -0.15
    assert (measured.held, bounded.held) == pytest.approx((2 * 0.2 / 0.7, 0), abs=5e-3)
    assert measured.share == pytest.approx(0.5, abs=0.01)
    low, high = measured.thickness  # spacings: the tube's is the side of the square that holds one point
    assert low <= RADIUS / np.sqrt(2 * np.pi * RADIUS / len(CLOUD)) < high
    assert measured.as_dict()["source"] == "MEASURED"


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_units_and_places_do_not_matter(scale: float) -> None:
    def elsewhere(curve: CurveGraph) -> CurveGraph:
        turned = curve.nodes[:, [1, 2, 0]] * scale + 5 * scale
        return CurveGraph(turned, curve.edges, curve.radii * scale)

    found = moved(FORK, 0.02)
    a = tree_agreement(found, FORK, tube(FORK))
    b = tree_agreement(
        elsewhere(found), elsewhere(FORK), np.ascontiguousarray(tube(FORK)[:, [1, 2, 0]] * scale + 5 * scale)
    )
    for key in ("f", "area", "to_truth", "from_truth", "tips_recall", "joints_precision", "length_ratio"):
        assert a.as_dict()[key] == pytest.approx(b.as_dict()[key], abs=0.01)


def test_feet_are_the_nearest_places() -> None:
    rng = np.random.default_rng(3)
    curve = CurveGraph(rng.random((30, 3)), np.sort(rng.permutation(30).reshape(-1, 2), axis=1).astype(np.int32))
    queries = rng.random((200, 3))
    a, b = curve.nodes[curve.edges[:, 0]], curve.nodes[curve.edges[:, 1]]
    along = np.einsum("qec,ec->qe", queries[:, None] - a, b - a) / ((b - a) ** 2).sum(axis=1)
    foot = a + np.clip(along, 0, 1)[:, :, None] * (b - a)
    distances = np.linalg.norm(queries[:, None] - foot, axis=2).min(axis=1)
    np.testing.assert_allclose(feet_on(curve, queries, 0.01).distances, distances, atol=1e-12)


def test_the_baseline_recovers_a_tree_of_wires() -> None:
    """The tree of the gallery, a twentieth as thick: 0.4 spacings at the twigs."""
    thick = shape_graph("tree")
    shape = replace(thick, radii=thick.radii / 20)
    cloud = make_shape(shape, ShapeParams(count=2000))[0]
    a = tree_agreement(path_tree(cloud), shape, cloud)
    assert a.f == pytest.approx(1, abs=0.05)
    assert (a.loops, a.components) == (0, 0)
    assert a.tips.recall == pytest.approx(1, abs=0.1)
