"""The wire regime: each of its steps against a plain reference or a case known in closed form."""

import heapq

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from reference.wires import STEP, jittered, tube, wire
from tiskel import RadiusSource, RobustParams
from tiskel.arrays import Numbers, Points
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.wire.curve import curve_of
from tiskel.methods.robust.wire.levels import BIN, RESOLVED, Levels, levels_of, widest_gaps
from tiskel.methods.robust.wire.limbs import crowding, limbs_of
from tiskel.methods.robust.wire.links import BRIDGE, Links, links_of
from tiskel.methods.robust.wire.routes import POWER, Routes, routes_of


def levels_along(points: Points, root: Numbers) -> tuple[Links, Routes, Levels]:
    links = links_of(points, 10)
    routes = routes_of(points, links, root)
    return links, routes, levels_of(points, links, routes, BRIDGE, RESOLVED)


# links


def test_the_spacing_of_an_even_line_is_its_step() -> None:
    assert links_of(wire([0, 0, 0], [0, 0, 3]), 10).spacing == pytest.approx(STEP)


def test_points_in_pairs_do_not_shrink_the_spacing() -> None:
    """Half of all nearest neighbours are a hundredth of a step away; the median of those would be that."""
    line = wire([0, 0, 0], [0, 0, 3])
    assert links_of(np.concatenate([line, line[:-1] + [STEP / 100, 0, 0]]), 10).spacing == pytest.approx(STEP, rel=0.01)


def test_links_are_both_ways_and_as_long_as_they_say() -> None:
    points = np.random.default_rng(3).random((200, 3))
    links = links_of(points, 10)
    np.testing.assert_allclose(links.lengths, np.linalg.norm(points[links.first] - points[links.second], axis=1))
    one = set(zip(links.first.tolist(), links.second.tolist(), strict=True))
    assert one == {(b, a) for a, b in one}
    # Every point is linked with its nearest.
    assert set(enumerate(cKDTree(points).query(points, k=2)[1][:, 1].tolist())) <= one


def test_pieces_are_joined_across_a_narrow_gap_by_the_shortest_link() -> None:
    """The gap is 22 steps wide, more points than a point has links, and a ninth of the larger piece."""
    one, other = wire([0, 0, 0], [0, 0, 10]), wire([0, 0.02, 11.1], [0, 1.5, 11.5])
    links = links_of(np.concatenate([one, other]), 10)
    assert links.kept.all()
    across = (links.first < len(one)) & (links.second >= len(one))
    assert list(zip(links.first[across], links.second[across], strict=True)) == [(len(one) - 1, len(one))]


def test_a_small_piece_far_away_is_left_out_and_a_large_one_is_not() -> None:
    """It is twenty steps away, a quarter of what is there; a piece with fewer than so many points is small."""
    body, piece = wire([0, 0, 0], [0, 0, 3]), wire([1, 0, 0], [1, 0, 1.5])
    for least, kept in ((len(piece) + 1, False), (len(piece), True)):
        links = links_of(np.concatenate([body, piece]), least)
        assert links.kept[: len(body)].all()
        assert (links.kept[len(body) :] == kept).all()
        assert not ((links.first < len(body)) & (links.second >= len(body))).any()


def test_two_cut_off_twigs_that_are_nearest_to_each_other_are_joined_to_the_body() -> None:
    """The gap between them is wide for both; that to the body is wider, and narrow for it."""
    body, one, other = wire([0, 0, 0], [0, 0, 10]), wire([0, 1.2, 9], [0, 1.6, 9]), wire([0, 1.6, 8.0], [0, 1.2, 8.0])
    links = links_of(np.concatenate([body, one, other]), 5)
    assert links.kept.all()
    assert connected_components(links.graph, directed=False)[0] == 1


# routes


def plain_routes(points: Points, links: Links, root: int) -> Numbers:
    """Return the length in spacings of the cheapest way of every point to the root, by Dijkstra's rule."""
    around: dict[int, list[tuple[int, float]]] = {}
    for a, b, length in zip(links.first.tolist(), links.second.tolist(), links.lengths.tolist(), strict=True):
        around.setdefault(a, []).append((b, length / links.spacing))
    cost, length, todo = {root: 0.0}, {root: 0.0}, [(0.0, root)]
    done: set[int] = set()
    while todo:
        _, at = heapq.heappop(todo)
        if at in done:
            continue
        done.add(at)
        for other, step in around[at]:
            if cost[at] + step**POWER < cost.get(other, np.inf):
                cost[other], length[other] = cost[at] + step**POWER, length[at] + step
                heapq.heappush(todo, (cost[other], other))
    return np.array([length.get(row, np.nan) for row in range(len(points))])


