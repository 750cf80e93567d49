"""Gaps: branches that the scan cuts through, joined again.

The end of a branch is round: points lie ahead of it. Where none do, the end is
open, a cut or the mouth of a tube. Open ends that face each other across a gap,
and open ends that face the side of another branch, are joined.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Edges, Numbers
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
AROUND = 1.4  # radii about an end in which its cap is looked for [0, 1]
AHEAD = 0.6  # radii ahead of the end, from where on points belong to the cap [0, 0; OPEN counts from there]
OPEN = 0.6  # share of a ball's cap, by area: an end with less is open [0, 0; decides where patches are missing]
FACING = 0.5  # cosine between the direction of an end and the way to another, at least [0, 0; without it tunnels close]
FACING_SIDE = 0.7  # the same towards the side of another branch [1, 1]
SIDE = 0.75  # share of the widest gap between two ends that a gap to a side may be wide, in the end's own radius [1, 0]


@dataclass(frozen=True)
class OpenEnd:
    """An end without a cap.

    Attributes
    ----------
    node : int
        Its node.
    direction : (3,) float64
        The direction it looks in, a unit vector.
    branch : frozenset of int
        The nodes of its branch.
    """

    node: int
    direction: Numbers
    branch: frozenset[int]


def bridged(curve: ConeCurve, network: Network, sections: Sections, widest: float) -> tuple[ConeCurve, int]:
    """Return the curve with its gaps closed by straight edges, and how many there were.

    widest is the width of a gap at most, in the sum of the radii at its sides; 0
    leaves all gaps open.
    """
    if widest == 0:
        return curve, 0
    ends = open_ends(curve, network, sections)
    pairs = _facing_pairs(curve, ends, widest)
    joined = {node for pair in pairs for node in pair}
    curve = _with_edges(curve, pairs)
    sides: list[tuple[int, int]] = []
    for end in ends:
        side = None if end.node in joined else _facing_side(curve, end, SIDE * widest)
        if side is not None:
            sides.append((end.node, side))
    return _with_edges(curve, sides), len(pairs) + len(sides)


def open_ends(curve: ConeCurve, network: Network, sections: Sections) -> list[OpenEnd]:
    """Return the ends that have no cap."""
    paths = curve.paths_from(ends=True)
    rows = np.flatnonzero(curve.node_of_section[sections.section] >= 0)
    tree, found = cKDTree(network.points[rows]), []
    whole = 2 * np.pi * (1 - AHEAD)  # area of a ball's cap, in squared radii
    for path in paths:
        end, radius = int(path[0]), float(curve.radii[path[0]])
        direction = curve.heading(path)
        direction /= max(float(np.linalg.norm(direction)), TINY)
        near = rows[np.sort(np.array(tree.query_ball_point(curve.nodes[end], AROUND * radius), int))]
        cap = near[(network.points[near] - curve.nodes[end]) @ direction > AHEAD * radius]
        if network.areas[cap].sum() < OPEN * whole * radius**2:
            found.append(OpenEnd(end, direction, frozenset(path.tolist())))
    return found


def _facing_pairs(curve: ConeCurve, ends: list[OpenEnd], widest: float) -> list[tuple[int, int]]:
    """Return pairs of open ends that look at each other, the nearest and straightest first, each end once."""
    found = []
    for number, one in enumerate(ends):
        for other in ends[:number]:
            gap = curve.nodes[other.node] - curve.nodes[one.node]
            width, radii = float(np.linalg.norm(gap)), curve.radii[[one.node, other.node]]
            facing = float(one.direction @ gap), -float(other.direction @ gap)
            near = 0 < width < widest * radii.sum()
            if near and min(facing) > FACING * width:
                found.append((width * 3 - sum(facing), one.node, other.node))
    pairs: list[tuple[int, int]] = []
    for _, a, b in sorted(found):
        if not {a, b} & {node for pair in pairs for node in pair}:
            pairs.append((a, b))
    return pairs


def _facing_side(curve: ConeCurve, end: OpenEnd, widest: float) -> int | None:
    """Return the node of another branch that an open end looks at, None where it looks at nothing near."""
    gap = curve.nodes - curve.nodes[end.node]
    width = np.maximum(np.linalg.norm(gap, axis=1), TINY)
    cosine = gap @ end.direction / width
    near = (cosine > FACING_SIDE) & (width < curve.radii + widest * curve.radii[end.node])
    near[list(end.branch)] = False
    cost = np.where(near, (width - curve.radii) * (2 - cosine), np.inf)
    return int(cost.argmin()) if near.any() else None


def _with_edges(curve: ConeCurve, pairs: list[tuple[int, int]]) -> ConeCurve:
    """Join nodes by straight lines with a node every radius or so."""
    for a, b in pairs:
        width = float(np.linalg.norm(curve.nodes[a] - curve.nodes[b]))
        between = max(0, int(2 * width / max(float(curve.radii[a] + curve.radii[b]), TINY)) - 1)
        share = (np.arange(1, between + 1) / (between + 1))[:, None]
        chain = np.array([a, *range(len(curve.nodes), len(curve.nodes) + between), b], np.int32)
        nodes = (1 - share) * curve.nodes[a] + share * curve.nodes[b]
        radii = ((1 - share) * curve.radii[a] + share * curve.radii[b])[:, 0]
        links: Edges = np.stack([chain[:-1], chain[1:]], axis=1)
        curve = with_nodes(curve, nodes, radii, links, np.full(between, curve.levels[a], np.int32), bridge=True)
    return curve
