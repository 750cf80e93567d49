"""All stages of one cloud, from what is done to it first to a sphere that rolls on it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy.typing as npt

from tiskel import messages
from tiskel.arrays import Points, PointsLike
from tiskel.contraction import Contraction, contract
from tiskel.errors import TiskelError
from tiskel.geometry.given import given_cloud
from tiskel.geometry.mesh_surface import MeshSurface, still_on
from tiskel.messages import Message, Messages
from tiskel.metrics.evaluate import evaluate
from tiskel.metrics.result import Quality
from tiskel.metrics.stability import Stability, assess_stability
from tiskel.params import PipelineParams
from tiskel.params.given import settled
from tiskel.preprocess.conditioning import condition
from tiskel.progress import Report
from tiskel.rolling.over import roll_over
from tiskel.rolling.trajectory import Trajectory
from tiskel.shown import Shown
from tiskel.skeleton import Skeleton, extract_skeleton
from tiskel.slicing.body import fit_whole
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.timing import Stopwatch

T = TypeVar("T")
Work = Callable[[], T]
Words = Callable[[T], Messages]  #: what there is to say about a result


@dataclass(frozen=True, eq=False)
class Finished:
    """A part of the pipeline that is done: condition, contract, skeleton, metrics, stability, surface or roll.

    Attributes
    ----------
    part : str
        Its name.
    result : object
        What it made; None where a surface or a roll was impossible.
    messages : tuple of Message
        What there is to say about it.
    """

    part: str
    result: Any
    messages: Messages


Observer = Callable[[Finished], None]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class PipelineResult(Shown):
    """What all stages made of one cloud; coordinates in the input's units.

    Attributes
    ----------
    points : (n, 3) float64
        The cloud as it was contracted: what conditioning left of the input.
    contraction : Contraction
    skeleton : Skeleton
    quality, stability
        None where the settings leave the stage out; surfaces and trajectories likewise.
    surfaces : Surfaces or None
        With that of the whole body; None where it could not be fitted, and then there are no trajectories.
    trajectories : tuple of Trajectory
        The runs over the body, or the longest surface of a branch; empty where the sphere cannot roll there.
    reason : str
        Why there are no surfaces or no trajectories, though asked for; else empty.
    seconds : dict
        Wall time by part, and of the inner parts of contraction and measures as "contract.X" and "metrics.X".
    messages : tuple of Message
        What there is to say, warnings included, in the order of the parts.
    params : PipelineParams

    Examples
    --------
    >>> from tiskel import ShapeParams, make_shape, run_pipeline, shape_graph
    >>> result = run_pipeline(make_shape(shape_graph("banana"), ShapeParams(count=400))[0])
    >>> result.skeleton.ends, result.surface.name, result.reason
    (2, '0', '')
    """

    _said = ("points", "skeleton", "surfaces", "trajectories", "reason")

    points: Points
    contraction: Contraction
    skeleton: Skeleton
    quality: Quality | None
    stability: Stability | None
    surfaces: Surfaces | None
    trajectories: tuple[Trajectory, ...]
    reason: str
    seconds: dict[str, float]
    messages: Messages
    params: PipelineParams

    @property
    def surface(self) -> FittedSurface | None:
        """The longest surface of a branch, which the sphere rolls on; None where no branch has one."""
        return self.surfaces.named(None) if self.surfaces else None


class _Record:
    """Times and messages of the parts, each told to the observer as soon as it is done."""

    def __init__(self, observer: Observer) -> None:
        self.observer, self.watch, self.messages = observer, Stopwatch(), messages.said(())

    def timed(self, part: str, work: Work[T]) -> T:
        with self.watch.measure(part):
            return work()

    def tell(self, part: str, result: T, lines: Messages) -> T:
        self.messages += lines
        self.observer(Finished(part, result, lines))
        return result

    def do(self, part: str, work: Work[T], words: Words[T]) -> T:
        result = self.timed(part, work)
        return self.tell(part, result, words(result))

    def attempt(self, part: str, work: Work[T], words: Words[T]) -> tuple[T, str] | tuple[None, str]:
        """Do what may be impossible; return None and the reason where it is."""
        try:
            result = self.timed(part, work)
        except TiskelError as error:
            what = "rolling" if part == "roll" else part
            self.tell(part, None, (Message(f"no {what}: {error}"),))
            return None, str(error)
        return self.tell(part, result, words(result)), ""


def run_pipeline(
    points: PointsLike,
    params: PipelineParams | None = None,
    weights: npt.ArrayLike | None = None,
    observer: Observer = lambda finished: None,
    surface: MeshSurface | None = None,
    progress: Report | None = None,
) -> PipelineResult:
    """Do everything with one cloud: condition, contract, skeleton, measures, stability, surfaces, rolling.

    Nothing is printed or written. Where no branch can have a surface, or the
    sphere cannot roll, the result says why and holds what there is.

    Parameters
    ----------
    points : (n, 3) array, Cloud, or object of Open3D or trimesh
        The cloud, in any unit; a mesh is sampled.
    params : PipelineParams, optional
        The settings of all stages.
    weights, surface
        See :func:`tiskel.contract`; not, or left out, where conditioning changes the points.
    observer : callable, optional
        Called after each part with a :class:`tiskel.pipeline.Finished`. What it raises ends the run.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts of the stages begin; every stage goes from 0 to 1.

    Returns
    -------
    PipelineResult

    Raises
    ------
    TiskelError
        As :func:`tiskel.condition`, :func:`tiskel.contract` and :func:`tiskel.extract_skeleton`.

    Examples
    --------
    >>> from tiskel import LbcParams, PipelineParams, ShapeParams, make_shape, run_pipeline, shape_graph
    >>> cloud = make_shape(shape_graph("capsule"), ShapeParams(count=400))[0]
    >>> parts = []
    >>> result = run_pipeline(
    ...     cloud, PipelineParams(contraction=LbcParams(max_steps=3)), observer=lambda done: parts.append(done.part)
    ... )
    >>> parts
    ['condition', 'contract', 'skeleton', 'metrics', 'stability', 'surface', 'roll']
    >>> len(result.contraction.steps), len(result.trajectories), result.reason
    (3, 1, '')
    """
    chosen, record = settled(PipelineParams, params, {}), _Record(observer)
    given, known = given_cloud(points)
    mesh = known if surface is None else surface
    ready, _ = record.do("condition", lambda: condition(given, chosen.conditioning), lambda r: messages.said(r[1]))
    c = record.do(
        "contract",
        lambda: contract(ready, chosen.contraction, weights, still_on(mesh, ready, given), progress=progress),
        messages.of_contraction,
    )
    s = record.do("skeleton", lambda: extract_skeleton(c, chosen.skeleton, progress=progress), messages.of_skeleton)
    quality = stability = None
    if "metrics" in chosen.stages:
        quality = record.do("metrics", lambda: evaluate(s, params=chosen.metrics, progress=progress), lambda _: ())
    if "stability" in chosen.stages:
        stability = record.do(
            "stability", lambda: assess_stability(c, chosen.stability, progress=progress), messages.of_stability
        )
    surfaces, trajectories, reason = _surfaces_and_runs(s, chosen, record, progress)
    return PipelineResult(
        points=ready,
        contraction=c,
        skeleton=s,
        quality=quality,
        stability=stability,
        surfaces=surfaces,
        trajectories=trajectories,
        reason=reason,
        seconds=record.watch.seconds | _inner_seconds(c, quality),
        messages=record.messages,
        params=chosen,
    )


def _surfaces_and_runs(
    skeleton: Skeleton, params: PipelineParams, record: _Record, progress: Report | None
) -> tuple[Surfaces | None, tuple[Trajectory, ...], str]:
    """Fit surfaces and roll over the longest; where that is impossible, return the reason and what there is."""
    if not {"surface", "roll"} & set(params.stages):
        return None, (), ""
    surfaces, reason = record.attempt(
        "surface",
        lambda: fit_whole(skeleton, params.surface, body=params.body, progress=progress),
        messages.of_surfaces,
    )
    if surfaces is None:
        return None, (), reason
    if "roll" not in params.stages:
        return surfaces, (), ""
    runs, reason = record.attempt(
        "roll",
        lambda: tuple(roll_over(surfaces, r, progress=progress) for r in params.roll),
        messages.of_runs,
    )
    return surfaces, runs or (), reason


def _inner_seconds(c: Contraction, quality: Quality | None) -> dict[str, float]:
    steps = {f"contract.{part}": sum(t.seconds.get(part, 0) for t in c.steps) for part in c.steps[0].seconds}
    measures = {f"metrics.{part}": seconds for part, seconds in (quality.seconds if quality else {}).items()}
    return steps | {"contract.rings": c.ring_seconds} | measures
