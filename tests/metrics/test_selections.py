"""What evaluate takes for points, curve and originals, and what each measure is of: small clouds, no contraction."""

from dataclasses import replace

import numpy as np
import pytest

from tiskel import (
    ContractionParams,
    CurveGraph,
    Skeleton,
    StabilityParams,
    TiskelError,
    assess_stability,
    contract,
    evaluate,
    extract_skeleton,
)
from tiskel.arrays import Points
from tiskel.metrics.barcode import barcode
from tiskel.metrics.topology import compare_topology
from tiskel.params import MetricParams

PARAMS = MetricParams()


def tube(count: int = 400) -> Points:
    rng = np.random.default_rng(5)
    turn, z = rng.uniform(0, 2 * np.pi, count), rng.uniform(-1, 1, count)
    return np.stack([0.2 * np.cos(turn), 0.2 * np.sin(turn), z], axis=1)


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return extract_skeleton(contract(tube()))


def test_a_skeleton_stands_for_its_cloud_points_curve_and_originals(skeleton: Skeleton) -> None:
    whole = evaluate(skeleton)
    s = skeleton
    apart = evaluate(s.cloud, s.contracted, s.nodes, s.edges, origin=s.origin)
    assert whole.as_dict() | {"seconds": 0} == apart.as_dict() | {"seconds": 0}
    assert whole.topology is not None
    # Without points there is nothing to compare; the curve's measures stay.
    line = CurveGraph(s.nodes, s.edges, s.radii)
    bare = evaluate(s.cloud, line)
    assert bare.topology is None
    assert bare.points is None
    assert bare.as_dict()["smoothness"]["curve"] == whole.as_dict()["smoothness"]["curve"]
    empty = replace(s, contracted=np.zeros((0, 3)), origin=np.zeros((0, 3)), node_of_point=np.zeros(0, np.int32))
    assert evaluate(empty).topology is None
    with pytest.raises(TiskelError, match="leave them out, or give arrays"):
        evaluate(s, origin=s.origin)
    with pytest.raises(TiskelError, match="leave them out, or give arrays"):
        evaluate(s.cloud, line, s.nodes)
    with pytest.raises(TiskelError, match="the curve comes without its cloud; give that first"):
        evaluate(line)


def test_topology_is_that_of_the_originals_where_they_are_known_and_else_of_the_cloud() -> None:
    """Points that stayed where their originals are: nothing has changed, whatever else is in the cloud."""
    cloud = tube()
    half = cloud[cloud[:, 2] > 0]
    known = evaluate(cloud, half, origin=half).topology
    nearest = evaluate(cloud, half, normalise="diagonal").topology
    assert known is not None
    assert nearest is not None
    assert known.bottleneck == 0
    assert nearest.bottleneck is not None
    assert nearest.bottleneck > 0
    middle, scale = (
        (cloud.min(axis=0) + cloud.max(axis=0)) / 2,
        np.linalg.norm(np.ptp(cloud, axis=0)) / 1.6,
    )  # as published
    whole, part = ((points - middle) / scale for points in (cloud, half))
    expected = compare_topology(whole, barcode(whole).deaths, barcode(part).deaths, PARAMS)
    assert nearest.bottleneck == pytest.approx(expected.bottleneck)
    assert nearest.wasserstein == pytest.approx(expected.wasserstein)


def test_loops_say_why_a_number_is_missing_and_show_their_bars(skeleton: Skeleton) -> None:
    with_curve, without = evaluate(skeleton).loops, evaluate(skeleton.cloud).loops
    assert (with_curve.graph, "graph" in with_curve.reasons) == (skeleton.loops, False)
    assert (without.graph, without.reasons["graph"]) == (None, "no curve was given")
    assert len(without.bars) > 0
    np.testing.assert_array_equal(with_curve.bars, without.bars)
    for loops in (with_curve, without):
        assert ("solid" in loops.reasons) == (loops.solid is None)


def test_stability_is_that_of_its_seed_and_of_no_other_place() -> None:
    cloud = tube()
    stability = assess_stability(contract(cloud, ContractionParams(method="lbc")))
    again, other = (
        assess_stability(contract(cloud, ContractionParams(method="lbc")), StabilityParams(seed=seed))
        for seed in (StabilityParams().seed, StabilityParams().seed + 1)
    )
    assert stability.as_dict()["steps"] == again.as_dict()["steps"]
    assert stability.as_dict()["steps"] != other.as_dict()["steps"]
    moved = assess_stability(contract(cloud + [30.0, -20, 10], ContractionParams(method="lbc")))
    for one, two in zip(stability.as_dict()["steps"], moved.as_dict()["steps"], strict=True):
        keys = [key for key, value in one.items() if isinstance(value, float)]
        assert keys
        np.testing.assert_allclose(
            np.array([one[key] for key in keys]), np.array([two[key] for key in keys]), atol=1e-6
        )
