"""Settings of every stage, with their defaults and where they come from.

These dataclasses are the only place where a default is written down; the
command line reads them from here. Values marked [T] are those of the published
MATLAB toolboxes, which produced the published tables.
"""

from dataclasses import dataclass
from math import inf, isfinite, pi
from typing import Literal, get_args

from tiskel.errors import TiskelError

Method = Literal["robust", "gls", "lbc"]
Normalisation = Literal["side", "diagonal"]
Solver = Literal["scipy", "cholmod"]
Bars = Literal["toolbox", "max"]
OrderRule = Literal["cross-validated", "published"]
Model = Literal["global", "local"]
Side = Literal["outside", "inside"]
Twist = Literal["object", "sphere", "world"]
Normals = Literal["surface", "pca"]

MIN_POINTS = 10  #: fewer distinct points have no surface to speak of
SIDE = 1.6  #: length that normalisation gives the longest side or the diagonal [T]


@dataclass(frozen=True, kw_only=True)
class ContractionParams:
    """Settings of :func:`tiskel.contract`; lengths in normalised units, weights without unit."""

    method: Method = "robust"
    neighbours: int | None = None  #: k nearest, the point included; None: 14 for robust, else published_neighbours [T]
    max_steps: int | None = None  #: None: 3 for robust, 10 for gls, 20 for lbc [T]
    normalise: Normalisation = "side"  #: what is scaled to 1.6: the longest side [T], or the diagonal (Wen et al.)
    solver: Solver = "scipy"
    growth: float = 3.0  #: s_L, factor of the contraction weight per step [T]
    max_contraction_weight: float = 2048.0  #: cap of W_L [T]
    max_attraction_weight: float = 10000.0  #: cap of W_H [T]
    cotangent_cap: float = 10000.0  #: cap of the absolute sum of a row's cotangents [T]
    box_growth: float = 1.2  #: a step that grows a side of the bounding box by more is discarded [T]
    stop_ratio: float = 0.01  #: lbc stops when the ratio of ring sizes falls by less [T]
    min_steps: int = 3  #: gls keeps at least so many steps [T]
    epsilon: float = 1.2  #: gls, factor of the mean ring shrinkage [T]
    phi: float = 1e5  #: gls, a point merges where F < phi s^2 [T]
    theta: float = 0.02  #: gls, least change of the explained score [T]
    guard: float = 1e-4  #: gls, stands in for eta s_i(0) where that is not positive [T]

    def __post_init__(self) -> None:
        _among("method", self.method, get_args(Method))
        _among("normalise", self.normalise, get_args(Normalisation))
        _among("solver", self.solver, get_args(Solver))
        _at_least("neighbours", self.neighbours, 4)
        _at_least("max_steps", self.max_steps, 1)
        _at_least("min_steps", self.min_steps, 1)

    def neighbours_for(self, count: int) -> int:
        """Return k for a cloud of so many points."""
        usual = 14 if self.method == "robust" else published_neighbours(count)
        return min(count, self.neighbours or usual)

    def step_limit(self) -> int:
        """Return the largest number of steps of the chosen method."""
        return self.max_steps or {"robust": 3, "gls": 10, "lbc": 20}[self.method]


@dataclass(frozen=True, kw_only=True)
class SkeletonParams:
    """Settings of :func:`tiskel.extract_skeleton`."""

    raw: bool = False  #: exactly as published: no spur removal
    radius: float = 0.02  #: of the sampling balls, as a share of the diagonal of the original cloud [T]

    def __post_init__(self) -> None:
        if not 0 < self.radius < 1:
            raise TiskelError(f"radius must be a share of the diagonal between 0 and 1, got {self.radius}")


