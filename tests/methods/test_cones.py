"""Round cones: residuals, their fit, and the limbs, tips and gaps that follow from it."""

from dataclasses import replace

import numpy as np
import pytest

from reference.cones import cone_residuals
from tiskel import ShapeParams, make_shape, shape_graph
from tiskel.arrays import Edges, Indices, Numbers, Points
from tiskel.geometry.graph import tidy_edges
from tiskel.geometry.round_cones import ConeGraph, signed_distance
from tiskel.geometry.solid import solid_of
from tiskel.methods.robust import fit as cones
from tiskel.methods.robust.branches import (
    with_missed_branches,
    with_tips,
    without_contained_ends,
    without_explained_branches,
    without_spurs,
)
from tiskel.methods.robust.bridges import bridged
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, keeps_loops
from tiskel.methods.robust.ends import open_ends
from tiskel.methods.robust.fit import ConeFit, fit_cones
from tiskel.methods.robust.junctions import merged_junctions, placed_junctions
from tiskel.methods.robust.network import neighbour_network
from tiskel.methods.trace import Sections
from tiskel.params import RobustParams

USUAL = RobustParams()


def curve_of(nodes: Points, radii: Numbers, edges: Edges, owner: Indices) -> tuple[ConeCurve, Sections]:
    """A curve whose nodes are sections themselves, and the sections of the points: their nodes."""
    count = len(nodes)
    curve = ConeCurve(
        nodes,
        np.asarray(edges, np.int32).reshape(-1, 2),
        radii,
        levels=np.arange(count, dtype=np.int32),
        node_of_section=np.append(np.arange(count), -1).astype(np.int32),
        section_sizes=np.bincount(owner[owner >= 0], minlength=count).astype(float),
    )
    return curve, Sections(owner, np.zeros_like(owner))


def chain(nodes: Points, radii: Numbers, owner: Indices) -> tuple[ConeCurve, Sections]:
    count = len(nodes)
    edges = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1).astype(np.int32)
    return curve_of(nodes, radii, edges, owner)


def fit(curve: ConeCurve, points: Points, sections: Sections, rounds: int) -> ConeFit:
    return fit_cones(curve, points, sections.section, rounds=rounds, straightness=USUAL.straightness)


def nearest_node(points: Points, nodes: Points) -> Indices:
    return np.asarray(np.linalg.norm(points[:, None] - nodes, axis=2).argmin(axis=1), np.int32)


def rod(count: int = 900, missing: float = 0.0) -> tuple[Points, ConeCurve, Sections]:
    """A rod of radius 0.2 from z = -0.7 to 0.7, and a crooked first guess of seven nodes."""
    points = make_shape(shape_graph("capsule"), ShapeParams(count=count))[0]
    points = points[np.abs(np.arctan2(points[:, 1], points[:, 0])) >= missing]
    guess = np.linspace(-0.6, 0.6, 7)[:, None] * [0, 0, 1.0]
    crooked = guess + np.random.default_rng(2).normal(size=guess.shape) * 0.03
    return points, *chain(crooked, np.full(7, 0.15), nearest_node(points, guess))


def test_residuals_are_signed_distances_whatever_the_taper() -> None:
    generator = np.random.default_rng(0)
    shape = ConeGraph(generator.normal(size=(3, 3)), np.array([[0, 1], [1, 2]], np.int32), np.array([0.5, 0.1, 0.3]))
    points = generator.normal(size=(200, 3))
    share, residual = cone_residuals(points, shape.nodes, shape.radii, shape.edges)
    for edge in range(2):
        np.testing.assert_allclose(residual[:, edge], signed_distance(points, shape, edge), atol=1e-12)
    assert ((share >= 0) & (share <= 1)).all()


