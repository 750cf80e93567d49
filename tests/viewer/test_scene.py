"""Scenes: what layers they have, that packing loses nothing that can be seen, and what is left out is said."""

import hashlib
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tiskel import ShapeParams, TiskelError, fit_surface, make_shape, roll, shape_graph, view
from tiskel.io.clouds import Cloud
from tiskel.params import LookParams, RollParams
from tiskel.skeleton import Skeleton
from tiskel.viewer.curves import MOST_POINTS
from tiskel.viewer.packed import STEPS, pack
from tiskel.viewer.page import asset
from tiskel.viewer.scene import Field, Layer, Remark, scene_of

NUMBERS = {"u8": np.uint8, "u16": "<u2", "u32": "<u4", "f32": "<f4"}


def unpacked(document: dict[str, Any], data: bytes) -> np.ndarray:
    return np.frombuffer(data, NUMBERS[document["type"]], document["count"], document["at"])  # type: ignore[call-overload, no-any-return]


@pytest.fixture(scope="module")
def banana() -> Skeleton:
    return make_shape(shape_graph("banana"), ShapeParams(count=900))[1]


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return make_shape(shape_graph("y"), ShapeParams(count=900))[1]


def test_places_and_values_come_back_within_a_step() -> None:
    """Far from the origin too: 16 bits are steps of the box, not of the coordinates."""
    rng = np.random.default_rng(0)
    places = rng.random((500, 3)) * [1, 20, 0.1] + [1e6, -3e5, 10]
    values = np.where(rng.random(500) < 0.1, np.nan, rng.normal(size=500))
    field, label = Field("v", values), Field("l", np.arange(500) % 3, labels=("a", "b", ""))
    scene = scene_of("t", [Layer("cloud", "points", "cloud", places, (field, label))], (), (), LookParams())
    document, data = pack(scene)
    layer = document["layers"][0]
    low, high = np.array(layer["box"])
    back = low + (high - low) * unpacked(layer["xyz"], data).reshape(-1, 3) / STEPS + document["centre"]
    assert np.abs(back - places).max(axis=0) == pytest.approx([0, 0, 0], abs=20 / STEPS)
    packed = layer["fields"][0]
    steps = unpacked(packed["values"], data)
    np.testing.assert_array_equal(steps == STEPS, np.isnan(values))
    known = packed["low"] + (packed["high"] - packed["low"]) * steps / (STEPS - 1)
    assert np.nanmax(np.abs(known - values)[steps < STEPS]) <= (packed["high"] - packed["low"]) / STEPS
    np.testing.assert_array_equal(unpacked(layer["fields"][1]["values"], data), label.values)


def test_arrays_begin_at_multiples_of_four(skeleton: Skeleton) -> None:
    """Browsers refuse views of 32 bits anywhere else."""
    document, _ = pack(view(skeleton).scene)
    found = re.findall(r'"at": (\d+)', json.dumps(document))
    assert len(found) > 8
    assert all(int(at) % 4 == 0 for at in found)


def test_a_large_cloud_is_thinned_and_said_and_strays_set_no_scale() -> None:
    cloud = np.random.default_rng(1).random((MOST_POINTS + 5000, 3))
    cloud[:3] = [[1e5, 0, 0], [0, 1e5, 0], [0, 0, -1e5]]
    scene = view(cloud).scene
    assert len(scene.layers[0].places) <= MOST_POINTS
    assert scene.said[0].startswith("100,000 of 105,000 points are shown")
    assert np.ptp(scene.body, axis=0).max() <= 1
    rows = scene.layers[0].more["rows"]
    np.testing.assert_array_equal(cloud[rows], scene.layers[0].places)


def test_layers_of_everything(banana: Skeleton) -> None:
    surfaces = fit_surface(banana)
    run = roll(surfaces.named(None), RollParams(duration=0.5))
    names = [layer.name for layer in view(banana, surfaces, run).scene.layers]
    assert names == ["cloud", "curve", "thickness", "surface", "slices", "rolling sphere, global"]


def test_branches_keep_their_colours_at_joints(skeleton: Skeleton) -> None:
    """The joint is there once for each branch, so no edge has two colours."""
    curve = next(layer for layer in view(skeleton).scene.layers if layer.kind == "curve")
    branch = next(field for field in curve.fields if field.name == "branch").values
    pairs = np.asarray(curve.more["edges"])
    np.testing.assert_array_equal(branch[pairs[:, 0]], branch[pairs[:, 1]])
    assert len(pairs) == len(skeleton.edges)
    assert len(np.unique(curve.places[np.asarray(curve.more["joint"], int)], axis=0)) == skeleton.junctions


def test_colours_and_properties_of_the_input_can_be_chosen() -> None:
    points = np.random.default_rng(2).random((50, 3))
    rgb = dict(zip(("red", "green", "blue"), np.arange(150, dtype=np.uint8).reshape(3, 50), strict=True))
    fields = view(Cloud(points, {**rgb, "intensity": np.arange(50.0)}, "c.ply")).scene.layers[0].fields
    assert [field.name for field in fields] == ["colour of the input", "intensity"]
    np.testing.assert_array_equal(fields[0].values[:, 1], rgb["green"])


def test_remarks_are_marks_at_their_places() -> None:
    remarks = [Remark("here <b>", "warning", np.zeros((2, 3))), Remark("everywhere", "note", np.zeros((0, 3)))]
    layers = [Layer("cloud", "points", "cloud", np.eye(3))]
    scene = scene_of("t", layers, remarks, (), LookParams())
    assert [layer.name for layer in scene.layers] == ["cloud", "warnings"]
    assert scene.layers[1].more["texts"] == ["here <b>", "here <b>"]


def test_no_name_and_no_warning_ends_an_element() -> None:
    """Everything between the first and the last script element is data; one of a name would be one more."""
    page = view(np.eye(3), title="</script><script>alert(1)</script>").html()
    assert page.count("</script>") == 3
    assert "<script>alert" not in page


def test_the_same_scene_gives_the_same_bytes(skeleton: Skeleton) -> None:
    assert view(skeleton).html() == view(skeleton).html()
    assert view(skeleton).dump(".png") == view(skeleton).dump(".png")


def test_a_notebook_gets_a_frame(skeleton: Skeleton) -> None:
    frame = skeleton._repr_html_()
    assert frame.startswith('<iframe srcdoc="&lt;!doctype html&gt;')
    assert frame.count("<") == 2


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_pictures_of_a_view(banana: Skeleton, suffix: str) -> None:
    surfaces = fit_surface(banana)
    starts = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}
    assert view(banana, surfaces).dump(suffix).startswith(starts[suffix])


def test_what_cannot_be_shown_is_refused() -> None:
    with pytest.raises(TiskelError, match="nothing to show"):
        view()
    with pytest.raises(TiskelError, match=r"cannot be written as '\.gif'"):
        view(np.eye(3)).dump(".gif")
    with pytest.raises(TiskelError, match="up must be one of"):
        view(np.eye(3), up="w")  # type: ignore[arg-type]


def test_the_script_is_made_of_its_sources() -> None:
    """Where this fails, run the recipe in tiskel/viewer/build."""
    sources = sorted((Path(__file__).parents[2] / "tiskel" / "viewer" / "build" / "src").iterdir())
    digest = hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()
    made = asset("viewer.js")
    assert f"sources {digest[:16]}" in made[:300]
    assert "http" not in made.replace("http://www.w3.org/", "")
    assert len(made) < 700_000