@dataclass(frozen=True, kw_only=True)
class MetricParams:
    """Settings of :func:`tiskel.evaluate`; d_B and d_W in normalised units, the rest are ratios and counts."""

    bars: Bars = "toolbox"  #: which H0 bars are compared: [T], or those longer than every nearest-neighbour distance
    diagonal: bool = True  #: bars may be matched to the diagonal [T]; the paper has bijections only
    similar: float = 0.02  #: d*, the topology is similar where d_B and d_W are below
    normalise: Normalisation = "side"  #: what is scaled to 1.6: the longest side [T], or the diagonal
    threshold: float = 0.75  #: overall centredness is the share above [T]
    curve_samples: int = 200  #: places on the curve, about so many [T]
    slab: float = 0.01  #: half the thickness of a cross-section, as a share of the diagonal [T]
    gap: float = 1.5  #: a section ends where the next point is so many times as far away [T]
    tangent_neighbours: int = 8  #: nearest others whose scatter gives the tangent at a skeletal point
    smooth_neighbours: int = 4  #: nearest others that this tangent is held against
    loop_ratio: float = 4.0  #: a loop of the surface lasts to so many times the length at which it is born
    loop_points: int = 16384  #: larger clouds are thinned to a random subset of so many for their loops
    seed: int = 0  #: of that subset, and of the check of the normals

    def __post_init__(self) -> None:
        _among("bars", self.bars, get_args(Bars))
        _among("normalise", self.normalise, get_args(Normalisation))
        for name in ("curve_samples", "tangent_neighbours", "smooth_neighbours"):
            _at_least(name, getattr(self, name), 1)
        _at_least("loop_points", self.loop_points, MIN_POINTS)
        if not 0 < self.slab < 1:
            raise TiskelError(f"slab must be a share of the diagonal between 0 and 1, got {self.slab}")


@dataclass(frozen=True, kw_only=True)
class StabilityParams:
    """Settings of :func:`tiskel.assess_stability`.

    The thresholds were found on sixteen shapes, five scans and models, a box
    and a ball, each contracted by lbc and gls, and held on nine more shapes:
    what contracts to a curve has distances of 0.02 to 0.11, box and ball of
    0.21 and more, and nothing lies between 0.11 and 0.14. Curves have median
    changes of curvature below 0.016, clumps and tubes that are still thick
    above 0.03.
    """

    neighbours: int = 9  #: whose scatter gives normal and curvature, the point included [T]
    bins: int = 50  #: of the histograms whose peaks are counted
    prominence: float = 0.02  #: a peak falls by so large a share of the points on both sides
    distance: float = 0.12  #: largest distance of the angles' distribution from the uniform one on [0, 1/2]
    curvature: float = 0.02  #: largest median change of curvature
    seed: int = 0  #: of the random signs of the control

    def __post_init__(self) -> None:
        _at_least("neighbours", self.neighbours, 4)
        _at_least("bins", self.bins, 2)


@dataclass(frozen=True, kw_only=True)
class SurfaceParams:
    """Settings of :func:`tiskel.fit_surface`; lengths in the input's unit, angles in radians."""

    branch: str = "all"  #: a number, "all", or "longest": the longest path between two ends, through joints
    interval: float = 0.02  #: between slices, as a share of the diagonal of the cloud [T]
    m: tuple[float, float, float] | Literal["normal", "rotation-minimising"] = (0.0, 0.0, 1.0)  #: sets where u is 0 [T]
    order_rule: OrderRule = "cross-validated"  #: or until the RMS error is below fit_error, in the unit of length [T]
    least_order: int = 3  #: of the Fourier series [T]
    most_order: int = 8  #: [T]
    fit_error: float = 1e-3  #: of the published rule [T]
    recentre: bool = True  #: the skeleton curve moves to the middles of its sections before the surface is fitted
    gap: float = pi / 2  #: a section that misses a larger angle is rejected
    least_points: int = 12  #: a section of fewer is rejected
    uneven: float = 0.45  #: share of the radius that a point of a star-shaped section is off at most, but for a tenth

    def __post_init__(self) -> None:
        _among("order_rule", self.order_rule, get_args(OrderRule))
        if isinstance(self.m, str):
            _among("m", self.m, ("normal", "rotation-minimising"))
        elif len(self.m) != 3 or not any(self.m):
            raise TiskelError(f"m must be a direction of three numbers, not all 0, got {self.m}")
        if self.branch not in ("all", "longest") and not self.branch.isdigit():
            raise TiskelError(f"branch must be all, longest or a number, got {self.branch!r}")
        if not 0 < self.interval < 1:
            raise TiskelError(f"interval must be a share of the diagonal between 0 and 1, got {self.interval}")
        if not 1 <= self.least_order <= self.most_order:
            raise TiskelError(f"orders must rise from at least 1, got {self.least_order} to {self.most_order}")


