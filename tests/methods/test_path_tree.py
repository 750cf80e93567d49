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


def test_the_way_does_not_take_the_short_cut_of_a_bend() -> None:
    """A hairpin six steps wide, ten long: its ends are the open ones, though points across it are neighbours."""
    arm, turn = np.arange(10) * STEP, np.linspace(0, np.pi, 10)[1:-1]
    bend = [[arm[-1] + 3 * STEP * np.sin(t), 3 * STEP * np.cos(t), 0] for t in turn]
    points = np.array([*([x, 3 * STEP, 0] for x in arm), *bend, *([x, -3 * STEP, 0] for x in arm[::-1])])
    tree = path_tree(points)
    assert (tree.ends, tree.loops) == (2, 0)
    assert (tree.nodes[tree.degrees == 1, 0] < STEP).all()


def test_the_same_cloud_makes_the_same_tree() -> None:
    points = np.random.default_rng(1).random((300, 3))
    other = np.random.default_rng(2).permutation(np.concatenate([points, points[:50]]))
    np.testing.assert_array_equal(path_tree(points).nodes, path_tree(other).nodes)


@pytest.mark.parametrize("count", [1, 2, 3, 20])
def test_a_few_points_are_no_accident(count: int) -> None:
    line = np.outer(np.arange(count), [1.0, 0, 0])
    tree = path_tree(line)
    assert (tree.components, tree.loops) == (1, 0)
    assert path_tree(np.random.default_rng(count).random((count, 3))).components == 1
