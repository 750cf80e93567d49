"""Cells, duplicates, crowds and strays of large clouds, against plain ways to find them."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from tiskel import ShapeParams, make_shape, shape_graph
from tiskel.arrays import Points, first_of_duplicates
from tiskel.geometry import strays
from tiskel.geometry.cells import cell_numbers, numbered
from tiskel.methods.robust.wire.routes import FINER, _crowds, _one_of_each

GENERATOR = np.random.default_rng(4)
POINTS = GENERATOR.normal(size=(800, 3))


def test_cells_are_numbered_as_their_corners_sort() -> None:
    corners = GENERATOR.integers(0, 4, (200, 3))
    cells, number = numbered(corners)
    expected, inverse = np.unique(corners, axis=0, return_inverse=True)
    np.testing.assert_array_equal(cells, expected)
    np.testing.assert_array_equal(number, inverse.ravel())
    far = corners * 2**40  # more cells than a number of 64 bits counts
    np.testing.assert_array_equal(numbered(far)[1], number)
    np.testing.assert_array_equal(numbered(far)[0], expected * 2**40)


def test_points_of_one_cell_are_within_its_diagonal() -> None:
    number = cell_numbers(POINTS, 0.5)
    for cell in np.unique(number)[::20]:
        assert np.ptp(POINTS[number == cell], axis=0).max() <= 0.5


@pytest.mark.parametrize("scale", [1.0, 1e-300, 1e300], ids=str)
def test_the_first_of_duplicates_is_the_lowest_row_at_a_place(scale: float) -> None:
    points: Points = GENERATOR.integers(-2, 3, (300, 3)) * scale  # type: ignore[assignment]
    points[points == 0] *= np.where(GENERATOR.random((points == 0).sum()) < 0.5, -1.0, 1.0)  # both zeros are one place
    expected = (points[:, None] == points).all(axis=2).argmax(axis=1)
    np.testing.assert_array_equal(first_of_duplicates(points), expected)
    np.testing.assert_array_equal(first_of_duplicates(POINTS), np.arange(len(POINTS)))


def test_the_largest_crowds_are_counted_and_none_is_much_larger() -> None:
    """One point of each cell is asked: no other has more about it than one as far away as the cell is wide."""
    part = (GENERATOR.random(800) < 0.2).astype(np.int32)
    away = cdist(POINTS, POINTS)
    full, surely = (away <= 0.4).sum(axis=1), (away <= 0.4 - np.sqrt(3) * 0.4 / FINER).sum(axis=1)
    crowd = _crowds(POINTS, part, 0.4)
    for number in (0, 1):
        assert surely[part == number].max() <= crowd[part == number].max() <= full[part == number].max()
    assert ((crowd == full) | (crowd == 0)).all()
    assert (crowd == 0).any()  # or all were asked


def test_of_every_group_the_point_nearest_to_its_mean_is_taken() -> None:
    group = GENERATOR.integers(0, 30, 800) * 7
    order = GENERATOR.permutation(800)
    taken = _one_of_each(POINTS, group)
    assert group[taken].tolist() == np.unique(group).tolist()
    for row in taken:
        own = POINTS[group == group[row]]
        away = np.linalg.norm(own - own.mean(axis=0), axis=1)
        assert np.linalg.norm(POINTS[row] - own.mean(axis=0)) == pytest.approx(away.min())
    np.testing.assert_array_equal(order[_one_of_each(POINTS[order], group[order])], taken)


def with_strays(count: int) -> Points:
    body = make_shape(shape_graph("y"), ShapeParams(count=count))[0]
    box = np.ptp(body, axis=0)
    alone = body.mean(axis=0) + 5 * box.max() * np.eye(3)
    group = alone[0] * [1, -1, 1] + 0.01 * GENERATOR.normal(size=(5, 3))
    return np.concatenate([body, alone, group])


@pytest.mark.parametrize("count", [2000, 9000])
def test_large_clouds_have_the_same_strays_as_if_all_points_were_asked(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    cloud = with_strays(count)
    asked = strays.stray_points(cloud)
    assert asked.sum() > 1
    monkeypatch.setattr(strays, "MANY", 0)
    np.testing.assert_array_equal(strays.stray_points(cloud), asked)
