"""GLSkeleton as its toolbox ships it: the toolbox's own points and curves, and the steps on cases made by hand."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from reference.fixtures import Load
from tiskel import GlsParams, ShapeParams, SkeletonParams, contract, extract_skeleton, make_shape, shape_graph
from tiskel.arrays import normalisation
from tiskel.geometry.rings import Rings
from tiskel.methods.laplacian.toolbox_curve import join_counts, without_lost, without_straight
from tiskel.methods.laplacian.toolbox_gls import merge_in_turn
from tiskel.methods.laplacian.toolbox_rings import merged_ring, renamed, walk, with_repeats, without_repeats
from tiskel.methods.trace import Status

TOOLBOX = GlsParams(variant="toolbox")
COUNTS = {  # points after each reduction; nodes and edges of the curve
    "hammer": ([2423, 1956, 1675], 52, 51),
    "horse": ([1182, 726, 610], 81, 93),
    "joint": ([2708, 1566, 1360], 36, 35),
    "cave": ([5766, 3608, 2265], 24, 26),
    "fertility": ([2446, 1498, 1120, 891, 686], 42, 49),
}


@pytest.mark.parametrize("name", COUNTS)
def test_points_and_curves_are_those_of_the_toolbox(name: str, reference_cloud: Load, toolbox: Load) -> None:
    points, theirs = reference_cloud(name), toolbox(f"{name}_gls")
    counts, nodes, edges = COUNTS[name]
    c = contract(points, TOOLBOX)
    assert [step.points for step in c.steps] == counts
    assert counts[-1] == len(theirs["points"])
    assert len(c.steps) == theirs["iterations"]
    assert c.status is (Status.BOX_GREW if name == "cave" else Status.CONVERGED)
    label = theirs["last_step_survived"]
    np.testing.assert_array_equal(c.rows, np.flatnonzero(label == label.max()))
    frame = normalisation(points)
    np.testing.assert_allclose(frame.apply(c.points), theirs["contracted"], atol=1e-4)  # SuperLU and CHOLMOD
    s = extract_skeleton(c, SkeletonParams(raw=True))
    assert (len(s.nodes), len(s.edges)) == (len(theirs["nodes"]), len(theirs["edges"])) == (nodes, edges)
    away, match = cKDTree(frame.apply(s.nodes)).query(theirs["nodes"])
    assert away.max() < 1e-4
    assert {tuple(sorted(e)) for e in s.edges.tolist()} == {tuple(sorted(match[e].tolist())) for e in theirs["edges"]}


@pytest.mark.parametrize("name", ["capsule", "torus", "hand"])
def test_books_are_kept_on_any_cloud(name: str) -> None:
    cloud = make_shape(shape_graph(name), ShapeParams(count=1000))[0]
    c = contract(cloud, TOOLBOX)
    assert len(c.points) < len(cloud)
    assert (c.merged_into >= 0).sum() + len(c.rows) == len(cloud)
    s = extract_skeleton(c)
    assert np.isfinite(s.nodes).all()
    assert s.node_of_point.min() >= 0
    assert s.node_of_point.max() < len(s.nodes)


def test_lists_and_rings_are_the_same() -> None:
    lists = [[1, 2, 3, 1], [0, 2], [0, 1, 0, 3], [0]]
    rings = without_repeats(lists)
    assert rings.sizes.tolist() == [3, 2, 4, 1]
    assert rings.closed.tolist() == [1, 0, 0, 0]
    assert with_repeats(rings) == lists


def test_a_walk_about_the_middle_of_a_hexagon_closes_and_one_at_a_corner_does_not() -> None:
    turn = np.arange(6) * np.pi / 3 + 0.1
    hexagon = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    around = walk(np.concatenate([[[0.01, 0.02]], hexagon]))
    assert around[0] == around[-1]
    assert sorted(around[:-1]) == [1, 2, 3, 4, 5, 6]
    assert {abs(a - b) for a, b in zip(around, around[1:], strict=False)} == {1, 5}
    corner = walk(hexagon)
    assert corner[0] < corner[-1]
    assert len(set(corner)) == len(corner)
    assert walk(np.zeros((2, 2))) == []


def test_merged_rings_leave_the_pair_out_and_small_ones_are_refused() -> None:
    lattice = np.stack([*np.meshgrid(np.arange(4.0), np.arange(4.0)), np.zeros((4, 4))], axis=-1).reshape(-1, 3)
    lattice += np.random.default_rng(0).normal(scale=0.05, size=lattice.shape) * [1, 1, 0]
    rings = [[] for _ in lattice]  # type: list[list[int]]
    rings[5], rings[6] = [1, 6, 9, 4, 1], [2, 7, 10, 5, 2]
    ring = merged_ring(lattice, 5, 6, rings, np.array([0.0, 0.0, 1.0]))
    assert ring[0] == ring[-1]
    assert set(ring) <= {1, 2, 4, 7, 9, 10}
    rings[5], rings[6] = [1, 6], [5, 2]
    assert merged_ring(lattice, 5, 6, rings, np.array([0.0, 0.0, 1.0])) == []


def test_merging_goes_in_order_and_renaming_drops_neighbours_that_become_one() -> None:
    into = np.array([-1, 0, -1, -1], np.int32)
    assert renamed([[2, 3], [9], [0, 1, 3, 0], [1, 2, 0, 1]], into) == [[1, 2], [0, 2, 0], [0, 1, 0]]
    generator = np.random.default_rng(1)
    points = generator.random((30, 3)) * [1, 1, 0.01]
    near = cKDTree(points).query(points, 8)[1]
    rings = [[*map(int, row[1:]), int(row[1])] for row in near]
    found, fresh = merge_in_turn(points, points, rings, np.ones(30, bool), np.tile([0.0, 0, 1], (30, 1)))
    lost = np.flatnonzero(found >= 0)
    assert len(lost) > 5
    assert len(np.unique(np.concatenate([lost, found[lost]]))) == 2 * len(lost)  # a point takes part once
    assert all(found[i] in rings[i] or i in rings[found[i]] for i in lost.tolist())
    assert len(fresh) == 30 - len(lost)
    assert max(map(max, fresh)) < len(fresh)


def test_counts_are_read_as_numbers_of_samples() -> None:
    """Three samples in a line; the middle one is joined once and twice, which names samples 1 and 2, itself."""
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [-1, 0, 0.0]])
    counts = np.zeros((4, 4), np.int32)
    for a, b, n in ((0, 1, 1), (1, 2, 3), (0, 3, 4)):
        counts[a, b] = counts[b, a] = n
    left, edges = without_straight(counts, nodes)
    # sample 0 has counts 1 and 4: itself and sample 3; sample 1 has 1 and 3: samples 0 and 2, and is straight between
    assert np.isnan(left[:, 0]).tolist() == [False, True, False, False]
    assert edges.tolist() == [[0, 2], [0, 3]]
    into = np.arange(4, dtype=np.int32)
    kept, links, owner = without_lost(left, edges, into, nodes)
    assert len(kept) == 3
    assert links.tolist() == [[0, 1], [0, 2]]
    assert owner.tolist() in ([0, 0, 1, 2], [0, 1, 1, 2])


def test_samples_without_neighbours_are_joined_to_the_nearest_once() -> None:
    rings = Rings(np.array([[1], [0], [0]], np.int32), np.ones(3, np.int32), np.zeros(3, np.int32))
    counts = join_counts(rings, np.array([0, 0, 1], np.int32), np.array([[0.0, 0, 0], [5, 0, 0]]))
    assert counts.tolist() == [[0, 1], [1, 0]]
    alone = Rings(np.array([[1], [0], [3], [2]], np.int32), np.ones(4, np.int32), np.zeros(4, np.int32))
    nodes = np.array([[0.0, 0, 0], [5, 0, 0]])
    assert join_counts(alone, np.array([0, 0, 1, 1], np.int32), nodes).tolist() == [[0, 1], [1, 0]]
