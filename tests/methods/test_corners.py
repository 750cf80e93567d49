"""Branches into the corners of a body are no limbs; short limbs on thick trunks are."""

import numpy as np
import pytest

from tiskel import ShapeParams, contract, extract_skeleton, make_shape
from tiskel.gallery.families import BODIES
from tiskel.geometry.body import Body, body_of
from tiskel.geometry.graph import edge_lengths
from tiskel.methods.robust.body.limbs import TAPERS
from tiskel.methods.robust.body.strands import plain_curve
from tiskel.methods.robust.corners import _with_clearances, without_false_limbs
from tiskel.methods.robust.curve import ConeCurve


def with_branch(*branch: tuple[float, float]) -> ConeCurve:
    """Return a trunk of radius 1 with a branch from its middle: so far out along y, and so thick."""
    trunk = [(-8.0, 0, 0), (0, 0, 0), (8.0, 0, 0)]
    nodes = np.array([*trunk, *((0, out, 0) for out, _ in branch)], float)
    last = len(nodes)
    edges = np.array([(0, 1), (1, 2), (1, 3), *((i, i + 1) for i in range(3, last - 1))], np.int32)
    return plain_curve(nodes, edges, np.array([1, 1, 1, *(radius for _, radius in branch)], float))


def kept(curve: ConeCurve, body: Body) -> bool:
    fewer = without_false_limbs(curve, body)
    return bool((curve if fewer is None else fewer).degrees.max() == 3)


def block(length: float, width: float, depth: float, step: float = 0.1) -> Body:
    """Return the inside of a block about the origin."""
    half = np.array([length, width, depth]) / 2
    axes = [np.arange(-h - 3 * step, h + 4 * step, step) for h in half]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    winding = (np.abs(places) < half).all(axis=-1).astype(float)
    faces = places[(np.abs(np.abs(places) - half) < step).any(axis=-1) & (np.abs(places) < half).all(axis=-1)]
    body = body_of(winding, places[0, 0, 0], step, np.ascontiguousarray(faces), 0.5)
    assert body is not None
    return body


@pytest.mark.parametrize("sine", [np.sqrt(1 / 3), np.sqrt(1 / 2)])  # the corner of a block, and a right angle
@pytest.mark.parametrize("share", [0.6, 0.9])  # how far from the joint to the corner the branch goes
def test_the_middle_of_a_corner_is_no_limb(sine: float, share: float) -> None:
    far = share / sine
    body = block(20, 2 * far + 0.8, 2)
    assert not kept(with_branch((far, 1 - share)), body)
    assert not kept(with_branch((far / 2, 1 - share / 2), (far, 1 - share)), body)
    assert kept(with_branch((far, 1 - (TAPERS - 0.01) * far)), body)
    assert not kept(with_branch((far, 1 - (TAPERS + 0.01) * far)), body)


def test_a_limb_that_a_gap_parts_from_the_trunk_stays() -> None:
    body = block(20, 1.6, 1.6)
    assert kept(with_branch((1.2, 0.3)), body)  # outside the body, or too thin for its grid
    assert kept(with_branch((1.0, 0.2), (1.8, 0.2)), body)


def test_a_short_branch_within_a_plate_is_no_limb() -> None:
    """Cones of a plate are as wide as it, whatever the way: no taper tells that the branch only runs about in it."""
    plate = block(20, 8, 1)
    assert not kept(with_branch((1.5, 1.2), (2.5, 1.2)), plate)
    assert kept(with_branch((1.5, 1.2), (3.5, 1.2)), plate)  # long
    assert kept(with_branch((0.1, 0.6), (2.5, 0.6)), plate)  # no wider than the body


def test_a_joint_does_not_lose_all_its_branches() -> None:
    star = with_branch((1.2, 0.2))
    nodes = star.nodes.copy()
    nodes[0, 0], nodes[2, 0] = -1.2, 1.2
    assert kept(plain_curve(nodes, star.edges, np.array([0.2, 1, 0.2, 0.2])), block(4, 4, 2))


def test_clearances_are_asked_for_all_along_a_curve() -> None:
    curve, body = with_branch((1.5, 0.8), (2.5, 0.8)), block(20, 8, 1)
    fine = _with_clearances(curve, body)
    assert edge_lengths(fine.nodes, fine.edges).max() <= body.step + 1e-12
    np.testing.assert_allclose(edge_lengths(fine.nodes, fine.edges).sum(), 18.5)
    np.testing.assert_array_equal(fine.nodes[: len(curve.nodes)], curve.nodes)
    np.testing.assert_array_equal(np.sort(fine.degrees)[[0, 1, 2, 3, -1]], [1, 1, 1, 2, 3])
    np.testing.assert_array_equal(fine.radii, body.clearance_at(fine.nodes))


@pytest.mark.parametrize("name", ["l-bracket", "twisted-bar"])
def test_thinned_bars_have_two_ends(name: str) -> None:
    """Means of cells lie densely along edges; cones that led into the corners there have made a third end."""
    shape = BODIES[name]()
    for seed in (1, 2):
        s = extract_skeleton(contract(make_shape(shape, ShapeParams(count=65_536, seed=seed))[0]))
        assert (s.components, s.loops, s.ends) == (1, 0, 2)


def test_branches_within_thinned_plates_go() -> None:
    s = extract_skeleton(contract(make_shape(BODIES["strip"](), ShapeParams(count=65_536, seed=1))[0]))
    assert (s.components, s.loops, s.ends) == (1, 4, 0)


@pytest.mark.parametrize(("count", "seed", "noise"), [(4096, 2, 0.0), (4096, 4, 0.1), (16_384, 4, 0.0)])
def test_the_frame_of_a_plate_has_no_ends_in_its_corners(count: int, seed: int, noise: float) -> None:
    s = extract_skeleton(
        contract(make_shape(BODIES["washer-plate"](), ShapeParams(count=count, seed=seed, noise=noise))[0])
    )
    assert (s.components, s.loops, s.ends) == (1, 1, 0)
