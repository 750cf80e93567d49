"""Nearest neighbours in our tree of boxes against SciPy's tree: identical sets, ties by index."""

import os
import subprocess
import sys

import numpy as np
import pytest

from reference import neighbours as plain
from reference.fixtures import Load
from tiskel.arrays import Points
from tiskel.geometry.neighbours import nearest_neighbours


def normalize(points: Points) -> Points:
    return np.asarray(points / np.linalg.norm(points, axis=1, keepdims=True))


GENERATOR = np.random.default_rng(7)
CLOUDS = {
    "uniform": GENERATOR.random((700, 3)),
    "sphere": normalize(GENERATOR.normal(size=(700, 3))),
    "line": np.outer(GENERATOR.random(300), [1.0, 2.0, 3.0]),
    "plane": GENERATOR.random((400, 3)) * [1, 1, 0],
    "lattice, all ties": np.stack(np.meshgrid(*[np.arange(8.0)] * 3), axis=-1).reshape(-1, 3),
    "duplicates": np.repeat(GENERATOR.random((60, 3)), 9, axis=0),
    "density 1e6:1": GENERATOR.normal(size=(900, 3)) * np.geomspace(1e-6, 1, 900)[:, None],
    "cluster and outliers": np.concatenate([GENERATOR.random((500, 3)) * 1e-5, GENERATOR.random((100, 3)) * 1e4]),
    "one stray": np.concatenate([GENERATOR.random((500, 3)), [[1e9, -1e9, 0]]]),
    "several calls of a kernel": GENERATOR.random((9000, 3)) * [1, 1, 0.01],
    "far away": GENERATOR.random((500, 3)) + [4.5e6, -3e6, 8e5],
    "one point": np.zeros((1, 3)),
    "all equal": np.ones((50, 3)),
}


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("k", [1, 8, 30, 32, 33, 70])
def test_neighbours_are_those_of_the_tree_with_ties_by_index(name: str, k: int) -> None:
    points = np.ascontiguousarray(CLOUDS[name])
    k = min(k, len(points))
    found, squares = nearest_neighbours(points, k)
    np.testing.assert_array_equal(found, plain.nearest(points, k))
    # The same products in the same order: equal to the last bit.
    d = points[found] - points[:, None]
    np.testing.assert_array_equal(squares, d[..., 0] ** 2 + d[..., 1] ** 2 + d[..., 2] ** 2)


@pytest.mark.parametrize("name", ["hammer", "horse", "joint", "fertility", "cave"])
def test_neighbours_of_real_clouds(name: str, reference_cloud: Load) -> None:
    points = reference_cloud(name)
    np.testing.assert_array_equal(nearest_neighbours(points, 30)[0], plain.nearest(points, 30))


@pytest.mark.parametrize("n", [1, 2, 15, 16, 17, 32, 33, 100])
def test_all_points_are_neighbours_where_all_are_asked_for(n: int) -> None:
    points = GENERATOR.random((n, 3))
    found, squares = nearest_neighbours(points, n)
    np.testing.assert_array_equal(np.sort(found, axis=1), np.tile(np.arange(n), (n, 1)))
    assert (np.diff(squares, axis=1) >= 0).all()


def test_distances_beyond_double_precision_are_ties() -> None:
    """Squares that overflow are all infinite: their order is that of the rows, and no row is out of range."""
    points = np.arange(60.0)[:, None] * [1e200, 0, 0]
    found, squares = nearest_neighbours(points, 40)
    np.testing.assert_array_equal(found[:, 0], np.arange(60))
    for i, row in enumerate(found):
        np.testing.assert_array_equal(row[1:], np.delete(np.arange(41), min(i, 40))[:39])
    assert np.isinf(squares[:, 1:]).all()


def test_the_cloud_is_left_alone() -> None:
    points = GENERATOR.random((100, 3))
    before = points.copy()
    nearest_neighbours(points, 5)
    np.testing.assert_array_equal(points, before)


def test_bytes_are_the_same_on_one_thread_and_two() -> None:
    script = """
import hashlib, numpy as np
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.kernels import runtime
runtime.ensure()
points = np.round(np.random.default_rng(3).random((20000, 3)), 2)  # with many ties
print(*(hashlib.sha256(array.tobytes()).hexdigest() for array in nearest_neighbours(points, 14)))
"""
    digests = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "TISKEL_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.splitlines()[-1]
        for threads in ("1", "2")
    }
    assert len(digests) == 1