def test_the_step_descends_along_the_slope_of_the_residuals() -> None:
    """The right-hand side of the data is minus the gradient of half the squares, by central differences."""
    points, curve, sections = rod(120)
    rows = np.arange(len(points), dtype=np.int32)
    at = cones.foot_points(curve, points, rows, sections.section, cones.nearby_edges(curve))
    unknowns, _, sides = cones._data(at, points)
    gradient = np.bincount(unknowns.ravel(), sides.ravel(), minlength=4 * len(curve.nodes)).reshape(-1, 4)
    light = 1 / np.maximum(1, np.abs(at.residual) / (cones.OUTLYING * at.deviation))

    def half_squares(nodes: Points, radii: Numbers) -> float:
        residual = cone_residuals(points, nodes, radii, curve.edges)[1][rows, at.edge]
        return 0.5 * float((light * residual**2).sum())

    h = 1e-6
    for node, axis in [(0, 0), (2, 1), (3, 2), (6, 2)]:
        shift = np.zeros_like(curve.nodes)
        shift[node, axis] = h
        both = [half_squares(curve.nodes + side * shift, curve.radii) for side in (1, -1)]
        assert -gradient[node, axis] == pytest.approx((both[0] - both[1]) / (2 * h), rel=1e-4, abs=1e-6)
    more = curve.radii + h * np.eye(7)[4], curve.radii - h * np.eye(7)[4]
    slope = (half_squares(curve.nodes, more[0]) - half_squares(curve.nodes, more[1])) / (2 * h)
    assert -gradient[4, 3] == pytest.approx(slope, rel=1e-4)


@pytest.mark.parametrize("missing", [0.0, 0.5 * np.pi, 0.6 * np.pi])
def test_the_fit_finds_axis_radius_and_ends_of_a_rod_even_from_an_arc(missing: float) -> None:
    points, curve, sections = rod(missing=missing)
    at = fit(curve, points, sections, 12)
    fitted = at.curve
    assert np.linalg.norm(fitted.nodes[:, :2], axis=1).max() < 0.03 * 0.2  # the crooked start still holds a little
    np.testing.assert_allclose(fitted.radii, 0.2, rtol=0.03)
    np.testing.assert_allclose(np.abs(fitted.nodes[[0, -1], 2]), 0.7, atol=0.05 * 0.2)
    assert np.abs(at.residual).max() < 0.1 * 0.2
    np.testing.assert_allclose(np.linalg.norm(at.places[:, :2], axis=1), 0, atol=0.03 * 0.2)


def test_outliers_hardly_move_the_fit() -> None:
    points, curve, sections = rod()
    generator = np.random.default_rng(1)
    stray = generator.choice(len(points), 45, replace=False)  # five per cent, on one side
    points[stray] += [0.3, 0, 0]
    fitted = fit(curve, points, sections, 12).curve
    assert np.linalg.norm(fitted.nodes[:, :2], axis=1).max() < 0.1 * 0.2


def test_a_curve_without_edges_is_left_as_it_is() -> None:
    alone, sections = curve_of(np.zeros((1, 3)), np.ones(1), np.zeros((0, 2), np.int32), np.zeros(5, np.int32))
    at = fit(alone, np.ones((5, 3)), sections, 3)
    assert at.curve is alone
    assert len(at.rows) == 0
    assert at.deviation == 0


def test_contracting_keeps_what_the_points_belong_to() -> None:
    curve, sections = chain(np.arange(12.0).reshape(4, 3), np.arange(1.0, 5), np.array([0, 1, 2, 3, -1], np.int32))
    fewer = contract_nodes(curve, np.array([0, 0, 1, 3], np.int32))  # a chain of replacements: 2 -> 1 -> 0
    np.testing.assert_array_equal(fewer.node_of_section[sections.section], [0, 0, 0, 1, -1])
    np.testing.assert_array_equal(fewer.point_counts, [3, 1])
    np.testing.assert_array_equal(fewer.edges, [[0, 1]])
    np.testing.assert_array_equal(fewer.nodes, curve.nodes[[0, 3]])
    mean = contract_nodes(curve, np.array([0, 0, 0, 3], np.int32), mean=True)
    np.testing.assert_array_equal(mean.nodes[0], curve.nodes[:3].mean(axis=0))
    assert mean.radii[0] == 3


def test_a_loop_is_not_contracted_away() -> None:
    ring, _ = chain(np.eye(4)[:, :3], np.ones(4), np.zeros(1, np.int32))
    ring = replace(ring, edges=tidy_edges(np.array([[0, 1], [1, 2], [2, 3], [3, 0]])))
    assert keeps_loops(ring, np.array([0, 0, 2, 3], np.int32))
    assert not keeps_loops(ring, np.array([0, 0, 0, 3], np.int32))


