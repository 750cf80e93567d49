"""Settings of clouds of named shapes."""

from dataclasses import dataclass, field
from math import inf, isfinite

from tiskel.errors import TiskelError


@dataclass(frozen=True, kw_only=True)
class ShapeParams:
    """Settings of :func:`tiskel.make_shape`.

    Examples
    --------
    >>> from tiskel import ShapeParams
    >>> ShapeParams(count=1000, noise=0.1)
    ShapeParams(count=1000, noise=0.1, missing=0.0, uneven=1.0, seed=0)
    >>> ShapeParams(views=((1, -2, 1), (-1, 2, 1)), sensor_noise=0.05).count  # scanned from two sides
    4096
    """

    count: int = 4096  #: points of the result
    noise: float = 0.0  #: standard deviation of isotropic Gaussian noise, in smallest radii of the shape
    missing: float = 0.0  #: share of the surface that is cut out in patches
    uneven: float = 1.0  #: ratio of the highest to the lowest density, along the longest axis
    seed: int = 0  #: of everything random
    #: directions from the shape to sensors; what none of them sees is not in the cloud. Empty: everything is seen
    views: tuple[tuple[float, float, float], ...] = field(default=(), repr=False)
    sensor_distance: float = field(default=10.0, repr=False)  #: of each sensor, in diagonals of the shape
    sensor_noise: float = field(default=0.0, repr=False)  #: deviation along the rays, in smallest radii of the shape
    table: bool = field(default=False, repr=False)  #: whether a quarter of the points are of a table under the shape

    def __post_init__(self) -> None:
        if self.count < 1:
            raise TiskelError(f"the number of points must be positive, got {self.count}")
        if not 0 <= self.noise < inf:
            raise TiskelError(f"noise must be a share of the smallest radius, 0 or more, got {self.noise}")
        if not 0 <= self.missing < 1:
            raise TiskelError(f"missing must be a share of the surface, at least 0 and below 1, got {self.missing}")
        if not 1 <= self.uneven < inf:
            raise TiskelError(f"uneven is the ratio of highest to lowest density, 1 or more, got {self.uneven}")
        self._check_sensors()

    def _check_sensors(self) -> None:
        for view in self.views:
            if len(view) != 3 or not all(map(isfinite, view)) or not any(view):
                raise TiskelError(f"a view is a direction of three numbers that are not all zero, got {view}")
        if not 1 <= self.sensor_distance < inf:
            raise TiskelError(f"sensors are 1 diagonal of the shape away or more, got {self.sensor_distance}")
        if not 0 <= self.sensor_noise < inf:
            raise TiskelError(
                f"sensor noise must be a share of the smallest radius, 0 or more, got {self.sensor_noise}"
            )
        if self.sensor_noise and not self.views:
            raise TiskelError("sensor noise is along rays, and there is no sensor; give a view")
