"""Measures as plain JSON: every key is there, and holds the number of its name or the reason why there is none."""

import json
from dataclasses import replace

import numpy as np
import pytest

from reference.quality import SECTIONS
from tiskel import (
    CurveGraph,
    GlsParams,
    MetricParams,
    Quality,
    ShapeParams,
    Stability,
    assess_stability,
    contract,
    evaluate,
    make_shape,
)
from tiskel.metrics.result import NO_CURVE, NO_POINTS
from tiskel.metrics.stability import verdict

WAYS = ("coverage", "outside", "hull", "map")
SETTLED = ("measured", "at_a_cloud_point", *(f"settled_by_{way}" for way in WAYS))
OF_POINTS = {"points_without_tangent", *(f"points_{name}" for name in SETTLED)}
OF_CURVE = {
    "nodes", "edges", "hairpins", *(f"curve_{name}" for name in SETTLED), "curve_valid_sections",
    "curve_without_direction", "curve_sparse_sections", "curve_stand_ins",
}  # fmt: skip
PARTS = {"inside", "loops", "topology", "boundedness", "centredness", "smoothness", "medialness", "air"}


@pytest.fixture(scope="module")
def made() -> tuple[np.ndarray, CurveGraph, np.ndarray]:
    cloud, true = make_shape("y", 500)
    return cloud, CurveGraph(true.nodes, true.edges), contract(cloud).points


def measured(made: tuple[np.ndarray, CurveGraph, np.ndarray], *, points: bool, curve: bool) -> Quality:
    cloud, graph, contracted = made
    nodes, edges = (graph.nodes, graph.edges) if curve else (None, None)
    return evaluate(cloud, contracted if points else None, nodes, edges)


@pytest.mark.parametrize("points", [True, False])
@pytest.mark.parametrize("curve", [True, False])
def test_every_key_is_there_with_a_number_or_a_reason(
    points: bool, curve: bool, made: tuple[np.ndarray, CurveGraph, np.ndarray]
) -> None:
    if not points and not curve:
        return
    quality = measured(made, points=points, curve=curve)
    document = json.loads(json.dumps(quality.as_dict(), allow_nan=False))
    assert set(document) == {*SECTIONS, "counts", "settings", "warnings"}
    for name, keys in SECTIONS.items():
        assert set(document[name]) == keys, name
        for key in {"points", "curve"} & keys:
            given = points if key == "points" else curve
            assert (document[name][key] is not None) == given, (name, key)
            if not given:
                assert document[name]["reasons"][key] == (NO_POINTS if key == "points" else NO_CURVE)
    counts = document["counts"]
    parts = (OF_POINTS if points else set()) | (OF_CURVE if curve else set())
    assert set(counts) == {"cloud", "oriented", "loop_points"} | parts
    assert counts["cloud"] == len(made[0])
    assert counts["loop_points"] == quality.loops.points
    if curve:
        assert (counts["nodes"], counts["edges"]) == (len(made[1].nodes), len(made[1].edges))
    assert set(document["settings"]) == {*MetricParams.__dataclass_fields__, "correspondence", "oriented_by"}
    assert set(quality.seconds) <= PARTS
    assert set(quality.seconds) == PARTS or not (points and curve)


@pytest.fixture(scope="module")
def stability() -> Stability:
    cloud = make_shape("capsule", ShapeParams(count=400))[0]
    return assess_stability(contract(cloud, GlsParams()))


def test_stability_says_the_last_verdict_and_every_step(stability: Stability) -> None:
    document = json.loads(json.dumps(stability.as_dict(), allow_nan=False))
    assert set(document) == {"stable", "reason", "points", "steps", "settings"}
    last = stability.steps[-1]
    assert (document["stable"], document["reason"], document["points"]) == (last.stable, last.reason, stability.points)
    assert [step["step"] for step in document["steps"]] == list(range(1, len(stability.steps) + 1))
    for said, step in zip(document["steps"], stability.steps, strict=True):
        for name in ("distance", "control_distance", "median_curvature", "in_hull", "in_cloud", "control_passes"):
            assert said[name] == getattr(step, name), name
        assert {"angles", "curvatures"}.isdisjoint(said)
        assert step.distance != step.control_distance


def test_a_step_that_is_not_stable_says_what_the_normals_do(stability: Stability) -> None:
    params = stability.params
    far = params.distance + 0.01
    for angles, said in (
        (np.full(100, 0.9), "points drifted: 100% of the normals turned by more than a right angle"),
        (np.full(100, 0.1), "normals have hardly turned, by 0.10 pi on average: it is still a surface"),
        (np.full(100, 0.3), "normals are not spread evenly across a curve"),
    ):
        stable, reason = verdict(far, 0.0, angles, params)
        assert not stable
        assert reason == f"{said} (distance {far:.3f}, at most {params.distance})"
    stable, reason = verdict(0.0, params.curvature + 0.01, np.full(100, 0.3), params)
    assert (stable, reason[:20]) == (False, "what is left is thic")
    assert verdict(params.distance, params.curvature, np.full(100, 0.3), replace(params))[0]
