"""Ways along a curve from one node, against SciPy's Dijkstra on whole graphs."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from tiskel import CurveGraph
from tiskel.geometry.graph import tidy_edges
from tiskel.geometry.ways import steps_of, way_to, ways_from


def random_graph(seed: int) -> CurveGraph:
    rng = np.random.default_rng(seed)
    pairs = rng.integers(0, 40, (60, 2))
    return CurveGraph(rng.random((40, 3)), tidy_edges(pairs[pairs[:, 0] != pairs[:, 1]].astype(np.int32)), np.ones(40))


def test_ways_are_those_of_a_search_of_the_whole_graph() -> None:
    for seed in range(20):
        graph = random_graph(seed)
        matrix = sparse.coo_array((graph.lengths, graph.edges.T), shape=(40, 40))
        whole = dijkstra(matrix.tocsr(), directed=False, indices=0, limit=1.5)
        found = ways_from(steps_of(graph), 0, most=1.5)
        assert sorted(found) == np.flatnonzero(np.isfinite(whole)).tolist()
        np.testing.assert_allclose([found[node][0] for node in sorted(found)], whole[np.isfinite(whole)])
        for goal in found:
            way = way_to(found, goal)
            assert (way[0], way[-1]) == (goal, 0)
            np.testing.assert_allclose(np.linalg.norm(np.diff(graph.nodes[way], axis=0), axis=1).sum(), whole[goal])


def test_a_search_for_a_goal_ends_there_and_finds_no_way_that_is_longer() -> None:
    edges = np.array([[0, 1], [1, 2], [2, 3]], np.int32)
    steps = steps_of(CurveGraph(np.array([[x, 0, 0] for x in (0.0, 1, 2, 4)]), edges, np.ones(4)))
    assert way_to(ways_from(steps, 0, 10.0, goal=2), 2) == [2, 1, 0]
    assert 3 not in ways_from(steps, 0, 10.0, goal=1)
    assert way_to(ways_from(steps, 0, 3.9), 3) == []
    assert way_to(ways_from(steps, 0, 4.0), 3) == [3, 2, 1, 0]
    assert way_to(ways_from(steps, 2, 0.0), 2) == [2]
