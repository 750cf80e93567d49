"""All stages in one call: the same results as one by one, every part told, and reasons where there is no more."""

from dataclasses import replace

import numpy as np
import pytest

from tiskel import (
    ConditioningParams,
    LbcParams,
    PipelineParams,
    PipelineResult,
    RobustParams,
    RollParams,
    ShapeParams,
    SkeletonParams,
    SurfaceParams,
    TiskelError,
    assess_stability,
    condition,
    contract,
    evaluate,
    extract_skeleton,
    fit_surface,
    make_shape,
    roll,
    run_pipeline,
    shape_graph,
)
from tiskel.pipeline import Finished

PARAMS = PipelineParams(
    conditioning=ConditioningParams(sample=600),
    contraction=RobustParams(neighbours=13),
    skeleton=SkeletonParams(rounds=3),
    surface=SurfaceParams(interval=0.03),
    roll=(RollParams(duration=1.0),),
)


@pytest.fixture(scope="module")
def cloud() -> np.ndarray:
    return make_shape(shape_graph("banana"), ShapeParams(count=700))[0]


@pytest.fixture(scope="module")
def result(cloud: np.ndarray) -> PipelineResult:
    return run_pipeline(cloud, PARAMS)


def test_results_are_those_of_the_stages_one_by_one(cloud: np.ndarray, result: PipelineResult) -> None:
    points = condition(cloud, PARAMS.conditioning)[0]
    c = contract(points, PARAMS.contraction)
    s = extract_skeleton(c, PARAMS.skeleton)
    surfaces = fit_surface(s, PARAMS.surface)
    trajectory = roll(surfaces.named(None), PARAMS.roll[0])
    np.testing.assert_array_equal(result.points, points)
    np.testing.assert_array_equal(result.contraction.points, c.points)
    np.testing.assert_array_equal(result.skeleton.nodes, s.nodes)
    assert result.quality is not None
    assert result.stability is not None
    assert result.quality.as_dict() == evaluate(s).as_dict()
    assert result.stability.as_dict() == assess_stability(c).as_dict()
    np.testing.assert_array_equal(result.trajectories[0].contact, trajectory.contact)
    assert result.surface is not None
    assert result.surface.name == surfaces.named(None).name
    assert result.reason == ""


def test_every_part_is_told_once_and_timed(cloud: np.ndarray, capfd: pytest.CaptureFixture[str]) -> None:
    run_pipeline(cloud, PARAMS)  # Taichi greets once a process
    capfd.readouterr()
    finished: list[Finished] = []
    result = run_pipeline(cloud, PARAMS, observer=finished.append)
    parts = ["condition", "contract", "skeleton", "metrics", "stability", "surface", "roll"]
    assert [one.part for one in finished] == parts
    assert [part for part in result.seconds if "." not in part] == parts
    assert result.seconds["contract.rings"] > 0
    assert result.messages == tuple(message for one in finished for message in one.messages)
    said = [message.text for message in result.messages]
    assert said[0] == "sampling took away 100 points"
    assert said[1].startswith("contracted 600 points in 3 steps")
    assert finished[1].result is result.contraction
    assert capfd.readouterr() == ("", "")


def test_what_is_impossible_has_a_reason(cloud: np.ndarray) -> None:
    rolled = run_pipeline(cloud, replace(PARAMS, roll=(RollParams(side="inside", radius=9.0),)))
    assert rolled.surfaces is not None
    assert (rolled.trajectories, "a sphere of radius 9" in rolled.reason) == ((), True)
    assert rolled.messages[-1].text == f"no rolling: {rolled.reason}"
    few = run_pipeline(cloud, replace(PARAMS, surface=SurfaceParams(interval=0.9)))
    assert few.surfaces is not None
    assert few.surfaces.body is not None
    assert (len(few.surfaces), few.surface, few.trajectories) == (0, None, ())
    assert "too short for 4 slices" in next(iter(few.surfaces.rejected.values()))
    assert "only the whole body has one" in few.reason
    assert few.messages[-1].text == f"no rolling: {few.reason}"
    assert few.seconds["surface"] > 0


@pytest.mark.parametrize("part", ["contract", "surface", "roll"])
def test_an_observer_that_raises_ends_the_run(part: str, cloud: np.ndarray) -> None:
    """As --strict does at the first warning, of a surface too."""

    def strict(finished: Finished) -> None:
        if finished.part == part:
            raise TiskelError(f"enough of {part}")

    with pytest.raises(TiskelError, match=f"enough of {part}"):
        run_pipeline(cloud, PARAMS, observer=strict)


def test_wrong_settings_are_told_before_the_work_begins(cloud: np.ndarray) -> None:
    with pytest.raises(TiskelError, match="rounds is a setting of method robust"):
        PipelineParams(contraction=LbcParams(), skeleton=SkeletonParams(rounds=2))
    fewer = PipelineParams(conditioning=ConditioningParams(sample=600), contraction=LbcParams())
    with pytest.raises(TiskelError, match=r"each of the 600 points, got shape \(700,\); leave out"):
        run_pipeline(cloud, fewer, weights=np.ones(700))
