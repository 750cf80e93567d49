"""Settings of the surface of a whole body."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class BodyParams:
    """Settings of :func:`tiskel.fit_body`.

    Examples
    --------
    >>> from tiskel import BodyParams
    >>> BodyParams(neighbours=(12, 24)).spread
    0.35
    """

    neighbours: tuple[int, ...] = (12, 18, 27, 40, 60, 90)  #: points that a patch may be fitted to, ascending
    noise: float = 1.1  #: a patch takes more points until its error is so many times the least
    exact: float = 2e-4  #: local radii: errors below count as none
    widest: float = 0.9  #: local radii that a patch is wide at most, but for the fewest points
    spread: float = 0.35  #: of a patch's width, from patch to patch
    facing: float = 0.8  #: of the distance to an opposite wall, that a patch reaches
