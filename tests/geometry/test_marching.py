"""Surfaces followed from cell to cell: closed whatever the function is, and where it is zero."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh

from tiskel.arrays import Numbers, Points
from tiskel.geometry.marching import Found, marched


def torus(p: Points) -> Numbers:
    return np.asarray(np.hypot(np.hypot(p[:, 0], p[:, 1]) - 1, p[:, 2]) - 0.3)


def rough(p: Points) -> Numbers:
    """A ball with bumps as small as the grid, so that cells are cut in all ways."""
    return np.asarray(np.linalg.norm(p, axis=1) - 1 + 0.3 * np.sin(31 * p[:, 0]) * np.sin(29 * p[:, 1] + 1))


def solid(found: Found) -> trimesh.Trimesh:
    return trimesh.Trimesh(found.vertices, found.triangles, process=False)


@pytest.mark.parametrize(("function", "seed"), [(torus, (1.3, 0, 0)), (rough, (0, 0, 1.0))])
def test_the_surface_is_closed_and_looks_outward(
    function: Callable[[Points], Numbers], seed: tuple[float, float, float]
) -> None:
    body = solid(marched(function, np.array([seed]), 0.06, 10**6))
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.volume > 0


def test_one_seed_finds_all_of_a_torus() -> None:
    found = marched(torus, np.array([[1.3, 0, 0]]), 0.05, 10**6)
    assert found.whole
    assert solid(found).euler_number == 0
    assert solid(found).volume == pytest.approx(2 * np.pi**2 * 0.09, rel=0.01)
    assert np.abs(torus(found.vertices)).max() < 0.05**2 / 0.3


def test_another_body_without_seed_is_not_found() -> None:
    two = lambda p: np.minimum(torus(p), np.linalg.norm(p - [9.0, 0, 0], axis=1) - 1)  # noqa: E731
    assert marched(two, np.array([[1.3, 0, 0]]), 0.1, 10**6).vertices[:, 0].max() < 2


def test_a_surface_without_end_ends() -> None:
    found = marched(lambda p: p[:, 2], np.zeros((1, 3)), 0.1, 500)
    assert 0 < len(found.triangles) < 20_000
    assert not found.whole


def test_values_of_exactly_zero_are_outside() -> None:
    """The grid meets the plane z = 0 and the sphere's poles exactly."""
    found = marched(lambda p: np.abs(p).max(axis=1) - 1.0, np.array([[0.0, 0, 1.0]]), 0.25, 10**5)
    assert solid(found).is_watertight
    assert solid(found).euler_number == 2
