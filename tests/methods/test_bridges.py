"""Gaps in the scan: missing corners and bends, and fragments between two gaps."""

import numpy as np
import pytest

from tiskel import ShapeParams, Skeleton, contract, extract_skeleton, make_shape
from tiskel.arrays import Edges, Numbers, Points
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.round_cones import ConeGraph, union_distance
from tiskel.methods.robust.ends import with_stubs
from tiskel.methods.robust.network import neighbour_network
from tiskel.methods.robust.sections import section_graph
from tiskel.methods.trace import Sections

RADIUS = 0.12


def bent_rod(places: Points) -> ConeGraph:
    edges: Edges = np.stack([np.arange(len(places) - 1), np.arange(1, len(places))], axis=1).astype(np.int32)
    return ConeGraph(places, edges, np.full(len(places), RADIUS))


def without_balls(shape: ConeGraph, balls: list[tuple[Numbers, float]]) -> Points:
    points = make_shape(shape, ShapeParams(count=4096))[0]
    for centre, radius in balls:
        points = points[np.linalg.norm(points - centre, axis=1) > radius]
    return points


def arc(extent: float) -> Points:
    angle = np.linspace(0, extent, 40)
    return np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)


@pytest.mark.parametrize("radius", [0.35, 0.5], ids=str)
def test_a_missing_corner_is_bridged_round_the_corner(radius: float) -> None:
    """A straight line between the ends would leave the body by a radius; the bridge by less than half of one."""
    corner = bent_rod(np.array([[1.0, 0, 0], [0.5, 0, 0], [0, 0, 0], [0, 0.5, 0], [0, 1.0, 0]]))
    skeleton = extract_skeleton(contract(without_balls(corner, [(np.zeros(3), radius)])))
    assert topology(skeleton) == (1, 0, 2)
    places = curve_samples(skeleton, 200).points
    assert union_distance(places, corner).max() < 0.4 * RADIUS


def test_a_missing_bend_is_bridged_along_the_bend() -> None:
    """Of a ring of four fifths, sixty-five degrees are gone: each end sees the other thirty degrees aside."""
    ring = bent_rod(arc(1.6 * np.pi))
    middle = np.array([np.cos(0.8 * np.pi), np.sin(0.8 * np.pi), 0])
    skeleton = extract_skeleton(contract(without_balls(ring, [(middle, 0.56)])))
    assert topology(skeleton)[:2] == (1, 0)
    assert skeleton.bridged.any()
    assert union_distance(curve_samples(skeleton, 200).points, ring).max() < RADIUS


def test_a_fragment_between_two_gaps_is_part_of_the_curve() -> None:
    """A rod of which all but the ends and a ring as long as its radius is missing."""
    rod = bent_rod(np.array([[-1.0, 0, 0], [0, 0, 0], [1.0, 0, 0]]))
    gaps = [(np.array([side * 0.35, 0, 0]), 0.3) for side in (-1, 1)]
    skeleton = extract_skeleton(contract(without_balls(rod, gaps)))
    assert topology(skeleton) == (1, 0, 2)
    assert skeleton.bridged.any()


def test_a_ring_becomes_a_stub_and_a_ball_does_not() -> None:
    angle = np.random.default_rng(0).uniform(0, 2 * np.pi, 300)
    height = np.random.default_rng(1).uniform(-0.5, 0.5, 300)
    ring = np.stack([np.cos(angle), np.sin(angle), height], axis=1)
    ball = np.random.default_rng(2).normal(size=(300, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    for points, edges in ((ring, 1), (ball, 0)):
        network = neighbour_network(points, 14)
        sections = Sections(np.zeros(300, np.int32), np.zeros(300, np.int32))
        stub = with_stubs(section_graph(network, sections), network, sections)
        assert len(stub.edges) == edges
        if edges:
            along = stub.nodes[1] - stub.nodes[0]
            assert abs(along[2]) > 0.99 * np.linalg.norm(along)
            np.testing.assert_allclose(stub.radii, 1, atol=0.05)


def topology(skeleton: Skeleton) -> tuple[int, int, int]:
    return skeleton.components, skeleton.loops, skeleton.ends
