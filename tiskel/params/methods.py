"""Settings of the methods, one class each, for their contraction and for their curve.

A method has only the settings that it reads; one that is given to another method
is an error that names the method it belongs to.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from math import inf
from typing import Any, Literal, get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among, at_least, between, finite, meant, of_its_type, so_many

Method = Literal["robust", "gls", "lbc"]
Normalisation = Literal["side", "diagonal"]
Variant = Literal["paper", "toolbox"]
Solver = Literal["scipy", "cholmod"]
RegimeChoice = Literal["auto", "tube", "wire"]
Topology = Literal["auto", "tree", "loops"]
Place = tuple[float, float, float]
MaxPoints = int | Literal["auto", "all"]

MIN_POINTS = 10  #: fewer distinct points have no surface to speak of
SIDE = 1.6  #: length that normalisation gives the longest side or the diagonal [T]


class ContractionParams:
    """Settings of :func:`tiskel.contract` and of the curve that follows, chosen by the method.

    ``ContractionParams(method="gls", theta=0.03)`` is ``GlsParams(theta=0.03)``.
    Raises TiskelError for a setting that the method does not read.

    Examples
    --------
    >>> from tiskel import ContractionParams
    >>> ContractionParams(method="lbc", max_steps=5).max_steps
    5
    >>> ContractionParams(method="robust", solver="scipy")
    Traceback (most recent call last):
    tiskel.errors.TiskelError: solver is a setting of methods gls and lbc, robust does not read it; leave it out
    """

    method: Method
    normalise: Normalisation
    max_steps: int

    def __new__(cls, *, method: str = "robust", **settings: object) -> "ContractionParams":
        if cls is not ContractionParams:
            return super().__new__(cls)
        kind = params_class(method)
        refuse_foreign(kind, settings)
        return super().__new__(kind)

    def neighbours_for(self, count: int) -> int:
        """Return k for a cloud of so many points."""
        raise NotImplementedError

    def placed(self, place: Callable[[Place], Place]) -> "ContractionParams":
        """Return the settings with all places in other coordinates."""
        return self


@dataclass(frozen=True, kw_only=True)
class RobustParams(ContractionParams):
    """Settings of method "robust", by fronts and round cones.

    Examples
    --------
    >>> from tiskel import RobustParams
    >>> RobustParams(bridge_gaps=0).least_branch
    0.5
    """

    method: Literal["robust"] = "robust"
    neighbours: int = 14  #: k nearest, the point included
    max_steps: int = 3  #: fronts of the contraction
    normalise: Normalisation = "side"  #: what is scaled to 1.6: the longest side [T], or the diagonal (Wen et al.)
    resolution: float = 2.5  #: width of a section along the front, in spacings of the points, at least
    max_points: MaxPoints = "auto"  #: that fronts run over: so many, what the surface needs of a large cloud, or all
    least_part: float = 0.005  #: share of the points; smaller separate parts get no curve
    extra_fronts: int = 5  #: from further ends, at most, while the curve is in doubt
    least_branch: float = 0.5  #: of its radius, what a branch sticks out of the rest at least
    merge_junctions: float = 0.8  #: junctions closer than so many radii become one
    grow_ends: int = 3  #: nodes that an end may grow by towards its tip
    bridge_gaps: float = 4.0  #: widest gap that is bridged, in sums of the radii at both sides; 0: none is
    straightness: float = 0.1  #: weight that holds a node between its two neighbours, in its share of the points
    rounds: int = 4  #: of the fit of round cones; half as many after a change to the graph
    regime: RegimeChoice = "auto"  #: what the limbs are: tubes, or wires thinner than the points are apart
    topology: Topology = "auto"  #: whether limbs may close loops; auto: those of wires that persist, and of no crown
    root: Place | None = None  #: of wires: where limbs grow from, in the input's unit; None: where most points are
    seen_from: Place | None = None  #: where the sensor stood, in the input's unit, if there was one

    def __post_init__(self) -> None:
        among("normalise", self.normalise, get_args(Normalisation))
        at_least("neighbours", self.neighbours, 4)
        for name in ("max_steps", "rounds"):
            at_least(name, getattr(self, name), 1)
        for name in ("extra_fronts", "grow_ends"):
            at_least(name, getattr(self, name), 0)
        so_many("max_points", self.max_points, ("auto", "all"), MIN_POINTS)
        between("resolution", self.resolution, 0.5, inf)
        between("least_part", self.least_part, 0, 1)
        for name in ("least_branch", "merge_junctions", "bridge_gaps", "straightness"):
            between(name, getattr(self, name), 0, inf)
        among("regime", self.regime, get_args(RegimeChoice))
        among("topology", self.topology, get_args(Topology))
        for name in ("root", "seen_from"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, tuple(map(float, getattr(self, name))))
                finite(name, getattr(self, name), 3)

    def neighbours_for(self, count: int) -> int:
        return min(count, self.neighbours)

    def placed(self, place: Callable[[Place], Place]) -> "RobustParams":
        """Return the settings with the root and the sensor in other coordinates."""
        root = None if self.root is None else place(self.root)
        return replace(self, root=root, seen_from=None if self.seen_from is None else place(self.seen_from))


@dataclass(frozen=True, kw_only=True)
class LaplacianParams(ContractionParams):
    """Settings that gls and lbc share; lengths in normalised units, weights without unit."""

    neighbours: int | None = None  #: k nearest, the point included; None: published_neighbours [T]
    normalise: Normalisation = "side"  #: what is scaled to 1.6: the longest side [T], or the diagonal (Wen et al.)
    solver: Solver = "scipy"
    growth: float = 3.0  #: s_L, factor of the contraction weight per step [T]
    contraction_weight: float | None = None  #: W_L of the first step; None: 1 / (5 times the mean ring length) [T]
    attraction_weight: float = 1.0  #: W_H of the first step; later ones are times S(0) / S(k) [T]
    max_contraction_weight: float = 2048.0  #: cap of W_L [T]
    max_attraction_weight: float = 10000.0  #: cap of W_H [T]
    cotangent_cap: float = 10000.0  #: cap of the absolute sum of a row's cotangents [T]
    box_growth: float = 1.2  #: a step that grows a side of the bounding box by more is discarded [T]
    raw: bool = False  #: the curve exactly as published: no spur removal
    radius: float = 0.02  #: of the sampling balls, as a share of the diagonal of the original cloud [T]

    def __post_init__(self) -> None:
        among("normalise", self.normalise, get_args(Normalisation))
        among("solver", self.solver, get_args(Solver))
        at_least("neighbours", self.neighbours, 4)
        at_least("max_steps", self.max_steps, 1)
        for name in ("growth", "contraction_weight", "attraction_weight"):
            if getattr(self, name) is not None and not 0 < getattr(self, name) < inf:
                raise TiskelError(f"{name} must be a positive number, got {getattr(self, name)}")
        if not 0 < self.radius < 1:
            raise TiskelError(f"radius must be a share of the diagonal between 0 and 1, got {self.radius}")

    def neighbours_for(self, count: int) -> int:
        return min(count, self.neighbours or published_neighbours(count))


@dataclass(frozen=True, kw_only=True)
class LbcParams(LaplacianParams):
    """Settings of method "lbc", Laplacian-based contraction (Cao et al. 2010).

    Examples
    --------
    >>> from tiskel import LbcParams
    >>> LbcParams().stop_ratio
    0.01
    """

    method: Literal["lbc"] = "lbc"
    max_steps: int = 20  #: [T]
    stop_ratio: float = 0.01  #: stop when the ratio of ring sizes falls by less [T]


@dataclass(frozen=True, kw_only=True)
class GlsParams(LaplacianParams):
    """Settings of method "gls", GLSkeleton (Wen et al. 2024).

    Examples
    --------
    >>> from tiskel import GlsParams
    >>> GlsParams(theta=0.03).max_steps
    10
    """

    method: Literal["gls"] = "gls"
    variant: Variant = "paper"  #: whose algorithm, where the published code departs from its paper
    max_steps: int = 10  #: [T]
    min_steps: int = 3  #: at least so many are kept [T]
    epsilon: float = 1.2  #: factor of the mean ring shrinkage [T]
    phi: float = 1e5  #: a point merges where F < phi s^2 [T]
    theta: float = 0.02  #: least change of the explained score [T]
    guard: float = 1e-4  #: stands in for eta s_i(0) where that is not positive [T]

    def __post_init__(self) -> None:
        super().__post_init__()
        among("variant", self.variant, get_args(Variant))
        at_least("min_steps", self.min_steps, 1)
        for name in ("epsilon", "phi", "theta", "guard"):
            between(name, getattr(self, name), 0, inf)


CLASSES: Mapping[str, type[ContractionParams]] = {"robust": RobustParams, "gls": GlsParams, "lbc": LbcParams}


def params_class(method: str) -> type[ContractionParams]:
    """Return the settings' class of a method; raise TiskelError where there is no such method."""
    among("method", method, tuple(CLASSES))
    return CLASSES[method]