@dataclass(frozen=True, kw_only=True)
class RollParams:
    """Settings of :func:`tiskel.roll`; lengths in the input's unit, angles in radians, times in seconds.

    omega and velocity are those of the object relative to the sphere in the
    axes of the contact frame (twist "object"), of the sphere relative to the
    object in the axes of the sphere's own frame at the contact ("sphere"), or
    of the sphere in the axes of the cloud ("world"); velocities are those of
    the material at the contact and have no part along the normal.
    """

    model: Model = "global"
    side: Side = "outside"
    radius: float | None = None  #: of the sphere; None: a quarter of the median radius of the surface
    omega: tuple[float, float, float] = (0.0, 1.0, 0.0)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: slip
    twist: Twist = "object"
    duration: float | None = None  #: None: 10, or as long as the inputs last
    rate: float = 100.0  #: rows of the trajectory per second
    start: tuple[float, float, float, float, float] = (0.1, pi / 2, 0.1, 0.1, pi / 2)  #: u_o, v_o, u_s, v_s, psi [T]
    start_at: tuple[float, float, float] | None = (
        None  #: instead of u_o and v_o, the point of the surface nearest to it
    )
    normals: Normals = "surface"  #: where curvature comes from; "pca": normals of neighbours, as printed, to compare
    neighbours: int = 20  #: of these normals [T]
    meet: bool = True  #: the run ends where the sphere meets another part of the cloud
    rtol: float = 1e-6  #: of the solver, relative; published: 1e-3, slipping by per cents where the sphere hardly fits
    atol: float = 1e-8  #: of the solver, absolute; published: 1e-5

    def __post_init__(self) -> None:
        _among("model", self.model, get_args(Model))
        _among("side", self.side, get_args(Side))
        _among("twist", self.twist, get_args(Twist))
        _among("normals", self.normals, get_args(Normals))
        _at_least("neighbours", self.neighbours, 6)
        for name, count in (("omega", 3), ("velocity", 3), ("start", 5), ("start_at", 3)):
            _finite(name, getattr(self, name), count)
        for name in ("radius", "duration", "rate", "rtol", "atol"):
            value = getattr(self, name)
            if value is not None and not 0 < value < inf:
                raise TiskelError(f"{name} must be a positive number, got {value}")
        if self.twist != "world" and self.velocity[2] != 0:
            raise TiskelError(f"velocity along the normal must be 0, contact is kept; got {self.velocity[2]}")

    @property
    def sigma(self) -> float:
        """1 outside, -1 inside."""
        return 1.0 if self.side == "outside" else -1.0


def published_neighbours(count: int) -> int:
    """Return k = clip(round(0.012 n), 8, 30), and no more than there are points [T]."""
    return min(count, max(round(0.012 * count), 8), 30)


def _among(name: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise TiskelError(f"{name} must be one of {', '.join(allowed)}, got {value!r}")


def _at_least(name: str, value: int | None, least: int) -> None:
    if value is not None and value < least:
        raise TiskelError(f"{name} must be at least {least}, got {value}")


def _finite(name: str, values: tuple[float, ...] | None, count: int) -> None:
    if values is not None and (len(values) != count or not all(map(isfinite, values))):
        raise TiskelError(f"{name} must be {count} finite numbers, got {values}")
