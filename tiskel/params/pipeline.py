"""Settings of all stages of one cloud."""

from dataclasses import dataclass, field
from typing import Literal, get_args

from tiskel.params.body import BodyParams
from tiskel.params.checks import among
from tiskel.params.conditioning import ConditioningParams
from tiskel.params.methods import ContractionParams, RobustParams
from tiskel.params.metrics import MetricParams
from tiskel.params.roll import RollParams
from tiskel.params.skeleton import SkeletonParams
from tiskel.params.stability import StabilityParams
from tiskel.params.surface import SurfaceParams

Stage = Literal["contract", "skeleton", "metrics", "stability", "surface", "roll"]
STAGES: tuple[Stage, ...] = get_args(Stage)


def over_the_body() -> tuple[RollParams, ...]:
    """Return the settings of a run over the whole body."""
    return (RollParams(model="body"),)


@dataclass(frozen=True, kw_only=True)
class PipelineParams:
    """Settings of :func:`tiskel.run_pipeline`, one object for each stage.

    Raises TiskelError where a setting of the curve is none of the method's.

    Examples
    --------
    >>> from tiskel import LbcParams, PipelineParams
    >>> params = PipelineParams(contraction=LbcParams(max_steps=5))
    >>> params.contraction.max_steps, params.surface.branch, [run.model for run in params.roll]
    (5, 'all', ['body'])
    """

    conditioning: ConditioningParams = field(default_factory=ConditioningParams)
    contraction: ContractionParams = field(default_factory=RobustParams)
    skeleton: SkeletonParams = field(default_factory=SkeletonParams)
    metrics: MetricParams = field(default_factory=MetricParams)
    stability: StabilityParams = field(default_factory=StabilityParams)
    surface: SurfaceParams = field(default_factory=SurfaceParams)
    body: BodyParams = field(default_factory=BodyParams)  #: the surface of the whole body
    roll: tuple[RollParams, ...] = field(
        default_factory=over_the_body
    )  #: one run each; on a branch, over the longest surface
    stages: tuple[Stage, ...] = STAGES  #: which are done; the first two always, the surface where a sphere is to roll

    def __post_init__(self) -> None:
        for stage in self.stages:
            among("stages", stage, STAGES)
        self.skeleton.over(self.contraction)
