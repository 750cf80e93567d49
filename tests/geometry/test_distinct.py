"""Distinct numbers against NumPy's own."""

import numpy as np
import pytest

from tiskel.geometry.distinct import distinct


@pytest.mark.parametrize("count", [0, 1, 2, 999])
def test_every_number_comes_once_in_order(count: int) -> None:
    numbers = np.random.default_rng(count).integers(0, 300, count) - 150
    np.testing.assert_array_equal(distinct(numbers), np.unique(numbers))


def test_tables_are_taken_as_lists_and_kinds_are_kept() -> None:
    table = np.array([[3, 1], [1, 2]], np.int32)
    assert distinct(table).tolist() == [1, 2, 3]
    assert distinct(table).dtype == np.int32
