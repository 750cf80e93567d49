"""Doubts about a curve, from plain data: true curves raise none, and each fault raises its own."""

from dataclasses import replace

import numpy as np
import pytest

from reference.judged import codes, dense, judged, true
from tiskel import (
    CurveGraph,
    CurveWarning,
    ShapeParams,
    contract,
    evaluate,
    extract_skeleton,
    make_shape,
    named_shape,
    shape_graph,
)
from tiskel.arrays import Points
from tiskel.gallery.trees import tree
from tiskel.geometry.doubt import UNKNOWN, warning_from
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.geometry.round_cones import sample_union
from tiskel.methods.robust.doubts import doubts_of
from tiskel.methods.robust.judged import Judged
from tiskel.methods.robust.turning import roughness


@pytest.mark.parametrize("name", ["y", "torus", "mug", "ladder", "hand", "banana"])
def test_true_curves_raise_no_warning(name: str) -> None:
    assert "warning" not in codes(true(name)).values()
    assert "warning" not in codes(true(name, noise=0.1)).values()


@pytest.mark.parametrize("name", ["y", "torus", "mug", "hand"])
def test_true_curves_over_holes_in_the_scan_raise_no_warning(name: str) -> None:
    """A fifth of the surface is missing: what is in the air then is over holes, and a note."""
    assert "warning" not in codes(true(name, missing=0.2)).values()


def with_edges(j: Judged, *added: tuple[int, int]) -> Judged:
    graph = CurveGraph(j.graph.nodes, np.concatenate([j.graph.edges, np.array(added, np.int32)]), j.graph.radii)
    return replace(j, graph=graph)


def test_a_chord_through_the_air_is_told_three_ways_with_places_on_it() -> None:
    y = true("y")
    a, b = np.flatnonzero(y.graph.degrees == 1)[:2].tolist()
    found = {doubt.code: doubt for doubt in doubts_of(with_edges(y, (a, b)))}
    assert {"in-air", "outside", "loops"} <= set(found)
    ends = y.graph.nodes[[a, b]]
    way = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    for code in ("in-air", "outside"):
        places = np.array(found[code].places)
        off = places - ends[0]
        np.testing.assert_allclose(off, np.outer(off @ way, way), atol=1e-9)  # on the chord
        assert 1 <= len(places) <= 3
        assert found[code].share > 0.1
    assert "the curve has 1 loops, the body only 0 handles" in str(found["loops"])


def test_a_loop_that_is_missing_is_told() -> None:
    ring = true("torus")
    opened = replace(ring, graph=CurveGraph(ring.graph.nodes, ring.graph.edges[1:], ring.graph.radii))
    (doubt,) = [doubt for doubt in doubts_of(opened) if doubt.code == "loops"]
    assert "the body has 1 handles, the curve only 0 loops" in str(doubt)


def test_a_limb_without_a_branch_is_told_and_where() -> None:
    cross = true("cross")
    limb = cross.graph.nodes[np.flatnonzero(cross.graph.degrees == 1)[0]]
    near = np.linalg.norm(cross.graph.nodes - limb, axis=1) < 0.6 * np.linalg.norm(limb)
    kept = np.flatnonzero(~near)
    place = np.full(len(near), -1, np.int32)
    place[kept] = np.arange(len(kept))
    edges = place[cross.graph.edges]
    less = CurveGraph(cross.graph.nodes[kept], edges[(edges >= 0).all(axis=1)], cross.graph.radii[kept])
    (doubt,) = [doubt for doubt in doubts_of(judged(cross.points, less)) if doubt.code == "far"]
    assert np.linalg.norm(np.array(doubt.places[0]) - limb) < 0.5 * np.linalg.norm(limb)


def cut(j: Judged, low: float, high: float) -> Judged:
    """Return the same without cloud and curve between two heights along z, where both are."""
    inside = (j.graph.nodes[:, 2] > low) & (j.graph.nodes[:, 2] < high)
    name = np.cumsum(~inside) - 1
    links = j.graph.edges[~inside[j.graph.edges].any(axis=1)]
    graph = CurveGraph(j.graph.nodes[~inside], name[links].astype(np.int32), j.graph.radii[~inside])
    return judged(j.points[(j.points[:, 2] < low) | (j.points[:, 2] > high)], graph)


