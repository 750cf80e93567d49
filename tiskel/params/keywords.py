"""All settings as keywords, for type checkers and editors; names and types are those of the dataclasses beside."""

from typing import Literal, TypedDict

from tiskel.params.conditioning import NoiseKind
from tiskel.params.methods import (
    MaxPoints,
    Method,
    Normalisation,
    Place,
    RegimeChoice,
    Solver,
    Topology,
    Variant,
)
from tiskel.params.metrics import Bars, BetaRule
from tiskel.params.plan import Quaternion
from tiskel.params.roll import Model, Normals, OnMeeting, Side, Trusted, Twist
from tiskel.params.stability import Orientation
from tiskel.params.surface import FrameRule, OrderRule
from tiskel.params.tiles import Parts


class MethodSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.ContractionParams`, of all methods together."""

    method: Method
    neighbours: int | None
    max_steps: int
    normalise: Normalisation
    resolution: float
    max_points: MaxPoints
    least_part: float
    extra_fronts: int
    least_branch: float
    merge_junctions: float
    grow_ends: int
    bridge_gaps: float
    straightness: float
    rounds: int
    regime: RegimeChoice
    topology: Topology
    root: Place | None
    seen_from: Place | None
    solver: Solver
    growth: float
    contraction_weight: float | None
    attraction_weight: float
    max_contraction_weight: float
    max_attraction_weight: float
    cotangent_cap: float
    box_growth: float
    raw: bool
    radius: float
    stop_ratio: float
    variant: Variant
    min_steps: int
    epsilon: float
    phi: float
    theta: float
    guard: float


class SkeletonSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.SkeletonParams`."""

    raw: bool | None
    radius: float | None
    extra_fronts: int | None
    least_branch: float | None
    merge_junctions: float | None
    grow_ends: int | None
    bridge_gaps: float | None
    straightness: float | None
    rounds: int | None
    regime: RegimeChoice | None
    topology: Topology | None
    root: Place | None
    seen_from: Place | None


class MetricSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.MetricParams`."""

    bars: Bars
    diagonal: bool
    beta: BetaRule
    bounded: float
    similar: float
    normalise: Normalisation
    threshold: float
    curve_samples: int
    slab: float
    gap: float
    tangent_neighbours: int
    smooth_neighbours: int
    loop_ratio: float
    loop_points: int
    seed: int


class StabilitySettings(TypedDict, total=False):
    """Settings of :class:`tiskel.StabilityParams`."""

    normals: Orientation
    neighbours: int
    bins: int
    prominence: float
    distance: float
    curvature: float
    seed: int


class SurfaceSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.SurfaceParams`."""

    branch: str
    interval: float
    m: tuple[float, float, float] | FrameRule
    order_rule: OrderRule
    least_order: int
    most_order: int
    fit_error: float
    recentre: bool
    gap: float
    least_points: int
    uneven: float


class BodySettings(TypedDict, total=False):
    """Settings of :class:`tiskel.BodyParams`."""

    neighbours: tuple[int, ...]
    noise: float
    exact: float
    widest: float
    reach: float
    spread: float
    facing: float
    tubes: float
    most: int


class RollSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.RollParams`."""

    model: Model
    side: Side
    radius: float | None
    omega: tuple[float, float, float]
    velocity: tuple[float, float, float]
    twist: Twist
    duration: float | None
    rate: float
    start: tuple[float, float, float, float, float]
    start_at: tuple[float, float, float] | None
    attitude: tuple[float, float, float, float]
    heading: tuple[float, float, float] | None
    on_meeting: OnMeeting
    trusted: Trusted
    normals: Normals
    neighbours: int
    meet: bool
    rtol: float
    atol: float


class PlanSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.PlanParams`."""

    start_at: Place
    goal: Place
    start_attitude: Quaternion
    attitude: Quaternion | None
    side: Side
    radius: float | None
    spin: bool
    avoid: tuple[tuple[float, float, float, float], ...]
    speed: float
    near: float
    within: float
    most_places: int
    seed: int


class ConditioningSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.ConditioningParams`."""

    columns: tuple[str, ...] | None
    classification: tuple[int, ...] | None
    crop: tuple[float, ...] | None
    outliers: bool
    voxel: float | None
    sample: int | None
    cap: bool
    noise: float
    noise_kind: NoiseKind
    seed: int


class ShapeSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.ShapeParams`."""

    count: int
    noise: float
    missing: float
    uneven: float
    seed: int
    views: tuple[tuple[float, float, float], ...]
    sensor_distance: float
    sensor_noise: float
    table: bool


class SplitSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.SplitParams`."""

    parts: Parts
    points: int
    size: float | None
    overlap: float | None
    gap: float | None
    least: int


class JoinSettings(TypedDict, total=False):
    """Settings of :class:`tiskel.JoinParams`."""

    keep: int | Literal["all"]
    incomplete: bool