def test_the_lengths_of_routes_are_those_of_dijkstra() -> None:
    rng = np.random.default_rng(5)
    body = rng.random((300, 3))
    points = np.concatenate([body, 9 + body[:30]])
    links = links_of(points, 31)
    routes = routes_of(points, links, points[17])
    np.testing.assert_array_equal(routes.roots, [17])
    np.testing.assert_allclose(routes.length[:300], plain_routes(points, links, 17)[:300], rtol=1e-9)
    assert np.isnan(routes.length[300:]).all()
    assert (routes.before[300:] == -1).all()


def test_a_route_keeps_to_the_points_of_a_hairpin() -> None:
    """Its arms are six steps apart, so that points across are linked; with length itself for weight they are a way."""
    arms = [wire([0, y, 0], [1, y, 0]) for y in (0, 6 * STEP)]
    points = jittered(np.concatenate([*arms, wire([1, STEP, 0], [1, 5 * STEP, 0])]), 0.01)
    links = links_of(points, 10)
    start, stop = 10, len(arms[0]) + 10  # half way along, opposite each other
    assert ((links.first == start) & (links.second == stop)).any()
    assert routes_of(points, links, points[start]).length[stop] == pytest.approx(26, rel=0.05)


def test_the_root_is_in_the_crowd_and_every_part_has_one() -> None:
    rng = np.random.default_rng(0)
    crowd = np.array([0, 0, 1.0]) + rng.normal(0, 0.03, (60, 3))
    points = np.concatenate([wire([0, 0, 0], [0, 0, 3]), crowd, wire([5, 0, 0], [5, 0, 3])])
    routes = routes_of(points, links_of(points, 10), None)
    assert len(routes.roots) == 2
    assert np.linalg.norm(points[routes.roots[0]] - [0, 0, 1]) < 0.1
    assert points[routes.roots[1], 0] == 5
    np.testing.assert_array_equal(routes.before[routes.roots], routes.roots)


# levels


def test_the_widest_gap_of_a_regular_ring_is_its_step() -> None:
    axis = np.array([[0, 0, 1.0], [0.6, 0, 0.8]])
    for count in (3, 5, 8):
        angle = 2 * np.pi * np.arange(count) / count
        around = Rotation.align_vectors(axis[1:], axis[:1])[0]
        ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        offset = np.concatenate([ring, around.apply(ring)[:-1]])  # the second one lacks a point
        gaps = widest_gaps(offset, axis, np.repeat([0, 1], [count, count - 1]).astype(np.int32))
        np.testing.assert_allclose(gaps, [2 * np.pi / count, min(2, count - 1) * 2 * np.pi / count], atol=1e-9)


def test_a_tube_falls_into_rings() -> None:
    points = tube(0.2, 2.0, 800)
    links, _, levels = levels_along(points, points[0])
    inner = np.abs(levels.centres[:, 2] - 1) < 0.6
    assert levels.rings[inner].all()
    assert np.linalg.norm(levels.centres[inner, :2], axis=1).max() < 0.1  # half the radius
    assert inner.sum() < 2 * 1.2 / (BIN * links.spacing)  # one or two a bin


@pytest.mark.parametrize("wires", [1, 3])
def test_wires_are_no_rings(wires: int) -> None:
    """Three, two steps apart from each other, would be one with the reach of links about tubes."""
    corner = 2 * STEP / np.sqrt(3)
    feet = [[corner * np.cos(a), corner * np.sin(a)] for a in 2 * np.pi * np.arange(wires) / 3]
    points = jittered(np.concatenate([wire([x, y, 0], [x, y, 2]) for x, y in feet]), 0.02)
    levels = levels_along(points, points[0])[2]
    assert not levels.rings.any()
    for section in range(len(levels.centres)):
        mine = points[levels.section == section]
        assert np.ptp(mine[:, :2], axis=0).max() < STEP


# limbs


