"""Wires whose turns lie side by side: springs are one wire, and surfaces whose points lie in rows are none."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tiskel import RobustParams, ShapeParams, Skeleton, make_shape, shape_graph, skeletonize
from tiskel.arrays import Points
from tiskel.gallery.wires import coil
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.methods.robust.network import prepared
from tiskel.methods.robust.wire.directions import beside_mean, refined, valleys, voted
from tiskel.methods.robust.wire.links import Links, linked
from tiskel.methods.robust.wire.parallel import _one_wire, parallel_links

NEIGHBOURS = RobustParams().neighbours


def spring(turns: float, count: int, pitch: float, seed: int = 0) -> Points:
    """Return points at random along a helix of radius 1."""
    angle = np.random.default_rng(seed).random(count) * turns * 2 * np.pi
    return np.stack([np.cos(angle), np.sin(angle), pitch * angle / (2 * np.pi)], axis=1)


def links_of_turns(cloud: Points) -> Links | None:
    return parallel_links(prepared(np.ascontiguousarray(cloud), min(NEIGHBOURS, len(cloud))))


def codes(made: Skeleton) -> list[str]:
    return [doubt.code for doubt in (*made.warnings, *made.notes)]


# directions and valleys


def test_beside_the_mean_direction_an_arc_is_not_and_a_parallel_is_by_its_distance() -> None:
    angle = np.linspace(0.05, 1.5, 20)
    start, first = np.array([1.0, 0, 0]), np.array([[0.0, 1, 0]])
    arc = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    there = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    assert beside_mean(arc - start, first, there) == pytest.approx(0, abs=1e-7)
    assert beside_mean(arc - start, first, -there) == pytest.approx(0, abs=1e-7)  # signs mean nothing
    steps = np.array([[0.3, 2.0, 0.4], [0.3, 0.0, 0.4]])
    assert beside_mean(steps, first, -first) == pytest.approx(0.5)


def test_a_valley_is_where_few_distances_are_and_none_is_in_an_even_distribution() -> None:
    generator = np.random.default_rng(0)
    both = np.concatenate([generator.normal(0.2, 0.1, 20_000), generator.normal(2.0, 0.1, 20_000)])
    (only,) = valleys(np.abs(both))
    assert 0.5 < only.beside < 1.7
    assert only.depth < 0.01
    assert valleys(generator.random(40_000) * 3) == []


def test_points_vote_for_the_direction_of_their_wire_and_not_across() -> None:
    """Half of all gaps are wider than a third of the way to the next turn."""
    cloud = spring(12, 3000, 0.08)
    near = nearest_neighbours(cloud, 21)[0][:, 1:]
    found = voted(cloud, near)
    true = np.stack([-cloud[:, 1], cloud[:, 0], np.full(len(cloud), 0.08 / (2 * np.pi))], axis=1)
    true /= np.linalg.norm(true, axis=1)[:, None]
    wrong = np.degrees(np.arccos(np.clip(np.abs((found * true).sum(axis=1)), 0, 1)))
    assert np.quantile(wrong, 0.9) < 15
    network = prepared(cloud, NEIGHBOURS)
    (valley, *_) = valleys(beside_mean(cloud[near] - cloud[:, None], found[:, None], found[near]) / network.spacing)
    wires = refined(cloud, near, found, valley, network.spacing)
    assert wires is not None
    better = np.degrees(np.arccos(np.clip(np.abs((wires.directions * true).sum(axis=1)), 0, 1)))
    assert np.quantile(better, 0.99) < 10


# links


@pytest.mark.parametrize(("turns", "count", "pitch"), [(5, 1200, 0.08), (12, 3000, 0.08), (30, 6000, 0.1)])
def test_links_follow_the_wire_from_turn_to_turn(turns: int, count: int, pitch: float) -> None:
    cloud = spring(turns, count, pitch)
    links = links_of_turns(cloud)
    assert links is not None
    assert links.kept.mean() > 0.99
    height = cloud[:, 2]
    assert (np.abs(height[links.first] - height[links.second]) > 0.9 * pitch).sum() <= 2


def test_points_in_rows_of_a_surface_are_no_wire() -> None:
    """Rows two to four times as far apart as the points in them are: no curve is longer than the body."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 120, endpoint=False), np.linspace(0, 4, 38))
    pipe = np.stack([np.cos(u), np.sin(u), v], axis=2).reshape(-1, 3)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 200, endpoint=False), np.linspace(0, 2 * np.pi, 25, endpoint=False))
    ring = np.stack([np.cos(u) * (3 + np.cos(v)), np.sin(u) * (3 + np.cos(v)), np.sin(v)], axis=2).reshape(-1, 3)
    x, y = np.meshgrid(np.linspace(0, 4, 100), np.linspace(0, 3, 25))
    plate = np.stack([x, y, 0 * x], axis=2).reshape(-1, 3)
    assert [links_of_turns(cloud) for cloud in (pipe, ring, plate)] == [None] * 3
    made = skeletonize(pipe)
    assert (made.components, made.loops, made.ends) == (1, 0, 2)
    assert "turns" not in codes(made)


@pytest.mark.parametrize("name", ["y", "torus", "knot"])
def test_what_is_no_wire_has_no_such_links(name: str) -> None:
    assert links_of_turns(make_shape(shape_graph(name))[0]) is None
    assert links_of_turns(np.random.default_rng(0).random((1000, 3))) is None


def test_a_shortcut_from_turn_to_turn_leaves_out_what_is_between() -> None:
    """Each row is linked to the next, and in the second case the first to the last but one, too."""
    cloud = spring(10, 2000, 0.1)
    cloud = cloud[np.argsort(cloud[:, 2])]
    along = np.stack([np.arange(1999), np.arange(1, 2000)], axis=1)
    wide = 0.05
    assert _one_wire(cloud, linked(cloud, along), wide)
    assert not _one_wire(cloud, linked(cloud, np.concatenate([along, [[200, 1800]]])), wide)
    assert not _one_wire(cloud, linked(cloud, along[:1000]), wide)  # half of it


# curves


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "count", "noise"), [(2, 4096, 0.0), (2, 8192, 0.1), (2, 16384, 0.1), (3, 2048, 0.1)])
def test_a_close_coil_is_one_wire(gap: float, count: int, noise: float) -> None:
    body = coil(gap)
    made = skeletonize(make_shape(body, ShapeParams(count=count, noise=noise))[0])
    assert (made.components, made.loops, made.ends) == (1, 0, 2)
    assert body.length * 0.97 < made.length < body.length * 1.25
    assert made.warnings == ()
    assert "turns" in codes(made)


def test_a_spring_is_the_same_turned_and_in_another_order_and_a_tube_where_that_is_asked_for() -> None:
    cloud = spring(8, 2000, 0.1)
    made = skeletonize(cloud)
    assert (made.components, made.loops, made.ends) == (1, 0, 2)
    turned = Rotation.from_euler("xyz", [10, 50, 20], degrees=True).as_matrix()
    order = np.random.default_rng(1).permutation(len(cloud))
    other = skeletonize(cloud[order] @ turned.T)
    assert (other.components, other.loops, other.ends) == (1, 0, 2)
    assert other.length == pytest.approx(made.length, rel=1e-6)
    tube = skeletonize(cloud, regime="tube")
    assert "turns" not in codes(tube)
    assert tube.length < made.length / 4
