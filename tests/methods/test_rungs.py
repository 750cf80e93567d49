"""Rungs through the air: pipes and bars that pass each other closely, and ladders, whose rungs stay."""

import numpy as np
import pytest

from tiskel import ShapeParams, Skeleton, contract, extract_skeleton, make_shape, shape_graph
from tiskel.gallery.families import BODIES
from tiskel.geometry.round_cones import ConeGraph

RADIUS = 0.1


def pipes(gap: float, angle: float) -> ConeGraph:
    """Return two pipes that pass each other with a gap of so many radii between them."""
    x, y, z = np.cos(np.radians(angle)), np.sin(np.radians(angle)), (2 + gap) * RADIUS
    nodes = np.array([[-1, 0, 0], [1, 0, 0], [-x, -y, z], [x, y, z]])
    return ConeGraph(nodes, np.array([[0, 1], [2, 3]], np.int32), np.full(4, RADIUS))


def skeleton_of(shape: ConeGraph, count: int, **sampling: float) -> Skeleton:
    params = ShapeParams(count=count, **sampling)  # type: ignore[arg-type]
    return extract_skeleton(contract(make_shape(shape, params)[0]))


@pytest.mark.parametrize("angle", [90, 45])
@pytest.mark.parametrize(("gap", "noise"), [(0.5, 0.0), (1.0, 0.0), (1.0, 0.1)])
def test_pipes_that_pass_each_other_are_two(gap: float, noise: float, angle: float) -> None:
    for count in (3000, 12000):
        s = skeleton_of(pipes(gap, angle), count, noise=noise)
        assert (s.components, s.loops, s.ends) == (2, 0, 4)


def test_bars_that_bend_towards_each_other_are_two_in_noise() -> None:
    for count in (4096, 16384):
        s = skeleton_of(BODIES["twins"](), count, noise=0.1)  # type: ignore[arg-type]
        assert (s.components, s.loops, s.ends) == (2, 0, 4)


def test_pipes_that_meet_are_one() -> None:
    nodes = np.array([[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], float)
    cross = ConeGraph(nodes, np.array([[0, 1], [0, 2], [0, 3], [0, 4]], np.int32), np.full(5, RADIUS))
    for noise in (0.0, 0.1):
        s = skeleton_of(cross, 3000, noise=noise)
        assert (s.components, s.loops, s.ends) == (1, 0, 4)


@pytest.mark.parametrize("sampling", [{}, {"noise": 0.2}, {"missing": 0.2}])
def test_the_rungs_of_a_ladder_stay(sampling: dict[str, float]) -> None:
    ladder = shape_graph("ladder")
    s = skeleton_of(ladder, 4096, **sampling)
    assert (s.components, s.loops, s.ends) == (ladder.components, ladder.loops, ladder.ends)
