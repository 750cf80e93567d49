"""Settings of plans."""

from dataclasses import dataclass
from math import inf
from typing import get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among, at_least, finite
from tiskel.params.roll import RollParams, Side

Place = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True)
class PlanParams:
    """Settings of :func:`tiskel.plan_roll`; lengths in the input's unit, times in seconds.

    Examples
    --------
    >>> from tiskel import PlanParams, TiskelError
    >>> try:
    ...     PlanParams(start_at=(0, 0, 0), goal=(1, 0, 0), speed=0)
    ... except TiskelError as error:
    ...     print(error)
    speed must be a positive number, got 0
    """

    start_at: Place  #: the contact begins at the surface's place there
    goal: Place  #: and comes to the surface's place there
    start_attitude: Quaternion = (1.0, 0.0, 0.0, 0.0)  #: of the sphere at the start, w, x, y, z
    attitude: Quaternion | None = None  #: of the sphere at the goal; None: any
    side: Side = "outside"  #: of the surface that the sphere rolls on
    radius: float | None = None  #: of the sphere; None: a quarter of the median radius of the surface
    spin: bool = False  #: whether the sphere may turn about the normal
    avoid: tuple[tuple[float, float, float, float], ...] = ()  #: balls x, y, z, radius that the sphere keeps out of
    speed: float = 1.0  #: radians per second that the sphere turns at most, but for corrections
    near: float = 1e-3  #: of the sphere's radius: how far from the goal it may arrive
    within: float = 1.0  #: degrees that the attitude may be off
    most_places: int = 40_000  #: that are looked at for a way
    seed: int = 0  #: of the loops that are tried for an attitude

    def __post_init__(self) -> None:
        among("side", self.side, get_args(Side))
        for name, count in (("start_at", 3), ("goal", 3), ("start_attitude", 4), ("attitude", 4)):
            finite(name, getattr(self, name), count)
        for name in ("radius", "speed", "near", "within"):
            value = getattr(self, name)
            if value is not None and not 0 < value < inf:
                raise TiskelError(f"{name} must be a positive number, got {value}")
        if not any(self.start_attitude) or (self.attitude is not None and not any(self.attitude)):
            raise TiskelError("an attitude is a quaternion w,x,y,z, which is not zero")
        for ball in self.avoid:
            finite("avoid", ball, 4)
        at_least("most_places", self.most_places, 100)
        at_least("seed", self.seed, 0)

    @property
    def roll(self) -> RollParams:
        """The settings of the run that the plan is for."""
        return RollParams(
            model="body", side=self.side, radius=self.radius, start_at=self.start_at, attitude=self.start_attitude,
            rtol=1e-7, atol=1e-9,
        )  # fmt: skip
