"""The plain baseline for trees finds them where it should: on wires."""

import numpy as np
import pytest

from reference.path_tree import path_tree

STEP = 0.05  # between points along a wire


def wires(*ways: tuple[list[float], list[float]]) -> np.ndarray:
    """Points along straight wires, jittered by a tenth of a step."""
    rng = np.random.default_rng(0)
    count = [int(np.linalg.norm(np.subtract(b, a)) / STEP) for a, b in ways]
    along = [np.linspace(a, b, n) for (a, b), n in zip(ways, count, strict=True)]
    points = np.concatenate(along)
    return points + rng.normal(0, STEP / 10, points.shape)


def test_a_fork_of_wires_is_found() -> None:
    tree = path_tree(wires(([0, 0, 0], [0, 0, 2]), ([0, 0, 2.05], [1, 0, 3]), ([0, 0.05, 2.05], [-1, 0.5, 3])))
    assert (tree.components, tree.loops, tree.ends, tree.junctions) == (1, 0, 3, 1)
    assert tree.length == pytest.approx(2 + np.hypot(1, 1) + np.hypot(1, 1.1), rel=0.08)
    assert not tree.bridged.any()


def test_a_gap_is_bridged_and_said() -> None:
    tree = path_tree(wires(([0, 0, 0], [0, 0, 2]), ([0, 0, 2.5], [0, 0, 4])))
    assert (tree.components, tree.ends) == (1, 2)
    (a, b), *more = tree.nodes[tree.edges[tree.bridged]]
    assert not more
    assert 2 - 3 * STEP < min(a[2], b[2]) < 2.25 < max(a[2], b[2])  # smoothing draws both inwards


def test_the_way_does_not_cut_a_bend_short() -> None:
    """A hairpin three steps wide: all its length is there, though each end sees the other side."""
    turn = np.linspace(0, 2, 41)
    points = np.concatenate([[[x, 0, 0] for x in turn], [[2 + STEP, 2 * STEP, 0]], [[x, 4 * STEP, 0] for x in turn]])
    assert path_tree(points).length > 3.7


def test_the_same_cloud_makes_the_same_tree() -> None:
    points = np.random.default_rng(1).random((300, 3))
    np.testing.assert_array_equal(path_tree(points).nodes, path_tree(points.copy()).nodes)
