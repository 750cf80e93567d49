"""Agreement with a true curve, and random shapes whose truth is known."""

from itertools import combinations

import numpy as np
import pytest

from tiskel import TiskelError, make_shape, shape_graph
from tiskel.gallery.random_graphs import EDGES, GAP, LENGTH, PER_SQUARE, RATIO, random_graph
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.round_cones import ConeGraph, signed_distance
from tiskel.metrics.truth import agreement
from tiskel.params import ShapeParams

SHAPE = shape_graph("y")  # arms of 0.9 and 0.92, radius 0.14, its joint first
NO_EDGES = np.zeros((0, 2), np.int32)


def test_the_truth_agrees_with_itself() -> None:
    for name in ("y", "mug", "two-holed-torus"):
        shape = shape_graph(name)
        a = agreement(shape, shape)
        assert a.topology_right
        assert (a.ends, a.spurious_ends) == (a.true_ends, 0)
        assert a.to_truth == a.from_truth == pytest.approx(0, abs=1e-12)


def test_a_moved_curve_is_so_many_radii_away() -> None:
    moved = SHAPE.nodes + [0, 0.07, 0]  # across the plane of the Y, by half its radius
    a = agreement(CurveGraph(moved, SHAPE.edges), SHAPE)
    assert a.to_truth == pytest.approx(0.5, rel=0.01)
    assert a.to_truth_95 == pytest.approx(0.5, rel=0.01)
    assert a.from_truth == pytest.approx(0.5, rel=0.01)
    assert (a.ends, a.spurious_ends) == (3, 0)
    assert agreement(CurveGraph(SHAPE.nodes + [0, 0.15, 0], SHAPE.edges), SHAPE).ends == 0  # further than one radius


def test_a_missing_arm_and_a_stray_one_are_told_apart() -> None:
    two_arms = agreement(CurveGraph(SHAPE.nodes, SHAPE.edges[:2]), SHAPE)
    assert (two_arms.ends, two_arms.spurious_ends) == (2, 0)
    assert two_arms.components == 1  # the third node is a component of its own
    nodes = np.concatenate([SHAPE.nodes, [[0, 0.9, 0]]])
    stray = agreement(CurveGraph(nodes, np.concatenate([SHAPE.edges, [[0, 4]]]).astype(np.int32)), SHAPE)
    assert (stray.ends, stray.spurious_ends) == (3, 1)
    assert stray.to_truth is not None
    assert stray.from_truth is not None
    assert stray.to_truth > 0.5 > stray.from_truth


def test_two_found_ends_do_not_share_a_true_one() -> None:
    nodes = np.concatenate([SHAPE.nodes, SHAPE.nodes[1:2] + 0.01])
    doubled = agreement(CurveGraph(nodes, np.concatenate([SHAPE.edges, [[0, 4]]]).astype(np.int32)), SHAPE)
    assert (doubled.ends, doubled.spurious_ends) == (3, 1)


def test_nothing_found_is_no_distance() -> None:
    a = agreement(CurveGraph(np.zeros((0, 3)), NO_EDGES), SHAPE)
    assert a.to_truth is a.from_truth is None
    assert (a.components, a.ends, a.true_ends) == (-1, 0, 3)
    point = agreement(CurveGraph(np.zeros((1, 3)), NO_EDGES), SHAPE)
    assert point.to_truth == 0
    assert point.from_truth is not None
    assert point.from_truth > 1


def gap(shape: ConeGraph, a: int, b: int) -> float:
    """The smallest distance of the surface of one part from places on the axis of the other, less the radius there."""
    (p, q), (rp, rq) = shape.nodes[shape.edges[a]], shape.radii[shape.edges[a]]
    share = np.linspace(0, 1, 200)[:, None]
    reach = signed_distance(p + share * (q - p), shape, b) - (rp + share[:, 0] * (rq - rp))
    return float(reach.min())


@pytest.mark.parametrize("seed", range(12))
def test_random_graphs_keep_what_is_asked_of_them(seed: int) -> None:
    made = random_graph(seed)
    shape = made.shape
    count = len(shape.edges)
    assert EDGES[0] <= count <= EDGES[1]
    assert shape.components == 1
    assert shape.loops == made.loops <= 4
    ratio = shape.lengths / shape.radii[shape.edges].mean(axis=1)
    assert LENGTH[0] <= ratio.min() <= ratio.max() <= LENGTH[1]
    assert shape.radii.max() / shape.radii.min() <= RATIO
    area = (np.pi * shape.radii[shape.edges].sum(axis=1) * shape.lengths).sum()
    assert made.count / area * shape.radii.min() ** 2 >= PER_SQUARE
    for a, b in combinations(range(count), 2):
        if not np.intersect1d(shape.edges[a], shape.edges[b]).size:
            radius = min(shape.radii[shape.edges[a]].min(), shape.radii[shape.edges[b]].min())
            # measured at 33 places along edges of up to ten radii: a tenth of a radius may be missed between them
            assert gap(shape, a, b) > GAP * radius - 0.1 * shape.radii.max()


def test_random_graphs_are_seeded_and_of_all_kinds() -> None:
    np.testing.assert_array_equal(random_graph(5).shape.nodes, random_graph(5).shape.nodes)
    loops = [random_graph(seed).loops for seed in range(40)]
    assert set(loops) == {0, 1, 2, 3, 4}
    assert random_graph(7, loops=2).loops == 2
    with pytest.raises(TiskelError, match="loops must be between 0 and 4, got 5"):
        random_graph(0, loops=5)


def test_a_random_graph_makes_a_cloud() -> None:
    made = random_graph(3)
    points, truth = make_shape(made.shape, ShapeParams(count=600))
    assert len(points) == 600
    assert truth.loops == made.loops
