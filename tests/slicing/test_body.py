"""The surface of the whole body: near all points, smooth, closed, and the same wherever and however it is fitted."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from reference.fixtures import Load
from tiskel import (
    BodyParams,
    BodySurface,
    ShapeParams,
    Skeleton,
    SurfaceParams,
    Surfaces,
    TiskelError,
    Trust,
    contract,
    extract_skeleton,
    fit_body,
    fit_surface,
    fit_whole,
    make_shape,
    shape_graph,
)
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.mesh import TriangleMesh
from tiskel.geometry.round_cones import union_distance
from tiskel.io.mesh_file import dump_mesh
from tiskel.io.stages.surface import dump_surfaces, parse_surfaces
from tiskel.slicing.body import spread
from tiskel.slicing.body_mesh import body_mesh
from tiskel.surfaces.implicit import projected, tangency


def skeleton(name: str, **degraded: Any) -> Skeleton:
    return extract_skeleton(contract(make_shape(shape_graph(name), ShapeParams(**degraded))[0]))


@pytest.fixture(scope="module")
def torus() -> Surfaces:
    """Radius 0.2 about a circle of 0.7, with its tube."""
    return fit_whole(skeleton("torus"))


@pytest.fixture(scope="module")
def y() -> Surfaces:
    return fit_whole(skeleton("y"))


def whole(surfaces: Surfaces) -> BodySurface:
    assert surfaces.body is not None
    return surfaces.body


def places_off(body: BodySurface, count: int, seed: int = 4) -> np.ndarray:
    """Return places near the surface, at random up to a tenth of the radius off."""
    generator = np.random.default_rng(seed)
    rows = generator.permutation(len(body.cloud))[:count]
    return np.asarray(body.cloud[rows] + 0.1 * body.radius * generator.uniform(-1, 1, (count, 3)))


def test_gradient_and_hessian_are_the_derivatives(y: Surfaces) -> None:
    """Central differences; of the Hessian those of gradients. A lost term of the quotient rule is off by 0.1."""
    body, step = whole(y), 1e-5
    places = places_off(body, 200)
    here = body.level(places)
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        one, other = body.level(places + shift), body.level(places - shift)
        np.testing.assert_allclose((one.value - other.value) / (2 * step), here.gradient[:, axis], atol=1e-5)
        difference = (one.gradient - other.gradient) / (2 * step)
        np.testing.assert_allclose(difference, here.hessian[:, axis], atol=1e-3 * np.abs(here.hessian).max())


def test_the_hessian_is_continuous_across_the_borders_of_patches(y: Surfaces) -> None:
    """Along short ways through many borders its steps shrink as the steps of the way do."""
    body = whole(y)
    starts = projected(body, body.cloud[::97])
    largest = []
    for steps in (200, 400):
        way = np.linspace(0, 1, steps + 1)[:, None, None] * np.array([0.3, -0.2, 0.25]) * body.radius * 0.3
        bends = body.level((starts + way).reshape(-1, 3)).hessian.reshape(steps + 1, -1, 9)
        largest.append(float(np.nanmax(np.abs(np.diff(bends, axis=0)))))
    assert largest[1] < 0.65 * largest[0]


@pytest.mark.parametrize(("name", "most"), [("egg", 0.001), ("y", 0.01), ("hand", 0.02)])
def test_every_point_is_near_the_surface(name: str, most: float) -> None:
    body = whole(fit_whole(skeleton(name)))
    assert body.summary["mean"] < most
    assert body.summary["coverage"] > 0.98
    assert np.isfinite(body.distances).all()
    assert body.warnings == ()


def test_points_that_were_held_out_are_as_near() -> None:
    cloud = make_shape(shape_graph("y"), ShapeParams(noise=0.01))[0]
    body = fit_body(extract_skeleton(contract(cloud[::2])))
    held = np.linalg.norm(projected(body, cloud[1::2]) - cloud[1::2], axis=1) / body.radius
    assert held.mean() < 1.2 * body.summary["mean"] + 0.002


@pytest.mark.parametrize(("noise", "most"), [(0.0, 0.016), (0.01, 0.015)])
def test_curvatures_of_a_torus(noise: float, most: float) -> None:
    """In units of 1 / R, the mean of the larger error of both; without the tube six times as far off at most."""
    s = skeleton("torus", noise=noise)
    for surfaces, allowed in ((fit_surface(s), most), (None, 6 * most)):
        body = fit_body(s, surfaces)
        at = projected(body, s.cloud[::8])
        shape = tangency(body, at).shape
        around = np.hypot(at[:, 0], at[:, 1]) if np.ptp(at[:, 2]) < 0.6 else np.hypot(at[:, 0], at[:, 2])
        cosine = np.clip((around - 0.7) / 0.2, -1, 1)
        right = np.sort(np.stack([cosine / (0.7 + 0.2 * cosine), np.full(len(at), 5.0), np.zeros(len(at))]).T, axis=1)
        error = np.abs(np.linalg.eigvalsh(shape) - right).max(axis=1) * 0.2
        assert error.mean() < allowed


def test_ends_of_a_capsule_are_spheres() -> None:
    body = whole(fit_whole(skeleton("capsule")))
    top = body.cloud[np.argsort(body.cloud @ np.linalg.svd(body.cloud - body.cloud.mean(axis=0))[2][0])[-40:]]
    bends = np.sort(np.linalg.eigvalsh(tangency(body, projected(body, top)).shape), axis=1)[:, 1:]
    np.testing.assert_allclose(bends.mean(axis=0), 5.0, rtol=0.05)


def test_the_surface_moves_and_grows_with_the_cloud() -> None:
    """The same skeleton moved: function values are those of the same places, in the new unit.

    With noise: clean shapes are symmetric, and which of two points at one distance is a neighbour is up to rounding.
    """
    s, turn = skeleton("y", noise=0.01), Rotation.from_rotvec([0.4, 1.1, -0.3]).as_matrix()
    moved = replace(s, nodes=3 * s.nodes @ turn.T + 7, radii=3 * s.radii, cloud=3 * s.cloud @ turn.T + 7)
    one, other = fit_body(s), fit_body(moved)
    places = places_off(one, 300)
    np.testing.assert_allclose(
        other.level(3 * places @ turn.T + 7).value, 3 * one.level(places).value, atol=1e-6 * one.radius
    )


def test_the_mesh_is_closed_and_has_the_handles_of_the_body(torus: Surfaces) -> None:
    mesh = body_mesh(whole(torus))
    solid = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert solid.is_watertight
    assert solid.is_winding_consistent
    assert solid.euler_number == 0
    assert solid.volume == pytest.approx(2 * np.pi**2 * 0.7 * 0.2**2, rel=0.01)
    assert np.abs(whole(torus).level(mesh.vertices).value).max() < 1e-6
    assert mesh.trust is not None
    assert np.mean(mesh.trust == Trust.MEASURED) > 0.95
    assert np.median(mesh.curvatures[:, 1]) == pytest.approx(5.0, rel=0.02)
    loaded: Any = trimesh.load(trimesh.util.wrap_as_stream(dump_mesh(mesh)), file_type="ply", process=False)
    assert len(loaded.faces) == len(mesh.triangles)


def test_where_there_is_more_surface_than_expected_triangles_are_longer(
    torus: Surfaces, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A crown with hardly a patch on its twigs is closed by four times the surface that they have."""
    usual = body_mesh(whole(torus))
    monkeypatch.setattr("tiskel.slicing.body_mesh.BEYOND", 0.05)
    mesh = body_mesh(whole(torus))
    assert len(mesh.triangles) < 5 * 0.05 * 60_000 < len(usual.triangles)
    assert mesh.edge == pytest.approx(usual.edge * 2, rel=0.5)
    assert trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False).is_watertight


