"""Layers of what is seldom: nodes without edges, bridges, meshes, measures that are missing, one cloud twice."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tiskel import CurveGraph, ShapeParams, evaluate, make_shape, shape_graph, view
from tiskel.io.anything import MeasureFile, MeshFile
from tiskel.io.clouds import Cloud
from tiskel.params import LookParams
from tiskel.skeleton import Skeleton
from tiskel.viewer.curves import curve_layers, skeleton_layers
from tiskel.viewer.measured import measure_field, measured_by, measured_in
from tiskel.viewer.packed import pack, value_span
from tiskel.viewer.scene import Field, Layer, scene_of

POINTS = np.random.default_rng(3).random((60, 3))
NONE = np.zeros((0, 2), np.int32)


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return make_shape(shape_graph("y"), ShapeParams(count=900))[1]


def test_nodes_without_edges_are_points_and_none_are_nothing() -> None:
    (layer,) = curve_layers(CurveGraph(POINTS, NONE))
    assert (layer.name, layer.kind) == ("nodes", "points")
    np.testing.assert_array_equal(layer.places, POINTS)
    assert curve_layers(CurveGraph(POINTS[:0], NONE)) == []


def test_a_skeleton_without_a_curve_shows_its_cloud(skeleton: Skeleton) -> None:
    lost = np.full(len(skeleton.cloud), -1, np.int32)
    empty = Skeleton(POINTS[:0], NONE, node_of_point=lost, cloud=skeleton.cloud, input_rows=skeleton.input_rows,
                     contracted=POINTS, origin=POINTS, rows=np.arange(60, dtype=np.int32))  # fmt: skip
    layers, said = skeleton_layers(empty)
    assert [layer.name for layer in layers] == ["cloud", "contracted points"]
    assert layers[0].fields == ()
    assert len(layers[0].places) == len(skeleton.cloud)
    assert said == ""
    assert [field.name for field in skeleton_layers(skeleton)[0][0].fields] == ["branch", "radius"]


def test_bridges_are_a_layer_of_their_own() -> None:
    path = CurveGraph(np.eye(4, 3), np.array([[0, 1], [1, 2], [2, 3]], np.int32), bridged=np.array([0, 1, 0], bool))
    bridges = curve_layers(path)[-1]
    assert (bridges.name, bridges.kind) == ("bridges over gaps", "lines")
    np.testing.assert_array_equal(bridges.places, path.nodes[[1, 2]])
    np.testing.assert_array_equal(bridges.more["counts"], [2])
    assert [layer.name for layer in curve_layers(replace(path, bridged=np.zeros(3, bool)))] == ["curve"]


def test_of_a_measured_file_the_curve_takes_only_what_is_there() -> None:
    """Samples are at 0, 1, 2 and 3 of the curve, vertices there are none."""
    places = np.array([[9.0, 9, 9], *([x, 0, 0] for x in range(4))])
    columns = {"of_curve": np.array([0.0, 1, 1, 1, 1]), "beta": np.array([0.5, 0.1, 0.2, 0.3, 0.4]),
               "smoothness": np.full(5, np.nan)}  # fmt: skip
    measured = measured_in(places, columns)
    none = (POINTS[:0], (measure_field("smoothness", np.zeros(0)),))
    measured = replace(measured, of_curve=(*measured.of_curve, none))
    line = CurveGraph(np.array([[0.1, 0, 0], [2.9, 0, 0]]), np.array([[0, 1]], np.int32))
    field = next(field for field in curve_layers(line, measured)[0].fields if field.name == "beta")
    np.testing.assert_array_equal(field.values, [0.1, 0.4])
    assert "smoothness" not in [one.name for one in curve_layers(line, measured)[0].fields]


def test_measures_without_points_or_without_a_curve() -> None:
    cloud, true = make_shape(shape_graph("capsule"), ShapeParams(count=300))
    both = evaluate(cloud, cloud[::4] * 0.9, true.nodes, true.edges)
    of_points = measured_by(replace(both, curve=None))
    assert len(of_points.points) == 75
    assert "beta" in [field.name for field in of_points.of_points]
    assert of_points.of_curve == ()
    of_curve = measured_by(replace(both, points=None))
    assert (len(of_curve.points), of_curve.of_points, len(of_curve.of_curve)) == (0, (), 2)


def test_one_cloud_of_two_things_is_shown_once_with_what_is_known_of_it(skeleton: Skeleton) -> None:
    """The cloud by itself has no fields; the one of the skeleton has two, under the first's name."""
    layers = view(Cloud(skeleton.cloud, {}, "plant.ply"), skeleton).scene.layers
    clouds = [layer for layer in layers if layer.role == "cloud"]
    assert [layer.name for layer in clouds] == ["plant.ply"]
    assert [field.name for field in clouds[0].fields] == ["branch", "radius"]
    other = view(Cloud(POINTS, {}, "a"), Cloud(POINTS[::-1], {}, "b")).scene.layers
    assert [layer.name for layer in other] == ["a", "b"]


def test_what_is_left_out_is_said_once() -> None:
    stray = np.concatenate([POINTS, [[1e5, 0, 0]]])
    said = view(Cloud(stray, {}, "a"), Cloud(stray[::-1], {}, "b")).scene.said
    assert said == ("1 stray points are not shown",)


def test_a_mesh_is_shown_with_its_faces_and_gives_the_title() -> None:
    mesh = MeshFile("pot.ply", np.eye(4, 3), np.array([[0, 1, 2], [1, 2, 3]], np.int32))
    scene = view(mesh).scene
    assert (scene.title, [layer.kind for layer in scene.layers]) == ("pot.ply", ["mesh"])
    np.testing.assert_array_equal(np.reshape(scene.layers[0].more["triangles"], (-1, 3)), mesh.faces)


def test_measures_alone_are_shown_at_their_points() -> None:
    columns = {"of_curve": np.zeros(60), "beta": np.linspace(0, 1, 60)}
    layers = view(MeasureFile("m.ply", POINTS, columns), Cloud(POINTS + 5, {}, "a")).scene.layers
    assert [layer.name for layer in layers] == ["measured points", "a"]
    np.testing.assert_array_equal(layers[0].fields[0].values, columns["beta"])


def test_colours_are_packed_as_bytes_and_a_field_of_nothing_from_0_to_1() -> None:
    rgb = Field("rgb", np.arange(180, dtype=np.uint8).reshape(60, 3))
    nothing = Field("v", np.full(60, np.nan))
    layer = Layer("cloud", "points", "cloud", POINTS, (rgb, nothing))
    document, data = pack(scene_of("t", [layer], (), (), LookParams()))
    head: Any
    head, empty = document["layers"][0]["fields"]
    assert head["rgb"] is True
    at = head["values"]["at"]
    assert data[at : at + 180] == rgb.values.tobytes()
    assert (empty["low"], empty["high"], empty["colours"]) == (0.0, 1.0, [0.0, 1.0])
    assert value_span(nothing) == (0.0, 1.0)
