"""The wire regime from cloud to skeleton: loops, strays, bridges, roots, and generated trees."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from reference.path_tree import path_tree
from reference.wires import STEP, circle, jittered, wire
from tiskel import RadiusSource, RobustParams, ShapeParams, Skeleton, contract, extract_skeleton, make_shape
from tiskel.arrays import Points
from tiskel.gallery.trees import thickened, tree
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.regime import Regime
from tiskel.geometry.round_cones import ConeGraph
from tiskel.metrics.tree_truth import tree_agreement


def skeleton_of(points: Points, **settings: Any) -> Skeleton:
    return extract_skeleton(contract(points, RobustParams(**settings)))


# wires from cloud to skeleton


@pytest.mark.parametrize(("topology", "loops"), [("auto", 1), ("tree", 0), ("loops", 1)])
def test_a_ring_of_wire_is_a_loop_unless_it_is_said_to_be_none(topology: str, loops: int) -> None:
    s = skeleton_of(circle(120), topology=topology)
    assert (s.components, s.loops, s.ends) == (1, loops, 2 - 2 * loops)
    assert s.length == pytest.approx(2 * np.pi, rel=0.04)


def test_a_lattice_of_wires_that_is_said_to_close_has_its_loops_and_its_ends() -> None:
    """Three wires across three others: four loops, and more ends than these."""
    lines = [wire([x, -0.6, 0], [x, 2.6, 0]) for x in range(3)]
    lines += [wire([-0.6, y, 0], [2.6, y, 0]) for y in range(3)]
    s = skeleton_of(jittered(np.concatenate(lines)), topology="loops")
    assert (s.components, s.loops, s.ends) == (1, 4, 12)


def test_a_tree_of_wires_whose_twigs_touch_has_no_loop_unless_it_is_said_to() -> None:
    """Two of five twigs meet head on; of its own accord a body with more ends than loops is a tree."""
    stems = [wire([0, 0, 0], [0, 0, 1])]
    twigs = [[1.0, 0, 2], [0, 1.0, 2], [-1.0, 0, 2]]
    arch = 0.5 * np.pi * np.linspace(0, 2, 64)
    touching = np.stack([0 * arch, -0.5 + 0.5 * np.cos(arch), 1 + 0.5 * np.sin(arch)], axis=1)
    back = wire([0, -1, 1], [0, 0, 0.3])
    points = jittered(np.concatenate([*stems, *(wire([0, 0, 1], end) for end in twigs), touching, back[:-2]]), 0.05)
    free, closed = skeleton_of(points), skeleton_of(points, topology="loops")
    assert (free.components, free.loops) == (1, 0)
    assert (closed.components, closed.loops) == (1, 1)
    assert (free.regimes == Regime.WIRE).all()


def test_a_stray_point_changes_no_wire() -> None:
    points = jittered(np.concatenate([wire([0, 0, 0], end) for end in ([0, 0, -2], [1, 0, 2], [-1, 0.3, 2])]))
    s, strayed = skeleton_of(points), skeleton_of(np.concatenate([points, [[30.0, 0, 0]]]))
    assert (s.components, s.ends) == (1, 3)
    assert (strayed.components, strayed.loops, strayed.ends) == (1, 0, 3)
    assert cKDTree(s.nodes).query(strayed.nodes)[0].max() < 1e-6


def test_a_cut_in_a_wire_is_bridged_and_said() -> None:
    line = wire([0, 0, 0], [0, 0, 4])
    s = skeleton_of(jittered(line[np.abs(line[:, 2] - 2) > 0.17]))
    assert (s.components, s.ends) == (1, 2)
    ((one, other),) = s.nodes[s.edges[s.bridged], 2]
    assert 1.65 < min(one, other) < 1.9
    assert 2.1 < max(one, other) < 2.35
    assert "bridged" in {note.code for note in s.notes}


def test_bounds_of_wires_are_not_below_the_truth_and_never_zero() -> None:
    """Points a step apart on wires of a third of a step in radius, at random angles about it."""
    rng = np.random.default_rng(2)
    ends: list[list[float]] = [[0, 0, 2], [1, 0, 3], [-0.5, 1, 3], [-0.5, -1, 3]]
    lines = [wire([0, 0, 0], ends[0]), *(wire(ends[0], end)[1:] for end in ends[1:])]
    points = np.concatenate(lines)
    off = rng.normal(size=points.shape)
    s = skeleton_of(points + STEP / 3 * off / np.linalg.norm(off, axis=1)[:, None])
    assert (s.regimes == Regime.WIRE).all()
    assert (s.radius_sources == RadiusSource.BOUNDED).mean() > 0.9
    assert s.radius.min() >= STEP / 3
    assert np.median(s.radius) < 1.5 * STEP


def test_limbs_grow_from_a_given_root_in_the_unit_of_the_input() -> None:
    """The bins of the way to the root start there, so that another root moves the nodes."""
    tip, shift = np.array([1.0, 0, 3]), np.array([-1000.0, 0, -700])  # away from the tip
    points = jittered(np.concatenate([wire(end, [0, 0, 1.5]) for end in ([0, 0, 0], tip.tolist(), [-1, 0.3, 3])]), 0.1)
    plain, rooted = skeleton_of(points), skeleton_of(points, root=tuple(tip))
    assert np.linalg.norm(rooted.nodes - tip, axis=1).min() < 2 * STEP
    assert cKDTree(plain.nodes).query(rooted.nodes)[0].max() > 0.1 * STEP
    moved = skeleton_of(40 * points + shift, root=tuple(40 * tip + shift))
    assert len(rooted.nodes) == len(moved.nodes)
    assert cKDTree((moved.nodes - shift) / 40).query(rooted.nodes)[0].max() < 1e-6


# generated trees

HABITS = (("spreading", 0.3, 3), ("spreading", 0.5, 3), ("leader", 0.5, 3), ("neuron", 0.2, 7), ("shrub", 0.2, 7))


def generated(habit: str, thickness: float, seed: int, count: int = 1200) -> tuple[Points, ConeGraph]:
    """Return a noisy cloud and its tree; without noise points are regular, and rounding tells which one is nearer."""
    shape = thickened(tree(habit, tips=25, seed=seed), count, thickness)
    return make_shape(shape, ShapeParams(count=count, seed=seed, noise=0.1))[0], shape


@pytest.mark.parametrize(("habit", "thickness", "seed"), HABITS)
def test_generated_trees_are_found_as_well_as_by_the_plain_baseline(habit: str, thickness: float, seed: int) -> None:
    cloud, shape = generated(habit, thickness, seed)
    s = skeleton_of(cloud)
    assert (s.components, s.loops) == (1, 0)
    assert Regime.WIRE in s.regimes
    found, plain = (tree_agreement(curve, shape, cloud) for curve in (s, path_tree(cloud)))
    assert found.f is not None
    assert plain.f is not None
    assert found.f >= max(0.95, plain.f - 0.01)
    assert found.tips.recall is not None
    assert found.tips.precision is not None
    assert min(found.tips.recall, found.tips.precision) >= 0.75


def samples(s: Skeleton) -> Points:
    return np.concatenate([s.nodes, curve_samples(s, 1000).points])


def test_the_curve_of_wires_does_not_hang_on_rotation_shift_scale_or_rows() -> None:
    cloud = generated(*HABITS[0])[0]
    s = skeleton_of(cloud)
    spacing = float(np.median(cKDTree(cloud).query(cloud, k=2)[0][:, 1]))
    rng = np.random.default_rng(1)
    for scale, shift in ((1.0, 0.0), (1e4, 1e6), (1e-4, -0.01)):
        turn, rows = Rotation.random(random_state=int(rng.integers(99))).as_matrix(), rng.permutation(len(cloud))
        t = skeleton_of((cloud @ turn.T * scale + shift)[rows])
        assert (t.components, t.loops, t.ends, t.junctions) == (s.components, s.loops, s.ends, s.junctions)
        one, other = samples(s), (samples(t) - shift) / scale @ turn
        apart = max(cKDTree(one).query(other)[0].max(), cKDTree(other).query(one)[0].max())
        assert apart < 1e-3 * spacing


def test_wires_give_the_same_bytes_on_one_thread_and_on_two(tmp_path: Path) -> None:
    np.save(tmp_path / "tree.npy", generated(*HABITS[0])[0])
    script = (
        "import sys, numpy as np, tiskel\n"
        "s = tiskel.extract_skeleton(tiskel.contract(np.load('tree.npy')))\n"
        "arrays = s.nodes, s.edges, s.radii, s.regimes, s.radius_sources, s.node_of_point, s.contracted\n"
        "sys.stdout.buffer.write(b''.join(np.ascontiguousarray(a).tobytes() for a in arrays))\n"
    )
    made = [
        subprocess.run(
            [sys.executable, "-c", script], cwd=tmp_path, env={**os.environ, "TISKEL_NUM_THREADS": threads},
            capture_output=True, check=True,
        ).stdout
        for threads in ("1", "2")
    ]  # fmt: skip
    assert len(made[0]) > 10000
    assert made[0] == made[1]
