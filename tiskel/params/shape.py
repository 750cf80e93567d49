"""Settings of clouds of named shapes."""

from dataclasses import dataclass
from math import inf

from tiskel.errors import TiskelError


@dataclass(frozen=True, kw_only=True)
class ShapeParams:
    """Settings of :func:`tiskel.make_shape`.

    Examples
    --------
    >>> from tiskel import ShapeParams
    >>> ShapeParams(count=1000, noise=0.1)
    ShapeParams(count=1000, noise=0.1, missing=0.0, uneven=1.0, seed=0)
    """

    count: int = 4096  #: points of the result
    noise: float = 0.0  #: standard deviation of isotropic Gaussian noise, in smallest radii of the shape
    missing: float = 0.0  #: share of the surface that is cut out in patches
    uneven: float = 1.0  #: ratio of the highest to the lowest density, along the longest axis
    seed: int = 0  #: of everything random

    def __post_init__(self) -> None:
        if self.count < 1:
            raise TiskelError(f"the number of points must be positive, got {self.count}")
        if not 0 <= self.noise < inf:
            raise TiskelError(f"noise must be a share of the smallest radius, 0 or more, got {self.noise}")
        if not 0 <= self.missing < 1:
            raise TiskelError(f"missing must be a share of the surface, at least 0 and below 1, got {self.missing}")
        if not 1 <= self.uneven < inf:
            raise TiskelError(f"uneven is the ratio of highest to lowest density, 1 or more, got {self.uneven}")
