"""Quadrics through oriented points: bodies that are quadrics, what moves with the points, and what noise does."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tiskel.arrays import Points
from tiskel.geometry.quadrics import Quadrics, fit_quadrics, matrices

EVERYONE = np.arange(60, dtype=np.int32)[None]


def directions(count: int = 60) -> Points:
    d = np.random.default_rng(4).normal(size=(count, 3))
    return np.asarray(d / np.linalg.norm(d, axis=1)[:, None])


def fitted(points: Points, normals: Points, centre: Points) -> Quadrics:
    return fit_quadrics(centre, points, normals, EVERYONE, np.ones((1, 60)), np.array([2.0]))


def test_a_cylinder_is_found_exactly_by_points_all_around() -> None:
    """q = (y^2 + z^2 - R^2) / 2R, whose gradients at the surface are units."""
    normals = directions() * [0, 1, 1]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    points = 0.7 * normals + np.linspace(-1, 1, 60)[:, None] * [1, 0, 0]
    value, gradient, hessian, error = fitted(points, normals, np.zeros((1, 3)))
    np.testing.assert_allclose(value, -0.35, atol=1e-4)
    np.testing.assert_allclose(gradient, 0, atol=1e-4)
    np.testing.assert_allclose(hessian[0], [0, 1 / 0.7, 1 / 0.7, 0, 0, 0], atol=1e-3)
    assert error[0] < 1e-4


def test_two_parallel_walls_are_one_quadric() -> None:
    points = np.random.default_rng(5).uniform(-1, 1, (60, 3))
    side = np.where(points[:, 2:] > 0, 1.0, -1.0)
    points[:, 2:] = 0.1 * side
    found = fitted(points, side * [0, 0, 1.0], np.array([[0, 0, 0.1]]))
    np.testing.assert_allclose(found.value, 0, atol=1e-3)
    np.testing.assert_allclose(found.gradient[0], [0, 0, 1], atol=1e-2)


def test_quadrics_turn_and_grow_with_their_points() -> None:
    turn, normals = Rotation.from_rotvec([0.3, -1.0, 0.5]).as_matrix(), directions()
    points = normals * [1.0, 0.6, 0.5]
    normals = normals / [1.0, 0.6, 0.5]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    one = fitted(points, normals, points[:1])
    there = fit_quadrics(
        3 * points[:1] @ turn.T, 3 * points @ turn.T, normals @ turn.T, EVERYONE, np.ones((1, 60)), np.array([6.0])
    )
    np.testing.assert_allclose(there.value, 3 * one.value, atol=1e-9)
    np.testing.assert_allclose(there.gradient, one.gradient @ turn.T, atol=1e-9)
    np.testing.assert_allclose(matrices(there.hessian), turn @ matrices(one.hessian) @ turn.T / 3, atol=1e-9)
    assert there.error[0] == pytest.approx(3 * one.error[0])


def test_a_quadric_is_the_same_about_another_centre() -> None:
    generator = np.random.default_rng(4)
    q = Quadrics(generator.normal(size=5), generator.normal(size=(5, 3)), generator.normal(size=(5, 6)), np.zeros(5))
    by, place = generator.normal(size=(2, 5, 3))
    there, back = q.moved(by).moved(place), q.moved(by + place)
    np.testing.assert_allclose(there.value, back.value, atol=1e-12)
    np.testing.assert_allclose(there.gradient, back.gradient, atol=1e-12)


def test_the_error_is_that_of_points_left_out() -> None:
    """Points off a sphere by noise alone: the mean error of those left out is the noise, not what is left of it."""
    generator = np.random.default_rng(4)
    errors = []
    for _ in range(100):
        normals = directions(60)[generator.permutation(60)[:20]]
        points = normals * (1 + 0.01 * generator.normal(size=(20, 1)))
        row = np.arange(20, dtype=np.int32)[None]
        errors.append(fit_quadrics(np.zeros((1, 3)), points, normals, row, np.ones((1, 20)), np.ones(1)).error[0])
    assert np.mean(errors) == pytest.approx(0.01, rel=0.15)
