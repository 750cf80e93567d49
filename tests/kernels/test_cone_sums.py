"""Sums of the normal equations against the plain sums of outer products."""

import numpy as np

from tiskel.kernels.cone_sums import summed_products


def test_sums_are_those_of_outer_products_edge_by_edge() -> None:
    generator = np.random.default_rng(3)
    slopes, weights, residuals = generator.normal(size=(50, 8)), generator.random(50), generator.normal(size=50)
    edge = generator.integers(0, 5, 50)
    edge[edge == 2] = 3  # nothing stands on one
    order = np.argsort(edge, kind="stable").astype(np.int32)
    starts = np.searchsorted(edge[order], np.arange(6)).astype(np.int32)
    blocks, sides = np.zeros((5, 8, 8)), np.zeros((5, 8))
    summed_products(slopes, weights, residuals, order, starts, blocks, sides)
    for number in range(5):
        own = edge == number
        matrix = slopes[own].T @ (weights[own, None] * slopes[own])
        # ten summands of order one, in another order
        np.testing.assert_allclose(blocks[number], matrix, atol=1e-13)
        np.testing.assert_allclose(sides[number], slopes[own].T @ (weights[own] * residuals[own]), atol=1e-13)
