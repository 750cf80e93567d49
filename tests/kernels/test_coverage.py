"""Coverage of the sphere of directions, and slabs, against plain implementations."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from reference.quality import cell_of, covered_cells
from tiskel.arrays import Points
from tiskel.kernels import coverage as kernel
from tiskel.metrics import boundedness, hulls
from tiskel.metrics.centredness import slab_members

AREAS = boundedness.cell_areas(kernel.SIDE)


def cells(directions: Points) -> np.ndarray:
    out = np.empty(len(directions), np.int32)
    kernel.cells(np.zeros((1, 3)), directions, out)
    return out


def test_cells_of_directions() -> None:
    generator = np.random.default_rng(8)
    directions = np.concatenate([generator.normal(size=(3000, 3)), np.eye(3), -np.eye(3), np.ones((1, 3))])
    assert cells(directions).tolist() == [cell_of(d, kernel.SIDE) for d in directions]
    assert cells(np.zeros((1, 3))).tolist() == [-1]


def test_cell_centres_and_areas_belong_to_the_cells() -> None:
    generator = np.random.default_rng(8)
    centres = hulls.cell_centres(kernel.SIDE)
    assert cells(centres).tolist() == list(range(kernel.CELLS))
    assert AREAS.sum() == pytest.approx(1, abs=1e-12)
    directions = generator.normal(size=(200_000, 3))
    share = np.bincount(cells(directions), minlength=kernel.CELLS) / len(directions)
    # A binomial count of 500 has a deviation of 22, in 384 cells hardly beyond 4 of them.
    assert np.abs(share / AREAS - 1).max() < 0.22


def test_touching_cells_are_all_there() -> None:
    """Two directions 0.05 apart are in one cell or in two that touch."""
    generator = np.random.default_rng(8)
    directions = generator.normal(size=(5000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    aside = directions + 0.05 * generator.uniform(-1, 1, size=directions.shape) / np.sqrt(3)
    table = hulls.touching_cells()
    assert all(b in table[a] for a, b in zip(cells(directions), cells(aside), strict=True))


def test_coverage_counts_each_cell_once() -> None:
    generator = np.random.default_rng(8)
    cloud = generator.normal(size=(60, 3))
    places = np.concatenate([generator.normal(size=(20, 3)) * 0.5, cloud[:2]])
    spacing = cKDTree(cloud).query(cloud, boundedness.DISC_NEIGHBOURS)[0].mean(axis=1)
    view = boundedness.view_of(cloud)
    np.testing.assert_array_equal(view.spacing, spacing[view.curve.order])
    seen = boundedness.coverage(places, view)
    for place, share in zip(places, seen.shares, strict=True):
        expected = AREAS[sorted(covered_cells(place, cloud, spacing, kernel.SIDE))].sum()
        assert share == pytest.approx(expected, abs=1e-12) or (share >= boundedness.ENOUGH and share <= expected)
    assert seen.coincident.tolist() == [0] * 20 + [1, 1]
    assert (seen.shares < boundedness.ENOUGH).any()  # or the whole way was never gone
    for row, share in zip(seen.seen, seen.shares, strict=True):
        assert AREAS[row >= 0].sum() == pytest.approx(share, abs=1e-12)


def test_slabs_hold_what_is_near_their_planes() -> None:
    generator = np.random.default_rng(8)
    cloud, centres = generator.normal(size=(500, 3)), generator.normal(size=(7, 3))
    directions = generator.normal(size=(7, 3))
    found = slab_members(cloud, centres, directions, 0.3)
    for rows, centre, direction in zip(found, centres, directions, strict=True):
        assert rows.tolist() == np.flatnonzero(np.abs((cloud - centre) @ direction) <= 0.3).tolist()
    assert slab_members(cloud, centres[:0], directions[:0], 0.3) == []
