"""Wires that pass each other, and such as meet: lattices, stents, slivers, contacts."""

import numpy as np
import pytest

from reference.wires import wire
from tiskel import CurveGraph, RobustParams, ShapeParams, Skeleton, contract, extract_skeleton, make_shape
from tiskel.arrays import Points
from tiskel.gallery.families import BODIES
from tiskel.methods.robust.contacts import touching_ends
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.wire.crossings import Crossing, crossings_of, parted
from tiskel.methods.robust.wire.links import links_of

THIN = 0.3  # radius of a wire, in the mean distance of its points along it


def wires(lines: list[tuple[list[float], list[float]]], spacing: float, seed: int) -> Points:
    """Return points at random places on thin wires, in the mean so far apart along them."""
    rng, found = np.random.default_rng(seed), []
    for start, stop in np.array(lines):
        length = float(np.linalg.norm(stop - start))
        count = round(length / spacing)
        along = (stop - start) / length
        off = rng.normal(size=(count, 3))
        off -= (off @ along)[:, None] * along
        off *= THIN * spacing / np.linalg.norm(off, axis=1)[:, None]
        found.append(start + rng.random(count)[:, None] * (stop - start) + off)
    return np.concatenate(found)


def skeleton_of(points: Points, **settings: object) -> Skeleton:
    return extract_skeleton(contract(points, RobustParams(**settings)))  # type: ignore[arg-type]


def crossed(gap: float, angle: float, seed: int) -> Points:
    """Return two wires that pass each other so many spacings apart."""
    spacing, turn = 4 / 1200, np.radians(angle)
    x, y, z = float(np.cos(turn)), float(np.sin(turn)), gap * spacing
    return wires([([-1, 0, 0], [1, 0, 0]), ([-x, -y, z], [x, y, z])], spacing, seed)


@pytest.mark.parametrize("gap", [2, 3, 5])
@pytest.mark.parametrize("angle", [90, 60])
def test_wires_that_pass_two_spacings_apart_are_two(gap: float, angle: float) -> None:
    for seed in range(3):
        s = skeleton_of(crossed(gap, angle, seed))
        assert (s.components, s.loops, s.ends) == (2, 0, 4)


@pytest.mark.parametrize("hidden", [2.5, 4.0])
def test_a_wire_that_is_not_seen_where_another_passes_it_is_one(hidden: float) -> None:
    """Half a gap, in spacings; links lead over it by way of the other wire alone, and go with the crossing."""
    for seed in range(3):
        points = crossed(2, 90, seed)
        gone = (np.abs(points[:, 0]) < hidden * 4 / 1200) & (np.abs(points[:, 1]) < 2 / 1200)
        s = skeleton_of(points[~gone])
        assert (s.components, s.loops, s.ends) == (2, 0, 4)


def test_wires_that_meet_are_one() -> None:
    for seed in range(3):
        s = skeleton_of(crossed(0, 90, seed))
        assert (s.components, s.loops, s.ends) == (1, 0, 4)


def woven(gap: float, seed: int) -> Points:
    """Return three wires across three others that pass them so many spacings apart."""
    spacing = 12 / 4000
    lines: list[tuple[list[float], list[float]]] = [([-1, y, 0], [1, y, 0]) for y in (-0.5, 0, 0.5)]
    lines += [([x, -1, gap * spacing], [x, 1, gap * spacing]) for x in (-0.5, 0, 0.5)]
    return wires(lines, spacing, seed)


def test_a_lattice_has_its_loops_and_one_that_is_woven_has_none() -> None:
    joined = skeleton_of(woven(0, 0))
    assert (joined.components, joined.loops, joined.ends) == (1, 4, 12)
    for seed in (1, 2):
        loose = skeleton_of(woven(2, seed))
        assert (loose.components, loose.loops, loose.ends) == (6, 0, 12)


