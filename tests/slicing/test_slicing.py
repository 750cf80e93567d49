"""Slices and fitted surfaces: paths, rings, series, named cases, accuracy, files."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import (
    Curve,
    Skeleton,
    Surfaces,
    TiskelError,
    contract,
    extract_skeleton,
    fit_surface,
    make_shape,
    read_surfaces,
    shape_graph,
    write_surfaces,
)
from tiskel.arrays import Numbers, Points, Table
from tiskel.geometry.bspline import fit_bspline
from tiskel.geometry.graph import CurveGraph, component_labels
from tiskel.geometry.round_cones import union_distance
from tiskel.io.mesh_file import dump_mesh
from tiskel.io.ply import parse
from tiskel.io.stages.surface import dump_surfaces, parse_surfaces
from tiskel.params import ShapeParams, SurfaceParams
from tiskel.slicing.body_mesh import tubes_mesh
from tiskel.slicing.coverage import distances_to_surfaces
from tiskel.slicing.cutter import middle_of, places_of
from tiskel.slicing.doubts import misfit
from tiskel.slicing.gaps import largest_gap
from tiskel.slicing.mesh import distances_to_mesh, measures, mesh_report, slice_table, surface_mesh
from tiskel.slicing.parts import parts_of
from tiskel.slicing.paths import longest_path, paths_of
from tiskel.slicing.rings import Ring, ring_of
from tiskel.slicing.sections import Case, Section, fit_section, left_out_error, one_valued
from tiskel.slicing.series import chosen_order, fit_sections, joined_series, without_unlike
from tiskel.surfaces.forms import forms_of, principal_curvatures
from tiskel.surfaces.tube import V_STOP

FIVE = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 0], [2, -0.5, 0]])
FORK = np.array([[0, 1], [1, 2], [2, 3], [2, 4]], np.int32)


def skeleton(name: str, **degraded: Any) -> Skeleton:
    return extract_skeleton(contract(make_shape(shape_graph(name), ShapeParams(**degraded))[0]))


@pytest.fixture(scope="module")
def banana() -> Surfaces:
    return fit_surface(skeleton("banana"))


def test_the_longest_path_runs_through_joints() -> None:
    assert longest_path(CurveGraph(FIVE, FORK)).tolist() in ([0, 1, 2, 3], [3, 2, 1, 0])
    assert [path.name for path in paths_of(CurveGraph(FIVE, FORK), "all")] == ["0", "1", "2"]
    assert len(paths_of(CurveGraph(FIVE, FORK), "2")) == 1
    with pytest.raises(TiskelError, match="no branch 7; the skeleton has 3, from 0 to 2"):
        paths_of(CurveGraph(FIVE, FORK), "7")


def test_a_curve_without_edges_is_one_path() -> None:
    assert paths_of(CurveGraph(FIVE, np.zeros((0, 2), np.int32)), "all")[0].nodes.tolist() == [0, 1, 2, 3, 4]


def circle(count: int, radius: float, centre: tuple[float, float] = (0, 0), start: float = 0.0) -> Table:
    u = start + np.linspace(0, 2 * np.pi - start, count, endpoint=False)
    return np.stack([centre[0] + radius * np.cos(u), centre[1] + radius * np.sin(u)], axis=1)


def test_a_ring_leaves_out_another_limb_in_its_plane() -> None:
    both = np.concatenate([circle(60, 1.0), circle(60, 1.0, (4.0, 0.0))])
    assert ring_of(both, 0.3).tolist() == list(range(60))


def test_a_ring_does_not_look_through_its_gap_at_another_limb() -> None:
    open_ring = circle(50, 1.0, start=1.0)
    both = np.concatenate([open_ring, circle(60, 1.0, (5.0, 2.5))])
    assert ring_of(both, 0.3).tolist() == list(range(50))


def test_a_ring_in_two_halves_is_one_ring() -> None:
    u = np.concatenate([np.linspace(0.3, 2.8, 30), np.linspace(3.4, 6.0, 30)])
    halves = np.stack([np.cos(u), np.sin(u)], axis=1)
    assert len(ring_of(halves, 0.15)) == 60


def ring(u: Numbers, r: Numbers) -> Ring:
    return Ring(
        np.arange(len(u), dtype=np.int32), u, np.ones(len(u)) + np.random.default_rng(4).uniform(-0.01, 0.01, len(u)), r
    )


EVEN = np.linspace(0, 2 * np.pi, 81, endpoint=False)
PARAMS = SurfaceParams()


def test_a_section_finds_its_series() -> None:
    r = 2 + 0.3 * np.sin(EVEN) - 0.2 * np.cos(2 * EVEN) + 0.1 * np.sin(3 * EVEN)
    found = fit_section(1.0, ring(EVEN, r), 3, PARAMS)
    # The ridge takes 1e-7 k^4 of a coefficient.
    np.testing.assert_allclose(found.series, [2, 0.3, 0, 0, -0.2, 0.1, 0], atol=1e-4)
    assert found.case is Case.FITTED
    assert found.error < 1e-4


def test_a_few_points_far_off_hardly_move_a_section() -> None:
    r = np.full(81, 2.0)
    r[[5, 30, 31, 60]] = [3.5, 1.0, 1.0, 4.0]
    assert fit_section(1.0, ring(EVEN, r), 3, PARAMS).series[0] == pytest.approx(2.0, abs=0.02)


@pytest.mark.parametrize(
    ("u", "r", "case"),
    [
        (EVEN[:10], np.ones(10), Case.FEW),
        (EVEN[:38], np.ones(38), Case.GAP),
        (np.tile(EVEN, 2), np.concatenate([np.ones(81), np.full(81, 3.0)]), Case.NOT_STAR),
    ],
)
def test_sections_that_have_no_series_say_why(u: Numbers, r: Numbers, case: Case) -> None:
    found = fit_section(1.0, ring(u, r), 3, PARAMS)
    assert found.case is case
    assert len(found.series) == 0


def test_a_gap_is_bridged_smoothly_at_every_order() -> None:
    """80 degrees without points, order 8, noise: the series stays near the circle, where a free one runs away."""
    generator = np.random.default_rng(4)
    u = EVEN[(EVEN > 1.4)]
    r = 1 + generator.normal(size=len(u)) * 0.01
    found = fit_section(1.0, ring(u, r), 8, PARAMS)
    assert found.case is Case.FITTED
    i = np.arange(1, 9)
    waves = np.stack([np.sin(EVEN[:, None] * i), np.cos(EVEN[:, None] * i)], axis=2).reshape(len(EVEN), -1)
    assert np.abs(found.series[0] + waves @ found.series[1:] - 1).max() < 0.1


def section(v: float, radius: float, case: Case = Case.FITTED) -> Section:
    series = np.array([radius, 0.1 * radius, 0.0]) if case is Case.FITTED else np.zeros(0)
    return Section(v, case, series, 40, 0.2, 0.01 if case is Case.FITTED else np.nan)


def test_rejected_slices_are_bridged_without_overshoot() -> None:
    """A jump from 1 to 2 on both sides of ten rejected slices: between them the radius stays between them."""
    v = places_of(30)
    cases = [Case.GAP if 10 <= i < 20 else Case.FITTED for i in range(30)]
    sections = tuple(section(x, 1.0 if x < 1.5 else 2.0, case) for x, case in zip(v, cases, strict=True))
    found = joined_series(sections, 15, closed=False).along(np.linspace(0, V_STOP, 200))[:, 0, 0]
    assert found.min() > 0.9
    assert found.max() < 2.1


def test_a_section_unlike_the_others_is_rejected() -> None:
    odd = replace(section(1.0, 1.0), error=0.2)
    found = without_unlike((*(section(x, 1.0) for x in places_of(9)), odd))
    assert [one.case for one in found].count(Case.FITTED) == 9
    assert found[-1].case is Case.ROUGH
    assert len(found[-1].series) == 0


def test_the_largest_gap_goes_around() -> None:
    assert largest_gap(np.array([0.5, 1.0, 6.0])) == pytest.approx((5.0, 3.5))
    assert largest_gap(np.array([1.0, 2.0, 3.0])) == pytest.approx((2 * np.pi - 2, 2 + np.pi))
    assert largest_gap(np.array([1.0])) == pytest.approx((2 * np.pi, 1 + np.pi))


def test_points_left_out_tell_noise_from_shape() -> None:
    """Noise alone: higher orders predict worse. A shape of order 5: they predict better."""
    generator = np.random.default_rng(4)
    noisy = ring(EVEN, 1 + generator.normal(size=81) * 0.005)
    assert left_out_error(1.0, noisy, 8) > left_out_error(1.0, noisy, 3)
    shaped = ring(EVEN, 1 + 0.1 * np.cos(5 * EVEN) + generator.normal(size=81) * 0.005)
    assert left_out_error(1.0, shaped, 5) < left_out_error(1.0, shaped, 4)


def test_a_little_shape_is_worth_a_higher_order_and_noise_is_not() -> None:
    """A sixth harmonic of a third of the noise saves 5 % of the error by order 6: a penalty of 2 % an order hid it."""
    generator, even = np.random.default_rng(5), np.linspace(0, 2 * np.pi, 500, endpoint=False)
    noise = [(1.0, ring(even, 1 + 0.005 * generator.normal(size=500))) for _ in range(30)]
    shaped = [(v, Ring(r.rows, r.u, r.v, r.r + 0.35 * 0.005 * np.cos(6 * even))) for v, r in noise]
    assert chosen_order(noise, PARAMS) == 3
    assert chosen_order(shaped, PARAMS) == 6


@pytest.mark.parametrize(("name", "noise", "most"), [
    ("capsule", 0.0, 0.001), ("banana", 0.0, 0.005), ("carrot", 0.0, 0.002), ("torus", 0.0, 0.01), ("helix", 0.0, 0.01),
    ("tunnel", 0.0, 0.005), ("capsule", 0.005, 0.01), ("torus", 0.005, 0.01), ("helix", 0.05, 0.04),
])  # fmt: skip
def test_the_surface_is_where_the_shape_is(name: str, noise: float, most: float) -> None:
    """Relative to the radius; asked is 1 % clean. The shapes are polygons of cones, which a smooth surface rounds."""
    shape = shape_graph(name)
    surface = fit_surface(skeleton(name, noise=noise))[0]
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0.05, 0.95, 60) * V_STOP)
    places = np.stack(surface.jet(u, v).f, axis=-1).reshape(-1, 3)
    assert np.abs(union_distance(places, shape)).max() < most * surface.radius
    assert surface.warnings == ()


@pytest.mark.parametrize("noise", [0.0, 0.005])
def test_curvatures_of_a_cylinder(noise: float) -> None:
    """Radius 0.2, 4096 points. With noise of half a percent curvatures are to below 5 % of 1/R, in the mean 1 %."""
    surface = fit_surface(skeleton("capsule", noise=noise))[0]
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0.1, 0.9, 40) * V_STOP)
    low, high = principal_curvatures(forms_of(surface.jet(u, v)))
    off = np.stack([low, high - 5.0]) / 5.0
    assert np.abs(off).max() < (0.05 if noise else 0.002)
    assert np.abs(off).mean() < (0.01 if noise else 0.0005)


def test_a_loop_is_closed_with_two_derivatives() -> None:
    surface = fit_surface(skeleton("torus"))[0]
    assert surface.periods == (2 * np.pi, V_STOP)
    before, after = (surface.jet(0.7, v) for v in (V_STOP - 1e-10, 1e-10))
    for a, b in zip(before, after, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-6)


def test_every_branch_of_a_body_with_limbs_has_a_surface() -> None:
    surfaces = fit_surface(skeleton("y"))
    assert [s.name for s in surfaces] == ["0", "1", "2"]
    assert all(s.radius == pytest.approx(0.14, abs=0.003) for s in surfaces)
    assert surfaces.named("1") is surfaces[1]
    assert len(surfaces.named(None).nodes) >= 10
    with pytest.raises(TiskelError, match="no surface of branch 9; there are 0, 1, 2"):
        surfaces.named("9")
    longest = fit_surface(skeleton("y"), SurfaceParams(branch="longest"))
    assert longest[0].length > 1.5


def test_branches_without_a_surface_say_why() -> None:
    surfaces = fit_surface(skeleton("hand"))
    assert "it has 2 nodes, a curve needs 3" in surfaces.rejected.values()
    with pytest.raises(TiskelError, match=r"no branch can be sliced: branch 0: it is 0.58\d* long, too short"):
        fit_surface(skeleton("egg"), SurfaceParams(interval=0.2))


def test_a_body_without_a_long_part_is_refused_with_the_reason() -> None:
    generator = np.random.default_rng(4)
    directions = generator.normal(size=(1500, 3))
    ball = directions / np.linalg.norm(directions, axis=1)[:, None]
    with pytest.raises(TiskelError, match="no branch can be sliced"):
        fit_surface(extract_skeleton(contract(ball)))


def test_a_curve_from_elsewhere_is_enough() -> None:
    shape = shape_graph("banana")
    cloud = make_shape(shape)[0]
    curve = Curve(shape.nodes, shape.edges)
    surface = fit_surface(curve, cloud=cloud)[0]
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0.05, 0.95, 60) * V_STOP)
    places = np.stack(surface.jet(u, v).f, axis=-1).reshape(-1, 3)
    assert np.abs(union_distance(places, shape)).max() < 0.01 * surface.radius
    with pytest.raises(TiskelError, match="needs the cloud"):
        fit_surface(curve)


def test_a_skeleton_off_the_middle_moves_there_unless_it_is_told_not_to() -> None:
    shape = shape_graph("capsule")
    cloud = make_shape(shape)[0]
    aside = Curve(shape.nodes[:2] + [0.06, 0, 0], np.array([[0, 1]], np.int32))
    straight = replace(aside, nodes=np.linspace(aside.nodes[0], aside.nodes[1], 12), edges=np.zeros((0, 2), np.int32))
    moved, kept = (fit_surface(straight, SurfaceParams(recentre=r), cloud)[0] for r in (True, False))
    middle = np.array([V_STOP / 2])
    assert np.abs(moved.tube.curve(middle)[0, :2]).max() < 1e-3
    assert kept.tube.curve(middle)[0, 0] == pytest.approx(0.06, abs=1e-3)
    assert np.abs(moved.tube.curve(np.array([0.0, V_STOP]))[:, :2]).max() < 0.005


def test_the_published_rule_ends_at_order_eight_where_there_is_noise() -> None:
    s = skeleton("capsule", noise=0.05)
    assert fit_surface(s, SurfaceParams(order_rule="published"))[0].order == 8
    assert fit_surface(s)[0].order == 3


def test_slices_measure_area_perimeter_and_axes() -> None:
    v = np.linspace(0, V_STOP, 20)
    strip = fit_bspline(v, np.tile([2.0, 0, 0], (20, 1)), np.ones(20), 4, V_STOP)
    area, perimeter, longer, shorter = measures(strip, 1.0)
    assert area == pytest.approx(4 * np.pi, rel=1e-9)
    assert perimeter == pytest.approx(4 * np.pi, rel=1e-9)
    assert longer == pytest.approx(2.0, rel=1e-6)
    assert shorter == pytest.approx(2.0, rel=1e-6)


def test_the_table_has_a_row_for_every_slice(banana: Surfaces) -> None:
    rows = slice_table(banana[0])
    assert len(rows) == len(banana[0].sections)
    assert rows[20]["equivalent_radius"] == pytest.approx(0.22, abs=0.01)


@pytest.mark.parametrize(("name", "caps"), [("banana", False), ("banana", True), ("torus", False)])
def test_the_mesh_is_closed_and_looks_outward(name: str, caps: bool) -> None:
    """Every edge twice, in opposite directions, but for open ends; volume by the divergence theorem is positive."""
    mesh = surface_mesh(fit_surface(skeleton(name))[0], caps=caps)
    sides = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])
    directed = {tuple(side) for side in sides.tolist()}
    assert len(directed) == len(sides)
    lonely = sum((b, a) not in directed for a, b in directed)
    assert lonely == (2 * 96 if name == "banana" and not caps else 0)
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    volume = (a * np.cross(b, c)).sum() / 6
    assert volume > 0
    if name == "torus":
        assert volume == pytest.approx(np.pi * 0.2**2 * 2 * np.pi * 0.7, rel=0.01)


def test_the_mesh_file_opens_elsewhere(banana: Surfaces) -> None:
    import io

    import trimesh

    mesh = surface_mesh(banana[0], caps=True)
    loaded: Any = trimesh.load(io.BytesIO(dump_mesh(mesh)), file_type="ply", process=False)
    assert len(loaded.faces) == len(mesh.triangles)
    assert loaded.is_watertight
    assert loaded.volume > 0
    assert len(parse(dump_mesh(mesh), "m.ply")["face"].data) == len(mesh.triangles)


def test_corners_of_tubes_say_where_they_are_and_how_the_surface_bends() -> None:
    """Of a torus of 0.7 and 0.2; u and v give the corners again, but for the middles of caps."""
    torus, banana = (fit_surface(skeleton(name)) for name in ("torus", "banana"))
    mesh = tubes_mesh(Surfaces((torus[0], banana[0]), {}, torus.cloud), caps=True)
    known = parse(dump_mesh(mesh), "m.ply")["vertex"].data
    one, other = (known[known["branch"] == number] for number in (0, 1))
    np.testing.assert_allclose(one["radius"], 0.2, rtol=0.01)
    np.testing.assert_allclose(one["curvature_max"], 1 / 0.2, rtol=0.05)
    assert one["curvature_min"].min() == pytest.approx(-1 / 0.5, rel=0.1)
    inner = other[np.isfinite(other["u"])]
    assert len(other) - len(inner) == 2
    corners = np.stack(banana[0].jet(inner["u"], inner["v"]).f, axis=1)
    np.testing.assert_allclose(np.stack([inner[axis] for axis in "xyz"], axis=1), corners, atol=1e-9)
    np.testing.assert_array_equal(one["scalar_radius"], one["radius"].astype(one["scalar_radius"].dtype))


def test_distances_to_a_mesh_are_those_to_its_triangles(banana: Surfaces) -> None:
    generator = np.random.default_rng(4)
    mesh = surface_mesh(banana[0])
    corners = mesh.vertices[mesh.triangles[::50]]
    weights = generator.dirichlet([1, 1, 1], len(corners))
    on = np.einsum("kc,kcd->kd", weights, corners)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    assert distances_to_mesh(on, mesh).max() < 1e-9
    # A hundredth away along the normal; neighbours can be nearer only by the bend of the mesh.
    np.testing.assert_allclose(distances_to_mesh(on + 0.001 * normals, mesh), 0.001, rtol=0.02)


def test_the_report_says_how_far_the_points_are(banana: Surfaces) -> None:
    off = banana[0].distance
    assert off == mesh_report(banana[0])
    assert 0 < off["mean"] <= off["p95"] <= off["max"] < 0.01 * banana[0].radius


def test_the_stage_file_gives_the_same_surface_back(banana: Surfaces, tmp_path: Any) -> None:
    write_surfaces(tmp_path / "s.json", banana, SurfaceParams())
    again = read_surfaces(tmp_path / "s.json")
    assert dump_surfaces(again) == dump_surfaces(banana)
    np.testing.assert_array_equal(again[0].jet(0.3, 1.1), banana[0].jet(0.3, 1.1))
    assert (tmp_path / "s.json").read_bytes() == dump_surfaces(banana, SurfaceParams())


def damaged(data: bytes, **changes: Any) -> bytes:
    document = json.loads(data)
    document.update(changes)
    return json.dumps(document).encode()


def test_broken_surface_files_end_with_one_line(banana: Surfaces) -> None:
    data = dump_surfaces(banana)
    one = json.loads(data)["surfaces"][0]
    broken = {
        "install a newer tiskel": damaged(data, format=2),
        "is not a surface file": damaged(data, stage="skeleton"),
        "holds no surface": damaged(data, surfaces=[]),
        "damaged surface file": damaged(data, surfaces=[{**one, "axis": [[0, 0, 0]]}]),
        "damaged": damaged(data, surfaces=[{**one, "rows": [10**6]}]),
        "different intervals": damaged(data, surfaces=[{**one, "series": one["series"][:-1]}]),
        "damaged surface": damaged(data, cloud="none"),
        "must be finite": damaged(data, surfaces=[{**one, "field": [[float("nan")] * 3] * len(one["field"])}]),
        "write one with tiskel slice": data[: len(data) // 2],
        "not a surface": b"[1, 2]",
    }
    for said, bad in broken.items():
        with pytest.raises(TiskelError, match=said):
            parse_surfaces(bad, "s.json")


def test_noise_holes_and_uneven_density_leave_a_surface() -> None:
    for degraded in ({"noise": 0.1}, {"missing": 0.2}, {"uneven": 10.0}, {"count": 1024}):
        surface = fit_surface(skeleton("banana", **degraded))[0]
        shape = shape_graph("banana")
        fitted = [s.v for s in surface.sections if s.case is Case.FITTED]
        u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 30), np.array(fitted))
        places: Points = np.stack(surface.jet(u, v).f, axis=-1).reshape(-1, 3)
        off = np.abs(union_distance(places, shape)) / surface.radius
        assert np.quantile(off, 0.9) < 0.06, degraded


@pytest.mark.parametrize(
    "wrong", [{"branch": "thumb"}, {"interval": 0.0}, {"m": (0, 0, 0)}, {"m": "up"}, {"least_order": 9}]
)
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(TiskelError):
        SurfaceParams(**wrong)


def rod(outline: Any, count: int = 5000) -> tuple[Curve, Points]:
    """A straight bar 12 long of an outline (k, 2), evenly strewn with points, and its middle line."""
    golden = np.mod(np.arange(count) * (np.sqrt(5) - 1) / 2, 1)
    closed = np.concatenate([outline, outline[:1]])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    at = golden * along[-1]
    plane = np.stack([np.interp(at, along, closed[:, k]) for k in (0, 1)], axis=1)
    cloud = np.column_stack([plane, np.linspace(0, 12, count)])
    line = np.column_stack([np.zeros((20, 2)), np.linspace(0.2, 11.8, 20)])
    return Curve(line, np.stack([np.arange(19), np.arange(1, 20)], axis=1).astype(np.int32)), cloud


TURN = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
BAR = np.array([[-3.0, -1], [3, -1], [3, 1], [-3, 1]])


def test_the_normals_of_an_ellipse_are_met_by_its_even_harmonics() -> None:
    """2 : 1 has no odd ones: a search that stops at the first order that does not help ends at 4, 10 degrees off."""
    curve, cloud = rod(np.stack([2 * np.cos(TURN), np.sin(TURN)], axis=1))
    surface = fit_surface(curve, cloud=cloud)[0]
    jet = surface.jet(*np.meshgrid(np.linspace(0, 2 * np.pi, 90), np.linspace(0.3, 2.8, 10)))
    place, normal = np.stack(jet.f), np.cross(np.stack(jet.f_u), np.stack(jet.f_v), axis=0)
    true = np.stack([place[0] / 4, place[1], 0 * place[0]])
    cosine = (normal * true).sum(axis=0) / np.linalg.norm(normal, axis=0) / np.linalg.norm(true, axis=0)
    assert surface.order == 8
    assert np.degrees(np.arccos(np.minimum(np.abs(cosine), 1))).max() < 3


def test_a_flat_bar_has_no_gap() -> None:
    curve, cloud = rod(BAR)
    surface = fit_surface(curve, cloud=cloud)[0]
    assert set(surface.cases()) == {"fitted"}
    assert surface.unseen == 0


def test_the_flat_end_of_a_bar_is_fitted_to_its_rim() -> None:
    """A face across the end, in the plane of the last slice: its points fill the section up to the middle."""
    generator = np.random.default_rng(2)
    u, r = np.concatenate([EVEN, generator.uniform(0, 2 * np.pi, 300)]), np.sqrt(generator.uniform(0, 1, 300))
    face = ring(u, np.concatenate([np.ones(81), r]))
    assert fit_section(1.0, face, 3, PARAMS).case is Case.NOT_STAR
    plain = ring(EVEN, np.ones(81))
    pairs = [(1.0, plain)] * 6 + [(1.0, face)]
    last = fit_sections(pairs, 3, PARAMS)[-1]
    assert last.case is Case.FITTED
    assert last.series[0] == pytest.approx(1, abs=0.05)
    assert fit_sections([*pairs, (1.0, plain)], 3, PARAMS)[-2].case is Case.NOT_STAR  # not at the end: no face


def test_an_unseen_side_is_rounded_off_and_marked() -> None:
    """A pipe of radius 1 off the curve by 0.2, 120 degrees of its turn unseen: there the surface is a circle, too."""
    curve, cloud = rod(np.stack([np.cos(TURN) + 0.2, np.sin(TURN)], axis=1), 12000)
    angle = np.arctan2(cloud[:, 1], cloud[:, 0] - 0.2)
    surface = fit_surface(curve, cloud=cloud[np.abs(angle) < np.radians(120)])[0]
    assert set(surface.cases()) == {"fitted"}
    assert surface.unseen == pytest.approx(1 / 3, abs=0.05)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 90), np.linspace(0.2, 2.9, 20))
    x, y, _ = surface.jet(u, v).f
    assert np.abs(np.hypot(x - 0.2, y) - 1).max() < 0.02
    trust = surface.trust(u, v)
    away = np.abs(np.abs(np.arctan2(y, x - 0.2)) - np.radians(120)) > 0.1
    np.testing.assert_array_equal(trust[away] == 2, (np.abs(np.arctan2(y, x - 0.2)) < np.radians(120))[away])
    marked = parse(dump_mesh(surface_mesh(surface)), "m.ply")["vertex"]["trust"]
    assert set(np.unique(marked)) == {1, 2}
    again = parse_surfaces(dump_surfaces(Surfaces((surface,), {}, cloud)), "s.json")[0]
    np.testing.assert_array_equal(again.trust(u, v), trust)


def test_a_section_says_its_true_reason() -> None:
    assert one_valued(ring(EVEN, np.ones(81)), 0.45)
    assert not one_valued(ring(np.tile(EVEN, 2), np.concatenate([np.ones(81), np.full(81, 3.0)])), 0.45)
    spikes = ring(np.tile(EVEN, 3), np.tile(np.where(np.arange(81) // 2 % 2, 0.3, 3.0), 3))
    assert fit_section(1.0, spikes, 3, replace(PARAMS, uneven=0.2)).case in (Case.ROUGH, Case.NOT_STAR)


def test_a_flat_section_beside_the_curve_has_its_middle_all_the_same() -> None:
    y, z = (rod(BAR + [4.0, 0.5])[1][:300, k] for k in (0, 1))
    beside = Ring(np.arange(300, dtype=np.int32), np.arctan2(z, y), np.ones(300), np.hypot(y, z))
    assert middle_of(beside) == pytest.approx((4.0, 0.5), abs=0.05)
    some = beside.part(z < 0)
    assert middle_of(some) == (0, 0)  # one side of it alone says nothing


def test_points_beyond_the_ends_are_no_misfit(banana: Surfaces) -> None:
    """A series that grows runs on without the points that the last slab sees beyond the end of the surface."""
    tube, count = banana[0].tube, 40
    u, v = np.tile(np.linspace(0, 6, count), 2), np.repeat([1.0, V_STOP + 0.5], count)
    r = np.where(v < V_STOP, tube.at(u, v)[1].R, 99.0)
    one = Ring(np.arange(2 * count, dtype=np.int32), u, v, r)
    rows, error = misfit(tube, [one], banana[0].sections[:1])
    assert (len(rows), error < 1e-12) == (count, True)


def test_coverage_tells_of_all_points(banana: Surfaces) -> None:
    """Both ends of a banana are rounded and have no slices; a block far away has none at all."""
    found = banana.coverage
    assert found is not None
    assert 0.8 < found.points < 1
    assert 0.8 < found.length <= 1.01
    off, relative = distances_to_surfaces(banana, banana.cloud)
    assert found.points == pytest.approx((relative <= 0.05).mean())
    assert found.radii["max"] == pytest.approx(relative.max())
    assert found.distance["p95"] == pytest.approx(np.quantile(off, 0.95))
    assert parse_surfaces(dump_surfaces(banana), "s.json").coverage == found


def test_files_without_coverage_are_read_as_before(banana: Surfaces) -> None:
    document = json.loads(dump_surfaces(banana))
    del document["coverage"]
    for one in document["surfaces"]:
        del one["unseen"]
        for part in one["sections"]:
            del part["gap_at"]
    old = parse_surfaces(json.dumps(document).encode(), "s.json")
    assert old.coverage is None
    assert (old[0].trust(np.array([0.3]), np.array([1.0])) == 2).all()


@pytest.mark.parametrize("count", [1, 40, 900])
def test_parts_are_those_of_all_pairs(count: int) -> None:
    generator = np.random.default_rng(count)
    for link in (0.02, 0.1, 0.3):
        plane = generator.normal(size=(9, 2))[generator.integers(0, 9, count)] + 0.1 * generator.normal(size=(count, 2))
        all_pairs = cKDTree(plane).query_pairs(link, output_type="ndarray")
        np.testing.assert_array_equal(parts_of(plane, link), component_labels(count, all_pairs))
