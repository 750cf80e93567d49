"""Stability: what a curve looks like, what does not become one, and what random signs prove."""

import json
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import find_peaks

from reference.fixtures import Load
from tiskel import (
    Contraction,
    ContractionParams,
    ShapeParams,
    StabilityParams,
    TiskelError,
    assess_stability,
    contract,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Points
from tiskel.metrics.distributions import distance_from_uniform, distribution, peaks, prominences
from tiskel.metrics.stability import oriented_normals
from tiskel.pictures.stability import stability_picture

PARAMS = StabilityParams()
Method = Literal["gls", "lbc"]


def ball(count: int = 4096) -> Points:
    directions = np.random.default_rng(0).normal(size=(count, 3))
    return np.asarray(directions / np.linalg.norm(directions, axis=1)[:, None])


def box(count: int = 4096) -> Points:
    """The surface of a box of sides 1, 0.8, 0.6, sampled by area."""
    generator, sides = np.random.default_rng(0), np.array([1, 0.8, 0.6])
    area = sides.prod() / sides
    across = generator.choice(3, count, p=area / area.sum())
    points = generator.random((count, 3))
    points[np.arange(count), across] = generator.integers(0, 2, count)
    return np.asarray(points * sides)


@pytest.fixture(scope="module")
def capsule_contraction(capsule: Points) -> Contraction:
    return contract(capsule, ContractionParams(method="lbc"))


@pytest.mark.parametrize("method", ["lbc", "gls"])
def test_the_hammer_is_stable_and_random_signs_are_no_evidence(method: Method, reference_cloud: Load) -> None:
    result = assess_stability(contract(reference_cloud("hammer"), ContractionParams(method=method)))
    assert result.stable, result.reason
    assert not any(step.control_passes for step in result.steps)


def test_towards_the_origin_the_hammer_does_what_is_published(reference_cloud: Load) -> None:
    """Proposition 4.2 and Fig 4.12: first skewed, at last symmetric about 1/2; one rule before and after says 1/4."""
    c = contract(reference_cloud("hammer"), ContractionParams(method="lbc"))
    result = assess_stability(c, StabilityParams(normals="origin"))
    assert [step.origin.mean for step in result.steps] == pytest.approx([0.302, 0.391, 0.493], abs=0.003)
    assert [step.origin.skewness for step in result.steps] == pytest.approx([0.89, 0.43, 0.0], abs=0.04)
    assert [step.control.mean for step in result.steps] == pytest.approx([0.5] * 3, abs=0.02)
    assert 0.2 < result.steps[-1].angle.mean < 0.3  # a quarter on a curve
    assert result.steps[-1].angles.mean() == result.steps[-1].origin.mean
    usual, random = assess_stability(c), assess_stability(c, StabilityParams(normals="random"))
    assert usual.steps[-1].angles.mean() == usual.steps[-1].angle.mean
    assert random.steps[-1].angles.mean() == random.steps[-1].control.mean
    assert result.stable == usual.stable == random.stable


@pytest.mark.parametrize("method", ["lbc", "gls"])
@pytest.mark.parametrize("body", [box, ball])
def test_a_box_and_a_ball_are_not_stable(body: type, method: Method) -> None:
    result = assess_stability(contract(body(), ContractionParams(method=method)))
    assert not result.stable
    assert not any(step.control_passes for step in result.steps)


def test_random_signs_look_the_same_on_a_good_cloud_and_a_bad_one() -> None:
    """Mean 1/2 and skewness 0, the published signs of stability, whatever the cloud: they say nothing."""
    good = make_shape(shape_graph("banana"), ShapeParams(count=2000))[0]
    for cloud in (good, ball(2000)):
        control = assess_stability(contract(cloud, ContractionParams(method="lbc"))).steps[-1].control
        assert control.mean == pytest.approx(0.5, abs=0.03)  # 2000 values of spread 0.3: a deviation of 0.007
        assert control.skewness == pytest.approx(0, abs=0.15)


def synthetic(final: Points, origin: Points, template: Contraction) -> Contraction:
    """Return a contraction whose only step takes the origin to its final places."""
    count = len(origin)
    rows, none = np.arange(count, dtype=np.int32), np.full(count, -1, np.int32)
    return replace(
        template, points=final, origin=origin, rows=rows, cloud=origin, input_rows=rows, merged_into=none,
        merged_step=none, history=final[None],
    )  # fmt: skip


def tube(count: int = 3000) -> Points:
    i = np.arange(count)
    turn = i * np.pi * (3 - 5**0.5)
    return np.stack([0.2 * np.cos(turn), 0.2 * np.sin(turn), 2 * (i + 0.5) / count], axis=1)


def test_points_that_reach_a_line_turn_their_normals_evenly(capsule_contraction: Contraction) -> None:
    """Around a thread of random cross-section the normals are uniform across it: mean 1/4, spread 1 / sqrt(48)."""
    generator = np.random.default_rng(12)
    origin = tube()
    thread = origin * [0, 0, 1] + generator.normal(size=origin.shape) * [1e-5, 1e-5, 0]
    step = assess_stability(synthetic(thread, origin, capsule_contraction)).steps[0]
    assert step.stable
    assert step.angle.mean == pytest.approx(0.25, abs=0.02)  # neighbourhoods overlap: some 300 independent normals
    assert step.angle.spread == pytest.approx(48**-0.5, abs=0.01)
    assert step.angle.skewness == pytest.approx(0, abs=0.15)
    assert step.in_hull > 0.99  # the last points of a tube of separate heights are not within its hull
    assert step.in_cloud is not None
    assert step.in_cloud > 0.98  # the ends are open


def test_points_that_hardly_move_are_still_a_surface(capsule_contraction: Contraction) -> None:
    origin = tube()
    result = assess_stability(synthetic(origin * [0.9, 0.9, 1], origin, capsule_contraction))
    assert not result.stable
    assert "still a surface" in result.reason


def test_a_thick_rest_is_told_by_its_curvature(capsule_contraction: Contraction) -> None:
    generator = np.random.default_rng(12)
    origin = tube()
    clump = origin * [0, 0, 1] + generator.normal(size=origin.shape) * 0.001  # 1.5 times the distance of heights
    result = assess_stability(synthetic(clump, origin, capsule_contraction))
    assert not result.stable
    assert "thick" in result.reason
    assert result.steps[0].median_curvature > 0.02


def test_normals_are_on_the_outward_side_and_curvature_is_the_smallest_share() -> None:
    points = ball(500)
    normals, curvature = oriented_normals(points, points, 9)
    assert (np.einsum("ij,ij->i", normals, points) >= 0).all()
    assert ((curvature >= 0) & (curvature <= 1 / 3)).all()
    same = np.zeros((20, 3))
    assert oriented_normals(same, same, 9)[1].tolist() == [0] * 20


def test_distances_from_the_uniform_distribution() -> None:
    even = (np.arange(1000) + 0.5) / 2000
    assert distance_from_uniform(even) == pytest.approx(0, abs=0.001)
    assert distance_from_uniform(np.zeros(50)) == 1
    assert distance_from_uniform(np.full(50, 0.75)) == 1
    assert distance_from_uniform(2 * even) == pytest.approx(0.5, abs=0.001)


def test_moments_and_peaks() -> None:
    generator = np.random.default_rng(12)
    exponential = -np.log1p(-(np.arange(20000) + 0.5) / 20000) / 10
    made = distribution(exponential, "angle", PARAMS)
    assert made.mean == pytest.approx(0.1, rel=0.01)
    assert made.skewness == pytest.approx(2, rel=0.03)  # the tail beyond one in 20 000 is missing
    assert distribution(np.ones(5), "angle", PARAMS).skewness == 0
    two = np.concatenate([generator.normal(0.3, 0.03, 900), generator.normal(0.7, 0.03, 100)])
    assert peaks(two, (0, 1), PARAMS) == 2
    assert peaks(two, (0, 1), replace(PARAMS, prominence=0.2)) == 1  # the lower one holds 100 of 1000 points
    assert peaks(two, (0, 1), replace(PARAMS, prominence=0.5)) == 0
    assert peaks(two[:900], (0, 1), PARAMS) == 1


@given(st.lists(st.integers(0, 6), min_size=1, max_size=40))
def test_prominences_are_those_of_scipy(heights: list[int]) -> None:
    shares = np.array(heights) / 7
    expected = find_peaks(np.concatenate([[0], shares, [0]]), prominence=0)[1]["prominences"]
    np.testing.assert_array_equal(prominences(shares), expected)


def test_only_points_that_survive_count_and_documents_hold_no_nan(capsule: Points) -> None:
    c = contract(capsule, ContractionParams(method="gls"))
    result = assess_stability(c)
    assert result.points == len(c.points) < len(capsule)
    assert len(result.steps) == len(c.steps)
    document = json.loads(json.dumps(result.as_dict(), allow_nan=False))
    assert document["steps"][0]["step"] == 1
    assert document["settings"]["distance"] == PARAMS.distance
    picture = stability_picture(c, result, "capsule")
    assert picture.startswith(b"\x89PNG")
    assert picture == stability_picture(c, result, "capsule")


def test_a_contraction_without_steps_is_refused(capsule_contraction: Contraction) -> None:
    with pytest.raises(TiskelError, match="nothing to compare"):
        assess_stability(replace(capsule_contraction, history=capsule_contraction.history[:0], steps=()))
