"""What a method says about its own curve: where it may be wrong, as data that scripts can act on."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from tiskel.arrays import Points

Severity = Literal["note", "warning"]
UNKNOWN = "unknown"  #: the code of what a file of an older version says


@dataclass(frozen=True)
class CurveWarning:
    """A note or a warning about a curve.

    Attributes
    ----------
    code : str
        A short name that stays the same: see the table in :mod:`tiskel.methods.robust.doubts`.
    text : str
        What, how much, and what it means, for a reader; ``str()`` gives it.
    severity : "warning" or "note"
        Whether the curve may be wrong, or is as it should be and only worth less than it seems.
    share : float
        Of what the text speaks of, from 0 to 1: of the curve's length, of nodes, or of points.
    places : tuple of (float, float, float)
        A few places that stand for all, in the input's units; empty where it is about the whole.

    Examples
    --------
    >>> from tiskel import CurveWarning
    >>> doubt = CurveWarning("in-air", "4% of the curve is in the air", share=0.04, places=((0.0, 1.0, 2.0),))
    >>> f"{doubt}", doubt.code, doubt.severity
    ('4% of the curve is in the air', 'in-air', 'warning')
    """

    code: str
    text: str
    severity: Severity = "warning"
    share: float = 0.0
    places: tuple[tuple[float, ...], ...] = ()

    def __str__(self) -> str:
        """Return the text."""
        return self.text

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values."""
        return {
            "code": self.code,
            "severity": self.severity,
            "text": self.text,
            "share": self.share,
            "places": [list(place) for place in self.places],
        }

    def moved(self, way: Callable[[Points], Points]) -> "CurveWarning":
        """Return the same with its places as a map of points (n, 3) has them."""
        return replace(self, places=as_places(way(np.reshape(np.array(self.places, float), (-1, 3)))))


def as_places(points: Points) -> tuple[tuple[float, ...], ...]:
    """Return points (k, 3) as tuples of numbers."""
    return tuple(tuple(place) for place in points.tolist())


def warning_from(said: Any) -> CurveWarning:
    """Return the warning of a JSON document: one of :meth:`CurveWarning.as_dict`, or the text alone, as it once was.

    Raises ValueError, KeyError or TypeError where it is neither.
    """
    if isinstance(said, str):
        return CurveWarning(UNKNOWN, said)
    places = tuple(tuple(map(float, place)) for place in said["places"])
    severity: Severity = "note" if said["severity"] == "note" else "warning"
    return CurveWarning(str(said["code"]), str(said["text"]), severity, float(said["share"]), places)
