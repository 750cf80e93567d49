"""What the stages tell of how far they are: ascending shares that end at 1, and the same results as unobserved."""

from collections.abc import Callable

import numpy as np
import pytest

from tiskel import (
    Contraction,
    GlsParams,
    LbcParams,
    PipelineParams,
    Progress,
    RollParams,
    ShapeParams,
    Skeleton,
    StabilityParams,
    SurfaceParams,
    assess_stability,
    contract,
    evaluate,
    extract_skeleton,
    fit_surface,
    make_shape,
    roll,
    roll_body,
    run_pipeline,
    shape_graph,
)
from tiskel.arrays import Points
from tiskel.io.stages.contraction import dump_contraction
from tiskel.io.stages.skeleton import dump_skeleton
from tiskel.progress import Report, Span
from tiskel.surfaces.analytic import Ellipsoid, Torus


@pytest.fixture(scope="module")
def tree() -> Points:
    """A Y of thin limbs: two further fronts may be tried on it, and it has three branches."""
    return make_shape(shape_graph("y"), ShapeParams(count=900))[0]


@pytest.fixture(scope="module")
def contraction(tree: Points) -> Contraction:
    return contract(tree)


@pytest.fixture(scope="module")
def skeleton(contraction: Contraction) -> Skeleton:
    return extract_skeleton(contraction)


def told_by(stage: Callable[[Report], object]) -> list[Progress]:
    """Return what a stage tells; check that it names its parts, and that shares ascend from 0 to 1."""
    told: list[Progress] = []
    stage(told.append)
    shares = [one.share for one in told]
    assert shares == sorted(shares)
    assert (shares[0], shares[-1]) == (0.0, 1.0)
    assert len({one.stage for one in told}) == 1
    assert [one.part for one in told if not one.part] == [""]  # the last alone
    return told


@pytest.mark.parametrize("params", [None, LbcParams(), LbcParams(max_steps=9, stop_ratio=0), GlsParams()])
def test_a_contraction_tells_and_stays_the_same(tree: Points, params: LbcParams | GlsParams | None) -> None:
    quiet = contract(tree, params)
    found: list[Contraction] = []
    told = told_by(lambda report: found.append(contract(tree, params, progress=report)))
    assert dump_contraction(found[0], history=True) == dump_contraction(quiet, history=True)
    steps = sum(one.part.startswith("step") for one in told)
    assert steps >= len(quiet.steps) * (params is not None)


def test_a_skeleton_tells_and_stays_the_same(contraction: Contraction, skeleton: Skeleton) -> None:
    found: list[Skeleton] = []
    told = told_by(lambda report: found.append(extract_skeleton(contraction, progress=report)))
    assert dump_skeleton(found[0]) == dump_skeleton(skeleton)
    assert {"solid", "fit", "doubts"} <= {one.part for one in told}


def test_a_published_curve_tells(tree: Points) -> None:
    c = contract(tree, LbcParams(max_steps=3))
    assert [one.part for one in told_by(lambda report: extract_skeleton(c, progress=report))][1:3] == [
        "samples", "triangles",
    ]  # fmt: skip


def test_measures_tell_part_by_part(skeleton: Skeleton) -> None:
    told = told_by(lambda report: evaluate(skeleton, progress=report))
    assert {"topology", "boundedness", "medialness"} <= {one.part for one in told}
    assert evaluate(skeleton, progress=lambda told: None).as_dict() == evaluate(skeleton).as_dict()


def test_stability_tells_step_by_step(contraction: Contraction) -> None:
    told = told_by(lambda report: assess_stability(contraction, StabilityParams(), progress=report))
    assert len(told) == 2 + len(contraction.steps)


def test_slices_and_rolls_tell(skeleton: Skeleton) -> None:
    told = told_by(lambda report: fit_surface(skeleton, SurfaceParams(), progress=report))
    assert len(told) == 2 + len(skeleton.branches)
    surface = fit_surface(skeleton).named(None)
    params = RollParams(duration=2.0, omega=(0, 0, 1))
    runs = [roll(surface, params)]
    told = told_by(lambda report: runs.append(roll(surface, params, progress=report)))
    assert np.array_equal(runs[0].state, runs[1].state)
    assert 3 < len(told) <= 103


def test_a_pipeline_tells_every_stage_from_0_to_1(tree: Points) -> None:
    told: list[Progress] = []
    run_pipeline(tree, PipelineParams(), progress=told.append)
    runs = [[one.share for one in told if one.stage == stage] for stage in dict.fromkeys(one.stage for one in told)]
    assert list(dict.fromkeys(one.stage for one in told)) == [
        "contract", "skeleton", "metrics", "stability", "slice", "body", "roll",
    ]  # fmt: skip
    assert all((shares[0], shares[-1]) == (0.0, 1.0) for shares in runs)


def test_two_bodies_tell_how_far_they_are() -> None:
    params = RollParams(omega=(0.5, 0.3, 0), start=(0.3, 1.0, 0.1, 0.1, 0.4), duration=1, rate=10)
    over, rolling = Torus(5.0, 2.0), Ellipsoid(0.3, 0.4, 0.25)
    runs = [roll_body(over, rolling, params)]
    told = told_by(lambda report: runs.append(roll_body(over, rolling, params, progress=report)))
    assert np.array_equal(runs[0].state, runs[1].state)
    assert 3 < len(told) <= 103


def test_what_the_callback_raises_ends_the_stage(tree: Points) -> None:
    def enough(told: Progress) -> None:
        if told.share > 0:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        contract(tree, progress=enough)


def test_steps_beyond_the_usual_number_still_ascend() -> None:
    told: list[Progress] = []
    span = Span(told.append, "contract").within(0.5, 1)
    for number in range(8):
        span.step(number, 3)
    shares = [one.share for one in told]
    assert shares == sorted(shares)
    assert shares[:4] == pytest.approx([1 / 2, 2 / 3, 5 / 6, 7 / 8])
    assert shares[-1] < 1
