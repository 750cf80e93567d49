"""Ends of wires: which are noise or strands of one limb, and where those of noisy limbs lie."""

import numpy as np
import pytest

from tiskel.geometry.regime import Regime
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.wire.spurs import without_spurs
from tiskel.methods.robust.wire.tips import on_their_lines, zigzag


def test_short_spurs_go_and_long_ones_stay() -> None:
    """Of a radius of 1 at the joint, two are asked for."""
    nodes = np.array([*([x, 0, 0] for x in range(-10, 11)), [0, 1.5, 0], [0, -2.5, 0]], float)
    edges = np.array([*([i, i + 1] for i in range(20)), [10, 21], [10, 22]], np.int32)
    many = np.ones(len(nodes))
    curve = ConeCurve(
        nodes=nodes, edges=edges, radii=many, levels=np.zeros(23, np.int32),
        node_of_section=np.append(np.arange(23), -1).astype(np.int32), section_sizes=many,
    )  # fmt: skip
    left = without_spurs(curve, 1.0, 0.0)
    assert left.ends == 3
    assert not (left.nodes == [0, 1.5, 0]).all(axis=1).any()
    assert (left.nodes == [0, -2.5, 0]).all(axis=1).any()
    assert left.node_of_section[21] == left.node_of_section[10]


def lone_spur(length: float, counts: float, radius: float = 0.1) -> ConeCurve:
    """Return a straight limb of nodes a spacing apart, ten points each, with an end branch of one node."""
    nodes = np.array([*([x, 0, 0] for x in range(-10, 11)), [0, length, 0]], float)
    edges = np.array([*([i, i + 1] for i in range(20)), [10, 21]], np.int32)
    return ConeCurve(
        nodes=nodes, edges=edges, radii=np.full(22, radius), levels=np.zeros(22, np.int32),
        node_of_section=np.append(np.arange(22), -1).astype(np.int32),
        section_sizes=np.append(np.full(21, 10.0), counts),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("length", "points", "crowd", "ends"),
    [(4, 10, 10, 2), (4, 30, 10, 3), (5, 10, 10, 3), (4, 1, 0, 3)],
    ids=["few points", "as many as elsewhere", "long", "threads"],
)
def test_a_short_end_of_few_points_is_noise_where_limbs_have_many(
    length: float, points: float, crowd: float, ends: int
) -> None:
    """Four spacings have 40 points elsewhere, and two standard deviations less are 27."""
    assert without_spurs(lone_spur(length, points), 1.0, crowd).ends == ends


def test_an_end_that_stays_within_the_reach_of_other_limbs_goes() -> None:
    """It runs three spacings along the limb, at 1.9 and at 2.1 of its radii."""
    for away, ends in ((1.9, 2), (2.1, 3)):
        nodes = np.array([*([x, 0, 0] for x in range(-10, 11)), *([x, away, 0] for x in range(1, 4))], float)
        edges = np.array([*([i, i + 1] for i in range(20)), [10, 21], [21, 22], [22, 23]], np.int32)
        curve = ConeCurve(
            nodes=nodes, edges=edges, radii=np.ones(24), levels=np.zeros(24, np.int32),
            node_of_section=np.append(np.arange(24), -1).astype(np.int32), section_sizes=np.ones(24),
        )  # fmt: skip
        assert without_spurs(curve, 1.0, 0.0).ends == ends


@pytest.mark.parametrize(
    ("away", "slope", "ends"),
    [(2.5, 0.0, 2), (3.5, 0.0, 3), (0.3, 0.5, 3)],
    ids=["strand beside the limb", "too far for one", "twig that parts"],
)
def test_strands_of_a_limb_go_and_twigs_that_part_stay(away: float, slope: float, ends: int) -> None:
    """Twelve spacings long, of radii that are no more than a tenth."""
    along = np.arange(1, 13)
    branch = np.stack([along, away + slope * along, 0 * along], axis=1)
    nodes = np.concatenate([[[x, 0, 0] for x in range(-20, 21)], branch])
    edges = np.array([*([i, i + 1] for i in range(40)), [20, 41], *([i, i + 1] for i in range(41, 52))], np.int32)
    count = len(nodes)
    curve = ConeCurve(
        nodes=nodes, edges=edges, radii=np.full(count, 0.1), levels=np.zeros(count, np.int32),
        node_of_section=np.append(np.arange(count), -1).astype(np.int32), section_sizes=np.ones(count),
    )  # fmt: skip
    assert without_spurs(curve, 1.0, 2.0, 3.0).ends == ends
    assert without_spurs(curve, 1.0, 1.9, 3.0).ends == 3  # threads side by side


def zigzagging(noise: float, regime: Regime) -> ConeCurve:
    """Return a limb of 21 nodes along x, each second one beside it, and the ends twice as far."""
    side = noise * (-1.0) ** np.arange(21)
    side[[0, -1]] *= 2
    nodes = np.stack([np.arange(21.0), side, 0 * side], axis=1)
    return ConeCurve(
        nodes=nodes, edges=np.stack([np.arange(20), np.arange(1, 21)], axis=1).astype(np.int32), radii=np.ones(21),
        levels=np.zeros(21, np.int32), node_of_section=np.append(np.arange(21), -1).astype(np.int32),
        section_sizes=np.ones(21), regimes=np.full(21, regime, np.uint8),
    )  # fmt: skip


def test_ends_of_noisy_wires_are_put_on_the_lines_of_their_limbs() -> None:
    curve = zigzagging(0.5, Regime.WIRE)
    assert zigzag(curve, np.ones(21, bool)) == pytest.approx(0.5)  # a whole step aside, of two along
    found = on_their_lines(curve)
    np.testing.assert_array_equal(found.nodes[1:-1], curve.nodes[1:-1])
    np.testing.assert_allclose(found.nodes[[0, -1], 1], 0, atol=0.45)  # they were 1 aside
    np.testing.assert_allclose(found.nodes[[0, -1], 0], [0, 20], atol=0.1)


@pytest.mark.parametrize(("noise", "regime"), [(0.1, Regime.WIRE), (0.5, Regime.TUBE)], ids=["clear", "tube"])
def test_ends_of_clear_wires_and_of_tubes_stay(noise: float, regime: Regime) -> None:
    curve = zigzagging(noise, regime)
    np.testing.assert_array_equal(on_their_lines(curve).nodes, curve.nodes)


def test_a_curve_without_passages_does_not_zigzag() -> None:
    assert zigzag(lone_spur(1.0, 1.0), np.zeros(22, bool)) == 0
