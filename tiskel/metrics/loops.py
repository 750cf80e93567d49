"""Loops: of the surface, of the solid it encloses, and of the curve.

A closed surface of genus g has 2 g loops, the solid inside it g, and so has its
curve skeleton; an open tube has one, its skeleton none. Only the loops of the
solid are comparable to those of the curve.

Of the surface: bars in H1 of the Delaunay-Rips complex that last to four times
the length at which they are born (gaps of a random sample reach 3.7, the thinnest
tubes that are sampled four points across 4.5).

Of the solid: its handles, see :mod:`tiskel.geometry.solid`. A solid with more of
them than its surface has loops is not decided: each handle is one of those.
"""

from dataclasses import dataclass

from tiskel.arrays import Numbers
from tiskel.geometry.oriented import OrientedCloud
from tiskel.geometry.solid import solid_handles
from tiskel.metrics.subject import Subject
from tiskel.params import MetricParams


@dataclass(frozen=True)
class Loops:
    """Numbers of loops; None where they cannot be told, with the reason.

    Attributes
    ----------
    surface : loops of the surface, from its persistent homology.
    solid : handles of the solid inside.
    graph : independent loops of the curve.
    bars : (b, 2) births and deaths in H1 in normalised units, by falling ratio.
    points : size of the subset that surface and solid were taken from.
    """

    surface: int | None
    solid: int | None
    graph: int | None
    bars: Numbers
    points: int
    reasons: dict[str, str]


def count_loops(bars: Numbers, surface: OrientedCloud, subject: Subject, params: MetricParams) -> Loops:
    """Count the loops of a surface with bars (b, 2) in H1, of the solid inside it, and of the subject's curve."""
    lasting = int((bars[:, 1] >= params.loop_ratio * bars[:, 0]).sum())
    solid, reason = solid_handles(surface)
    if solid is not None and solid > lasting:  # every handle of the solid is a loop of its surface, too
        reason = f"{solid} handles, but only {lasting} loops of the surface last; the cloud is too sparse for its tubes"
        solid = None
    reasons = {"solid": reason} if reason else {}
    curve = subject.curve.loops if subject.curve_given else None
    if curve is None:
        reasons["graph"] = "no curve was given"
    return Loops(lasting, solid, curve, bars, len(surface.points), reasons)
