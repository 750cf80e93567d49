"""Medialness: is a curve as far from the surface as it could be where it is?

The clearance of a place, its distance to the surface, divided by the best
clearance that climbing in the plane across the curve finds; 0 outside. On the
axis of a tube it is 1, halfway to the wall 0.5, on the wall 0.

The climb goes by half the clearance at most, so that it stays in its limb, and
never out of the body. It looks round in twelve directions that turn from step to
step, so that it does not stick on a ridge; where none leads up it looks nearer by.
"""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Mask, Numbers, Points, Stack
from tiskel.geometry.clearance import Body, QuickBody
from tiskel.geometry.feet import even_places
from tiskel.geometry.frames import across, unit
from tiskel.geometry.graph import CurveGraph

PLACES = 500  # on a curve that is measured
DIRECTIONS = 12  # looked in at once
LONG, SHORT = 0.5, 0.01  # of the clearance: the longest step, and the shortest before the climb ends
TURN = np.pi * (3 - np.sqrt(5))  # the golden angle: turned by it, directions never come again
MOST_STEPS = 100  # a climb that still goes on has come out of a very large body


@dataclass(frozen=True, eq=False)
class Medialness:
    """How medial a curve is in a body.

    Attributes
    ----------
    clearance : (q,) float64
        Distance to the surface of places along the curve, 0 outside.
    best : (q,) float64
        The best clearance across the curve; 0 outside.
    values : (q,) float64
        Medialness of the places, 0 to 1; NaN inside where no direction is known.
    """

    clearance: Numbers
    best: Numbers
    values: Numbers

    @property
    def inside(self) -> float | None:
        """Share of the places that are inside; None where there is none."""
        return float((self.clearance > 0).mean()) if len(self.clearance) else None

    @property
    def mean(self) -> float | None:
        """Mean medialness of the places that have one; None where there is none."""
        known = self.values[~np.isnan(self.values)]
        return float(known.mean()) if len(known) else None


def medialness(curve: CurveGraph, body: Body, places: int = PLACES) -> Medialness:
    """Measure a curve against a body.

    Parameters
    ----------
    curve : CurveGraph
        In the unit of the body.
    body : Body
        Such as :class:`tiskel.geometry.clearance.ConeBody`, or ``CloudBody``.
    places : int
        How many places are measured, evenly along its edges.

    Returns
    -------
    Medialness

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.geometry.clearance import ConeBody
    >>> from tiskel.metrics.medialness import medialness
    >>> capsule = shape_graph("capsule")
    >>> m = medialness(capsule, ConeBody(capsule), 50)
    >>> m.inside, round(m.mean, 1)
    (1.0, 1.0)
    """
    if curve.length == 0:
        return Medialness(np.zeros(0), np.zeros(0), np.zeros(0))
    edges, shares = even_places(curve, places)
    start, end = curve.nodes[curve.edges[edges, 0]], curve.nodes[curve.edges[edges, 1]]
    return medialness_at(start + shares[:, None] * (end - start), unit(end - start), body)


def medialness_at(places: Points, directions: Points, body: Body) -> Medialness:
    """Measure places of a curve against a body.

    Parameters
    ----------
    places : (q, 3) float64
        In the unit of the body.
    directions : (q, 3) float64
        Unit tangents; zero where there is none.
    body : Body

    Returns
    -------
    Medialness
    """
    clearance = body.clearance(places)
    climbing = (clearance > 0) & directions.any(axis=1)
    best = clearance.copy()
    best[climbing] = _climbed(places[climbing], directions[climbing], clearance[climbing], body)
    values = np.divide(clearance, best, out=np.zeros_like(best), where=best > 0)
    return Medialness(clearance, best, np.where((clearance > 0) & ~climbing, np.nan, values))


def _climbed(places: Points, directions: Points, clearance: Numbers, body: Body) -> Numbers:
    """Return the clearance at the top of a climb from each place, in the plane across its direction."""
    at, high, step = places.copy(), clearance.copy(), np.full(len(places), LONG)
    planes = across(directions)
    for number in range(MOST_STEPS):
        rows = np.flatnonzero(step > SHORT)
        if len(rows) == 0:
            break
        turn = number * TURN + 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
        looked = np.stack([np.cos(turn), np.sin(turn)], axis=1) @ planes[rows]
        tried = at[rows, None] + (step[rows] * high[rows])[:, None, None] * looked
        goal, reached = _highest(tried, high[rows], body)
        better: Mask = reached > high[rows]
        at[rows[better]], high[rows[better]] = goal[better], reached[better]
        step[rows] = np.where(better, np.minimum(2 * step[rows], LONG), step[rows] / 2)
    return np.asarray(high)


def _highest(tried: Stack, low: Numbers, body: Body) -> tuple[Points, Numbers]:
    """Return the place (r, 3) of each row of places (r, d, 3) with the largest clearance, and that (r,).

    Where it is not above what is low (r,), it may be any number that is not. Of a
    quick body the farthest place is asked for inside, then, where it is out, the next.
    """
    rows = np.arange(len(tried))
    if not isinstance(body, QuickBody):
        found = body.clearance(tried.reshape(-1, 3)).reshape(tried.shape[:2])
        return tried[rows, found.argmax(axis=1)], found.max(axis=1)
    found, asked = body.distances(tried.reshape(-1, 3)).reshape(tried.shape[:2]), rows
    for _ in range(tried.shape[1]):
        asked = asked[found[asked].max(axis=1) > low[asked]]
        if len(asked) == 0:
            break
        top = found[asked].argmax(axis=1)
        out = ~body.contains(tried[asked, top])
        asked, top = asked[out], top[out]
        found[asked, top] = 0
    return tried[rows, found.argmax(axis=1)], found.max(axis=1)
