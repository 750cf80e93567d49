"""Gaps: branches that the scan cuts through, joined again.

Open ends that face each other across a gap are joined, those that see each other
straight ahead first, then those whose lines meet before them, as at a corner or
along a bend; and open ends that face the side of another branch are joined to it.
"""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import TINY, Edges, Mask, Numbers, Points
from tiskel.geometry.graph import component_labels
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.ends import OpenEnd, open_ends
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
FACING = 0.5  # cosine between the direction of an end and the way to another, at least [0, 0; without it tunnels close]
FACING_SIDE = 0.7  # the same towards the side of another branch [1, 1]
SIDE = 0.75  # share of the widest gap between two ends that a gap to a side may be wide, in the end's own radius [1, 0]
PIECE = 1.5  # the same where the side belongs to another piece of the curve [0, 0; decides where patches are missing]
MEETING = 0.7  # sums of radii that the lines of two ends are apart at most, to meet [0, 0; where patches are missing]
PARALLEL = 1e-6  # least squared sine between two lines; those with less meet too far away to matter [numerics]
BEHIND = 0.75  # radii that they may meet behind an end [0, 0; where patches are missing]
CORNER = 1.85  # widest gap, in sums of radii: they meet before an end within so many of its radii [0, 0; patches]
BEND = 3.1  # the same where both ends see each other, at BEND_FACING at least [0, 0; where patches are missing]
BEND_FACING = 0.1  # cosine, see FACING [0, 0; where patches are missing]
BEND_WIDTH = 1.25  # widest gap: the straight way between two such ends is no wider [0, 0; where patches are missing]


@dataclass(frozen=True, eq=False)
class Gap:
    """A gap that is to be bridged.

    Attributes
    ----------
    cost : float
        The cheapest gap is bridged first.
    first, last : int
        The nodes at its sides.
    corner : (3,) float64 or None
        Where the lines of two ends meet, that do not see each other straight ahead.
    """

    cost: float
    first: int
    last: int
    corner: Numbers | None = None


def bridged(curve: ConeCurve, network: Network, sections: Sections, widest: float) -> tuple[ConeCurve, int]:
    """Return the curve with its gaps closed by edges through nothing, and how many there were.

    widest is the width of a gap at most, in the sum of the radii at its sides; 0
    leaves all gaps open.
    """
    if widest == 0:
        return curve, 0
    ends, count = open_ends(curve, network, sections), 0
    for gaps_between in (_straight, _corners, _bends):
        curve, ends, closed = _closed(curve, ends, gaps_between(curve, ends, widest))
        count += closed
    for reach, pieces in ((SIDE * widest, False), (PIECE * widest, True)):
        curve, ends, closed = _closed_to_sides(curve, ends, reach, pieces=pieces)
        count += closed
    return curve, count


def _closed(curve: ConeCurve, ends: list[OpenEnd], gaps: list[Gap]) -> tuple[ConeCurve, list[OpenEnd], int]:
    """Bridge gaps between ends, each end once; return the curve, the ends that are left, and how many gaps."""
    joined: set[int] = set()
    count = 0
    for gap in sorted(gaps, key=lambda one: (one.cost, one.first, one.last)):
        if not {gap.first, gap.last} & joined:
            joined |= {gap.first, gap.last}
            curve, count = _with_bridge(curve, gap), count + 1
    return curve, [end for end in ends if end.node not in joined], count


def _straight(curve: ConeCurve, ends: list[OpenEnd], widest: float) -> list[Gap]:
    """Return the gaps between open ends that look at each other, the nearest and straightest cheapest."""
    found = []
    for number, one in enumerate(ends):
        for other in ends[:number]:
            gap = curve.nodes[other.node] - curve.nodes[one.node]
            width, radii = float(np.linalg.norm(gap)), curve.radii[[one.node, other.node]]
            facing = float(one.direction @ gap), -float(other.direction @ gap)
            near = 0 < width < widest * radii.sum()
            if near and min(facing) > FACING * width:
                ways, corner, apart = _meeting_place(curve, one, other)
                bend = ways.min() > 0 and ways.max() < width and apart < MEETING * radii.sum()
                found.append(Gap(width * 3 - sum(facing), one.node, other.node, corner if bend else None))
    return found


def _corners(curve: ConeCurve, ends: list[OpenEnd], widest: float) -> list[Gap]:
    """Return the gaps between open ends whose lines meet near before both, the nearest cheapest."""
    return _meeting(curve, ends, CORNER * widest, -1.0, np.inf)


