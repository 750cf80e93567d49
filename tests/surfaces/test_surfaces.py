"""Splines, frames, tubes and analytic surfaces: derivatives, orientation, periods."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from reference.tubes import bent_tube
from tiskel import TiskelError
from tiskel.arrays import Numbers, Points
from tiskel.geometry.bspline import fit_bspline
from tiskel.slicing.axis import fit_axis, sharpest
from tiskel.slicing.field import fit_field
from tiskel.surfaces.analytic import Cone, Ellipsoid, EllipticCylinder, Plane, Torus, cylinder
from tiskel.surfaces.forms import forms_of
from tiskel.surfaces.nearest import nearest_place
from tiskel.surfaces.tube import V_STOP, Tube

BENT = bent_tube()
EVERY: dict[str, Any] = {
    "plane": Plane(), "elliptic": EllipticCylinder(2, 1), "cone": Cone(0.3), "torus": Torus(5, 2),
    "ellipsoid": Ellipsoid(1, 2, 3), "bent": BENT,
}  # fmt: skip
H = 1e-4  # of central differences: truncation of 1e-8 times fourth derivatives, rounding of 1e-16 / 1e-8


@pytest.mark.parametrize("name", EVERY)
def test_derivatives_are_those_of_the_surface(name: str) -> None:
    surface, u, v = EVERY[name], 0.7, 1.2

    def f(a: float, b: float) -> Numbers:
        return np.array(surface.jet(u + a * H, v + b * H).f, float)

    numeric = [
        f(0, 0), (f(1, 0) - f(-1, 0)) / (2 * H), (f(0, 1) - f(0, -1)) / (2 * H),
        (f(1, 0) - 2 * f(0, 0) + f(-1, 0)) / H**2, (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / (4 * H**2),
        (f(0, 1) - 2 * f(0, 0) + f(0, -1)) / H**2,
    ]  # fmt: skip
    for ours, theirs in zip(surface.jet(u, v), numeric, strict=True):
        np.testing.assert_allclose(np.array(ours, float), theirs, atol=2e-6)


@pytest.mark.parametrize("name", EVERY)
def test_arrays_give_what_numbers_give(name: str) -> None:
    u, v = np.array([[0.2, 0.7], [1.0, 2.0]]), np.array([[1.2, 1.0], [0.5, 0.9]])
    many = EVERY[name].jet(u, v)
    for i in range(2):
        for j in range(2):
            one = EVERY[name].jet(float(u[i, j]), float(v[i, j]))
            for ours, theirs in zip(one, many, strict=True):
                np.testing.assert_allclose(ours, [np.broadcast_to(c, u.shape)[i, j] for c in theirs], atol=1e-13)


@pytest.mark.parametrize("name", ["elliptic", "cone", "torus", "ellipsoid", "bent"])
def test_the_normal_points_outward(name: str) -> None:
    """Away from the axis: a little along it the surface is farther from the middle of the section."""
    surface = EVERY[name]
    u = np.linspace(0, 2 * np.pi, 24, endpoint=False) if name != "ellipsoid" else np.linspace(-1, 1, 24)
    v = np.full(24, 1.2)
    jet = surface.jet(u, v)
    places = np.stack(np.broadcast_arrays(*jet.f), axis=1)
    normals = np.stack(np.broadcast_arrays(*forms_of(jet).z), axis=1)
    middle = np.zeros(3) if name == "ellipsoid" else places.mean(axis=0)
    assert ((places - middle) * normals).sum(axis=1).min() > 0


def test_a_strip_follows_a_smooth_curve_to_its_third_derivative() -> None:
    v = np.linspace(0, V_STOP, 200)
    strip = fit_bspline(v, np.sin(2 * v)[:, None], np.ones(200), 40, V_STOP, penalty=1e-12)
    at = strip.at(1.1)[:, 0]
    # Quintic splines of step 0.08: the error of the k-th derivative is of the order 0.08^(6 - k) * 64.
    np.testing.assert_allclose(at, [np.sin(2.2), 2 * np.cos(2.2), -4 * np.sin(2.2), -8 * np.cos(2.2)], atol=2e-2)
    assert at[0] == pytest.approx(np.sin(2.2), abs=1e-7)


def test_a_strip_takes_values_at_its_very_end() -> None:
    """The last knot is intervals times the step, which may be a rounding below the end."""
    for intervals in range(4, 120):
        v = np.linspace(0, V_STOP, 2 * intervals)
        strip = fit_bspline(v, v[:, None], np.ones(len(v)), intervals, V_STOP)
        assert strip.at(V_STOP)[0, 0] == pytest.approx(V_STOP)


def test_cross_validation_smooths_noise_and_keeps_a_signal() -> None:
    v = np.linspace(0, V_STOP, 100)
    noisy = np.sin(3 * v) + np.random.default_rng(0).normal(size=100) * 0.05
    strip = fit_bspline(v, noisy[:, None], np.ones(100), 50, V_STOP)
    off = strip.along(v)[:, 0, 0] - np.sin(3 * v)
    assert np.sqrt((off**2).mean()) < 0.03  # ten or so free coefficients of a hundred leave a third of the noise


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_a_closed_strip_closes_with_three_derivatives(order: int) -> None:
    v = np.linspace(0, V_STOP, 60, endpoint=False)
    strip = fit_bspline(v, np.stack([np.cos(2 * v), np.sin(2 * v)], axis=1), np.ones(60), 20, V_STOP, periodic=True)
    before, after = strip.at(V_STOP - 1e-9)[order], strip.at(1e-9)[order]
    np.testing.assert_allclose(before, after, atol=1e-5)


def test_the_curve_runs_at_an_even_speed() -> None:
    share = np.linspace(0, 1, 30) ** 2
    places = np.stack([3 * np.cos(2 * share), 3 * np.sin(2 * share), share], axis=1)
    axis = fit_axis(places, np.ones(30), 0.1, 20, closed=False)
    speed = np.linalg.norm(axis.along(np.linspace(0.05, 3.1, 50))[:, 1], axis=1)
    assert np.ptp(speed) / speed.mean() < 1e-3


def test_a_corner_is_rounded_until_slices_do_not_cross() -> None:
    corner = np.array([[x, 0, 0] for x in np.linspace(0, 1, 11)] + [[1, y, 0] for y in np.linspace(0.1, 1, 10)], float)
    assert sharpest(fit_axis(corner, np.ones(21), 1e-6, 30, closed=False)) > 5
    assert sharpest(fit_axis(corner, np.ones(21), 0.2, 30, closed=False)) * 0.2 < 0.85


def helix() -> Points:
    t = np.linspace(0, 4, 60)
    return np.stack([np.cos(t), np.sin(t), 0.5 * t], axis=1)


def test_a_rotation_minimising_frame_does_not_turn_about_the_tangent() -> None:
    axis = fit_axis(helix(), np.ones(60), 0.1, 30, closed=False)
    field, kind, note = fit_field(axis, "rotation-minimising", 0.1, 30)
    assert (kind, note) == ("rotation-minimising", "")
    w1 = Tube(axis, field, replace(axis, coefficients=axis.coefficients[:, :1])).at(0 * V, V)[0].w[0]
    assert np.abs(w1).max() < 1e-3  # a turn of 1e-3 in all, where m makes the frame turn by radians


V = np.linspace(0.1, 3.0, 40)


def test_the_frame_of_the_normal_is_that_of_frenet() -> None:
    """m = N gives (T, B, -N); its turn about the tangent is the torsion, 0.5 / 1.25 on this helix."""
    axis = fit_axis(helix(), np.ones(60), 0.1, 40, closed=False)
    field, kind, _ = fit_field(axis, "normal", 0.1, 40)
    assert kind == "normal"
    frame = Tube(axis, field, replace(axis, coefficients=axis.coefficients[:, :1])).at(0 * V, V)[0]
    rows = axis.along(V)
    normal = np.cross(np.cross(rows[:, 1], rows[:, 2]), rows[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    np.testing.assert_allclose(-np.array(frame.z).T, normal, atol=1e-4)
    inner = slice(8, -8)  # third derivatives at the ends of a spline are off by more
    np.testing.assert_allclose((frame.w[0] / frame.l)[inner], 0.4, atol=0.02)


@pytest.mark.parametrize(("m", "said"), [((0.0, 0.0, 1.0), "parallel"), ("normal", "straight")])
def test_frames_fall_back_and_say_so(m: Any, said: str) -> None:
    axis = fit_axis(np.linspace(0, 1, 20)[:, None] * [0, 0, 1.0], np.ones(20), 0.1, 8, closed=False)
    _, kind, note = fit_field(axis, m, 0.1, 8)
    assert kind == "rotation-minimising"
    assert said in note


def test_the_frame_of_a_loop_closes() -> None:
    t = np.linspace(0, 2 * np.pi, 81)
    loop = np.stack([np.cos(t), np.sin(t), 0.4 * np.sin(2 * t)], axis=1)
    loop[-1] = loop[0]
    axis = fit_axis(loop, np.ones(81), 0.1, 30, closed=True)
    field, _, _ = fit_field(axis, "rotation-minimising", 0.1, 30)
    tube = Tube(axis, field, replace(axis, coefficients=axis.coefficients[:, :1]))
    before, after = (tube.at(0.0, v)[0] for v in (V_STOP - 1e-9, 1e-9))
    np.testing.assert_allclose(before.y, after.y, atol=1e-6)
    np.testing.assert_allclose(before.w, after.w, atol=1e-3)


@pytest.mark.parametrize("name", ["elliptic", "torus", "ellipsoid", "bent"])
def test_the_nearest_place_looks_along_the_normal(name: str) -> None:
    point = np.array(EVERY[name].jet(0.9, 1.4).f, float) + 0.1 * np.array(forms_of(EVERY[name].jet(0.9, 1.4)).z, float)
    jet = EVERY[name].jet(*nearest_place(EVERY[name], point))
    np.testing.assert_allclose(np.array(jet.f, float), np.array(EVERY[name].jet(0.9, 1.4).f, float), atol=1e-9)


@pytest.mark.parametrize("x", [1.5, 80.0, -5000.0])
def test_the_nearest_place_of_a_surface_without_end_is_as_far_as_the_point(x: float) -> None:
    """First guesses go to v = 10, steps of 0.3 only came to 25: a place on the surface was told to be far from it."""
    u, v = nearest_place(cylinder(2.0), np.array([x, 0.0, 3.0]))
    assert (np.sin(u), v) == pytest.approx((1.0, x), rel=1e-9)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_the_nearest_place_to_nothing_is_refused(wrong: float) -> None:
    with pytest.raises(TiskelError, match=rf"three finite coordinates, got \[0\.0, {wrong}, 1\.0\]"):
        nearest_place(cylinder(2.0), np.array([0, wrong, 1.0]))
