"""Ring sizes and cotangent weights against loops and closed forms."""

import numpy as np
import pytest

from reference import laplacian as plain
from tiskel.arrays import Points
from tiskel.geometry.neighbours import cloud_rings
from tiskel.geometry.rings import Rings, cotangent_laplacian, mean_ring_length, smallest_distances

CAP = 1e4


def as_lists(rings: Rings) -> list[tuple[list[int], bool]]:
    return [(rings.of(i).tolist(), bool(rings.closed[i])) for i in range(len(rings))]


def hexagon(closed: int) -> tuple[Points, Rings]:
    """A unit hexagon around point 0, whose ring is the hexagon; the others have no ring."""
    turn = np.arange(6) * np.pi / 3
    points = np.concatenate([[[0.0, 0, 0]], np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)])
    members = np.full((7, 6), -1, np.int32)
    members[0] = np.arange(1, 7)
    return points, Rings(
        members, np.array([6, 0, 0, 0, 0, 0, 0], np.int32), np.array([closed, 0, 0, 0, 0, 0, 0], np.int32)
    )


def test_weights_of_a_regular_hexagon_are_twice_the_cotangent_of_60_degrees() -> None:
    points, rings = hexagon(closed=1)
    row = cotangent_laplacian(points, rings, CAP).toarray()[0]
    np.testing.assert_allclose(row, [-12 / np.sqrt(3), *[2 / np.sqrt(3)] * 6], rtol=1e-14)


def test_an_open_ring_has_no_triangle_across_its_gap() -> None:
    points, rings = hexagon(closed=0)
    row = cotangent_laplacian(points, rings, CAP).toarray()[0]
    np.testing.assert_allclose(row[1:], np.array([1, 2, 2, 2, 2, 1]) / np.sqrt(3), rtol=1e-14)


def test_laplacian_of_a_flat_interior_point_vanishes(capsule: Points) -> None:
    """Cotangent weights reproduce linear functions: on a plane L P = 0 inside (Au et al. 2008)."""
    flat = np.column_stack([np.random.default_rng(1).random((400, 2)), np.zeros(400)])
    rings = cloud_rings(flat, 20)
    delta = cotangent_laplacian(flat, rings, np.inf) @ flat
    inside = rings.closed == 1
    assert inside.sum() > 300
    # Slivers have cotangents of 1e3 and more, so 1e-16 grows to 1e-12.
    np.testing.assert_allclose(delta[inside], 0, atol=1e-10)


@pytest.mark.parametrize("cap", [CAP, 20.0])
def test_weights_sizes_and_lengths_equal_the_plain_ones_to_the_last_bit(capsule: Points, cap: float) -> None:
    rings = cloud_rings(capsule, 12)
    lists = as_lists(rings)
    ours, theirs = cotangent_laplacian(capsule, rings, cap), plain.cotangent_laplacian(capsule, lists, cap)
    np.testing.assert_array_equal(ours.toarray(), theirs.toarray())
    np.testing.assert_array_equal(smallest_distances(capsule, rings), plain.sizes(capsule, lists))
    assert mean_ring_length(capsule, rings, count_first_twice=False) == plain.mean_length(capsule, lists)


def test_rows_sum_to_zero_and_the_cap_holds(capsule: Points) -> None:
    matrix = cotangent_laplacian(capsule, cloud_rings(capsule, 12), 5.0)
    assert np.abs(matrix.diagonal()).max() <= 5.0 * (1 + 1e-12)
    np.testing.assert_allclose(matrix.sum(axis=1), 0, atol=1e-12)


def test_a_degenerate_triangle_contributes_nothing() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    rings = Rings(
        np.array([[1, 2], [-1, -1], [-1, -1]], np.int32), np.array([2, 0, 0], np.int32), np.zeros(3, np.int32)
    )
    assert not cotangent_laplacian(points, rings, CAP).toarray().any()
