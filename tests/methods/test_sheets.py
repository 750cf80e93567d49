"""Sheets and scans from one side: the curve lies on what was seen, unless enough was seen to tell where the axis is."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import (
    RadiusSource,
    RobustParams,
    ShapeParams,
    Skeleton,
    contract,
    extract_skeleton,
    make_shape,
    named_shape,
)
from tiskel.arrays import Points
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.cycles import without_tight_cycles

GOLDEN = (5**0.5 - 1) / 2


def arc(degrees: float, radius: float, length: float, count: int) -> Points:
    """Return points spread evenly over so many degrees of a tube along z, those about the y axis."""
    number = np.arange(count)
    angle = np.radians(degrees) * (GOLDEN * number % 1 - 0.5)
    points = np.stack([radius * np.sin(angle), radius * np.cos(angle), length * (number + 0.5) / count], axis=1)
    return points + np.random.default_rng(1).normal(0, 0.002, points.shape)


def spacing(points: Points) -> float:
    return float(np.median(cKDTree(points).query(points, k=2)[0][:, 1]))


def skeleton_of(points: Points, **settings: Any) -> Skeleton:
    return extract_skeleton(contract(points, RobustParams(**settings)))


@pytest.mark.parametrize("radius", [0.5, 1.0])
def test_the_curve_of_a_leaf_lies_on_the_leaf(radius: float) -> None:
    """A quarter of a tube; its axis is a radius away from every point."""
    leaf = arc(90, radius, 4.0, 800)
    s = skeleton_of(leaf)
    assert (s.components, s.loops, s.ends) == (1, 0, 2)
    assert s.length > 3
    assert cKDTree(leaf).query(curve_samples(s, 300).points)[0].max() < 2 * spacing(leaf)
    assert np.abs(s.nodes[:, 0]).max() < 0.2 * radius  # on its middle
    assert (s.regimes == Regime.SHEET).all()
    assert (s.radius_sources == RadiusSource.BOUNDED).all()
    assert not s.warnings
    # Half the width, of all but the outermost points.
    chord = radius * np.sin(np.pi / 4)
    assert 0.75 * chord < np.median(s.radius) < 1.1 * chord


@pytest.mark.parametrize("degrees", [150, 180])
def test_a_pipe_of_which_much_is_seen_keeps_its_axis(degrees: float) -> None:
    s = skeleton_of(arc(degrees, 0.3, 3.0, 500))
    assert (s.components, s.loops, s.ends) == (1, 0, 2)
    assert np.linalg.norm(s.nodes[:, :2], axis=1).max() < 0.1 * 0.3
    assert not (s.regimes == Regime.SHEET).any()
    np.testing.assert_allclose(s.radius, 0.3, rtol=0.1)


def test_of_the_same_turn_a_fold_is_a_sheet_and_an_arc_a_pipe() -> None:
    """Both cover 110 degrees about where their normals meet; a circle is what a pipe looks like."""
    number = np.arange(600)
    across = 0.8 * (GOLDEN * number % 1 - 0.5)
    fold = np.stack([across, -np.abs(across) * np.tan(np.radians(30)), 3 * (number + 0.5) / 600], axis=1)
    fold += np.random.default_rng(1).normal(0, 0.002, fold.shape)
    folded, round_one = skeleton_of(fold), skeleton_of(arc(115, 0.3, 3.0, 500))
    assert (folded.regimes == Regime.SHEET).mean() > 0.9
    assert np.median(cKDTree(fold).query(folded.nodes)[0]) < spacing(fold)
    assert not (round_one.regimes == Regime.SHEET).any()
    assert np.linalg.norm(round_one.nodes[:, :2], axis=1).max() < 0.1 * 0.3


def test_what_a_sensor_saw_through_is_no_body() -> None:
    """Half a pipe seen from outside may be a pipe; seen from the hollow side it is a gutter."""
    points = arc(150, 0.3, 3.0, 500)
    outside, inside = (skeleton_of(points, seen_from=(0.0, y, 1.5)) for y in (8.0, -8.0))
    assert np.linalg.norm(outside.nodes[:, :2], axis=1).max() < 0.1 * 0.3
    assert (inside.regimes == Regime.SHEET).all()
    assert cKDTree(points).query(inside.nodes)[0].max() < 2 * spacing(points)


def test_the_sensor_stands_in_the_unit_of_the_input() -> None:
    """A shift by a hundred lengths would put a sensor that is not moved along on the other side."""
    points, shift = arc(150, 0.3, 3.0, 500), np.array([0.0, 300.0, 0])
    s = skeleton_of(7 * points + shift, seen_from=(0.0, -8.0 * 7 + 300, 10.0))
    assert (s.regimes == Regime.SHEET).all()


def test_a_leaf_stays_one_wherever_its_sensor_stood() -> None:
    leaf = arc(90, 1.0, 4.0, 800)
    for y in (8.0, -8.0, -1.5):
        assert (skeleton_of(leaf, seen_from=(0.0, y, 2.0)).regimes == Regime.SHEET).all()


def ring(radius: float, width: float) -> ConeCurve:
    """Return a cycle of eight nodes with such radii, and a tail of two."""
    angle = 2 * np.pi * np.arange(8) / 8
    nodes = np.concatenate([np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1) * radius, [[9, 0, 0]]])
    edges = np.array([*([i, (i + 1) % 8] for i in range(8)), [0, 8]], np.int32)
    return ConeCurve(
        nodes=nodes, edges=np.sort(edges, axis=1), radii=np.full(9, width), levels=np.zeros(9, np.int32),
        node_of_section=np.append(np.arange(9), -1).astype(np.int32), section_sizes=np.ones(9),
    )  # fmt: skip


def test_a_tight_cycle_is_contracted_and_a_real_loop_is_not() -> None:
    tight, loop = without_tight_cycles(ring(1.0, 1.1)), without_tight_cycles(ring(1.0, 0.9))
    assert (tight.components, tight.loops, len(tight.nodes)) == (1, 0, 2)
    np.testing.assert_allclose(tight.nodes[0], 0, atol=1e-9)
    np.testing.assert_array_equal(tight.node_of_section, [*[0] * 8, 1, -1])
    assert (loop.loops, len(loop.nodes)) == (1, 9)


@pytest.mark.parametrize("seed", range(4))
def test_a_stem_goes_on_beside_a_leaf(seed: int) -> None:
    """The cones of a leaf, as thick as it is wide, hold the tip of the stem; it is six of its own radii long."""
    made = extract_skeleton(contract(make_shape(named_shape("seedling"), ShapeParams(seed=seed))[0]))
    assert (made.components, made.loops, made.ends) == (1, 0, 5)
