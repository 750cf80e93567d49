"""Settings of the measures."""

from dataclasses import dataclass
from math import inf
from typing import Literal, get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among, at_least, between
from tiskel.params.methods import MIN_POINTS, Normalisation

Bars = Literal["toolbox", "max"]
BetaRule = Literal["hull", "print", "toolbox"]


@dataclass(frozen=True, kw_only=True)
class MetricParams:
    """Settings of :func:`tiskel.evaluate`; d_B and d_W in normalised units, the rest are ratios and counts.

    Examples
    --------
    >>> from tiskel import MetricParams
    >>> MetricParams(bars="max").similar
    0.02
    """

    bars: Bars = "toolbox"  #: which H0 bars are compared: [T], or those longer than every nearest-neighbour distance
    diagonal: bool = True  #: bars may be matched to the diagonal [T]; the paper has bijections only
    beta: BetaRule = "hull"  #: boundedness by the hull of directions, by the printed map of them, or as in the toolbox
    bounded: float = 0.75  #: beta*, bounded is what has at least that much; others than 0.75 take the hull in full
    similar: float = 0.02  #: d*, the topology is similar where d_B and d_W are below
    normalise: Normalisation = "side"  #: what is scaled to 1.6: the longest side [T], or the diagonal
    threshold: float = 0.75  #: c*, overall centredness is the share above [T]
    curve_samples: int = 200  #: places on the curve, about so many [T]
    slab: float = 0.01  #: half the thickness of a cross-section, as a share of the diagonal [T]
    gap: float = 1.5  #: a section ends where the next point is so many times as far away [T]
    tangent_neighbours: int = 8  #: nearest others whose scatter gives the tangent at a skeletal point
    smooth_neighbours: int = 4  #: nearest others that this tangent is held against
    loop_ratio: float = 4.0  #: a loop of the surface lasts to so many times the length at which it is born
    loop_points: int = 16384  #: larger clouds are thinned to a random subset of so many for their loops
    seed: int = 0  #: of that subset, and of the check of the normals

    def __post_init__(self) -> None:
        among("bars", self.bars, get_args(Bars))
        among("beta", self.beta, get_args(BetaRule))
        for name in ("bounded", "threshold"):
            between(name, getattr(self, name), 0, 1)
        between("similar", self.similar, 0, inf)
        among("normalise", self.normalise, get_args(Normalisation))
        for name in ("curve_samples", "tangent_neighbours", "smooth_neighbours"):
            at_least(name, getattr(self, name), 1)
        at_least("loop_points", self.loop_points, MIN_POINTS)
        if not 0 < self.slab < 1:
            raise TiskelError(f"slab must be a share of the diagonal between 0 and 1, got {self.slab}")
