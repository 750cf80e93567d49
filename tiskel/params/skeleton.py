"""Settings of the curve."""

from dataclasses import dataclass

from tiskel.errors import TiskelError


@dataclass(frozen=True, kw_only=True)
class SkeletonParams:
    """Settings of :func:`tiskel.extract_skeleton`."""

    raw: bool = False  #: exactly as published: no spur removal
    radius: float = 0.02  #: of the sampling balls, as a share of the diagonal of the original cloud [T]

    def __post_init__(self) -> None:
        if not 0 < self.radius < 1:
            raise TiskelError(f"radius must be a share of the diagonal between 0 and 1, got {self.radius}")