def test_the_mesh_of_a_y_is_a_ball_where_the_shape_is(y: Surfaces) -> None:
    mesh = body_mesh(whole(y))
    assert trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False).euler_number == 2
    off = np.abs(union_distance(mesh.vertices, shape_graph("y"))) / whole(y).radius
    assert np.quantile(off, 0.95) < 0.03  # seams of the union are sharp, those of the surface are not


def test_twigs_that_triangles_do_not_show_are_told() -> None:
    """A twig of radius 0.04 from a trunk of 0.5, between the places of the grid that thin parts of it ask for."""
    generator = np.random.default_rng(0)
    u, w = generator.uniform(0, 2 * np.pi, 3000), generator.uniform(0, 2 * np.pi, 300)
    trunk = np.stack([0.5 * np.cos(u), 0.5 * np.sin(u), generator.uniform(0, 2, 3000)], axis=1)
    twig = np.stack([generator.uniform(0.5, 1.5, 300), 0.055 + 0.04 * np.cos(w), 1.055 + 0.04 * np.sin(w)], axis=1)
    along = np.linspace(0, 2, 9)[:, None]
    nodes = np.concatenate([along * [0, 0, 1.0], [0.5, 0.055, 1.055] + along * [0.5, 0, 0]])
    edges = np.array([*zip(range(8), range(1, 9), strict=True), (4, 9), *zip(range(9, 17), range(10, 18), strict=True)])
    curve = CurveGraph(nodes, edges.astype(np.int32), np.repeat([0.5, 0.04], 9))
    body = fit_body(curve, cloud=np.concatenate([trunk, twig]))
    coarse, fine = body_mesh(body, 0.2), body_mesh(body, 0.05)
    assert 0.02 < coarse.lost < 0.1
    assert "the mesh lacks" in coarse.warnings[0]
    assert "--edge" in coarse.warnings[0]
    assert fine.lost < 0.001  # one of the patches at its tip
    assert fine.warnings == ()
    assert fine.vertices[:, 0].max() > 1.45
    assert len(TriangleMesh(fine.vertices, fine.triangles).halves.free) == 0


