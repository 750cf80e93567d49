"""Curve skeletons of point clouds.

    from tiskel import skeletonize

    skeleton = skeletonize("in.ply")
    skeleton.nodes, skeleton.edges, skeleton.radius

Everything public is named here; modules load on first use, so that importing
the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tiskel.contraction import Contraction as Contraction
    from tiskel.contraction import contract as contract
    from tiskel.errors import TiskelError as TiskelError
    from tiskel.gallery.make import make_shape as make_shape
    from tiskel.gallery.make import named_shape as named_shape
    from tiskel.gallery.make import shape_graph as shape_graph
    from tiskel.geometry.doubt import CurveWarning as CurveWarning
    from tiskel.geometry.graph import CurveGraph as CurveGraph
    from tiskel.geometry.radius import RadiusSource as RadiusSource
    from tiskel.geometry.regime import Regime as Regime
    from tiskel.io.clouds import Cloud as Cloud
    from tiskel.io.clouds import load_cloud as load_cloud
    from tiskel.io.curves import Curve as Curve
    from tiskel.io.curves import load_curve as load_curve
    from tiskel.io.exports import write_skeleton as write_skeleton
    from tiskel.io.frames import skeleton_table as skeleton_table
    from tiskel.io.join import join_skeletons as join_skeletons
    from tiskel.io.split import split_cloud as split_cloud
    from tiskel.io.stages.contraction import read_contraction as read_contraction
    from tiskel.io.stages.contraction import write_contraction as write_contraction
    from tiskel.io.stages.skeleton import read_skeleton as read_skeleton
    from tiskel.io.stages.surface import read_surfaces as read_surfaces
    from tiskel.io.stages.surface import write_surfaces as write_surfaces
    from tiskel.methods.trace import Status as Status
    from tiskel.methods.trace import StepRecord as StepRecord
    from tiskel.metrics.comparison import Comparison as Comparison
    from tiskel.metrics.comparison import compare as compare
    from tiskel.metrics.evaluate import evaluate as evaluate
    from tiskel.metrics.result import Quality as Quality
    from tiskel.metrics.stability import Stability as Stability
    from tiskel.metrics.stability import assess_stability as assess_stability
    from tiskel.one_call import load_skeleton as load_skeleton
    from tiskel.one_call import plot_skeleton as plot_skeleton
    from tiskel.one_call import skeletonize as skeletonize
    from tiskel.params import BodyParams as BodyParams
    from tiskel.params import ConditioningParams as ConditioningParams
    from tiskel.params import ContractionParams as ContractionParams
    from tiskel.params import GlsParams as GlsParams
    from tiskel.params import JoinParams as JoinParams
    from tiskel.params import LbcParams as LbcParams
    from tiskel.params import LookParams as LookParams
    from tiskel.params import MetricParams as MetricParams
    from tiskel.params import PipelineParams as PipelineParams
    from tiskel.params import PlanParams as PlanParams
    from tiskel.params import RobustParams as RobustParams
    from tiskel.params import RollParams as RollParams
    from tiskel.params import ShapeParams as ShapeParams
    from tiskel.params import SkeletonParams as SkeletonParams
    from tiskel.params import SplitParams as SplitParams
    from tiskel.params import StabilityParams as StabilityParams
    from tiskel.params import SurfaceParams as SurfaceParams
    from tiskel.pipeline import PipelineResult as PipelineResult
    from tiskel.pipeline import run_pipeline as run_pipeline
    from tiskel.preprocess.conditioning import condition as condition
    from tiskel.progress import Progress as Progress
    from tiskel.rolling.bodies import BodyTrajectory as BodyTrajectory
    from tiskel.rolling.bodies import roll_body as roll_body
    from tiskel.rolling.inputs import Inputs as Inputs
    from tiskel.rolling.plan import Plan as Plan
    from tiskel.rolling.plan import plan_roll as plan_roll
    from tiskel.rolling.roll import roll as roll
    from tiskel.rolling.roll_on import roll_on as roll_on
    from tiskel.rolling.trajectory import RollStatus as RollStatus
    from tiskel.rolling.trajectory import Trajectory as Trajectory
    from tiskel.skeleton import Skeleton as Skeleton
    from tiskel.skeleton import extract_skeleton as extract_skeleton
    from tiskel.slicing.body import fit_body as fit_body
    from tiskel.slicing.body import fit_whole as fit_whole
    from tiskel.slicing.fit import fit_surface as fit_surface
    from tiskel.slicing.fitted import FittedSurface as FittedSurface
    from tiskel.slicing.fitted import Surfaces as Surfaces
    from tiskel.surfaces.patches import BodySurface as BodySurface
    from tiskel.surfaces.patches import Trust as Trust
    from tiskel.viewer.show import View as View
    from tiskel.viewer.show import view as view

_HOME = {
    "BodyParams": "params",
    "BodySurface": "surfaces.patches",
    "BodyTrajectory": "rolling.bodies",
    "Cloud": "io.clouds",
    "Comparison": "metrics.comparison",
    "ConditioningParams": "params",
    "Contraction": "contraction",
    "ContractionParams": "params",
    "Curve": "io.curves",
    "CurveGraph": "geometry.graph",
    "CurveWarning": "geometry.doubt",
    "FittedSurface": "slicing.fitted",
    "GlsParams": "params",
    "Inputs": "rolling.inputs",
    "JoinParams": "params",
    "LbcParams": "params",
    "LookParams": "params",
    "MetricParams": "params",
    "PipelineParams": "params",
    "PipelineResult": "pipeline",
    "Plan": "rolling.plan",
    "PlanParams": "params",
    "Progress": "progress",
    "Quality": "metrics.result",
    "RadiusSource": "geometry.radius",
    "Regime": "geometry.regime",
    "RobustParams": "params",
    "RollParams": "params",
    "RollStatus": "rolling.trajectory",
    "ShapeParams": "params",
    "Skeleton": "skeleton",
    "SkeletonParams": "params",
    "SplitParams": "params",
    "Stability": "metrics.stability",
    "StabilityParams": "params",
    "Status": "methods.trace",
    "StepRecord": "methods.trace",
    "SurfaceParams": "params",
    "Surfaces": "slicing.fitted",
    "TiskelError": "errors",
    "Trajectory": "rolling.trajectory",
    "Trust": "surfaces.patches",
    "View": "viewer.show",
    "assess_stability": "metrics.stability",
    "compare": "metrics.comparison",
    "condition": "preprocess.conditioning",
    "contract": "contraction",
    "evaluate": "metrics.evaluate",
    "extract_skeleton": "skeleton",
    "fit_body": "slicing.body",
    "fit_surface": "slicing.fit",
    "fit_whole": "slicing.body",
    "join_skeletons": "io.join",
    "load_cloud": "io.clouds",
    "load_curve": "io.curves",
    "load_skeleton": "one_call",
    "make_shape": "gallery.make",
    "named_shape": "gallery.make",
    "plan_roll": "rolling.plan",
    "plot_skeleton": "one_call",
    "read_contraction": "io.stages.contraction",
    "read_skeleton": "io.stages.skeleton",
    "read_surfaces": "io.stages.surface",
    "roll": "rolling.roll",
    "roll_body": "rolling.bodies",
    "roll_on": "rolling.roll_on",
    "run_pipeline": "pipeline",
    "shape_graph": "gallery.make",
    "skeleton_table": "io.frames",
    "skeletonize": "one_call",
    "split_cloud": "io.split",
    "view": "viewer.show",
    "write_contraction": "io.stages.contraction",
    "write_skeleton": "io.exports",
    "write_surfaces": "io.stages.surface",
}
__all__ = sorted(_HOME)  # noqa: PLE0605


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from tiskel.version import version

        return version()
    if name not in _HOME:
        raise AttributeError(f"module 'tiskel' has no attribute {name!r}")
    return getattr(import_module(f"tiskel.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return [*_HOME, "__version__"]
