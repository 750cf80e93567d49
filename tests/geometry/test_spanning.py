"""The minimum spanning tree and the shortest links against the dense matrix."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.distance import pdist, squareform

from tiskel.arrays import Numbers, Points
from tiskel.geometry.spanning import box_tree, shortest_links, spanning_tree

GENERATOR = np.random.default_rng(5)
TURN = np.linspace(0, 12, 400)
HELIX = np.stack([np.cos(TURN), np.sin(TURN), TURN / 5], axis=1)


def lattice(*counts: int) -> Points:
    return np.stack(np.meshgrid(*[np.arange(float(c)) for c in counts]), axis=-1).reshape(-1, 3)


CLOUDS = {
    "ball": GENERATOR.normal(size=(500, 3)),
    "curve": HELIX,
    "curve, shuffled": GENERATOR.permutation(HELIX),
    "curve in pairs": np.concatenate([HELIX, HELIX + 1e-9]),
    "line": np.outer(np.sort(GENERATOR.random(300)), [1.0, 2, 3]),
    "line, even": np.outer(np.arange(200.0), [1.0, 0, 0]),
    "plane": GENERATOR.random((200, 3)) * [1, 1, 0] + [0, 0, 5],
    "lattice": lattice(7, 8, 9),
    "flat lattice": lattice(20, 20, 1),
    "thirds": lattice(6, 6, 6) / 3,
    "duplicates": np.repeat(GENERATOR.random((40, 3)), 9, axis=0),
    "one place": np.ones((70, 3)),
    "two places": np.repeat([[0.0, 0, 0], [3, 4, 0]], 50, axis=0),
    "clusters": GENERATOR.random((8, 3)).repeat(60, axis=0) + 1e-3 * GENERATOR.normal(size=(480, 3)),
    "cluster and outliers": np.concatenate([GENERATOR.random((300, 3)) * 1e-5, GENERATOR.random((50, 3)) * 1e4]),
    "density 1e6:1": GENERATOR.normal(size=(500, 3)) * np.geomspace(1e-6, 1, 500)[:, None],
    "far away": GENERATOR.random((300, 3)) + [4.5e6, -3e6, 8e5],
    "two": np.array([[0.0, 0, 0], [3, 4, 0]]),
    "eight": GENERATOR.random((8, 3)),
    "nine": GENERATOR.random((9, 3)),
}


def dense_lengths(points: Points) -> Numbers:
    """Prim's on the whole matrix, ascending: zeros are distances like others."""
    away = squareform(pdist(points))
    near, left, lengths = away[0].copy(), np.ones(len(points), bool), []
    left[0] = False
    while left.any():
        rows = np.flatnonzero(left)
        row = rows[near[rows].argmin()]
        lengths.append(near[row])
        left[row] = False
        near = np.minimum(near, away[row])
    return np.sort(lengths)


@pytest.mark.parametrize("name", CLOUDS)
def test_lengths_are_those_of_the_dense_matrix(name: str) -> None:
    points = CLOUDS[name]
    tree = spanning_tree(points)
    np.testing.assert_allclose(tree.lengths, dense_lengths(points), rtol=1e-12, atol=0)
    apart = np.linalg.norm(points[tree.edges[:, 0]] - points[tree.edges[:, 1]], axis=1)
    np.testing.assert_allclose(tree.lengths, apart, rtol=1e-15, atol=0)


@pytest.mark.parametrize("name", CLOUDS)
def test_it_is_a_tree(name: str) -> None:
    """As many edges as points but one, and all hang together: no cycle, however many lengths are equal."""
    count, edges = len(CLOUDS[name]), spanning_tree(CLOUDS[name]).edges
    assert edges.shape == (count - 1, 2)
    assert (edges[:, 0] < edges[:, 1]).all()
    links = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    assert connected_components(links, directed=False)[0] == 1


@given(st.lists(st.tuples(*[st.integers(0, 4)] * 3), min_size=2, max_size=60))
@settings(max_examples=60, deadline=None)
def test_ties_everywhere(places: list[tuple[int, int, int]]) -> None:
    points = np.array(places, float)
    np.testing.assert_allclose(spanning_tree(points).lengths, dense_lengths(points), rtol=1e-12)


def test_no_point_and_one_point_have_no_edge() -> None:
    assert spanning_tree(np.zeros((0, 3))).edges.shape == spanning_tree(np.zeros((1, 3))).edges.shape == (0, 2)


@pytest.mark.parametrize("name", ["ball", "curve", "clusters", "density 1e6:1", "duplicates"])
@pytest.mark.parametrize("parts", [2, 5, 40])
def test_links_between_parts_are_those_of_the_dense_matrix(name: str, parts: int) -> None:
    points = CLOUDS[name]
    labels = np.arange(len(points), dtype=np.int32) % parts
    links, lengths = shortest_links(points, labels)
    away = squareform(pdist(points))
    away[labels[:, None] == labels] = np.inf
    np.testing.assert_allclose(lengths, [away[labels == part].min() for part in range(parts)], rtol=1e-12)
    np.testing.assert_array_equal(labels[links[:, 0]], np.arange(parts))
    assert (labels[links[:, 1]] != np.arange(parts)).all()


def test_boxes_hold_their_points_and_know_what_they_share() -> None:
    tree = box_tree(CLOUDS["ball"][:77])
    labels = np.repeat([3, 1, 2], [40, 17, 20]).astype(np.int32)
    shared = tree.shared(labels)
    for node in range(1, 2 * tree.leaves):
        depth = node.bit_length() - 1
        width = 8 * tree.leaves >> depth
        rows = slice((node - (1 << depth)) * width, min(77, (node - (1 << depth) + 1) * width))
        inside, own = tree.points[rows], np.unique(labels[rows])
        if len(inside):
            np.testing.assert_array_equal(tree.low[node], inside.min(axis=0))
            np.testing.assert_array_equal(tree.high[node], inside.max(axis=0))
            assert shared[node] == (own[0] if len(own) == 1 else -1)
        else:
            assert np.isinf(tree.low[node]).all()