def test_the_balls_of_a_cap_are_one_end_and_a_taper_is_not() -> None:
    along = np.array([0.0, 0.5, 1.0, 1.1, 1.25])
    cap, _ = chain(along[:, None] * [0, 0, 1], np.array([0.3, 0.3, 0.3, 0.2, 0.05]), np.zeros(1, np.int32))
    np.testing.assert_allclose(without_contained_ends(cap).nodes[-1], [0, 0, 1])
    taper = replace(cap, radii=np.array([0.3, 0.28, 0.26, 0.25, 0.24]))
    assert len(without_contained_ends(taper).nodes) == 5


def y_curve(arm: float) -> tuple[Points, ConeCurve, Sections]:
    """A rod with a node beside it, so many radii from its axis."""
    points, curve, sections = rod()
    curve = fit(curve, points, sections, 8).curve
    tip = curve.nodes[3] + [arm * 0.2, 0, 0]
    owner = sections.section.copy()
    owner[np.linalg.norm(points - tip, axis=1) < 0.08] = 7
    edges = tidy_edges(np.concatenate([curve.edges, [[3, 7]]]))
    return points, *curve_of(np.vstack([curve.nodes, tip]), np.append(curve.radii, 0.05), edges, owner)


def test_a_branch_within_the_rest_is_no_branch() -> None:
    points, curve, sections = y_curve(0.8)
    network = replace(neighbour_network(points, 14), spacings=np.full(len(points), 0.05))
    fewer = without_explained_branches(curve, network, sections, USUAL.least_branch)
    assert fewer is not None
    assert len(fewer.nodes) == 7
    assert without_explained_branches(fewer, network, sections, USUAL.least_branch) is None
    assert len(without_spurs(curve, points, sections).nodes) == 8  # its points do reach the surface of the rod
    assert len(without_spurs(replace(curve, radii=curve.radii * 1.5), points, sections).nodes) == 7


def test_a_branch_that_sticks_out_stays() -> None:
    shape = shape_graph("y")
    points = make_shape(shape, ShapeParams(count=900))[0]
    curve, sections = curve_of(shape.nodes, shape.radii, shape.edges, nearest_node(points, shape.nodes))
    assert without_explained_branches(curve, neighbour_network(points, 14), sections, USUAL.least_branch) is None


def test_an_end_that_falls_short_grows_to_the_tip() -> None:
    points, curve, sections = rod()
    network = neighbour_network(points, 14)
    short = replace(contract_nodes(curve, np.array([0, 1, 2, 3, 4, 4, 4], np.int32)), radii=np.full(5, 0.2))
    grown = with_tips(fit(short, points, sections, 0), network, sections)
    assert grown is not None
    assert grown.nodes[-1][2] > 0.6
    assert with_tips(fit(curve, points, sections, 8), network, sections) is None


def test_a_branch_that_the_sections_missed_grows() -> None:
    shape = shape_graph("y")
    points = make_shape(shape, ShapeParams(count=1500))[0]
    network, owner = neighbour_network(points, 14), nearest_node(points, shape.nodes[:3])
    two_arms, sections = curve_of(shape.nodes[:3], shape.radii[:3], shape.edges[:2], owner)
    grown = with_missed_branches(fit(two_arms, points, sections, 0), network, sections, USUAL)
    assert grown is not None
    curve, labelled = grown
    assert np.linalg.norm(curve.nodes - shape.nodes[3], axis=1).min() < 0.14
    new = curve.node_of_section[labelled.section] >= 3  # what the branch took over
    np.testing.assert_array_equal(new, labelled.section != sections.section)
    assert curve.point_counts.sum() == len(points)
    whole, sections = curve_of(shape.nodes, shape.radii, shape.edges, nearest_node(points, shape.nodes))
    assert with_missed_branches(fit(whole, points, sections, 0), network, sections, USUAL) is None


