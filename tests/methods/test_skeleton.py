"""Skeletons: against the toolbox, and the properties of their parts."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from reference.fixtures import Load
from tiskel import (
    ContractionParams,
    ShapeParams,
    SkeletonParams,
    contract,
    extract_skeleton,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Indices, normalisation
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.rings import Rings
from tiskel.methods.laplacian.collapse import collapse_triangles, inherited_edges
from tiskel.methods.laplacian.curve import without_spurs
from tiskel.methods.laplacian.sampling import front_samples


def edges(*pairs: tuple[int, int]) -> np.ndarray:
    return np.array(pairs, np.int32).reshape(-1, 2)


@pytest.mark.parametrize(
    ("name", "count", "links"),
    [("hammer", 50, 49), ("horse", 55, 57), ("joint", 46, 45), ("cave", 29, 29), ("fertility", 44, 49)],
)
def test_raw_skeletons_are_those_of_the_toolbox(
    name: str, count: int, links: int, reference_cloud: Load, toolbox: Load
) -> None:
    """Contractions agree to 2e-4; the curve is that of the toolbox's, so that rounding chooses no other samples."""
    points, theirs = reference_cloud(name), toolbox(f"{name}_lbc")
    frame, contraction = normalisation(points), contract(points, ContractionParams(method="lbc"))
    assert np.linalg.norm(frame.apply(contraction.points) - theirs["contracted"], axis=1).max() < 2e-4
    contraction = replace(contraction, points=frame.undo(theirs["contracted"]))
    s = extract_skeleton(contraction, SkeletonParams(raw=True))
    distance, match = cKDTree(frame.apply(s.nodes)).query(theirs["nodes"])
    assert len(s.nodes) == len(theirs["nodes"]) == count
    assert distance.max() < 1e-12
    ours = {tuple(sorted(edge)) for edge in s.edges.tolist()}
    assert ours == {tuple(sorted(match[edge].tolist())) for edge in theirs["edges"]}
    assert len(ours) == links


def test_front_samples_cover_the_cloud_and_owners_are_within_the_radius() -> None:
    points = np.random.default_rng(1).random((800, 3))
    samples, owner = front_samples(points, 0.15)
    distance = np.linalg.norm(points - points[samples[owner]], axis=1)
    assert distance.max() <= 0.15
    assert (owner[samples] == np.arange(len(samples))).all()


def test_front_samples_equal_the_published_loop() -> None:
    """The queue against the toolbox's way: look through all points for the farthest claimed one, every time."""
    points = np.random.default_rng(2).random((400, 3)) * [3, 1, 1]
    radius = 0.2
    owner, distance = np.full(400, -1), np.full(400, np.nan)
    samples: list[int] = []
    for start in range(400):
        if owner[start] >= 0:
            continue
        distance[start] = np.inf
        while (owner < 0).any():
            at = int(np.nanargmax(distance))
            if distance[at] == 0:
                break
            to = np.linalg.norm(points - points[at], axis=1)
            ball = to <= radius
            if (owner[ball] >= 0).all():
                distance[at] = 0
                continue
            won = ball & (np.isnan(distance) | (to < distance))
            distance[won], owner[won] = to[won], len(samples)
            samples.append(at)
    found, found_owner = front_samples(points, radius)
    assert found.tolist() == samples
    np.testing.assert_array_equal(found_owner, owner)


def test_joining_takes_the_first_foreign_member_and_leaves_no_sample_alone() -> None:
    rings = Rings(np.array([[1, 2, 3], [0, 2, -1], [3, 0, -1], [2, -1, -1], [4, -1, -1]], np.int32)[:, :3],
                  np.array([3, 2, 2, 1, 0], np.int32), np.zeros(5, np.int32))  # fmt: skip
    owner = np.array([0, 0, 1, 2, 3], np.int32)
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2.5, 0, 0]])
    assert inherited_edges(rings, owner, nodes).tolist() == [[0, 1], [1, 2], [2, 3]]


def test_collapsing_leaves_no_triangle_and_keeps_components() -> None:
    generator = np.random.default_rng(4)
    for _ in range(20):
        nodes = generator.random((30, 3))
        pairs = np.unique(np.sort(generator.integers(30, size=(60, 2)), axis=1), axis=0)
        pairs = pairs[pairs[:, 0] != pairs[:, 1]].astype(np.int32)
        left, links, into = collapse_triangles(nodes, pairs)
        around = [set(n) for n in CurveGraph(left, links).neighbours]
        assert not any(around[a] & around[b] for a, b in links)
        assert CurveGraph(left, links).components == CurveGraph(nodes, pairs).components
        assert set(into.tolist()) == set(range(len(left)))


def test_a_single_triangle_collapses_to_an_edge_with_the_survivor_at_the_midpoint() -> None:
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [0, 3, 0]])
    left, links, into = collapse_triangles(nodes, edges((0, 1), (1, 2), (0, 2)))
    np.testing.assert_allclose(left, np.array([[0.5, 0, 0], [0.0, 3, 0]]))
    assert links.tolist() == [[0, 1]]
    assert into.tolist() == [0, 0, 1]


