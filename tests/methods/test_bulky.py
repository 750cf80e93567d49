"""Bulky bodies by method robust: loops for holes, limbs, joints, and a curve in the middle of the inside."""

import numpy as np
import pytest

from tiskel import ContractionParams, CurveGraph, Skeleton, contract, extract_skeleton
from tiskel.arrays import Indices, Points
from tiskel.geometry.body import Body, shares_of_depth
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.round_cones import ConeGraph, sample_union, union_distance
from tiskel.geometry.solid import Solid, solid_of
from tiskel.methods.robust.body import body_curve
from tiskel.methods.robust.body.limbs import without_corners, zipped
from tiskel.methods.robust.body.strands import plain_curve, strands_of
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.fit import ConeFit
from tiskel.methods.robust.network import prepared
from tiskel.params import RobustParams

HALF = np.array([1.0, 0.6, 0.4])  # half sides of the blocks
RADIUS = 0.25  # of their holes


def block(holes: int, count: int = 4096, seed: int = 0) -> Points:
    """Return points on a block with holes through its third axis, even by area."""
    generator = np.random.default_rng(seed)
    centres = (np.arange(holes) - (holes - 1) / 2) * 1.8 / max(holes, 1)
    sides = generator.uniform(-1, 1, (4 * count, 3))
    share = np.array([HALF[1] * HALF[2], HALF[0] * HALF[2], HALF[0] * HALF[1]])
    axis = generator.choice(3, len(sides), p=share / share.sum())
    sides[np.arange(len(sides)), axis] = np.sign(sides[np.arange(len(sides)), axis])
    sides = sides * HALF
    away = np.hypot(sides[:, :1] - centres, sides[:, 1:2])
    sides = sides[(axis != 2) | (away > RADIUS).all(axis=1)]
    walls = int(4 * count * holes * 2 * np.pi * RADIUS * 2 * HALF[2] / (8 * share.sum()))
    turn, where = generator.uniform(0, 2 * np.pi, walls), generator.integers(0, max(holes, 1), walls)
    x, y = centres[where] + RADIUS * np.cos(turn) if walls else turn, RADIUS * np.sin(turn)
    points = np.concatenate([sides, np.stack([x, y, generator.uniform(-HALF[2], HALF[2], walls)], axis=1)])
    return generator.permutation(points)[:count]


def in_block(places: Points, holes: int) -> np.ndarray:
    centres = (np.arange(holes) - (holes - 1) / 2) * 1.8 / max(holes, 1)
    outside_holes = (np.hypot(places[:, :1] - centres, places[:, 1:2]) > RADIUS).all(axis=1)
    return np.asarray((np.abs(places) < HALF).all(axis=1) & outside_holes)


def skeleton_of(cloud: Points) -> tuple[Skeleton, Points]:
    """Return the skeleton, and places on its curve in the coordinates of the cloud."""
    s = extract_skeleton(contract(cloud, ContractionParams(method="robust")))
    return s, curve_samples(s, 300).points


def solid_from(cloud: Points) -> Solid:
    network = prepared(cloud, 14)
    return solid_of(network.oriented(np.zeros_like(network.points)))


@pytest.mark.parametrize("holes", [1, 2])
def test_holes_through_a_block_become_loops(holes: int) -> None:
    """No end in a corner, and no place of the curve in a hole or in the air. Fronts run through the holes."""
    s, places = skeleton_of(block(holes))
    assert (s.components, s.loops, s.ends) == (1, holes, 0)
    assert in_block(places, holes).mean() > 0.99


def test_a_block_with_holes_lies_the_same_turned_round() -> None:
    """Everything happens in the axes of the cloud."""
    cloud = block(2)
    one = skeleton_of(cloud)[0]
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    other = skeleton_of(np.ascontiguousarray(cloud @ turn.T) * 3 + 5)[0]
    assert (one.components, one.loops, one.ends) == (other.components, other.loops, other.ends)
    assert other.length == pytest.approx(3 * one.length, rel=0.01)


def torso() -> ConeGraph:
    """A trunk wider than deep, of two balls side by side, with a head, arms, and legs close to each other."""
    nodes = np.array([
        [-0.15, 0, 0], [-0.15, 0, -0.7], [0.15, 0, 0], [0.15, 0, -0.7], [0, 0, 0.2], [0, 0, 0.6],
        [-0.95, 0, -0.3], [0.95, 0, 0.4], [-0.25, 0, -1.7], [0.25, 0, -1.7],
    ])  # fmt: skip
    edges = np.array([[0, 1], [2, 3], [0, 2], [1, 3], [0, 3], [1, 2], [4, 5], [0, 6], [2, 7], [1, 8], [3, 9]], np.int32)
    radii = np.array([0.33, 0.3, 0.33, 0.3, 0.15, 0.2, 0.1, 0.1, 0.13, 0.13])
    return ConeGraph(nodes, edges, radii)


