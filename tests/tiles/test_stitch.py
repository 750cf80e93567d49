"""Two curves across a plane where they disagree: each case drawn by hand, in the plane z = 0."""

from dataclasses import replace

import numpy as np
import pytest

from tiskel import CurveGraph
from tiskel.geometry.graph import tidy_edges
from tiskel.tiles.join import joined
from tiskel.tiles.stitch import stitched
from tiskel.tiles.tiling import Tiling
from tiskel.tiles.web import Web, divided, web_of

HALF, STEP = 6.0, 0.5
Way = list[tuple[float, float]]


def drawn(*ways: Way, tile: int = 0, radius: float = 1.0, torn: Way | None = None) -> Web:
    """Return ways through places (x, y) as a web of short edges: equal places are one node, some of them are torn."""
    places = np.array([place for way in ways for place in way])
    nodes, number = np.unique(places, axis=0, return_inverse=True)
    starts = np.cumsum([0, *map(len, ways)])
    rows = [number.ravel()[a:b] for a, b in zip(starts[:-1], starts[1:], strict=True)]
    edges = np.concatenate([np.stack([row[:-1], row[1:]], axis=1) for row in rows]).astype(np.int32)
    curve = CurveGraph(np.pad(nodes, ((0, 0), (0, 1))), tidy_edges(edges), np.full(len(nodes), radius))
    web = replace(web_of(curve, tile), reach=np.full(len(nodes), radius))
    web = replace(web, torn=(nodes[:, None] == np.array(torn or [(99.0, 99.0)])).all(axis=2).any(axis=1))
    return divided(web, STEP, np.ones(len(edges), bool))


def sewn(low: Web, high: Web) -> Web:
    return stitched(low, high, 0, 0.0, HALF, STEP)


def counts(web: Web) -> tuple[int, int, int]:
    curve = web.graph()
    return curve.components, curve.loops, curve.ends


def test_a_limb_goes_on_in_the_curve_that_crosses_its_way() -> None:
    """The high side knows a bar along the plane, the low side a stem that is cut: a joint becomes of them."""
    stem = drawn([(-20, 0), (10, 0)], torn=[(10, 0)])
    bar = drawn([(1, -20), (1, 20)], tile=1)
    web = sewn(stem, bar)
    assert counts(web) == (1, 0, 3)
    assert not web.torn.any()
    joint = int(np.flatnonzero(web.graph().degrees == 3)[0])
    np.testing.assert_allclose(web.nodes[joint], [1, 0, 0], atol=STEP)
    assert web.graph().length == pytest.approx(20 + 1 + 40, abs=STEP)
    assert not web.bridged.any()


@pytest.mark.parametrize("beside", [30.0, 0.0])
def test_a_limb_that_the_other_side_has_nothing_beside_stays_torn(beside: float) -> None:
    """With nothing about the plane at all, and with a curve too far off."""
    stem = drawn([(-20, 0), (10, 0)], torn=[(10, 0)])
    web = sewn(stem, drawn([(20 if beside else 3, 9), (40, 9)], tile=1))
    assert counts(web) == (2, 0, 4)
    assert web.torn.sum() == 1
    assert web.nodes[web.torn][0, 1] == 0
    assert web.nodes[web.tile == 0, 0].max() == pytest.approx(web.nodes[web.torn][0, 0])


def test_a_limb_that_ends_beyond_the_slab_is_kept_whole() -> None:
    """It ends farther from the plane than it may be cut, by itself: the other side does not know it at all."""
    twig = drawn([(-20, 0), (9, 0)])
    web = sewn(twig, drawn([(20, 9), (40, 9)], tile=1))
    assert counts(web) == (2, 0, 4)
    assert not web.torn.any()
    assert web.nodes[web.tile == 0, 0].max() == 9


LINE = [(0.0, 0.0), (20.0, 0.0)]