@pytest.mark.parametrize("count", [4096, 8192, 16384])
@pytest.mark.parametrize(("name", "loops", "ends"), [("lattice", 4, 12), ("stent", 13, 0)])
def test_lattices_and_stents_have_their_loops_however_many_points_they_have(
    name: str, loops: int, ends: int, count: int
) -> None:
    s = skeleton_of(make_shape(BODIES[name](), ShapeParams(count=count, noise=0.1))[0])
    assert (s.components, s.loops, s.ends) == (1, loops, ends)


def test_turns_of_two_coils_that_run_together_are_told_and_rings_of_a_stent_are_not() -> None:
    """Of one coil the turns are known to be apart, see test_turns.py."""
    coil, stent = (make_shape(BODIES[name](), ShapeParams(count=16384))[0] for name in ("coil", "stent"))
    height = coil[:, 2] - coil[:, 2].mean()
    s = skeleton_of(coil[np.abs(height) > 0.1 * np.ptp(height)])
    assert s.loops > 10  # the turns are two spacings of 4096 points apart
    (said,) = [warning for warning in s.warnings if warning.code == "contacts"]
    assert f"{s.loops} loops of wire" in said.text
    assert not skeleton_of(stent).warnings


# its steps


def cross(gap: float, noise: float = 0.0) -> ConeCurve:
    """Return two wires of a step of 1 that pass each other as far apart as told, linked where they do."""
    one = wire([-20, 0, 0], [20, 0, 0], 1.0)
    nodes = np.concatenate([one, one[:, [1, 0, 2]] + [0, 0, gap]])
    nodes += np.random.default_rng(0).normal(0, noise, nodes.shape)
    count = len(one)
    chain = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1)
    edges = np.concatenate([chain, chain + count, [[count // 2, count + count // 2]]]).astype(np.int32)
    plain = np.zeros(len(nodes), np.int32)
    return ConeCurve(
        nodes=nodes, edges=edges, radii=np.full(len(nodes), 0.3), levels=plain,
        node_of_section=np.append(np.arange(len(nodes)), -1).astype(np.int32), section_sizes=np.ones(len(nodes)),
    )  # fmt: skip


def test_a_crossing_is_where_both_wires_go_straight_on_apart() -> None:
    (found,) = crossings_of(cross(2.0), 1.0)
    assert {round(float(strand[:, 2].mean()), 6) for strand in (found.one, found.other)} == {0.0, 2.0}
    assert crossings_of(cross(2.0, noise=0.1), 1.0)
    assert not crossings_of(cross(0.9), 1.0)  # nearer than points are: a joint
    bent = cross(2.0)
    bent.nodes[:20] = bent.nodes[20] + np.arange(20, 0, -1)[:, None] * [-np.cos(0.7), 0, np.sin(0.7)]
    assert not crossings_of(bent, 1.0)  # one arm leaves at 40 degrees: nobody knows where it goes


def test_links_from_one_strand_to_the_other_go_and_no_others() -> None:
    points = np.concatenate([wire([-20, 0, 0], [20, 0, 0], 1.0), wire([0, -20, 1.5], [0, 20, 1.5], 1.0)])
    links = links_of(points, 10)
    count = len(points) // 2
    left = parted(links, points, [Crossing(points[:count], points[count:])])
    across = (links.first < count) != (links.second < count)
    assert across.any()
    kept = set(zip(left.first.tolist(), left.second.tolist(), strict=True))
    all_of_them = zip(links.first.tolist(), links.second.tolist(), strict=True)
    assert kept == {pair for pair, gone in zip(all_of_them, across, strict=True) if not gone}


def test_an_end_touches_what_is_near_in_space_and_far_along_the_curve() -> None:
    turn = np.linspace(0, 1.95 * np.pi, 80)  # a ring that is open for a 40th of its turn
    ring = 10 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    edges = np.stack([np.arange(79), np.arange(1, 80)], axis=1).astype(np.int32)
    graph = CurveGraph(ring, edges, np.full(80, 0.1))
    assert touching_ends(graph, 1.0).tolist() == [0, 79]
    assert touching_ends(graph, 0.4).tolist() == []  # the gap is 1.57 wide
    assert touching_ends(CurveGraph(ring[:40], edges[:39], np.full(40, 0.1)), 1.0).tolist() == []
