"""Codes along the Morton curve against bits interleaved one by one."""

import numpy as np

from reference import morton as plain
from tiskel.geometry.neighbours import morton_curve
from tiskel.kernels.morton import LEVELS, morton_codes


def test_codes_interleave_the_bits_of_the_cells() -> None:
    points = np.random.default_rng(2).random((300, 3)) * [4.0, 1.0, 0.1] - 0.5
    low, per_length = points.min(axis=0) + 0.01, 2**LEVELS / 3.0  # some points are outside the grid
    found = np.empty(300, np.int64)
    morton_codes(points, low, per_length, found)
    assert found.tolist() == plain.codes(points, low, per_length, LEVELS)


def test_the_curve_has_every_point_once_in_the_order_of_its_codes() -> None:
    points = np.random.default_rng(2).random((500, 3))
    curve = morton_curve(points)
    assert (np.diff(curve.codes) >= 0).all()
    assert sorted(curve.order.tolist()) == list(range(500))
    np.testing.assert_array_equal(curve.points, points[curve.order])
    assert curve.codes.tolist() == plain.codes(curve.points, curve.low, curve.per_length, LEVELS)