def test_a_torso_has_its_limbs_and_joints_where_they_meet() -> None:
    """Head, two arms, two legs; the legs' joint is at the height where they part, not in the middle of the chest."""
    shape = torso()
    cloud = sample_union(shape, 4096, np.random.default_rng(2))
    s, places = skeleton_of(cloud)
    assert (s.components, s.loops, s.ends) == (1, 0, 5)
    assert (union_distance(places, shape) < 0).mean() > 0.99
    height = np.sort(places[np.abs(places[:, 0]) < 0.05, 2])
    assert height[0] < -0.5  # a middle line leads down to the legs: between two legs there is none


def test_a_knob_that_sticks_out_by_more_than_its_radius_is_there() -> None:
    nodes = np.array([[-1.0, 0, 0], [0, 0, 0], [1, 0, 0], [0, 0, 0.6]])
    knobbed = ConeGraph(nodes, np.array([[0, 1], [1, 2], [1, 3]], np.int32), np.array([0.4, 0.4, 0.4, 0.15]))
    s, places = skeleton_of(sample_union(knobbed, 4096, np.random.default_rng(2)))
    assert (s.loops, s.ends) == (0, 3)
    assert places[:, 2].max() > 0.5


def test_a_flat_bent_tube_has_its_middle_line() -> None:
    """Three times as wide as thick. Fronts zigzag in it."""
    turn = np.linspace(0, 3, 20)
    nodes = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    edges = np.stack([np.arange(19), np.arange(1, 20)], axis=1).astype(np.int32)
    cloud = sample_union(ConeGraph(nodes, edges, np.full(20, 0.3)), 4096, np.random.default_rng(2)) * [1, 1, 0.33]
    s, places = skeleton_of(cloud)
    assert (s.components, s.loops, s.ends) == (1, 0, 2)
    assert np.median(np.abs(np.hypot(places[:, 0], places[:, 1]) - 1)) < 0.06
    assert np.abs(places[:, 2]).max() < 0.08


def test_orientation_of_a_block_is_found_by_propagation() -> None:
    """Its points hardly contract, so that normals away from where they contract to face either way."""
    network = prepared(block(2), 14)
    noise = np.random.default_rng(0).normal(size=network.points.shape)
    solid = solid_of(network.oriented(0.9 * network.points + 0.1 * noise))
    assert solid.oriented.oriented_by == "propagation"
    assert solid.handles == 2


def test_strands_have_the_loops_of_their_cells() -> None:
    """Cells that touch in all ways: the graph has their loops, and none for a square or a pile of cells."""
    body = solid_from(block(1)).body
    assert body is not None
    strands = strands_of(body, body.inside)
    assert (strands.components, strands.loops) == (1, 1)


def test_the_middle_is_as_deep_as_can_be() -> None:
    """In a block without holes: 1 on the long axis, half that half the way to the nearest side, 0 outside."""
    body = solid_from(block(0)).body
    assert body is not None
    axis = body.places[body.clearance.argmax()]
    long = np.eye(3)[np.ptp(body.places, axis=0).argmax()]
    flat = np.eye(3)[np.ptp(body.places, axis=0).argmin()]
    places = np.stack([axis, axis + 0.2 * flat, axis + 0.6 * flat])
    found = shares_of_depth(body, places, np.stack([long] * 3))
    np.testing.assert_allclose(found, [1, 0.5, 0], atol=0.15)  # of cells of 0.17 of the depth


def test_corners_are_no_limbs() -> None:
    """A branch whose clearance falls as in a corner goes, one that keeps its own stays."""
    body = solid_from(block(0)).body
    assert body is not None
    step = np.arange(1, 13)
    ways = {"trunk": [1.0, 0, 0], "back": [-1.0, 0, 0], "other": [0, 1.0, 0]}
    nodes = np.concatenate([[np.zeros(3)], *(0.05 * step[:, None] * np.array(way) for way in ways.values())]) + 5
    edges = np.concatenate([np.stack([np.r_[0, 12 * k + step[:-1]], 12 * k + step], axis=1) for k in range(3)])
    for slope, ends in ((0.6, 2), (0.1, 3)):
        radii = np.full(len(nodes), 0.35)
        radii[25:] = np.maximum(0.01, (0.35 if slope > 0.5 else 0.1) - slope * 0.05 * step)
        curve = plain_curve(nodes, edges.astype(np.int32), radii)
        assert without_corners(curve, body).ends == ends


