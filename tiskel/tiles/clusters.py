"""Two curves about a plane that both know: what belongs together, and where each is cut so that they fit.

A curve differs a little from tile to tile: a joint may lie on one side of the
plane in one and on the other in the next, a limb along the plane on either
side. So every cluster of limbs in the slab about the plane is cut where the two
curves agree, not on the plane. Clusters are looked for in slabs of several
widths, and a wide one is cut at one place only where that fits better than
cutting its parts in a narrow slab each at its own.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Mask, Numbers, Pairs, Points
from tiskel.geometry.frames import unit
from tiskel.geometry.graph import component_labels
from tiskel.tiles.cells import Integers
from tiskel.tiles.web import Web

LEVELS = (0.25, 0.5, 1.0)  # of the half width of the slab: those of the slabs in which clusters are looked for
PLACES = 17  # of a cut that are tried in a slab, the middle of it included
FIT = 2.0  # a pair of crossings may cost: distance in reaches, and one less the cosine of their directions
DOUBLE = 0.5  # price of a reach of curve that both tiles give, or neither; a crossing without a partner costs 1
OFF = 0.02  # price of a cut at the rim of the slab, and a tenth of what pairs cost: decides where all else fits
WIDER = 0.01  # what a wide slab must be better by
ROUNDING = 1e-9  # of the half width: so far may rounding move a node beyond a slab, and a cut then miss its edge


@dataclass(frozen=True, eq=False)
class Cut:
    """Where a cluster is cut.

    Attributes
    ----------
    members : (k,) int32
        Its nodes, of the two webs one behind the other.
    place : float
        From the plane, along the axis.
    pairs : (p, 4) int32
        Crossings that fit: node kept and node left of the low side, node left and node kept of the high side.
    alone : (q, 2) int32
        Other crossings: node kept and node left.
    cost : float
        What does not fit.
    """

    members: Indices
    place: float
    pairs: Pairs
    alone: Pairs
    cost: float


class Slab:
    """Two webs, one behind the other, about a plane.

    Parameters
    ----------
    low, high : Web
        Of the two sides, each with a margin beyond the plane, edges divided.
    axis : int
        The plane is across it.
    place : float
        Where it is.
    half : float
        Half the width of the widest slab.
    step : float
        Longest edge in it.
    """

    def __init__(self, low: Web, high: Web, axis: int, place: float, half: float, step: float) -> None:
        self.nodes = np.concatenate([low.nodes, high.nodes])
        self.x: Numbers = self.nodes[:, axis] - place
        self.reach = np.concatenate([low.reach, high.reach])
        self.is_high: Mask = np.arange(len(self.nodes)) >= len(low.nodes)
        self.edges = np.concatenate([low.edges, high.edges + len(low.nodes)])
        self.half, self.step = half, step
        self.links, self.partner = self._links()
        lengths = np.linalg.norm(self.nodes[self.edges[:, 0]] - self.nodes[self.edges[:, 1]], axis=1)
        self.own = np.bincount(self.edges.ravel(), np.repeat(lengths / 2, 2), len(self.nodes)).astype(np.float64)

    def cuts(self) -> list[Cut]:
        """Return the cuts of all clusters in the slab, those of narrow slabs where these do as well."""
        below: list[Cut] = []
        for level in LEVELS:
            below = list(self._level(level * self.half, below))
        return below

    def _links(self) -> tuple[Pairs, Indices]:
        """Return (l, 2) nodes of both webs within reach of each other, and (v,) the nearest of these, -1 for none."""
        partner = np.full(len(self.nodes), -1, np.int32)
        inside = np.abs(self.x) <= self.half
        rows = [np.flatnonzero(inside & (self.is_high == high)) for high in (False, True)]
        found = [np.zeros((0, 2), np.int64)]
        if min(map(len, rows)):
            for own, others in (rows, rows[::-1]):
                tree = cKDTree(self.nodes[others])
                near = tree.query_ball_point(self.nodes[own], self.reach[own], return_sorted=True)
                counts = np.array(list(map(len, near)))
                if counts.sum():
                    found.append(np.stack([np.repeat(own, counts), others[np.concatenate(near).astype(int)]], axis=1))
                distance, nearest = tree.query(self.nodes[own])
                near_enough = distance <= np.maximum(self.reach[own], self.reach[others[nearest]])
                partner[own[near_enough]] = others[nearest[near_enough]]
        return np.concatenate(found), partner

    def _level(self, half: float, below: list[Cut]) -> Iterator[Cut]:
        inside = np.abs(self.x) <= half * (1 + ROUNDING)
        joins = np.concatenate([self.edges, self.links])
        joins = joins[inside[joins].all(axis=1)]
        label = component_labels(len(self.nodes), joins)
        parts: dict[int, list[Cut]] = {}
        for cut in below:
            parts.setdefault(int(label[cut.members[0]]), []).append(cut)
        edges = self.edges[inside[self.edges].all(axis=1)]
        of_edge = label[edges[:, 0]]
        rows = np.flatnonzero(inside)
        order = rows[np.argsort(label[rows], kind="stable")]
        for members in np.split(order, np.flatnonzero(np.diff(label[order])) + 1) if len(order) else ():
            number = int(label[members[0]])
            narrow = parts.get(number, [])
            if narrow and sum(cut.cost for cut in narrow) < WIDER:
                yield from narrow
                continue
            cut = self._best(members.astype(np.int32), edges[of_edge == number], half)
            if narrow and sum(part.cost for part in narrow) <= cut.cost + WIDER:
                yield from narrow
            else:
                yield cut

    def _best(self, members: Indices, edges: Pairs, half: float) -> Cut:
        room = max(half - self.step, 0.0)
        tried = [self._cut(members, edges, place, half) for place in np.linspace(-room, room, PLACES)]
        return min(tried, key=lambda cut: cut.cost)

    def _cut(self, members: Indices, edges: Pairs, place: float, half: float) -> Cut:
        """Return what a cut of a cluster at a place gives."""
        crossing = edges[(self.x[edges[:, 0]] < place) != (self.x[edges[:, 1]] < place)]
        kept = self.kept(crossing, place)
        ordered = np.where(kept[:, :1], crossing, crossing[:, ::-1])  # the node that is kept first
        is_high = self.is_high[ordered[:, 0]]
        low, high = ordered[~is_high], ordered[is_high]
        rows, columns, price = self._matched(low, high, place)
        pairs = np.concatenate([low[rows], high[columns][:, ::-1]], axis=1)
        alone = np.concatenate([np.delete(low, rows, axis=0), np.delete(high, columns, axis=0)])
        cost = len(alone) + DOUBLE * self._doubled(members, place) + OFF * (abs(place) / self.half + price)
        return Cut(members, place, pairs.astype(np.int32), alone.astype(np.int32), float(cost))

    def kept(self, nodes: Integers, place: float) -> npt.NDArray[np.bool_]:
        """Return which nodes (any shape) stay where the cut is at a place: those of either web on its own side."""
        return np.asarray((self.x[nodes] < place) != self.is_high[nodes])

    def _matched(self, low: Pairs, high: Pairs, place: float) -> tuple[Indices, Indices, float]:
        """Return rows of crossings of both sides that fit, and what these pairs cost together."""
        if not len(low) or not len(high):
            return np.zeros(0, np.int32), np.zeros(0, np.int32), 0.0
        (at, to), (other, towards) = self._crossings(low, place), self._crossings(high[:, ::-1], place)
        reach = np.maximum(self.reach[low[:, :1]], self.reach[high[:, 0]])
        price = np.linalg.norm(at[:, None] - other, axis=2) / reach + (1 - to @ towards.T)
        rows, columns = linear_sum_assignment(np.minimum(price, FIT))
        good = price[rows, columns] < FIT
        return rows[good], columns[good], float(price[rows, columns][good].sum())

    def _crossings(self, edges: Pairs, place: float) -> tuple[Points, Points]:
        """Return where edges (k, 2) cross a place, and their directions."""
        a, b = self.nodes[edges[:, 0]], self.nodes[edges[:, 1]]
        share = (place - self.x[edges[:, 0]]) / (self.x[edges[:, 1]] - self.x[edges[:, 0]])
        return a + share[:, None] * (b - a), unit(b - a)

    def _doubled(self, members: Indices, place: float) -> float:
        """Return how many reaches of curve both webs give, or neither does, where they are near each other."""
        paired = members[self.partner[members] >= 0]
        same = self.kept(paired, place) == self.kept(self.partner[paired], place)
        return float((self.own[paired[same]] / self.reach[paired[same]]).sum() / 2)
