"""Settings of what is done to a cloud before the first stage."""

from dataclasses import dataclass
from math import inf
from typing import Literal, get_args

from tiskel.errors import TiskelError
from tiskel.params.checks import among

NoiseKind = Literal["coordinates", "diagonal"]


@dataclass(frozen=True, kw_only=True)
class ConditioningParams:
    """Settings of :func:`tiskel.condition`; lengths in the input's units.

    Examples
    --------
    >>> from tiskel import ConditioningParams
    >>> ConditioningParams(outliers=True, voxel=0.05).cap
    False
    """

    columns: tuple[str, ...] | None = None  #: of x, y and z in a text file, by name or counted from 1
    classification: tuple[int, ...] | None = None  #: classes whose points are kept, of LAS and LAZ
    crop: tuple[float, ...] | None = None  #: xmin, ymin, zmin, xmax, ymax, zmax
    outliers: bool = False  #: remove points whose mean neighbour distance is 2 deviations above the mean
    voxel: float | None = None  #: side of the cubes whose points become their mean
    sample: int | None = None  #: points of a random subset
    cap: bool = False  #: close open tube ends with flat discs of points
    noise: float = 0.0  #: standard deviation of Gaussian noise, as a share
    noise_kind: NoiseKind = "coordinates"  #: of what: each centred coordinate, or half the diagonal of the cloud
    seed: int = 0  #: of the subset and of the noise

    def __post_init__(self) -> None:
        if self.crop is not None and not _is_box(self.crop):
            raise TiskelError(
                f"crop must be xmin,ymin,zmin,xmax,ymax,zmax with each min below its max, got {self.crop}"
            )
        if self.voxel is not None and not 0 < self.voxel < inf:
            raise TiskelError(f"voxel must be a positive length in the cloud's units, got {self.voxel}")
        if not 0 <= self.noise < inf:
            raise TiskelError(f"noise must be a share, 0 or more, got {self.noise}")
        among("noise_kind", self.noise_kind, get_args(NoiseKind))
        if self.sample is not None and self.sample < 1:
            raise TiskelError(f"sample must be a positive number of points, got {self.sample}")


def _is_box(crop: tuple[float, ...]) -> bool:
    return len(crop) == 6 and all(low < high for low, high in zip(crop[:3], crop[3:], strict=True))