def settings_of(kind: type[ContractionParams]) -> set[str]:
    """Return the names of the settings of a method."""
    return {field.name for field in fields(kind)}  # type: ignore[arg-type]


def refuse_foreign(kind: type[ContractionParams], names: Iterable[str]) -> None:
    """Raise TiskelError where a setting is none of a method's, naming the methods whose it is."""
    method = next(name for name, other in CLASSES.items() if other is kind)
    for name in names:
        if name in settings_of(kind):
            continue
        owners = [other for other, owner in CLASSES.items() if name in settings_of(owner)]
        if not owners:
            known = {each for owner in CLASSES.values() for each in settings_of(owner)}
            near = meant(name, known) or f"; {method} has {', '.join(sorted(settings_of(kind)))}"
            raise TiskelError(f"no method has a setting {name}{near}")
        several = f"method{'s' * (len(owners) > 1)} {' and '.join(owners)}"
        raise TiskelError(f"{name} is a setting of {several}, {method} does not read it; leave it out")


def known_settings(document: Mapping[str, Any]) -> ContractionParams:
    """Return the settings in a document, without those that the method does not read: older files name all of them.

    Raises
    ------
    TiskelError
        For a value of another type than the setting has, and one that it cannot have.
    """
    kind = params_class(document.get("method", "robust"))
    given = {name: value for name, value in document.items() if name in settings_of(kind) and value is not None}
    for field in fields(kind):  # type: ignore[arg-type]
        of_its_type(field.name, given.get(field.name, field.default), field.default)
    return kind(**given)


def published_neighbours(count: int) -> int:
    """Return k = clip(round(0.012 n), 8, 30), and no more than there are points [T]."""
    return min(count, max(round(0.012 * count), 8), 30)
