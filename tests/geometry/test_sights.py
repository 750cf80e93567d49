"""Views are turns, never mirror images, and up is where the rule says."""

import numpy as np
import pytest

from tiskel.geometry.views import AXES, View, broad_view, eye_direction, screen_axes, up_axis, views
from tiskel.params.look import Up


def directions(view: View) -> np.ndarray:
    """Return (3, 3) the unit vectors to the right, upwards and towards the eye."""
    made = np.zeros((3, 3))
    for row, (axis, sign) in enumerate(zip((*view.axes, view.towards[0]), (*view.signs, view.towards[1]), strict=True)):
        made[row, axis] = sign
    return made


@pytest.mark.parametrize("up", AXES)
def test_no_view_is_a_mirror_image(up: str) -> None:
    """Right, up and towards the eye are right-handed; a mirrored picture would have determinant -1."""
    for view in views(up):
        for one in (view, view.behind()):
            assert np.linalg.det(directions(one)) == 1
        assert view.up == up == view.behind().up
        assert view.behind().behind().towards == view.towards


@pytest.mark.parametrize("up", AXES)
def test_upright_views_have_up_upwards_and_top_looks_down(up: str) -> None:
    front, side, top = views(up)
    for view in (front, side):
        assert directions(view)[1][AXES.index(up)] == 1
    assert directions(top)[2][AXES.index(up)] == 1


def test_third_angle_top_and_front_share_the_axis_across() -> None:
    for up in AXES:
        front, side, top = views(up)
        assert (front.axes[0], front.signs[0]) == (top.axes[0], top.signs[0])
        assert (side.axes[0], side.signs[0]) == (top.axes[1], top.signs[1])


@pytest.mark.parametrize(
    ("low", "wanted"), [((0, 0, 0), "z"), ((-1, 0, -1), "y"), ((-1, -1, 0), "z"), ((5, 5, 5), "z")]
)
def test_auto_is_z_but_y_where_the_cloud_stands_on_it(low: tuple[float, ...], wanted: str) -> None:
    cloud = np.random.default_rng(1).random((500, 3)) * 2
    cloud[:8] = np.array(np.meshgrid([0, 2], [0, 2], [0, 2])).reshape(3, -1).T  # the corners of the box
    assert up_axis(cloud + low) == wanted
    assert up_axis(cloud + low, "x") == "x"


def test_auto_does_not_depend_on_the_unit() -> None:
    cloud = np.random.default_rng(2).random((500, 3)) - [0.5, 0, 0.5]
    assert {up_axis(cloud * unit) for unit in (1e-3, 1.0, 1e6)} == {"y"}


def test_the_broad_view_shows_the_largest_box() -> None:
    box = np.random.default_rng(3).random((300, 3))
    for sizes, wanted in (((5, 1, 4), "front"), ((1, 5, 4), "side"), ((5, 4, 1), "top")):
        assert broad_view(box * sizes, "z").name == wanted


@pytest.mark.parametrize("up", AXES)
def test_the_eye_is_above_and_its_axes_are_right_handed(up: Up) -> None:
    cloud = np.random.default_rng(4).random((200, 3)) * [1, 2, 3]
    eye = eye_direction(cloud, up)
    axes = screen_axes(eye, up)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert eye[AXES.index(up)] > 0.2
    assert axes[1][AXES.index(up)] > 0.9  # up in space is up in the picture