def test_a_second_cut_end_beside_a_limb_that_goes_on_is_taken_off() -> None:
    """The low side sees a limb twice, side by side; the high side once."""
    low = drawn([(-20, 0), (-2, 0), (10, 0)], [(-2, 0), (-1, 1.2), (10, 1.2)], torn=[(10, 0), (10, 1.2)])
    web = sewn(low, drawn([(-10, 0), (20, 0)], tile=1, torn=[(-10, 0)]))
    assert counts(web) == (1, 0, 2)
    assert not web.torn.any()
    assert np.abs(web.nodes[:, 1]).max() < 0.7
    assert web.nodes[:, 0].max() == 20


def test_a_long_second_end_stays_though_another_way_is_near() -> None:
    """It is longer than a stub: three reaches."""
    low = drawn([(-20, 0), (-2.4, 0), (10, 0)], [(-2.4, 0), (-2.4, 1.3), (10, 1.3)], torn=[(10, 0), (10, 1.3)])
    web = sewn(low, drawn([(-1, 0), (20, 0)], tile=1))
    assert counts(web) == (1, 0, 3)
    assert web.nodes[web.torn].tolist() == [[pytest.approx(-0.4, abs=STEP), pytest.approx(1.3), 0]]


def test_a_limb_cut_at_its_very_joint_leaves_nothing_torn() -> None:
    """The way goes on round a corner there, and across the plane in both."""
    corner: Way = [(-20, 0), (-0.2, 0), (-0.2, 1.3), (10, 1.3)]
    low = drawn(corner, [(-0.2, 0), (10, 0)], torn=[(10, 0), (10, 1.3)])
    web = sewn(low, drawn([(-0.2, 1.3), (20, 1.3)], tile=1))
    assert counts(web) == (1, 0, 2)
    assert not web.torn.any()
    assert web.graph().length == pytest.approx(19.8 + 1.3 + 20.2)


def test_a_limb_that_turns_round_at_the_plane_is_no_stub() -> None:
    """Its second end leads to no joint, but back into the other side and to an end there."""
    low = drawn([(10, 0), (-8, 0), (-8, 1.2), (10, 1.2)], radius=8.0, torn=[(10, 0), (10, 1.2)])
    web = sewn(low, drawn([(-7, 0), (4, 0)], tile=1, radius=8.0, torn=[(-7, 0)]))
    assert counts(web) == (1, 0, 2)
    assert web.nodes[web.torn].tolist() == [[pytest.approx(-0.4, abs=STEP), pytest.approx(1.2), 0]]


def test_a_joint_that_both_sides_have_makes_no_loop() -> None:
    """A limb that each side sees divided about the plane is one limb, of thick bodies."""
    low = drawn(
        [(-20, 0), (-1.5, 0), (0, 1.2), (10, 1.2)], [(-1.5, 0), (0, -1.2), (10, -1.2)], radius=3.0,
        torn=[(10, 1.2), (10, -1.2)],
    )  # fmt: skip
    high = replace(low, nodes=low.nodes * [-1, 1, 1], tile=low.tile + 1)
    web = sewn(low, high)
    assert counts(web) == (1, 0, 2)
    assert not web.torn.any()
    assert (web.nodes[:, 0].min(), web.nodes[:, 0].max()) == (-20, 20)
    thin = sewn(replace(low, reach=low.reach / 3), replace(high, reach=low.reach / 3))
    assert counts(thin) == (1, 1, 2)


def test_what_is_cut_off_and_shorter_than_the_body_goes() -> None:
    """A torn end nearer to a joint than its radius, and a torn piece that is no longer than its body is wide."""
    ways: list[Way] = [[(-10, 0), (0, 0), (10, 0)], [(0, 0), (0, 1.5)], [(0, 0), (0, -2.5)], [(5, 9), (8, 9)]]
    web = drawn(*ways, radius=2.0, torn=[(0, 1.5), (5, 9), (0, -2.5)])
    made = joined({0: web}, Tiling(1.0, 8.0, 0))
    assert counts(made) == (1, 0, 3)
    assert made.nodes[made.torn].tolist() == [[0, -2.5, 0]]
    assert made.nodes[:, 1].max() == 0
    whole = joined({0: replace(web, torn=web.torn & False)}, Tiling(1.0, 8.0, 0))
    assert counts(whole) == (2, 0, 6)
