"""Winding numbers against the plain sum and against solid angles."""

import numpy as np
import pytest

from reference.quality import winding_number
from tiskel.geometry.oriented import SOFTENING, OrientedCloud


def sphere(count: int) -> OrientedCloud:
    """A Fibonacci sphere: nearly equal areas, exact normals."""
    i = np.arange(count) + 0.5
    z, turn = 1 - 2 * i / count, np.pi * (1 + 5**0.5) * i
    points = np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=1)
    return OrientedCloud(points, points, np.full(count, 4 * np.pi / count))


def plain(surface: OrientedCloud, queries: np.ndarray) -> np.ndarray:
    dipoles = surface.normals * surface.areas[:, None]
    return np.array([winding_number(q, surface.points, dipoles, SOFTENING * surface.areas) for q in queries])


def test_one_block_equals_the_plain_sum() -> None:
    generator = np.random.default_rng(5)
    count = 20  # fewer than a block; queries within twice its radius, so that nothing is summed up
    points = generator.normal(size=(count, 3))
    surface = OrientedCloud(points, generator.normal(size=(count, 3)), generator.random(count))
    queries = points[:5] + 0.1
    # twenty summands of order one in another order
    np.testing.assert_allclose(surface.winding_numbers(queries), plain(surface, queries), atol=1e-13)


def test_far_blocks_stand_for_their_points() -> None:
    """A dipole stands for a patch that is seen from two of its radii or more: an error of a few per cent of its own
    solid angle, which is a small part of the whole."""
    generator = np.random.default_rng(5)
    surface = sphere(2000)
    queries = generator.normal(size=(200, 3)) * 0.8
    difference = np.abs(surface.winding_numbers(queries) - plain(surface, queries))
    assert difference.max() < 0.02  # a fiftieth of the step from 0 to 1 that it has to show
    assert difference.max() > 0  # or no block was ever summed up


@pytest.mark.parametrize(("radius", "number"), [(0.0, 1.0), (0.5, 1.0), (0.9, 1.0), (1.1, 0.0), (3.0, 0.0)])
def test_a_sphere_winds_once_around_its_inside(radius: float, number: float) -> None:
    queries = sphere(50).points * radius
    # 4000 points are 0.056 apart; at 0.1 from them softening costs 3 %, blocks add their 2 %
    assert np.abs(sphere(4000).winding_numbers(queries) - number).max() < 0.05


def test_a_hemisphere_is_half_as_much_at_its_centre() -> None:
    whole = sphere(4000)
    upper = whole.points[:, 2] > 0
    half = OrientedCloud(whole.points[upper], whole.normals[upper], whole.areas[upper])
    assert half.winding_numbers(np.zeros((1, 3)))[0] == pytest.approx(0.5, abs=0.02)  # the blocks' error, as above


def test_a_place_on_a_point_has_a_finite_number() -> None:
    surface = sphere(500)
    assert np.isfinite(surface.winding_numbers(surface.points)).all()


def test_a_place_has_its_number_in_any_company() -> None:
    """Eight places ask at a time; each far block is summed up for those it is far from, and only for those."""
    surface = sphere(2000)
    queries = np.random.default_rng(5).normal(size=(101, 3))
    together = surface.winding_numbers(queries)
    assert (together == [surface.winding_numbers(query[None])[0] for query in queries]).all()
    assert len(surface.winding_numbers(np.zeros((0, 3)))) == 0
