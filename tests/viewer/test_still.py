"""The still picture, piece by piece: colours, lines, faces and their shade, and what is said beside them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.colors import to_rgb

from tiskel.params import LookParams
from tiskel.pictures.canvas import new_figure
from tiskel.pictures.style import CATEGORIES, CLOUD, SCALE, faded
from tiskel.viewer.scene import Field, Layer, Scene, scene_of
from tiskel.viewer.still import SHADE, _colours, _Eye, _faces, _lines, _mesh, still

PLACES = np.random.default_rng(0).random((40, 3)) * [3, 2, 1]
CUBE = np.stack(np.meshgrid([-1.0, 1], [-1.0, 1], [-1.0, 1], indexing="ij"), axis=-1).reshape(-1, 3)


def cloud(*fields: Field) -> Layer:
    return Layer("cloud", "points", "cloud", PLACES, fields)


def scene(layer: Layer, colour: str = "", unit: str = "") -> Scene:
    return replace(scene_of("t", [layer], (), (), LookParams(up="z", unit=unit)), colour=colour)


def panel() -> Any:
    return new_figure(4, 4).add_subplot()


@pytest.mark.parametrize(
    ("field", "expected"),
    [
        (None, [to_rgb(CLOUD)] * 3),
        (Field("rgb", np.array([[255, 0, 0], [0, 51, 0], [0, 0, 0]], np.uint8)), [(1, 0, 0), (0, 0.2, 0), (0, 0, 0)]),
        (Field("branch", np.array([0, 1, 8]), labels=tuple("abcdefghi")), [to_rgb(CATEGORIES[i]) for i in (0, 1, 0)]),
        (Field("v", np.array([0.0, 1, 3]), span=(0.0, 2.0)), [colormaps[SCALE](x)[:3] for x in (0.0, 0.5, 1.0)]),
        (Field("v", np.full(3, 7.0)), [colormaps[SCALE](0.0)[:3]] * 3),
    ],
    ids=["plain", "of the input", "labels", "numbers", "one number"],
)
def test_every_kind_of_field_has_its_colours(field: Field | None, expected: Any) -> None:
    layer = Layer("cloud", "points", "cloud", np.zeros((3, 3)))
    np.testing.assert_allclose(_colours(layer, field), expected, atol=1e-12)


def test_lines_of_a_layer_are_not_joined_to_one_another() -> None:
    layer = Layer("bridges", "lines", "note", PLACES[:5], more={"counts": np.array([2, 3], np.uint32)})
    eye, drawn = _Eye(scene(cloud())), panel()
    _lines(drawn, layer, eye, np.zeros((5, 3)), 100)
    found = {tuple(np.round(part, 9).ravel()) for part in drawn.collections[0].get_segments()}
    flat = eye.flat(PLACES[:5])[0]
    assert found == {tuple(np.round(flat[[a, a + 1]], 9).ravel()) for a in (0, 2, 3)}


@pytest.mark.parametrize(("closed", "count"), [(True, 6), (False, 3)])
def test_faces_of_grids_close_around_and_along_where_they_should(closed: bool, count: int) -> None:
    """Two grids of two rows of three corners: bands of three faces, and as many back for a loop."""
    layer = Layer("tube", "mesh", "tube", np.zeros((12, 3)), more={"grids": [(2, 3, closed), (2, 3, False)]})
    faces = _faces(layer)
    assert faces.shape == (count + 3, 4)
    assert faces[2].tolist() == [2, 0, 3, 5]  # around, back to the first corner
    assert faces[count:].min() == 6  # those of the second grid
    assert (faces[:count].max(), faces.max()) == (5, 11)


def test_faces_are_drawn_from_far_to_near_and_those_towards_the_light_are_brighter() -> None:
    """Of a cube every side is drawn; its depths are those that the corners have."""
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])
    layer = Layer("mesh", "mesh", "surface", CUBE, more={"triangles": triangles.ravel()})
    eye, drawn = _Eye(scene(layer)), panel()
    _mesh(drawn, layer, eye, np.ones((8, 3)) * 0.5, 100)
    collection = drawn.collections[0]
    _, depth = eye.flat(CUBE)
    order = np.argsort(depth[triangles].mean(axis=1))
    corners = np.array([path.vertices[:3] for path in collection.get_paths()])
    np.testing.assert_allclose(corners, eye.flat(CUBE)[0][triangles[order]])
    # The shade by itself: colours of 0.5 with no light are SHADE of that, with all of it 0.5.
    painted = collection.get_facecolor()[:, 0]
    near = depth[triangles[order, 0]]
    dark, bright = (faded(np.full((12, 3), 0.5 * share), near)[:, 0] for share in (SHADE, 1.0))
    assert (painted >= dark - 1e-9).all()
    assert (painted <= bright + 1e-9).all()
    shares = (painted - dark) / (bright - dark)
    assert np.ptp(shares) > 0.2
    pairs = {tuple(sorted(sides[row // 2])): [] for row in range(12)}  # type: ignore[var-annotated]
    for place, row in enumerate(order):
        pairs[tuple(sorted(sides[row // 2]))].append(shares[place])
    assert all(np.ptp(two) < 1e-9 for two in pairs.values())  # one side has one shade


@pytest.mark.parametrize(
    ("field", "unit", "label"),
    [
        (Field("thick", PLACES[:, 0], "how thick", length=True), "mm", "how thick, mm"),
        (Field("thick", PLACES[:, 0], length=True), "", "thick"),
        (Field("thick", PLACES[:, 0], "how thick"), "mm", "how thick"),
        (Field("thick", np.zeros(40, int), labels=("a",)), "mm", None),
        (Field("thick", np.zeros((40, 3), np.uint8)), "mm", None),
    ],
    ids=["lengths", "without a unit", "no lengths", "labels", "colours"],
)
def test_a_bar_tells_what_the_colours_are(field: Field, unit: str, label: str | None) -> None:
    """matplotlib notes every text in a comment of its SVG."""
    drawn = still(scene(cloud(field), "thick", unit), "svg").decode()
    assert (f"<!-- {label} -->" in drawn) == (label is not None)
    assert ("how thick" in drawn or "<!-- thick" in drawn) == (label is not None)
    assert "how thick" not in still(scene(cloud(field), "", unit), "svg").decode()
