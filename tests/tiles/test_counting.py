"""Cells are the same however a cloud comes, and tell its spacing, its objects and how thick it is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse.csgraph import connected_components
from scipy.spatial import distance_matrix

from tiskel import ShapeParams, TiskelError, make_shape, named_shape
from tiskel.arrays import Points
from tiskel.geometry.spacing import spacing_of
from tiskel.tiles import cells
from tiskel.tiles.cells import CellGrid, Counting, cells_of
from tiskel.tiles.margin import radius_of
from tiskel.tiles.objects import CellLookup, connecting, objects_of


def grid_of(points: Points, pieces: int = 1, **settings: float) -> CellGrid:
    counting = Counting(**settings)  # type: ignore[arg-type]
    for piece in np.array_split(points, pieces):
        counting.add(piece)
    return counting.grid()


def cloud_of(name: str, count: int, noise: float = 0.0) -> Points:
    return make_shape(named_shape(name), ShapeParams(count=count, noise=noise))[0]


def test_counts_and_means_are_those_of_the_points_in_each_cell() -> None:
    points = np.random.default_rng(0).normal(size=(500, 3)) * [1, 2, 3]
    grid = grid_of(points, side=0.7)
    for corner, count, mean in zip(grid.corners, grid.counts, grid.means, strict=True):
        inside = (np.floor(points / 0.7) == corner).all(axis=1)
        assert count == inside.sum()
        np.testing.assert_allclose(mean, points[inside].mean(axis=0))
    assert grid.counts.sum() == 500


def test_pieces_do_not_matter_and_cells_grow_until_they_are_few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cells, "PENDING", 100)
    points = np.random.default_rng(1).uniform(-5, 5, (3000, 3))
    whole, parts = grid_of(points, most=300), grid_of(points, 7, most=300)
    assert len(whole.counts) <= 300
    assert whole.side == parts.side
    np.testing.assert_array_equal(whole.corners, parts.corners)
    np.testing.assert_array_equal(whole.counts, parts.counts)
    np.testing.assert_array_equal(whole.corners, np.unique(cells_of(points, whole.side), axis=0))


def test_a_sentinel_far_away_costs_cells_and_nothing_else() -> None:
    grid = grid_of(np.concatenate([np.eye(3), [[1e30, 0, 0]]]), 2)
    assert grid.counts.sum() == 4


def test_cells_that_must_not_grow_are_an_error_where_they_are_too_many() -> None:
    with pytest.raises(TiskelError, match="larger gap"):
        grid_of(np.arange(30.0).reshape(10, 3), side=0.5, most=5)
    with pytest.raises(TiskelError, match="nothing to split"):
        grid_of(np.zeros((0, 3)))


@pytest.mark.parametrize("name", ["hand", "knot", "flat-tube"])
def test_spacing_is_that_of_the_library_within_a_third(name: str) -> None:
    """Between clouds of one point a cell and of many: the size of the cells does not matter."""
    for count in (5000, 40000):
        points = cloud_of(name, count)
        for most in (2000, 1 << 20):
            assert grid_of(points, most=most).spacing() == pytest.approx(spacing_of(points), rel=0.33)


@given(st.integers(0, 10_000))
def test_objects_are_what_a_gap_does_not_part(seed: int) -> None:
    """Against single linkage: what is within a side hangs together, what is 3.5 sides from all else does not."""
    points = np.random.default_rng(seed).uniform(0, 12, (60, 3))
    grid = grid_of(points, side=1.0)
    label = CellLookup(grid, objects_of(grid)).of(points)
    apart = distance_matrix(points, points)
    for reach in (1.0, np.sqrt(12)):
        of_reach = connected_components(apart <= reach, directed=False)[1]
        same = of_reach[:, None] == of_reach
        ours = label[:, None] == label
        assert not (same & ~ours).any() if reach == 1.0 else not (ours & ~same).any()
    assert (np.diff(np.bincount(label)) <= 0).all()  # the largest first


def test_objects_of_a_scene_and_of_a_surface_with_random_points() -> None:
    """A random sample of a surface has holes of two spacings; cells of three spacings bridge them."""
    points = cloud_of("hand", 20000)
    both = np.concatenate([points, points + [3.0, 0, 0]])
    grid = grid_of(both)
    labels = objects_of(connecting(grid, grid.spacing()))
    assert labels.max() == 1


@pytest.mark.parametrize("noise", [0.0, 0.05])
@pytest.mark.parametrize("name", ["knot", "hand", "y"])
def test_the_radius_of_the_thickest_limb_is_found(name: str, noise: float) -> None:
    """Clean, and with noise of a twentieth of the thinnest limb; between fingers there is more room than in them."""
    grid = grid_of(cloud_of(name, 20000, noise))
    assert radius_of(grid, grid.spacing()) == pytest.approx(named_shape(name).radii.max(), rel=0.3)