def test_ends_at_a_hole_that_face_each_other_are_told_and_the_mouths_of_tubes_are_not() -> None:
    capsule = true("capsule")
    assert "open-ends" not in codes(cut(capsule, 0.3, 9))  # a mouth that faces nothing
    (doubt,) = [doubt for doubt in doubts_of(cut(capsule, -0.3, 0.3)) if doubt.code == "open-ends"]
    assert doubt.text.startswith("2 ends")
    np.testing.assert_allclose(np.abs(np.array(doubt.places)[:, 2]), 0.3, atol=0.1)
    two = np.concatenate([capsule.points, capsule.points + [0, 0, 2.4]])
    nodes = np.concatenate([capsule.graph.nodes, capsule.graph.nodes + [0, 0, 2.4]])
    edges = np.concatenate([capsule.graph.edges, capsule.graph.edges + len(capsule.graph.nodes)])
    pair = CurveGraph(nodes, edges, np.tile(capsule.graph.radii, 2))
    assert "open-ends" not in codes(judged(two, pair))  # two bodies, each with its caps


def leaf(count: int = 3000) -> Points:
    generator = np.random.default_rng(1)
    return np.stack([generator.normal(0, 1e-3, count), *generator.uniform(-1, 1, (2, count)) * [[0.4], [2]]], axis=1)


def spine(x: float, regime: Regime) -> CurveGraph:
    """Return a straight curve along a leaf, so far before it, with the radius that cones would have."""
    nodes = np.stack([np.full(30, x), np.zeros(30), np.linspace(-1.8, 1.8, 30)], axis=1)
    links = np.stack([np.arange(29), np.arange(1, 30)], axis=1).astype(np.int32)
    return CurveGraph(nodes, links, np.full(30, max(x, 0.2)), regimes=np.full(30, regime, np.uint8))


def test_a_curve_beside_a_leaf_is_wrong_and_one_on_it_is_noted() -> None:
    beside = codes(judged(leaf(), spine(0.5, Regime.TUBE)))
    assert (beside["in-air"], beside["flat"], beside["one-sided"]) == ("warning", "warning", "warning")
    upon = codes(judged(leaf(), spine(0.0, Regime.SHEET)))
    assert "warning" not in upon.values()
    assert {"flat", "one-sided"} <= set(upon)


@pytest.mark.parametrize("count", [2500, 20000])
def test_the_true_curve_of_a_tree_of_twigs_is_thin_and_nothing_else(count: int) -> None:
    """At 2500 points all of it is thinner than they are apart, at 20 000 the trunk is a tube."""
    shape = tree("leader", tips=30, seed=2)
    cloud = sample_union(shape, count, np.random.default_rng(2))
    j = judged(cloud, dense(shape, 0.15))
    bounded = j.graph.radii < 1.5 * j.spacing
    sources = np.where(bounded, RadiusSource.BOUNDED, RadiusSource.MEASURED).astype(np.uint8)
    for regime in (Regime.WIRE, Regime.TUBE):
        regimes = np.where(bounded, regime, Regime.TUBE).astype(np.uint8)
        assert set(codes(replace(j, graph=replace(j.graph, radius_sources=sources, regimes=regimes)))) == {"thin"}


def test_bridges_bounds_and_dust_are_notes_until_they_are_much() -> None:
    y = true("y")
    count = len(y.graph.edges)
    one, many = np.arange(count) < 2, np.arange(count) < count // 2
    assert codes(replace(y, graph=replace(y.graph, bridged=one)))["bridged"] == "note"
    assert codes(replace(y, graph=replace(y.graph, bridged=many)))["bridged"] == "warning"
    thin = np.full(len(y.graph.nodes), RadiusSource.BOUNDED, np.uint8)
    assert codes(replace(y, graph=replace(y.graph, radius_sources=thin)))["thin"] == "note"
    some, much = (np.arange(len(y.points)) < n for n in (20, 600))
    assert codes(replace(y, left_out=some))["small-parts"] == "note"
    assert codes(replace(y, left_out=much))["small-parts"] == "warning"


