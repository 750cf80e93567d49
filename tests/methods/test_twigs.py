"""Wires: limbs thinner than the points are apart, whose nodes can have radius zero."""

from pathlib import Path

import numpy as np
import pytest

from tiskel import RobustParams, contract, extract_skeleton, load_cloud
from tiskel.arrays import Points
from tiskel.methods.robust.wire.links import links_of

pytestmark = pytest.mark.filterwarnings("error::RuntimeWarning")

STEP = 0.1  # between the points of a twig
WIRES = RobustParams(regime="wire")
SEEDS = (171, 0, 1, 2)  # of these the first divided by a radius of zero


def forking_twigs(seed: int) -> Points:
    """Return 20 to 150 points that lie exactly on straight, forking twigs."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(20, 150))
    points = [np.zeros(3)]
    tips = [(np.zeros(3), np.array([0.0, 0.0, 1.0]))]
    while len(points) <= count:
        forks = []
        for place, direction in tips:
            for _ in range(int(rng.integers(2, 6))):
                place = place + STEP * direction  # noqa: PLW2901
                points.append(place)
            for _ in range(int(rng.integers(1, 4))):
                bent = direction + rng.normal(0, 0.6, 3)
                forks.append((place, bent / np.linalg.norm(bent)))
        tips = forks[:30]
    return np.array(points[:count])


@pytest.mark.parametrize("seed", SEEDS)
def test_nodes_of_radius_zero_are_no_crash(seed: int) -> None:
    skeleton = extract_skeleton(contract(forking_twigs(seed)))
    assert np.isfinite(skeleton.nodes).all()
    assert np.isfinite(skeleton.radius).all()


@pytest.mark.parametrize("name", ["twigs", "crash_54points"])
def test_reported_twigs_are_no_crash(cases_folder: Path, name: str) -> None:
    skeleton = extract_skeleton(contract(load_cloud(cases_folder / f"{name}.xyz").points))
    assert skeleton.components == 1


def test_points_a_rounding_error_apart_end() -> None:
    """Ways between them grow by nothing, so that sections lead to each other in turn."""
    points = forking_twigs(3)
    again = points + 1e-15 * np.random.default_rng(0).normal(size=points.shape)
    skeleton = extract_skeleton(contract(np.concatenate([points, again]), WIRES))
    assert skeleton.components == 1
    assert np.isfinite(skeleton.nodes).all()


def test_dots_far_apart_do_not_set_a_spacing_of_nothing() -> None:
    """Rings of radius 1.3e-9: in their spacings the way from one to the next is more than an int32 can count."""
    angle, height = 2 * np.pi * np.arange(15) / 15, np.linspace(0, 2.5, 7)
    rings = [np.stack([1.3e-9 * np.cos(angle), 1.3e-9 * np.sin(angle), np.full(15, z)], axis=1) for z in height]
    assert links_of(np.concatenate(rings), 10).spacing == pytest.approx(2.5e-6)
    skeleton = extract_skeleton(contract(np.concatenate(rings), WIRES))
    assert np.isfinite(skeleton.nodes).all()


def test_a_cloud_without_neighbours_along_a_surface_has_a_curve() -> None:
    """Upright columns of close points: all their links run along normals, and none is left."""
    lattice = np.stack(np.meshgrid(*map(np.arange, (3, 3, 7)), indexing="ij"), axis=-1).reshape(-1, 3)
    skeleton = extract_skeleton(contract(lattice * [1, 1, 1e-3]))
    assert len(skeleton.edges) > 0
    assert np.isfinite(skeleton.radius).all()


def test_points_of_a_part_without_edges_keep_its_node() -> None:
    """A ball beside a long twig: its points stand on no edge, and on none of the twig's either."""
    twig = np.column_stack([np.arange(300.0), np.zeros(300), 0.1 * np.sin(np.arange(300))])
    ball = np.random.default_rng(0).normal(size=(40, 3)) * 0.2 + [0, 0, 200]
    skeleton = extract_skeleton(contract(np.concatenate([twig, ball]), WIRES))
    away = np.linalg.norm(skeleton.nodes[skeleton.node_of_point] - skeleton.cloud, axis=1)
    assert away.max() < 5


def test_junctions_of_radius_zero_stay() -> None:
    """A prism over a triangle, whose edges are strands, and a point beyond."""
    angle = 2 * np.pi * np.arange(3) / 3
    rings = [np.stack([np.cos(angle), np.sin(angle), np.full(3, 0.1 * level)], axis=1) for level in range(19)]
    skeleton = extract_skeleton(contract(np.concatenate([*rings, [[0, 0, 2.8]]]), RobustParams(regime="tube")))
    assert np.isfinite(skeleton.nodes).all()


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_even_twigs_are_the_same_in_any_order_turned_and_scaled(seed: int) -> None:
    """Points exactly one step apart: three steps are two bins, and rounding must not say one."""
    points, rng = forking_twigs(seed), np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    nodes = extract_skeleton(contract(points, WIRES)).nodes
    for moved in (points[rng.permutation(len(points))], points @ turn, 3.7 * points):
        other = extract_skeleton(contract(moved, WIRES)).nodes
        away = [np.sort(np.linalg.norm(place - place.mean(axis=0), axis=1)) for place in (nodes, other)]
        assert away[0] / away[0].max() == pytest.approx(away[1] / away[1].max(), abs=1e-6)
