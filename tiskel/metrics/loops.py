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

from tiskel.arrays import Table
from tiskel.extras import ADVICE
from tiskel.geometry.oriented import OrientedCloud
from tiskel.geometry.solid import solid_handles
from tiskel.metrics.barcode import NO_CYCLES
from tiskel.metrics.subject import Subject
from tiskel.params import MetricParams


@dataclass(frozen=True, eq=False)
class Loops:
    """Numbers of loops; None where they cannot be told, with the reason.

    Attributes
    ----------
    surface : int or None
        Loops of the surface, from its persistent homology.
    solid : int or None
        Handles of the solid inside.
    graph : int or None
        Independent loops of the curve.
    bars : (b, 2) float64
        Births and deaths in H1, in normalised units, by falling ratio.
    points : int
        Size of the subset of the cloud that surface and solid were taken from.
    reasons : dict of str to str
        Why a number is None, by the name of its field.
    """

    surface: int | None
    solid: int | None
    graph: int | None
    bars: Table
    points: int
    reasons: dict[str, str]


def count_loops(bars: Table | None, surface: OrientedCloud, subject: Subject, params: MetricParams) -> Loops:
    """Count the loops of a surface, of the solid inside it, and of a curve.

    Parameters
    ----------
    bars : (b, 2) float64 or None
        Births and deaths of the surface in H1, in normalised units; None where there is nothing to compute them with.
    surface : OrientedCloud
        The points that the bars were taken from, with normals.
    subject : Subject
        Its curve is counted.
    params : MetricParams
        ``loop_ratio`` says how long a bar must last.

    Returns
    -------
    Loops
    """
    lasting = None if bars is None else int((bars[:, 1] >= params.loop_ratio * bars[:, 0]).sum())
    solid, reason = solid_handles(surface)
    if solid is not None and lasting is not None and solid > lasting:  # each handle is a loop of the surface, too
        reason = f"{solid} handles, but only {lasting} loops of the surface last; the cloud is too sparse for its tubes"
        solid = None
    reasons = {"solid": reason} if reason else {}
    if lasting is None:
        reasons["surface"] = f"it needs ripser; {ADVICE}"
    curve = subject.curve.loops if subject.curve_given else None
    if curve is None:
        reasons["graph"] = "no curve was given"
    return Loops(lasting, solid, curve, NO_CYCLES if bars is None else bars, len(surface.points), reasons)