def test_branches_side_by_side_become_one_until_they_part() -> None:
    """In the middle of a block two ways from a joint at a narrow angle are one."""
    body = solid_from(block(0)).body
    assert body is not None
    middle = body.places[body.clearance.argmax()]
    long, flat = (np.eye(3)[by(np.ptp(body.places, axis=0))] for by in (np.argmax, np.argmin))
    along = np.linspace(0.05, 0.5, 10)[:, None]
    ways = [-along * long, along * long + 0.1 * along * flat, along * long - 0.1 * along * flat]
    nodes = middle + np.concatenate([[np.zeros(3)], *ways])
    rows = np.arange(1, 11)
    edges = np.concatenate([np.stack([np.r_[0, 10 * k + rows[:-1]], 10 * k + rows], axis=1) for k in range(3)])
    curve = plain_curve(nodes, edges.astype(np.int32), body.clearance_at(nodes))
    joined: CurveGraph = zipped(curve, body)
    assert len(joined.nodes) < len(curve.nodes)
    assert joined.components == 1
    assert joined.length < 0.8 * curve.length


def forked(body: Body, counts: tuple[int, int]) -> ConeCurve:
    """Two ways of so many nodes each, of the same length and at a narrow angle, and one back from their joint."""
    middle = body.places[body.clearance.argmax()]
    long, flat = (np.eye(3)[by(np.ptp(body.places, axis=0))] for by in (np.argmax, np.argmin))
    nodes, edges = [middle[None]], []
    at = 1
    for way, count in ((-long, 10), (long + 0.1 * flat, counts[0]), (long - 0.1 * flat, counts[1])):
        nodes.append(middle + np.linspace(0, 0.5, count + 1)[1:, None] * way)
        edges.append(np.stack([np.r_[0, at + np.arange(count - 1)], at + np.arange(count)], axis=1))
        at += count
    places = np.concatenate(nodes)
    return plain_curve(places, np.concatenate(edges).astype(np.int32), body.clearance_at(places))


def test_branches_are_not_joined_where_that_would_make_a_loop() -> None:
    """Of nodes unevenly apart one takes the place of two of the other branch, and the way past the first stays."""
    body = solid_from(block(0)).body
    assert body is not None
    assert zipped(forked(body, (10, 10)), body).length < 0.8 * forked(body, (10, 10)).length
    uneven = forked(body, (5, 10)), forked(body, (10, 5))
    joined = [zipped(curve, body) for curve in uneven]
    assert [curve.loops for curve in joined] == [0, 0]
    assert all(one is other for one, other in zip(uneven, joined, strict=True))


def test_branches_are_joined_no_more_often_than_there_are_branches(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = plain_curve(np.eye(4, 3), np.array([[0, 1], [0, 2], [0, 3]], np.int32), np.ones(4))
    asked = []

    def again(found: ConeCurve, _: Body) -> tuple[Indices, Indices, Points]:
        asked.append(len(found.nodes))
        return np.arange(4, dtype=np.int32), np.array([1], np.int32), found.nodes[[1]] / 2

    monkeypatch.setattr("tiskel.methods.robust.body.limbs._longest_zip", again)
    body = solid_from(block(0)).body
    assert body is not None
    assert zipped(curve, body).nodes[1] == pytest.approx(curve.nodes[1] / 8)
    assert asked == [4, 4, 4]


def test_a_body_without_an_inside_has_no_curve() -> None:
    network = prepared(block(0, 300), 14)
    oriented = network.oriented(network.points * 0.9)
    assert body_curve(network, Solid(oriented, trusted=False, handles=None), RobustParams()) is None


def test_ends_grow_as_often_as_is_asked_and_no_further(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each time a node more at one end; then the curve is fitted once more."""
    network = prepared(block(0, 1500), 14)
    solid = solid_of(network.oriented(0.5 * network.points))
    asked = []

    def longer(fit: ConeFit, *_: object) -> ConeCurve:
        asked.append(len(fit.curve.nodes))
        end = np.flatnonzero(fit.curve.degrees == 1)[:1]
        tip = fit.curve.nodes[end] * 1.02
        links = np.stack([end, [len(fit.curve.nodes)]], axis=1).astype(np.int32)
        return with_nodes(fit.curve, tip, fit.curve.radii[end] / 2, links, fit.curve.levels[end])

    monkeypatch.setattr("tiskel.methods.robust.body.with_tips", longer)
    found = body_curve(network, solid, RobustParams(grow_ends=2))
    assert found is not None
    assert asked == [asked[0], asked[0] + 1]
    assert len(found.curve.nodes) == asked[0] + 2
