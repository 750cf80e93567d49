"""Settings of every stage, with their defaults and where they come from.

These dataclasses are the only place where a default is written down; the
command line reads them from here, so nothing in this room needs NumPy. Values
marked [T] are those of the published MATLAB toolboxes, which produced the
published tables.
"""

from tiskel.params.batch import BatchParams
from tiskel.params.body import BodyParams
from tiskel.params.conditioning import ConditioningParams, NoiseKind
from tiskel.params.look import UPS, LookParams, Up
from tiskel.params.methods import (
    MIN_POINTS,
    SIDE,
    ContractionParams,
    GlsParams,
    LaplacianParams,
    LbcParams,
    MaxPoints,
    Method,
    Normalisation,
    Place,
    RegimeChoice,
    RobustParams,
    Solver,
    Topology,
    Variant,
    known_settings,
    params_class,
    published_neighbours,
    settings_of,
)
from tiskel.params.metrics import Bars, BetaRule, MetricParams
from tiskel.params.pipeline import STAGES, PipelineParams, Stage
from tiskel.params.plan import PlanParams as PlanParams
from tiskel.params.roll import Model, Normals, RollParams, Side, Twist
from tiskel.params.shape import ShapeParams
from tiskel.params.skeleton import SkeletonParams
from tiskel.params.stability import Orientation, StabilityParams
from tiskel.params.surface import FrameRule, OrderRule, SurfaceParams
from tiskel.params.tiles import JoinParams, Parts, SplitParams

__all__ = [
    "MIN_POINTS",
    "SIDE",
    "STAGES",
    "UPS",
    "Bars",
    "BatchParams",
    "BetaRule",
    "BodyParams",
    "ConditioningParams",
    "ContractionParams",
    "FrameRule",
    "GlsParams",
    "JoinParams",
    "LaplacianParams",
    "LbcParams",
    "LookParams",
    "MaxPoints",
    "Method",
    "MetricParams",
    "Model",
    "NoiseKind",
    "Normalisation",
    "Normals",
    "OrderRule",
    "Orientation",
    "Parts",
    "PipelineParams",
    "Place",
    "RegimeChoice",
    "RobustParams",
    "RollParams",
    "ShapeParams",
    "Side",
    "SkeletonParams",
    "Solver",
    "SplitParams",
    "StabilityParams",
    "Stage",
    "SurfaceParams",
    "Topology",
    "Twist",
    "Up",
    "Variant",
    "known_settings",
    "params_class",
    "published_neighbours",
    "settings_of",
]
