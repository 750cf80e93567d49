"""Curve in the air, where it is known: axes of tubes, spokes, leaves, arcs."""

import numpy as np
import pytest

from tiskel import CurveGraph
from tiskel.arrays import Points
from tiskel.geometry.air import HALF_SLAB, in_the_air
from tiskel.geometry.curve import curve_samples

SPACING = 0.1  # of the lattices below


def line(*ends: tuple[float, float, float]) -> CurveGraph:
    """Return a polyline through places."""
    links = np.stack([np.arange(len(ends) - 1), np.arange(1, len(ends))], axis=1)
    return CurveGraph(np.array(ends, float), links.astype(np.int32))


def share(curve: CurveGraph, cloud: Points) -> float | None:
    return in_the_air(curve, curve_samples(curve, 100), cloud).share


def pipe(turn: float, length: float = 6.0) -> Points:
    """Return a pipe of radius 1 about the z-axis, of which so many degrees of its turn about +x were seen."""
    angles = np.deg2rad(np.arange(-turn / 2, turn / 2, np.rad2deg(SPACING)))
    u, v = np.meshgrid(angles, np.arange(0, length, SPACING))
    return np.stack([np.cos(u), np.sin(u), v], axis=-1).reshape(-1, 3)


def leaf() -> Points:
    """Return a flat leaf across x, 2 wide and 6 long."""
    y, z = np.meshgrid(np.arange(-1, 1, SPACING), np.arange(0, 6, SPACING))
    return np.stack([np.zeros_like(y), y, z], axis=-1).reshape(-1, 3)


AXIS = line((0, 0, 1), (0, 0, 3), (0, 0, 5))


@pytest.mark.parametrize(
    ("turn", "expected"),
    [(360, 0), (180, 0), (165, 0), (150, 1), (120, 1)],  # between points where 160 degrees are seen, 200 are not
)
def test_the_axis_of_a_pipe_is_between_its_points_while_160_degrees_are_seen(turn: int, expected: float) -> None:
    assert share(AXIS, pipe(turn)) == expected


def test_a_spoke_through_the_air_and_a_curve_beside_a_leaf_are_in_the_air() -> None:
    pipes = np.concatenate([pipe(360), pipe(360) + [6, 0, 0]])
    spoke = line((1.5, 0, 3), (4.5, 0, 3))  # all of it farther than three spacings from either pipe
    assert share(spoke, pipes) == 1
    assert share(line((0.5, 0, 1), (0.5, 0, 5)), leaf()) == 1


def test_a_curve_on_the_points_is_not_in_the_air_whatever_their_side() -> None:
    assert share(line((0.2, 0, 1), (0.2, 0, 5)), leaf()) == 0
    wire = np.stack([np.zeros(60), np.zeros(60), np.arange(60) * SPACING], axis=1)
    wire += np.random.default_rng(0).normal(0, 1e-3, wire.shape)
    assert share(line((0, 0, 0), (0, 0, 5.9)), wire) == 0


def test_the_share_is_of_length_however_the_edges_are_cut() -> None:
    """A quarter of this curve leaves the pipe, in one edge; the other three quarters are eighty."""
    inside = [(0.0, 0.0, z) for z in np.linspace(1, 4, 81).tolist()]
    cloud = pipe(360, length=5.0 + 1e-9)
    cloud = cloud[cloud[:, 2] < 4]
    found = share(line(*inside, (0, 0, 5)), cloud)
    rim = 3.9 + HALF_SLAB * np.sqrt(np.pi) / 2 * SPACING  # the last row, and the slab that still sees it
    assert found == pytest.approx((5 - rim) / 4, abs=0.011)  # one place in a hundred


def test_turning_shifting_and_scaling_change_nothing() -> None:
    cloud = np.concatenate([pipe(360), leaf() + [3, 0, 0]])
    curve = line((0, 0, 1), (0, 0, 5), (3.5, 0, 5), (3.5, 0, 1))
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    moved = CurveGraph(7 * curve.nodes @ turn.T + [100, 20, 3], curve.edges)
    before = share(curve, cloud)
    assert before is not None
    assert 0.2 < before < 0.8
    assert share(moved, 7 * cloud @ turn.T + [100, 20, 3]) == before


def test_a_stray_point_does_not_put_a_spoke_at_the_points() -> None:
    """Its own spacing is wide; that of nearly all points counts instead."""
    stray = np.concatenate([leaf(), [[30.0, 0, 3]]])
    assert share(line((20, 0, 3), (40, 0, 3.0)), stray) == pytest.approx(1, abs=0.1)


def test_a_curve_without_length_has_no_share() -> None:
    assert share(CurveGraph(np.zeros((2, 3)), np.array([[0, 1]], np.int32)), pipe(360)) is None
