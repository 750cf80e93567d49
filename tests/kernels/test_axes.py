"""Principal axes against LAPACK."""

import numpy as np
import pytest

from tiskel.geometry.neighbours import principal_axes

SHAPES: dict[str, list[float]] = {
    "ball": [1, 1, 1],
    "plate": [1, 1, 0],
    "rod": [1, 0, 0],
    "point": [0, 0, 0],
    "long": [1e3, 1, 1e-3],
}


@pytest.mark.parametrize("name", SHAPES)
def test_axes_are_eigenvectors_of_the_covariance(name: str) -> None:
    generator = np.random.default_rng(3)
    points = generator.normal(size=(200, 3)) * SHAPES[name] + 5.0
    neighbours = generator.integers(200, size=(100, 12)).astype(np.int32)
    values, axes = principal_axes(points, neighbours)
    for i, rows in enumerate(neighbours):
        covariance = np.cov(points[rows].T, bias=True)
        scale = max(np.trace(covariance), 1e-30)
        # Twelve summands and eight sweeps of rotations: a few hundred roundings of 1e-16.
        np.testing.assert_allclose(values[i], np.linalg.eigvalsh(covariance)[::-1], atol=1e-13 * scale)
        np.testing.assert_allclose(axes[i] @ axes[i].T, np.eye(3), atol=1e-13)
        np.testing.assert_allclose(axes[i] @ covariance @ axes[i].T, np.diag(values[i]), atol=1e-13 * scale)
