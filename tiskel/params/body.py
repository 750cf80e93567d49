"""Settings of the surface of a whole body."""

from dataclasses import dataclass

from tiskel.errors import TiskelError
from tiskel.params.checks import at_least, between


@dataclass(frozen=True, kw_only=True)
class BodyParams:
    """Settings of :func:`tiskel.fit_body`; found on ellipsoids, tori and blends with and without noise, and on scans.

    Examples
    --------
    >>> from tiskel import BodyParams
    >>> BodyParams(neighbours=(12, 24)).spread
    0.35
    """

    neighbours: tuple[int, ...] = (12, 18, 27, 40, 60, 90, 135)  #: points that a patch may be fitted to, ascending
    noise: float = 1.25  #: a patch takes more points until its error is so many times the least
    exact: float = 1e-3  #: local radii: errors below count as none
    widest: float = 0.9  #: local radii that a patch is wide at most, but for the fewest points
    reach: float = 1.5  #: widths that a patch counts at most
    spread: float = 0.35  #: widths from patch to patch
    facing: float = 0.8  #: of the distance to an opposite wall, that a patch counts at most
    tubes: float = 0.002  #: local radii that a tube may be worse than a quadric and still count in its place

    most: int = 60_000  #: points that it is fitted to; of more, evenly many are taken

    def __post_init__(self) -> None:
        counts = self.neighbours
        if not counts or counts[0] < 10 or any(a >= b for a, b in zip(counts, counts[1:], strict=False)):
            raise TiskelError(f"neighbours must be numbers of points that rise from at least 10, got {counts}")
        for name in ("noise", "widest", "reach", "facing"):
            between(name, getattr(self, name), 0.1, 10.0)
        between("spread", self.spread, 0.05, 1.0)
        at_least("most", self.most, 100)
        between("exact", self.exact, 0.0, 1.0)
        between("tubes", self.tubes, 0.0, 1.0)