def test_a_gap_is_closed_and_marked() -> None:
    """A capsule without the points on one side of its middle: closed there, near where it was, and bridged."""
    s = skeleton("capsule")
    middle = np.median(s.cloud, axis=0)
    axis = np.linalg.svd(s.cloud - middle)[2][0]
    side = np.cross(axis, [1.0, 0, 0] if abs(axis[0]) < 0.9 else [0, 1.0, 0])
    side /= np.linalg.norm(side)
    gone = (np.abs((s.cloud - middle) @ axis) < 0.15) & ((s.cloud - middle) @ side > 0.12)
    body = fit_body(replace(s, cloud=np.ascontiguousarray(s.cloud[~gone]), node_of_point=s.node_of_point[~gone]), None)
    lost = s.cloud[gone]
    deep = lost[np.abs((lost - middle) @ axis) < 0.05]
    feet = projected(body, deep)
    assert np.linalg.norm(feet - deep, axis=1).max() < 0.35 * body.radius
    assert (body.trust(feet) == Trust.BRIDGED).mean() > 0.9
    assert 0 < body.share(Trust.BRIDGED) < 0.2
    mesh = body_mesh(body)
    assert trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False).is_watertight


def test_beyond_all_patches_nothing_is_known(y: Surfaces) -> None:
    far = np.full((1, 3), 50.0)
    assert np.isnan(whole(y).level(far).value).all()
    assert np.isnan(whole(y).local_radius(far)).all()
    assert whole(y).trust(far)[0] == Trust.BRIDGED


def test_tubes_give_patches_where_they_fit(torus: Surfaces) -> None:
    """Outside the bend slabs spread, and a fifth of the points lies between them: these are the tube's all the same."""
    assert whole(torus).of_tubes > 0.95
    assert whole(fit_whole(skeleton("egg"), SurfaceParams(interval=0.2))).of_tubes == 0


