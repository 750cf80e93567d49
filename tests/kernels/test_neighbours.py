"""Nearest neighbours on the grid hierarchy against SciPy's tree: identical sets, ties by index."""

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
    "far away": GENERATOR.random((500, 3)) + [4.5e6, -3e6, 8e5],
    "one point": np.zeros((1, 3)),
    "all equal": np.ones((50, 3)),
}


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("k", [1, 8, 30])
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
