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
from tiskel.methods.robust.wire.spurs import without_spurs
from tiskel.methods.robust.wire.tips import on_their_lines, zigzag


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
    [(4, 10, 10, 2), (4, 30, 10, 3), (7, 10, 10, 3), (4, 1, 0, 3)],
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