def test_the_stage_file_gives_the_same_surface_back(y: Surfaces) -> None:
    data = dump_surfaces(y)
    again = parse_surfaces(data, "s.json")
    assert dump_surfaces(again) == data
    places = places_off(whole(y), 100)
    for ours, theirs in zip(whole(y).level(places), whole(again).level(places), strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert parse_surfaces(dump_surfaces(replace(y, body=None)), "s.json").body is None
    older = {key: value for key, value in json.loads(data).items() if key != "body"}
    assert parse_surfaces(json.dumps(older).encode(), "s.json").body is None


def test_damaged_surfaces_of_bodies_are_refused(y: Surfaces) -> None:
    document = json.loads(dump_surfaces(y))
    body = document["body"]
    parts, count = body["patches"], len(whole(y).patches)
    for wrong, said in (
        ({**body, "distances": [0.0]}, f"1 distances of {len(y.cloud)} points"),
        ({**body, "patches": {**parts, "supports": [0.0] * count}}, "the support of a patch must be positive"),
        ({**body, "patches": {**parts, "values": [1.0]}}, "columns of patches have different lengths, or none"),
        ({**body, "patches": {key: [] for key in parts}}, "columns of patches have different lengths, or none"),
        ({**body, "patches": {**parts, "radii": [None] * count}}, "radii of patches must be finite numbers, one row"),
        ({**body, "patches": {**parts, "radii": [[1.0]] * count}}, "radii of patches must be finite numbers, one row"),
        ({key: value for key, value in body.items() if key != "radius"}, "there is no 'radius'"),
    ):
        with pytest.raises(TiskelError) as error:
            parse_surfaces(json.dumps({**document, "body": wrong}).encode(), "s.json")
        assert str(error.value).startswith(f"s.json is a damaged surface file: {said}")


def test_a_cloud_of_more_points_is_thinned_and_all_distances_are_told() -> None:
    s = skeleton("egg", count=3000)
    body = fit_body(s, None, BodyParams(most=1000))
    assert len(body.patches) <= 1000
    assert np.isfinite(body.distances).all()
    assert body.summary["coverage"] == 1.0


def test_a_curve_without_cloud_is_refused() -> None:
    with pytest.raises(TiskelError, match="needs the cloud"):
        fit_body(shape_graph("y"))


@pytest.mark.parametrize("wrong", [{"neighbours": (5, 8)}, {"neighbours": (20, 12)}, {"spread": 2.0}, {"most": 3}])
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(TiskelError):
        BodyParams(**wrong)


def test_spread_leaves_no_point_alone() -> None:
    points = np.random.default_rng(4).uniform(size=(300, 3))
    apart = np.random.default_rng(5).uniform(0.05, 0.2, 300)
    rows = spread(points, apart)
    near = np.linalg.norm(points[:, None] - points[rows], axis=2) <= apart[rows]
    assert near.any(axis=1).all()


@pytest.mark.slow
def test_one_thread_and_two_give_the_same_bytes(tmp_path: Path) -> None:
    code = "import sys; from tiskel import *; from tiskel.io.stages.surface import dump_surfaces\n"
    code += "s = extract_skeleton(contract(make_shape(shape_graph('y'), ShapeParams(noise=0.01))[0]))\n"
    code += "sys.stdout.buffer.write(dump_surfaces(fit_whole(s)))"
    made = [
        subprocess.run(
            [sys.executable, "-c", code], check=True, capture_output=True, env={**os.environ, "TISKEL_NUM_THREADS": n},
        ).stdout
        for n in ("1", "2")
    ]  # fmt: skip
    assert made[0] == made[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "mean", "p95", "coverage"),
    [("hammer", 0.01, 0.04, 0.9), ("joint", 0.005, 0.02, 0.9), ("fertility", 0.01, 0.04, 0.9),
     ("cave", 0.02, 0.06, 0.9), ("horse", 0.04, 0.12, 0.75)],
)  # fmt: skip
def test_the_reference_clouds_are_met(
    reference_cloud: Load, name: str, mean: float, p95: float, coverage: float
) -> None:
    body = whole(fit_whole(extract_skeleton(contract(reference_cloud(name)))))
    found = body.summary
    assert found["mean"] < mean
    assert found["p95"] < p95
    assert found["coverage"] > coverage