def _bends(curve: ConeCurve, ends: list[OpenEnd], widest: float) -> list[Gap]:
    """Return the gaps between open ends that see each other and whose lines meet before both, further away."""
    return _meeting(curve, ends, BEND * widest, BEND_FACING, BEND_WIDTH * widest)


def _meeting(curve: ConeCurve, ends: list[OpenEnd], before: float, least: float, widest: float) -> list[Gap]:
    """Return the gaps between ends whose lines meet so many radii before both.

    The cosine between the direction of an end and the way to the other is at
    least what is given, and the gap no wider than so many sums of radii.
    """
    found = []
    for number, one in enumerate(ends):
        for other in ends[:number]:
            radii = curve.radii[[one.node, other.node]]
            gap = curve.nodes[other.node] - curve.nodes[one.node]
            width = float(np.linalg.norm(gap))
            facing = np.array([gap @ one.direction, -gap @ other.direction])
            ways, corner, apart = _meeting_place(curve, one, other)
            near = (ways > -BEHIND * radii) & (ways < before * radii) & (facing > least * width)
            if near.all() and apart < MEETING * radii.sum() and 0 < width < widest * radii.sum():
                found.append(Gap(float(ways.sum()), one.node, other.node, corner))
    return found


def _meeting_place(curve: ConeCurve, one: OpenEnd, other: OpenEnd) -> tuple[Numbers, Numbers, float]:
    """Return how far before two ends (2,) their lines are closest, the middle there (3,), and how wide apart."""
    gap, turn = curve.nodes[other.node] - curve.nodes[one.node], float(one.direction @ other.direction)
    along = np.array([gap @ one.direction, gap @ other.direction])
    ways = np.array([along[0] - turn * along[1], turn * along[0] - along[1]]) / max(1 - turn**2, PARALLEL)
    first = curve.nodes[one.node] + ways[0] * one.direction
    last = curve.nodes[other.node] + ways[1] * other.direction
    return ways, np.asarray((first + last) / 2), float(np.linalg.norm(first - last))


def _closed_to_sides(
    curve: ConeCurve, ends: list[OpenEnd], reach: float, *, pieces: bool
) -> tuple[ConeCurve, list[OpenEnd], int]:
    """Join open ends to the sides of other branches that they look at; of other pieces of the curve only, if so."""
    left, count = [], 0
    for end in ends:
        own = np.zeros(len(curve.nodes), bool)
        own[list(end.branch)] = True
        if pieces:
            label = component_labels(len(curve.nodes), curve.edges)
            own = label == label[end.node]
        side = _side(curve, end, own, reach)
        if side is None:
            left.append(end)
        else:
            curve, count = _with_bridge(curve, Gap(0.0, end.node, side)), count + 1
    return curve, left, count


def _side(curve: ConeCurve, end: OpenEnd, own: Mask, reach: float) -> int | None:
    """Return the node, but for its own, that an open end looks at, None where it looks at nothing near."""
    gap = curve.nodes - curve.nodes[end.node]
    width = np.maximum(np.linalg.norm(gap, axis=1), TINY)
    cosine = gap @ end.direction / width
    near = (cosine > FACING_SIDE) & (width < curve.radii + reach * curve.radii[end.node]) & ~own
    cost = np.where(near, (width - curve.radii) * (2 - cosine), np.inf)
    return int(cost.argmin()) if near.any() else None


def _with_bridge(curve: ConeCurve, gap: Gap) -> ConeCurve:
    """Join two nodes by a straight line or, where their lines meet, along the bend, with a node every radius or so."""
    start, stop = curve.nodes[gap.first], curve.nodes[gap.last]
    radii = curve.radii[[gap.first, gap.last]]
    corner = (start + stop) / 2 if gap.corner is None else gap.corner
    width = float(np.linalg.norm(stop - start) + np.linalg.norm(corner - start) + np.linalg.norm(stop - corner)) / 2
    between = max(0, int(2 * width / max(float(radii.sum()), TINY)) - 1)
    share = (np.arange(1, between + 1) / (between + 1))[:, None]
    nodes: Points = (1 - share) ** 2 * start + 2 * share * (1 - share) * corner + share**2 * stop
    chain = np.array([gap.first, *range(len(curve.nodes), len(curve.nodes) + between), gap.last], np.int32)
    links: Edges = np.stack([chain[:-1], chain[1:]], axis=1)
    levels = np.full(between, curve.levels[gap.first], np.int32)
    return with_nodes(curve, nodes, ((1 - share) * radii[0] + share * radii[1])[:, 0], links, levels, bridge=True)
