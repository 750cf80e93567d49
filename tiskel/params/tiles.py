"""Settings of cutting a cloud that does not fit into parts, and of joining their skeletons."""

from dataclasses import dataclass
from math import inf, isfinite
from typing import Literal, get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among, at_least, so_many
from tiskel.params.methods import MIN_POINTS

Parts = Literal["tiles", "objects"]


@dataclass(frozen=True, kw_only=True)
class SplitParams:
    """Settings of :func:`tiskel.split_cloud`; lengths in the cloud's units.

    Examples
    --------
    >>> from tiskel import SplitParams
    >>> SplitParams(parts="objects", gap=0.2).least
    100
    """

    parts: Parts = "tiles"  #: boxes that overlap, or what hangs together
    points: int = 250_000  #: of a tile without its margin, about, at most; a million take ten times as much memory
    size: float | None = None  #: longest side of a tile without its margin, instead of points
    overlap: float | None = None  #: width of the margin about a tile; None: by how thick a sample says the bodies are
    gap: float | None = None  #: what is nearer is one object; None: three spacings, about
    least: int = 100  #: points of an object; those of smaller ones go into one file that gets no skeleton

    def __post_init__(self) -> None:
        among("parts", self.parts, get_args(Parts))
        at_least("points", self.points, MIN_POINTS)
        at_least("least", self.least, MIN_POINTS)
        for name in ("size", "overlap", "gap"):
            value = getattr(self, name)
            if value is not None and not (isfinite(value) and 0 < value < inf):
                raise TiskelError(f"{name} must be a positive length in the cloud's units, got {value}")


@dataclass(frozen=True, kw_only=True)
class JoinParams:
    """Settings of :func:`tiskel.join_skeletons`.

    Examples
    --------
    >>> from tiskel import JoinParams
    >>> JoinParams(keep="all").incomplete
    False
    """

    keep: int | Literal["all"] = 1_000_000  #: points of the cloud that the result holds, evenly by row; or all
    incomplete: bool = False  #: join what is there where skeletons are missing

    def __post_init__(self) -> None:
        so_many("keep", self.keep, ("all",), 1)
