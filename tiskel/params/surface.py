"""Settings of slices and the surfaces fitted to them."""

from dataclasses import dataclass
from math import pi
from typing import Literal, get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among

FrameRule = Literal["normal", "rotation-minimising"]
OrderRule = Literal["cross-validated", "published"]


@dataclass(frozen=True, kw_only=True)
class SurfaceParams:
    """Settings of :func:`tiskel.fit_surface`; lengths in the input's unit, angles in radians.

    Examples
    --------
    >>> from tiskel import SurfaceParams
    >>> SurfaceParams(branch="longest", most_order=5).least_order
    3
    """

    branch: str = "all"  #: a number, "all", or "longest": the longest path between two ends, through junctions
    interval: float = 0.02  #: between slices, as a share of the diagonal of the cloud [T]
    m: tuple[float, float, float] | FrameRule = (0.0, 0.0, 1.0)  #: sets where u is 0 [T]
    order_rule: OrderRule = "cross-validated"  #: or until the RMS error is below fit_error, in the unit of length [T]
    least_order: int = 3  #: of the Fourier series [T]
    most_order: int = 8  #: [T]
    fit_error: float = 1e-3  #: of the published rule [T]
    recentre: bool = True  #: the skeleton curve moves to the middles of its sections before the surface is fitted
    gap: float = pi  #: a section that misses a larger angle is rejected; what is unseen of others is rounded off
    least_points: int = 12  #: a section of fewer is rejected
    uneven: float = 0.45  #: share of the radius that a point of a star-shaped section is off at most, but for a tenth

    def __post_init__(self) -> None:
        among("order_rule", self.order_rule, get_args(OrderRule))
        if isinstance(self.m, str):
            among("m", self.m, get_args(FrameRule))
        elif len(self.m) != 3 or not any(self.m):
            raise TiskelError(f"m must be a direction of three numbers, not all 0, got {self.m}")
        if self.branch not in ("all", "longest") and not self.branch.isdigit():
            raise TiskelError(f"branch must be all, longest or a number, got {self.branch!r}")
        if not 0 < self.interval < 1:
            raise TiskelError(f"interval must be a share of the diagonal between 0 and 1, got {self.interval}")
        if not 1 <= self.least_order <= self.most_order:
            raise TiskelError(f"orders must rise from at least 1, got {self.least_order} to {self.most_order}")
