"""Settings of the stability of a contraction."""

from dataclasses import dataclass
from typing import Literal, get_args

from tiskel.params.checks import among, at_least

Orientation = Literal["outward", "origin", "random"]


@dataclass(frozen=True, kw_only=True)
class StabilityParams:
    """Settings of :func:`tiskel.assess_stability`.

    The thresholds were found on sixteen shapes, five scans and models, a box
    and a ball, each contracted by lbc and gls, and held on nine more shapes:
    what contracts to a curve has distances of 0.02 to 0.11, box and ball of
    0.21 and more, and nothing lies between 0.11 and 0.14. Curves have median
    changes of curvature below 0.016, clumps and tubes that are still thick
    above 0.03.

    Examples
    --------
    >>> from tiskel import StabilityParams
    >>> StabilityParams(neighbours=12).distance
    0.12
    """

    #: whose angles the result holds and pictures show: of normals away from the final points, towards the origin as the
    #: author's routine has them, or of random signs; the verdict is always by the first
    normals: Orientation = "outward"
    neighbours: int = 9  #: whose scatter gives normal and curvature, the point included [T]
    bins: int = 50  #: of the histograms whose peaks are counted
    prominence: float = 0.02  #: a peak falls by so large a share of the points on both sides
    distance: float = 0.12  #: largest distance of the angles' distribution from the uniform one on [0, 1/2]
    curvature: float = 0.02  #: largest median change of curvature
    seed: int = 0  #: of the random signs of the control

    def __post_init__(self) -> None:
        among("normals", self.normals, get_args(Orientation))
        at_least("neighbours", self.neighbours, 4)
        at_least("bins", self.bins, 2)
