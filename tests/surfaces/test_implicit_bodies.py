"""Bodies with closed forms: derivatives by differences, curvatures by the book."""

from math import sqrt
from typing import Any

import numpy as np
import pytest

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.surfaces import analytic
from tiskel.surfaces.forms import forms_of, principal_curvatures
from tiskel.surfaces.implicit import projected, tangency
from tiskel.surfaces.implicit_bodies import (
    Capsule,
    Ellipsoid,
    Plane,
    RoundCylinder,
    Sphere,
    Torus,
    Union,
    y_of_capsules,
)

BODIES: dict[str, Any] = {
    "plane": Plane((1.0, 2.0, -1.0), 0.3),
    "sphere": Sphere(1.3, (0.2, -0.1, 0.4)),
    "cylinder": RoundCylinder(0.7, (1.0, 1.0, 0.5), (0.1, 0.2, 0.3)),
    "capsule": Capsule((-0.9, 0.1, 0.0), (0.8, 0.4, 0.5), 0.5),
    "torus": Torus(1.5, 0.5, (0.3, 0.2, 1.0), (0.1, 0.0, 0.2)),
    "ellipsoid": Ellipsoid(1.5, 1.0, 0.6),
    "y": y_of_capsules(),
    "sharp": Union((Sphere(0.8), Sphere(0.7, (1.0, 0.0, 0.0)))),
}


def around(seed: int = 0, count: int = 300) -> Points:
    """Places about the bodies, off the axes."""
    return np.random.default_rng(seed).uniform(-2, 2, (count, 3))


@pytest.mark.parametrize("name", BODIES)
def test_derivatives_are_those_of_differences(name: str) -> None:
    """Central differences of step 1e-5: 1e-10 and rounding; a capsule's Hessian jumps where its caps begin."""
    body, step, places = BODIES[name], 1e-5, around()
    value, gradient, hessian = body.level(places)
    smooth = np.ones(len(places), bool)
    for axis in range(3):
        by = step * np.eye(3)[axis]
        after, before = body.level(places + by), body.level(places - by)
        slope = (after.value - before.value) / (2 * step)
        bend = (after.gradient - before.gradient) / (2 * step)
        smooth &= np.abs(after.hessian - before.hessian).max(axis=(1, 2)) < 0.01 * (
            1 + np.abs(hessian).max(axis=(1, 2))
        )
        np.testing.assert_allclose(gradient[smooth, axis], slope[smooth], atol=1e-8)
        np.testing.assert_allclose(hessian[smooth, :, axis], bend[smooth], atol=1e-6, rtol=1e-5)
    assert smooth.mean() > 0.95
    np.testing.assert_allclose(hessian, np.swapaxes(hessian, 1, 2), atol=1e-14)
    assert value.shape == (300,)


@pytest.mark.parametrize(
    ("name", "curvatures"),
    [("plane", (0, 0)), ("sphere", (1 / 1.3, 1 / 1.3)), ("cylinder", (0, 1 / 0.7))],
)
def test_even_bodies_have_their_curvatures_everywhere(name: str, curvatures: tuple[float, float]) -> None:
    near = projected(BODIES[name], around())
    shape = tangency(BODIES[name], near).shape
    found = np.sort(np.linalg.eigvalsh(shape), axis=1)
    np.testing.assert_allclose(found, np.tile(sorted([0, *curvatures]), (len(near), 1)), atol=1e-12)


def test_a_torus_bends_as_its_angle_says() -> None:
    """Around the tube 1/r, along it cos u / (A + r cos u) with u from the outside."""
    body = Torus(1.5, 0.5)
    near = projected(body, around(1))
    out = (np.hypot(*near[:, :2].T) - 1.5) / 0.5
    expected = np.sort(np.stack([0 * out, 0 * out + 2, out / (1.5 + 0.5 * out)], axis=1), axis=1)
    np.testing.assert_allclose(np.sort(np.linalg.eigvalsh(tangency(body, near).shape), axis=1), expected, atol=1e-10)


def test_a_capsule_is_a_cylinder_between_two_spheres() -> None:
    body = Capsule((0, 0, 0), (0, 0, 2), 0.5)
    places = np.array([[0.5, 0, 1.0], [0.3, 0, 2.4], [0, -0.3, -0.4]])
    found = np.linalg.eigvalsh(tangency(body, places).shape)
    np.testing.assert_allclose(found, [[0, 0, 2], [0, 2, 2], [0, 2, 2]], atol=1e-12)
    np.testing.assert_allclose(body.level(places).value, 0, atol=1e-15)


@pytest.mark.parametrize(
    ("body", "chart"),
    [
        (Ellipsoid(1.5, 1.0, 0.6), analytic.Ellipsoid(1.5, 1.0, 0.6)),
        (Torus(1.5, 0.5), analytic.Torus(1.5, 0.5)),
        (RoundCylinder(0.8, (1.0, 0, 0)), analytic.cylinder(0.8)),
    ],
)
def test_normals_and_curvatures_are_those_of_the_chart(body: Any, chart: Any) -> None:
    u, v = np.random.default_rng(2).uniform(0.1, 1.4, (2, 50))
    jet = chart.jet(u, v)
    forms = forms_of(jet)
    found = tangency(body, np.stack(np.broadcast_arrays(*jet.f), axis=1))
    outward = np.stack(np.broadcast_arrays(*forms.z), axis=1)
    np.testing.assert_allclose(found.normal, outward, atol=1e-12)
    low, high = principal_curvatures(forms)
    expected = np.sort(np.stack([low, high, 0 * low], axis=1), axis=1)
    np.testing.assert_allclose(np.sort(np.linalg.eigvalsh(found.shape), axis=1), expected, atol=1e-10)


def test_a_blend_fills_the_seam_and_nothing_else() -> None:
    """At the seam of two spheres as far below either as blend 3/20; beyond the blend nothing moves."""
    one, other = Sphere(1.0), Sphere(1.0, (1.2, 0.0, 0.0))
    joined = Union((one, other), blend=0.2)
    seam = np.array([[0.6, 0.8, 0.0]])
    assert joined.level(seam).value[0] == pytest.approx(-0.2 * 3 / 20, abs=1e-12)
    assert np.linalg.eigvalsh(tangency(joined, projected(joined, seam)).shape)[0, 0] < -1  # concave across it
    places = around(3)
    values = [body.level(places).value for body in (one, other, joined)]
    apart = np.abs(values[0] - values[1]) > 0.2
    np.testing.assert_array_equal(values[2][apart], np.minimum(values[0], values[1])[apart])


def test_the_y_is_three_capsules_away_from_its_joint() -> None:
    body = y_of_capsules(2.0, 0.4, 0.2)
    third = 2 * np.pi / 3 * np.arange(3)
    tips = 2.4 * np.stack([np.cos(third), np.sin(third), 0 * third], axis=1)
    np.testing.assert_allclose(body.level(tips).value, 0, atol=1e-12)
    assert body.level(np.array([[0.3, 0.3 * sqrt(3), 0.0]])).value[0] > 0  # 120 degrees between two of them
    assert body.level(np.array([[0.0, 0.0, 0.41]])).value[0] < 0  # thicker where they meet
    np.testing.assert_allclose(np.linalg.eigvalsh(tangency(body, tips).shape)[:, 1:], 2.5, atol=1e-9)


def test_a_direction_without_length_is_refused() -> None:
    with pytest.raises(TiskelError, match="needs a length"):
        Plane((0.0, 0.0, 0.0)).level(np.zeros((1, 3)))