def chain(*ways: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """Return the parents of sections on ways from the root on, and the lengths of their ways to it."""
    parents, tops = np.full(1 + max(map(max, ways)), -1, np.int32), np.zeros(1 + max(map(max, ways)))
    for way in ways:
        parents[way[1:]] = way[:-1]
        for before, section in zip(way[:-1], way[1:], strict=True):
            tops[section] = tops[before] + 1
    return parents, tops


def test_crowding_is_the_points_to_a_spacing_of_length() -> None:
    """1 on a thread, on a tube all its points over its length; its limb is longer by a turn at either end."""
    thread, resolved = jittered(wire([0, 0, 0], [0, 0, 3]), 0.05), tube(0.2, 2.0, 800)
    for points, expected in ((thread, 1.0), (resolved, None)):
        links, _, levels = levels_along(points, points[0])
        found = crowding(levels, limbs_of(levels, links.spacing), links.spacing)
        assert found == pytest.approx(expected or 800 / 2 * links.spacing, rel=0.2)


@pytest.mark.parametrize(("contacts", "edges", "joint"), [(4, 8, None), (0, 12, 3), (1, 12, 3)])
def test_a_way_beside_an_earlier_limb_is_not_its_own(contacts: int, edges: int, joint: int | None) -> None:
    """Sections 9 to 12 leave the limb 0 to 8 at 3; they touch the limb in so many places, once by chance."""
    parents, tops = chain(list(range(9)), [3, 9, 10, 11, 12])
    centres = np.array([[i, 0.0, 0] for i in range(9)] + [[3 + i, 0.5 * i, 0] for i in range(1, 5)])
    beside: list[list[int]] = [[] for _ in parents]
    for section in range(12, 12 - contacts, -1):
        beside[section] = [section - 5]
    levels = Levels(
        np.arange(13, dtype=np.int32), centres, parents, np.zeros(13, bool), tops, beside, np.zeros(13, bool)
    )
    limbs = limbs_of(levels, 1.0)
    assert len(limbs.edges) == edges
    if joint is None:
        np.testing.assert_array_equal(limbs.owner[9:], [4, 5, 6, 7])
    else:
        assert [9, joint] in limbs.edges.tolist()
        np.testing.assert_array_equal(limbs.owner, np.arange(13))


def test_a_limb_shorter_than_a_spacing_belongs_to_what_it_grows_from() -> None:
    parents, tops = chain(list(range(9)), [3, 9])
    for out, edges in ((0.9, 8), (1.1, 9)):
        centres = np.array([*([i, 0.0, 0] for i in range(9)), [3.0, out, 0]])
        none = np.zeros(10, bool)
        levels = Levels(np.arange(10, dtype=np.int32), centres, parents, none, tops, [[] for _ in parents], none)
        limbs = limbs_of(levels, 1.0)
        assert len(limbs.edges) == edges
        assert limbs.owner[9] == (3 if edges == 8 else 9)


# curve


def curve_along(points: Points) -> ConeCurve:
    links, _, levels = levels_along(points, points[0])
    return curve_of(points, links.spacing, levels, limbs_of(levels, links.spacing), RobustParams())[0]


def test_the_radius_of_a_tube_is_measured_and_that_of_a_wire_bounded() -> None:
    thick, thin = curve_along(tube(0.2, 2.0, 800)), curve_along(jittered(wire([0, 0, 0], [0, 0, 3]), 0.05))
    inner = np.abs(thick.nodes[:, 2] - 1) < 0.6
    assert (thick.radius_sources[inner] == RadiusSource.MEASURED).all()
    assert (thick.regimes[inner] == Regime.TUBE).all()
    np.testing.assert_allclose(thick.radii[inner], 0.2, rtol=0.1)
    assert (thin.radius_sources == RadiusSource.BOUNDED).all()
    assert (thin.regimes == Regime.WIRE).all()
    assert thin.radii.max() < STEP


def test_radii_between_measured_ones_are_modelled_along_the_limb() -> None:
    """Of a tube whose middle fifth shows only a stripe, too narrow to say how thick it is: they change linearly."""
    points = tube(0.25, 3.0, 1500)
    hidden = (np.abs(points[:, 2] - 1.5) < 0.3) & (points[:, 0] < 0.24)
    curve = curve_along(points[~hidden])
    rows = np.flatnonzero((np.abs(curve.nodes[:, 2] - 1.5) < 0.2) & (curve.nodes[:, 0] > 0.2))
    rows = rows[np.argsort(curve.nodes[rows, 2])]
    assert len(rows) >= 5
    assert (curve.radius_sources[rows] == RadiusSource.MODELLED).all()
    way = np.append(0, np.cumsum(np.linalg.norm(np.diff(curve.nodes[rows], axis=0), axis=1)))
    np.testing.assert_allclose(curve.radii[rows], np.poly1d(np.polyfit(way, curve.radii[rows], 1))(way), rtol=1e-9)