def test_a_ball_has_no_curve_skeleton() -> None:
    ball = np.random.default_rng(0).normal(size=(2000, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    assert "hardly longer than it is thick" in str(extract_skeleton(contract(ball)).warnings[0])


def test_shares_are_those_of_the_measures() -> None:
    """Of a curve that a method made, moved aside: what is outside and in the air is one number for all."""
    made = extract_skeleton(contract(make_shape(shape_graph("y"))[0]))
    aside = replace(made, nodes=made.nodes + [0.2, 0.0, 0.0], warnings=(), notes=())
    quality = evaluate(aside).as_dict()
    j = replace(judged(made.cloud, CurveGraph(aside.nodes, aside.edges, aside.radii)), contracted=made.contracted)
    found = {doubt.code: doubt for doubt in doubts_of(j)}
    assert found["in-air"].share == pytest.approx(quality["air"]["curve"], abs=1e-9)
    assert found["outside"].share == pytest.approx(1 - quality["inside"]["curve"], abs=1e-9)


def test_warnings_come_back_from_json_and_from_older_files() -> None:
    doubt = CurveWarning("far", "much", "note", 0.25, ((1.0, 2.0, 3.0),))
    assert warning_from(doubt.as_dict()) == doubt
    assert warning_from("as it once was") == CurveWarning(UNKNOWN, "as it once was")
    moved = doubt.moved(lambda points: 2 * points + 1)
    assert moved == replace(doubt, places=((3.0, 5.0, 7.0),))
    assert replace(doubt, places=()).moved(lambda points: points).places == ()


def test_a_long_flat_bar_is_a_note_and_a_plate_a_warning() -> None:
    """A bar of 5 : 1 has a middle line; a plate of 1 : 1 has none, whatever curve comes out."""
    generator = np.random.default_rng(0)
    for long, severity in ((5.0, "note"), (1.0, "warning")):
        sides = np.array([long, 1.0, 0.1])
        area = np.array([sides[1] * sides[2], sides[0] * sides[2], sides[0] * sides[1]])
        places, face = generator.random((4096, 3)) - 0.5, generator.choice(3, 4096, p=area / area.sum())
        rows = np.arange(4096)
        places[rows, face] = np.sign(places[rows, face]) / 2
        s = extract_skeleton(contract(places * sides))
        assert {one.code: one.severity for one in (*s.warnings, *s.notes)}["flat"] == severity


def test_a_flat_ring_is_a_note_and_one_that_ends_stick_out_of_a_warning() -> None:
    made = extract_skeleton(contract(make_shape(named_shape("washer-plate"))[0]))
    assert (made.ends, made.loops) == (0, 1)
    assert [(doubt.code, doubt.severity) for doubt in (*made.warnings, *made.notes)] == [("flat", "note")]


def test_strands_taken_for_one_tube_have_no_inside_and_noise_alone_is_not_told() -> None:
    bundle = extract_skeleton(contract(make_shape(named_shape("bundle"))[0]))
    assert [warning.code for warning in bundle.warnings] == ["no-inside"]
    assert bundle.warnings[0].share > 0.2
    noisy = extract_skeleton(contract(make_shape(shape_graph("y"), ShapeParams(noise=0.5))[0]))
    assert "no-inside" not in [warning.code for warning in noisy.warnings]


def test_a_thin_strap_has_no_inside_behind_many_of_its_points() -> None:
    """The normals of both faces are mixed up; more than a tenth of the points is told, with an inside to speak of."""
    strap = extract_skeleton(contract(make_shape(named_shape("strap"), ShapeParams(noise=0.1))[0]))
    assert "no-inside" in [warning.code for warning in strap.warnings]


@pytest.mark.parametrize(("degrees", "told"), [(230, "warning"), (300, None)])
def test_the_axis_of_a_pipe_of_which_a_third_is_not_seen_is_a_guess(degrees: float, told: str | None) -> None:
    generator = np.random.default_rng(0)
    turn, along = np.radians(degrees) * generator.random(4000), generator.uniform(-5, 5, 4000)
    pipe = np.stack([np.cos(turn), np.sin(turn), along], axis=1)
    nodes = np.stack([np.zeros(30), np.zeros(30), np.linspace(-4.5, 4.5, 30)], axis=1)
    links = np.stack([np.arange(29), np.arange(1, 30)], axis=1).astype(np.int32)
    axis = CurveGraph(nodes, links, np.ones(30), regimes=np.full(30, Regime.TUBE, np.uint8))
    assert codes(judged(pipe, axis)).get("one-sided") == told


def test_no_sheet_is_thick_and_thickness_is_in_the_spacing_about_a_place() -> None:
    assert not judged(leaf(), spine(0.0, Regime.SHEET)).thick.any()
    y = true("y")
    assert y.thick.all()
    middle = float(np.quantile(y.points[:, 2], 0.3))
    coarse = replace(y, spacings=np.where(y.points[:, 2] < middle, y.graph.radii.max(), y.spacings.min()))
    height = coarse.samples.points[:, 2] - middle
    assert not coarse.thick[height < -0.5].any()
    assert coarse.thick[height > 0.5].all()


def test_roughness_is_none_on_a_plane_and_half_a_spacing_in_noise() -> None:
    flat = np.random.default_rng(0).random((3000, 3)) * [1, 1, 0]
    up = np.tile([0.0, 0, 1], (3000, 1))
    spacing = np.full(3000, 0.02)
    assert roughness(flat, up, spacing) == 0
    tilted = flat + flat[:, :1] * [0, 0, 1]
    across = np.array([-1.0, 0, 1]) / np.sqrt(2)
    assert roughness(tilted, np.tile(across, (3000, 1)), spacing) == pytest.approx(0, abs=1e-12)
    noise = np.random.default_rng(1).normal(scale=0.001, size=3000)
    # The root of the mean of eight squares, each of a difference of two: of noise of a twentieth of a spacing.
    assert roughness(flat + noise[:, None] * [0, 0, 1], up, spacing) == pytest.approx(np.sqrt(2) / 20, rel=0.15)
