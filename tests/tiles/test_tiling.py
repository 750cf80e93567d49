"""Every point is in exactly one core, and in the margin of every tile that reaches it."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tiskel import SplitParams, TiskelError
from tiskel.arrays import Points
from tiskel.tiles.cells import Counting
from tiskel.tiles.tiling import Plane, Tiling, tiles_of


def tiling_of(cloud: Points, overlap: float, **settings: float) -> Tiling:
    counting = Counting()
    counting.add(cloud)
    return tiles_of(counting.grid(), SplitParams(**settings), overlap)  # type: ignore[arg-type]


@given(st.integers(0, 10_000), st.sampled_from([0.01, 0.3]), st.sampled_from([1.0, 1e6]))
def test_cores_share_the_points_and_margins_reach_as_far_as_they_should(seed: int, overlap: float, far: float) -> None:
    generator = np.random.default_rng(seed)
    points = generator.normal(size=(400, 3)) * generator.uniform(0.5, 4, 3) + far
    points[::7] = points[0]  # many at one place
    tiling = tiling_of(points, overlap, points=40)
    owners, inside = np.zeros(len(points), int), np.zeros((len(tiling.cores()), len(points)), bool)
    for tile, rows, core in tiling.deal(points):
        owners[rows[core]] += 1
        inside[tile, rows] = True
        low, high = tiling.cores()[tile]
        assert ((points[rows[core]] >= low) & (points[rows[core]] <= high)).all()
    assert (owners == 1).all()
    for tile, (low, high) in enumerate(tiling.cores()):
        reached = ((points >= low - overlap) & (points < high + overlap)).all(axis=1)
        np.testing.assert_array_equal(inside[tile], reached)


def test_tiles_have_about_as_many_points_as_asked_and_are_no_longer_than_asked() -> None:
    points = np.random.default_rng(0).uniform(0, 10, (20000, 3)) * [4, 1, 0.01]
    cores = [int(core.sum()) for _, _, core in tiling_of(points, 0.1, points=2500).deal(points)]
    assert max(cores) <= 2500
    assert len(cores) <= 16
    tiling = tiling_of(points, 0.1, size=7.0)
    for _, rows, core in tiling.deal(points):
        assert np.ptp(points[rows[core]], axis=0).max() <= 7.0


def test_planes_go_between_bodies_where_that_is_even_enough() -> None:
    """Two blobs of 60 and 40 % with air between: no point is copied."""
    generator = np.random.default_rng(0)
    points = np.concatenate([generator.uniform(0, 1, (600, 3)), generator.uniform(0, 1, (400, 3)) + [3, 0, 0]])
    tiling = tiling_of(points, 0.2, points=700)
    assert sorted(len(rows) for _, rows, _ in tiling.deal(points)) == [400, 600]


def test_no_tile_is_narrower_than_two_overlaps() -> None:
    points = np.random.default_rng(0).uniform(0, 1, (5000, 3)) * [10, 0.1, 0.1]
    tiling = tiling_of(points, 1.0, points=100)
    widths = [np.ptp(points[rows[core], 0]) for _, rows, core in tiling.deal(points)]
    assert 3 <= len(widths) <= 5
    with pytest.raises(TiskelError, match="longer than the cloud"):
        tiling_of(points, 20.0)


def test_a_tiling_survives_its_document() -> None:
    tiling = Tiling(0.25, 0.5, Plane(0, 3, Plane(2, -7, 0, 1), 2))
    assert Tiling.from_dict(json.loads(json.dumps(tiling.as_dict()))) == tiling
