"""Beta by the printed map of the sphere and as in the toolbox: closed cases, and the published share of a tree."""

import numpy as np
import pytest

from reference.fixtures import Load
from reference.quality import hull_beta
from tiskel import ConditioningParams, ContractionParams, MetricParams, TiskelError, condition, contract, evaluate
from tiskel.arrays import Points, normalisation
from tiskel.metrics.betas import betas
from tiskel.metrics.boundedness import MAP, boundedness, boundedness_by
from tiskel.params import BetaRule


def sphere(count: int, seed: int = 0) -> Points:
    v = np.random.default_rng(seed).normal(size=(count, 3))
    return np.asarray(0.8 * v / np.linalg.norm(v, axis=1)[:, None])


@pytest.mark.parametrize("rule", ["hull", "print", "toolbox"])
def test_from_the_middle_of_a_sphere_all_of_it_is_seen(rule: BetaRule) -> None:
    assert betas(np.zeros((1, 3)), sphere(3000), rule)[0] == pytest.approx(1, abs=0.005)


def test_the_hull_in_full_is_the_plain_one() -> None:
    cloud, places = sphere(400), np.random.default_rng(1).normal(scale=0.5, size=(20, 3))
    np.testing.assert_allclose(betas(places, cloud, "hull"), [hull_beta(p, cloud) for p in places], atol=1e-12)


def test_half_a_sphere_is_at_least_its_half_and_at_most_its_hull() -> None:
    half = sphere(2000)
    half[:, 0] = -np.abs(half[:, 0])  # towards the place: longitudes within a right angle of 0
    found = betas(np.zeros((1, 3)), half, "print")[0]
    assert 0.49 < found < hull_beta(np.zeros(3), half) < 0.75


def test_the_toolbox_leaves_out_only_what_is_small_and_sunk() -> None:
    far = sphere(40)  # large triangles, sunk under the sphere
    place = np.zeros((1, 3))
    assert betas(place, far, "toolbox")[0] == betas(place, far, "print")[0]
    assert betas(place, 1e-3 * far, "toolbox")[0] < 0.7 * betas(place, 1e-3 * far, "print")[0]


def test_few_directions_have_no_area() -> None:
    line = np.outer(np.arange(1.0, 9), [1, 0, 0])
    assert betas(np.zeros((1, 3)), line, "print")[0] == betas(np.zeros((1, 3)), line[:2], "toolbox")[0] == 0


@pytest.mark.slow
def test_an_apple_tree_is_bounded_as_published(reference_cloud: Load) -> None:
    """Table 4.2: 0.830 of the skeletal points of the synthetic tree of 8936 points; all of them give 0.830 here."""
    cloud = condition(reference_cloud("apple_tree"), ConditioningParams(voxel=0.02))[0]
    assert len(cloud) == 8936
    frame = normalisation(cloud)
    points = frame.apply(contract(cloud, ContractionParams(method="lbc")).points)[::20]
    shares = {rule: (betas(points, frame.apply(cloud), rule) > 0.75).mean() for rule in ("print", "toolbox")}
    assert shares["toolbox"] == pytest.approx(0.83, abs=0.02)
    assert shares["print"] == pytest.approx(0.90, abs=0.02)


def test_rules_and_thresholds_are_settings(capsule: Points) -> None:
    points = capsule[::40] * [0.1, 0.1, 0.9]
    usual = evaluate(capsule, points, origin=capsule[::40])
    printed = evaluate(capsule, points, origin=capsule[::40], params=MetricParams(beta="print"))
    assert usual.points is not None
    assert printed.points is not None
    assert (printed.points.boundedness.settled_by == MAP).all()
    assert printed.counts()["points_settled_by_map"] == len(points)
    assert usual.points.boundedness.bounded.mean() == printed.points.boundedness.bounded.mean() == 1
    outside = capsule[::40] * 1.3
    easy = boundedness_by(outside, capsule, "hull", 0.3)
    assert easy.bounded.mean() > boundedness(outside, capsule).bounded.mean()
    np.testing.assert_array_equal(easy.bounded, easy.beta >= 0.3)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"beta": "cap"}, "beta must be one of hull, print, toolbox"),
        ({"bounded": 1.5}, "bounded must be a number from 0 to 1, got 1.5"),
        ({"similar": -1.0}, "similar must be"),
    ],
)
def test_wrong_settings_are_refused(settings: dict[str, float], said: str) -> None:
    with pytest.raises(TiskelError, match=said):
        MetricParams(**settings)  # type: ignore[arg-type]
