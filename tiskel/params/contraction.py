"""Settings of the contraction: every method's, for now in one class."""

from dataclasses import dataclass
from typing import Literal, get_args

from tiskel.params.checks import among, at_least

Method = Literal["robust", "gls", "lbc"]
Normalisation = Literal["side", "diagonal"]
Solver = Literal["scipy", "cholmod"]

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
        among("method", self.method, get_args(Method))
        among("normalise", self.normalise, get_args(Normalisation))
        among("solver", self.solver, get_args(Solver))
        at_least("neighbours", self.neighbours, 4)
        at_least("max_steps", self.max_steps, 1)
        at_least("min_steps", self.min_steps, 1)

    def neighbours_for(self, count: int) -> int:
        """Return k for a cloud of so many points."""
        usual = 14 if self.method == "robust" else published_neighbours(count)
        return min(count, self.neighbours or usual)

    def step_limit(self) -> int:
        """Return the largest number of steps of the chosen method."""
        return self.max_steps or {"robust": 3, "gls": 10, "lbc": 20}[self.method]


def published_neighbours(count: int) -> int:
    """Return k = clip(round(0.012 n), 8, 30), and no more than there are points [T]."""
    return min(count, max(round(0.012 * count), 8), 30)
