"""Two curves side by side: what they are made of, and how far each is from the other."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Numbers
from tiskel.geometry.graph import CurveGraph
from tiskel.metrics.repeatability import Repeatability, Way, alike, tail, ways_between
from tiskel.shown import Brief


@dataclass(frozen=True)
class Apart:
    """How far the length of one curve is from another, in their unit.

    Attributes
    ----------
    mean : float
    median : float
    p95 : float
        What 95 % of the length is within.
    largest : float
    """

    mean: float
    median: float
    p95: float
    largest: float


@dataclass(frozen=True, repr=False)
class Comparison(Repeatability, Brief):
    """Two curves held against each other; counts are those of the second minus those of the first.

    Attributes
    ----------
    components, loops, ends, joints, tips, tips_share, radii_95, diagonals_95
        See :class:`tiskel.metrics.repeatability.Repeatability`.
    lengths : (float, float)
        Of the first and of the second, in their unit.
    there : Apart or None
        From the first to the second; None where one has no length.
    back : Apart or None
        From the second to the first.

    Examples
    --------
    >>> from tiskel import compare, shape_graph
    >>> found = compare(shape_graph("y"), shape_graph("banana"))
    >>> found.ends, found.joints, found.there.mean > found.back.mean
    (-1, -1, True)
    """

    lengths: tuple[float, float]
    there: Apart | None
    back: Apart | None

    def __repr__(self) -> str:
        far = [f"{name}={'None' if way is None else format(way.mean, '.4g')}" for name, way in self._ways().items()]
        lengths = ", ".join(f"{length:.4g}" for length in self.lengths)
        return f"<Comparison same_graph={self.same_graph} lengths=({lengths}) {' '.join(far)} tips={self.tips}>"

    def _ways(self) -> dict[str, Apart | None]:
        return {"there": self.there, "back": self.back}

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values."""
        return {"same_graph": self.same_graph, **asdict(self), "lengths": list(self.lengths)}


def compare(first: CurveGraph, second: CurveGraph) -> Comparison:
    """Compare two skeletons of one body, of this or of other programs.

    Parameters
    ----------
    first : Skeleton or CurveGraph
        One of them.
    second : Skeleton or CurveGraph
        The other, in the same frame and unit.

    Returns
    -------
    Comparison
        Distances both ways along all their length, lengths, and differences of components, loops, ends and joints.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from tiskel import compare, shape_graph
    >>> y = shape_graph("y")
    >>> found = compare(y, replace(y, nodes=y.nodes + [0, 0.1, 0]))
    >>> round(found.there.mean, 6), round(found.back.largest, 6), found.ends, found.same_graph
    (0.1, 0.1, 0, True)
    """
    ways = ways_between(first, second)
    there, back = map(_apart, ways) if ways else (None, None)
    found = alike(first, second, ways)
    return Comparison(**vars(found), lengths=(first.length, second.length), there=there, back=back)


def _apart(way: Way) -> Apart:
    far, lengths = way.distances, way.lengths
    return Apart(
        mean=float(np.average(far, weights=lengths)), median=_within(far, lengths, 0.5),
        p95=_within(far, lengths, 0.95), largest=float(far.max()),
    )  # fmt: skip


def _within(values: Numbers, lengths: Numbers, share: float) -> float:
    return tail(values, lengths, share) or 0.0
