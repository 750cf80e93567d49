"""Clouds of wires are thinned for their loops, surfaces are not."""

import numpy as np
import pytest

from tiskel import MetricParams, ShapeParams, evaluate, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.metrics.barcode import barcode, delaunay_edges
from tiskel.metrics.loop_points import EACH, EDGES, FEW, loop_rows, on_wires

PARAMS = MetricParams()


def trefoil(count: int, noise: float = 0.0) -> Points:
    turn = np.arange(count) * 2 * np.pi / count
    axes = [np.sin(turn) + 2 * np.sin(2 * turn), np.cos(turn) - 2 * np.cos(2 * turn), -np.sin(3 * turn)]
    knot = np.stack(axes, axis=1)
    spacing = float(np.linalg.norm(knot[1] - knot[0]))
    return np.asarray(knot + noise * spacing * np.random.default_rng(3).normal(size=knot.shape))


@pytest.mark.parametrize("name", ["torus", "helix", "tree", "hand"])
def test_surfaces_stay_as_they_are(name: str) -> None:
    cloud = make_shape(shape_graph(name), ShapeParams(count=3000))[0]
    assert loop_rows(cloud, PARAMS).tolist() == list(range(3000))


@pytest.mark.parametrize("noise", [0.0, 0.003, 0.02])
def test_wires_are_thinned_evenly_until_their_graph_is_small(noise: float) -> None:
    wire = trefoil(3000, noise)
    rows = loop_rows(wire, PARAMS)
    assert FEW <= len(rows) <= 3000
    assert (np.diff(rows) > 0).all()
    assert len(delaunay_edges(wire[rows])) <= max(EDGES, EACH * len(rows))
    gaps = np.diff(np.append(rows, rows[0] + 3000))  # along the wire, whose points are nearly even
    assert gaps.max() <= 4 * 3000 / len(rows)


def test_a_large_cloud_is_thinned_at_random_as_before() -> None:
    cloud = make_shape(shape_graph("torus"), ShapeParams(count=3000))[0]
    rows = loop_rows(cloud, MetricParams(loop_points=1500, seed=4))
    expected = np.sort(np.random.default_rng(4).choice(3000, 1500, replace=False))
    np.testing.assert_array_equal(rows, expected)


def test_points_on_wires_are_told_from_those_of_tubes() -> None:
    assert on_wires(trefoil(1500)).mean() > 0.9
    assert on_wires(make_shape(shape_graph("helix"), ShapeParams(count=1000))[0]).mean() == 0
    sheet = np.random.default_rng(0).random((1000, 3)) * [1, 1, 0]
    assert on_wires(sheet).mean() < 0.01


def test_the_loop_of_a_closed_wire_is_there() -> None:
    """2000 points of it have a million edges, and took minutes."""
    wire = trefoil(2000)
    cycles = barcode(np.ascontiguousarray(wire[loop_rows(wire, PARAMS)]), loops=True).cycles
    assert (cycles[:, 1] >= PARAMS.loop_ratio * cycles[:, 0]).sum() >= 1
    quality = evaluate(wire, wire)
    assert quality.loops.surface is not None
    assert quality.loops.surface >= 1
    assert quality.loops.points < 2000


def test_wires_whose_graph_is_small_stay_as_they_are() -> None:
    """Thirty short ones in a box: most of their points are in line, and yet few of them are neighbours."""
    generator = np.random.default_rng(5)
    ends = generator.random((2, 30, 1, 3)) * 20
    ends[1] = ends[0] + 2 * generator.normal(size=(30, 1, 3))
    shares = np.linspace(0, 1, 40)[:, None]
    wires = (ends[0] + shares * (ends[1] - ends[0])).reshape(-1, 3)
    wires += 1e-4 * generator.normal(size=wires.shape)
    assert on_wires(wires).sum() > 2 * FEW
    assert len(delaunay_edges(wires)) <= max(EDGES, EACH * len(wires))
    assert loop_rows(wires, PARAMS).tolist() == list(range(1200))