@pytest.mark.parametrize(
    ("links", "expected"),
    [
        (edges((0, 1), (1, 2)), [[0, 1, 2]]),
        (edges((0, 1), (1, 2), (1, 3)), [[0, 1], [1, 2], [1, 3]]),
        (edges((0, 1), (1, 2), (0, 2)), [[0, 1, 2, 0]]),
        (edges((0, 1), (1, 2), (0, 2), (2, 3)), [[2, 0, 1, 2], [2, 3]]),
        (edges(), [[0], [1], [2], [3]]),
    ],
)
def test_branches_run_from_stop_to_stop_and_loops_close(links: np.ndarray, expected: list[list[int]]) -> None:
    count = max(int(links.max(initial=0)) + 1, 4 if not len(links) else 0)
    found = CurveGraph(np.zeros((count, 3)), links).branches
    assert sorted(min(b.tolist(), b.tolist()[::-1]) for b in found) == sorted(min(b, b[::-1]) for b in expected)


def test_every_edge_lies_on_exactly_one_branch() -> None:
    for name in ("hand", "torus", "two-holed-torus", "mug"):
        shape = shape_graph(name)
        lines = [b.tolist() for b in shape.branches]
        walked = [tuple(sorted(pair)) for line in lines for pair in itertools.pairwise(line)]
        assert sorted(walked) == sorted(map(tuple, shape.edges.tolist())), name


def pruned(nodes: np.ndarray, links: np.ndarray, radius: float) -> tuple[CurveGraph, Indices]:
    """Without its spurs, a curve with one point of the cloud at the given radius around every node."""
    rows = np.arange(len(nodes), dtype=np.int32)
    curve = CurveGraph(nodes, links, np.full(len(nodes), radius))
    return without_spurs(curve, nodes + [0, 0, radius], rows)


def test_spurs_shorter_than_the_local_radius_go_and_their_points_go_to_the_joint() -> None:
    nodes = np.array([[-2.0, 0, 0], [0, 0, 0], [2, 0, 0], [0, 0.4, 0]])
    curve, node_of_point = pruned(nodes, edges((0, 1), (1, 2), (1, 3)), radius=0.5)
    assert curve.edges.tolist() == [[0, 1], [1, 2]]
    assert node_of_point.tolist() == [0, 1, 2, 1]
    assert len(curve.branches) == 1


def test_ends_of_a_plain_rod_are_no_spurs_and_long_spurs_stay() -> None:
    rod, _ = pruned(np.array([[0.0, 0, 0], [0.1, 0, 0]]), edges((0, 1)), radius=0.5)
    assert len(rod.nodes) == 2
    nodes = np.array([[-2.0, 0, 0], [0, 0, 0], [2, 0, 0], [0, 0.6, 0]])
    assert len(pruned(nodes, edges((0, 1), (1, 2), (1, 3)), radius=0.5)[0].nodes) == 4


def test_a_joint_that_loses_a_spur_keeps_its_other_ends() -> None:
    """Of a joint with three short ends only one is a spur: without it the rest is a rod."""
    nodes = np.array([[0.0, 0, 0], [0.3, 0, 0], [-0.2, 0, 0], [0, 0.1, 0]])
    curve, _ = pruned(nodes, edges((0, 1), (0, 2), (0, 3)), radius=0.5)
    assert len(curve.nodes) == 3
    assert curve.ends == 2


@pytest.mark.parametrize("raw", [True, False])
@pytest.mark.parametrize("name", ["hand", "torus"])
def test_skeleton_parts_fit_together(name: str, raw: bool) -> None:
    cloud = make_shape(shape_graph(name), ShapeParams(count=1500))[0]
    s = extract_skeleton(contract(cloud, ContractionParams(method="gls")), SkeletonParams(raw=raw))
    assert s.node_of_point.shape == (len(cloud),)
    assert set(s.node_of_point.tolist()) == set(range(len(s.nodes)))
    own = np.linalg.norm(cloud - s.nodes[s.node_of_point], axis=1)
    for node in range(len(s.nodes)):
        assert s.radius[node] == pytest.approx(own[s.node_of_point == node].mean())
    assert (s.edges[:, 0] < s.edges[:, 1]).all()
    assert s.loops == len(s.edges) - len(s.nodes) + s.components
    assert (s.branch_of_node() == -1).sum() == s.junctions


def test_radius_of_a_capsule_is_that_of_the_capsule() -> None:
    s = extract_skeleton(contract(make_shape(shape_graph("capsule"))[0]))
    # Away from the ends every point is 0.2 from the axis; a node's points spread along it by up to a ball's radius.
    middle = np.abs(s.nodes[:, 2]) < 0.5
    np.testing.assert_allclose(s.radius[middle], 0.2, atol=0.03)


def test_networkx_graph_carries_positions_radii_and_lengths() -> None:
    s = make_shape(shape_graph("hammer"))[1]
    network = s.to_networkx()
    assert network.number_of_edges() == len(s.edges)
    assert sum(d["length"] for _, _, d in network.edges(data=True)) == pytest.approx(s.length)
    assert network.nodes[0]["radius"] == s.radius[0]