def test_a_joint_goes_to_where_the_lines_of_its_branches_meet() -> None:
    shape = shape_graph("y")
    points = make_shape(shape, ShapeParams(count=1500))[0]
    share = np.array([0.35, 0.6, 0.85])[:, None]
    arms = [shape.nodes[0] + share * (tip - shape.nodes[0]) for tip in shape.nodes[1:]]
    nodes = np.vstack([[[0.03, 0.05, 0.12]], *arms])
    links = [(0, 1), (1, 2), (2, 3), (0, 4), (4, 5), (5, 6), (0, 7), (7, 8), (8, 9)]
    curve, _ = curve_of(nodes, np.full(10, 0.14), tidy_edges(np.array(links)), np.zeros(1500, np.int32))
    oriented = neighbour_network(points, 14).oriented(shape.nodes[nearest_node(points, shape.nodes)] * 0.5)
    placed = placed_junctions(curve, solid_of(oriented))
    assert np.linalg.norm(placed.nodes[0]) < 0.1 * 0.14 + 0.2 / 2 * np.linalg.norm(nodes[0])  # HOLD keeps a share


def test_joints_closer_than_their_radius_become_one() -> None:
    nodes = np.array([[0, 0, 0], [0.1, 0, 0], [0, 1, 0], [0, -1, 0], [1, 1, 0], [1, -1, 0.0]])
    links = np.array([[0, 1], [0, 2], [0, 3], [1, 4], [1, 5]])
    near, _ = curve_of(nodes, np.full(6, 0.2), tidy_edges(links), np.zeros(1, np.int32))
    assert merged_junctions(near, USUAL.merge_junctions).junctions == 1
    assert merged_junctions(near, 0.4).junctions == 2
    assert merged_junctions(replace(near, radii=np.full(6, 0.1)), USUAL.merge_junctions).junctions == 2


def cut_rod(gap: float) -> tuple[Points, ConeCurve, Sections]:
    """A rod of which the middle is missing, and a curve in either half."""
    points = make_shape(shape_graph("capsule"), ShapeParams(count=2000))[0]
    points = points[np.abs(points[:, 2]) > gap / 2]
    heights = np.concatenate([np.linspace(-0.7, -gap / 2, 4), np.linspace(gap / 2, 0.7, 4)])
    nodes = heights[:, None] * [0, 0, 1.0]
    edges = tidy_edges(np.array([[0, 1], [1, 2], [2, 3], [4, 5], [5, 6], [6, 7]]))
    return points, *curve_of(nodes, np.full(8, 0.2), edges, nearest_node(points, nodes))


def test_open_ends_that_face_each_other_are_joined_and_round_ones_are_not() -> None:
    points, curve, sections = cut_rod(0.3)
    network = neighbour_network(points, 14)
    assert [end.node for end in open_ends(curve, network, sections)] == [3, 4]
    joined, gaps = bridged(curve, network, sections, USUAL.bridge_gaps)
    assert gaps == 1
    assert joined.bridged.sum() == len(joined.edges) - len(curve.edges)
    assert not joined.bridged[[tuple(edge) in set(map(tuple, curve.edges)) for edge in joined.edges]].any()
    assert bridged(curve, network, sections, 0) == (curve, 0)
    assert (joined.degrees == 1).sum() == 2
    wide = replace(curve, radii=np.full(8, 0.03))  # a gap of ten radii
    assert bridged(wide, network, sections, USUAL.bridge_gaps)[1] == 0


def test_an_open_end_that_faces_a_side_is_joined_to_it() -> None:
    """A T whose stem is cut off under its bar."""
    shape = ConeGraph(
        np.array([[-0.6, 0, 0], [0, 0, 0], [0.6, 0, 0], [0, 0, -1.0]]), np.array([[0, 1], [1, 2], [1, 3]], np.int32),
        np.full(4, 0.15),
    )  # fmt: skip
    points = make_shape(shape, ShapeParams(count=2500))[0]
    points = points[(points[:, 2] < -0.4) | (points[:, 2] > -0.16)]
    nodes = np.array([[-0.6, 0, 0], [0, 0, 0], [0.6, 0, 0], [0, 0, -0.4], [0, 0, -0.7], [0, 0, -1.0]])
    edges = tidy_edges(np.array([[0, 1], [1, 2], [3, 4], [4, 5]]))
    curve, sections = curve_of(nodes, np.full(6, 0.15), edges, nearest_node(points, nodes))
    joined, gaps = bridged(curve, neighbour_network(points, 14), sections, USUAL.bridge_gaps)
    assert gaps == 1
    assert joined.degrees[1] == 3
