"""Stages that the settings leave out are not done; what is done is as with all of them."""

import pytest

from tiskel import PipelineParams, ShapeParams, TiskelError, make_shape, run_pipeline, shape_graph


def test_only_the_stages_asked_for_are_done() -> None:
    cloud = make_shape(shape_graph("capsule"), ShapeParams(count=400))[0]
    parts: list[str] = []
    alone = run_pipeline(cloud, PipelineParams(stages=("surface",)), observer=lambda done: parts.append(done.part))
    assert parts == ["condition", "contract", "skeleton", "surface"]
    assert (alone.quality, alone.stability, alone.trajectories, alone.reason) == (None, None, (), "")
    rolled = run_pipeline(cloud, PipelineParams(stages=("roll",)))
    assert rolled.surface is not None
    assert alone.surface is not None
    assert rolled.surface.radius == alone.surface.radius
    assert len(rolled.trajectories) == 1
    assert run_pipeline(cloud, PipelineParams(stages=())).surfaces is None


def test_a_stage_that_is_none_is_refused() -> None:
    with pytest.raises(TiskelError, match="stages must be one of contract"):
        PipelineParams(stages=("report",))  # type: ignore[arg-type]
