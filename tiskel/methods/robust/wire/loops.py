"""Loops: where the two halves of a ring of wire meet, which a tree of shortest ways has to cut.

The ways around a loop part at one place and meet at another, head on, so that a
limb ends where another is near and points at it. In a crown twigs end near others
by chance; there are many more ends than such meetings, and none is taken for a
loop unless the user says so, or the wires are clear lines, which hardly touch.
"""

import numpy as np

from tiskel.arrays import Edges, Mask, Points
from tiskel.geometry.frames import step_lengths
from tiskel.geometry.graph import component_labels
from tiskel.geometry.ways import steps_of, way_to, ways_from
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, with_nodes
from tiskel.methods.robust.wire.links import Links
from tiskel.methods.trace import Sections
from tiskel.params import Topology

# Found by trial on rings, stents and generated trees.
REACH = 4.0  # spacings between the points of an end and of what it meets, at most
DETOUR = 10.0  # spacings along the curve between the two, at least
RADII = 4.0  # the same in the sum of the radii at both
SLIVER = 4.0  # times as long a detour may be a sliver: two wires side by side about the joint where they part
HEAD_ON = 0.25  # share of ends that meet another end, from which on a part is no tree [trees to 0.15, lattices 0.4]
MET = 0.1  # meetings for an end, from which on a part of clear lines is no tree [trees to 0.05, lattices 0.2 up]
MEETINGS = 2  # of ends with ends in a part, at least: one is chance, and a quarter of the ends of a small tree
FACING = 0.0  # cosine of the end's direction to what it meets, at least


def with_loops(
    curve: ConeCurve, sections: Sections, links: Links, topology: Topology, clear: bool = False
) -> tuple[ConeCurve, int]:  # fmt: skip
    """Return the curve with the edges that close its loops, and how many ends meet something and are left open.

    topology says whether there are loops.

    Of its own accord only in parts that are no trees. Where the wires are clear
    lines, which hardly touch by chance, a few meetings are enough.
    """
    if topology == "tree":
        return curve, 0
    pairs, strands = _meetings(curve, sections, links)
    meetings = len(pairs) + len(strands)
    if topology == "auto" and len(pairs):
        pairs = pairs[_looped(curve, pairs, clear)]
    left = meetings - len(pairs)
    if not len(pairs):
        return curve, left
    closed = _closed(curve, pairs)
    return (_without(closed, strands) if clear else closed), left  # in a crown some of them are twigs


def _closed(curve: ConeCurve, pairs: Edges) -> ConeCurve:
    return with_nodes(curve, np.zeros((0, 3)), np.zeros(0), pairs, np.zeros(0, np.int32))


def _without(curve: ConeCurve, ends: list[int]) -> ConeCurve:
    """Return the curve without the branches of some ends: strands beside the wire that they parted from."""
    into = np.arange(len(curve.nodes), dtype=np.int32)
    for path in curve.paths_from(ends=True):
        if path[0] in ends and curve.degrees[path[-1]] > 2:
            into[path[:-1]] = path[-1]
    return contract_nodes(curve, into)


def _looped(curve: ConeCurve, pairs: Edges, clear: bool) -> Mask:
    """Tell which pairs (p, 2) are in parts that have no more ends left than loops, or where many ends meet head on.

    In clear lines a few meetings are many.
    """
    part = component_labels(len(curve.nodes), curve.edges)
    closed = _closed(curve, pairs)
    count, end = int(part.max()) + 1, curve.degrees == 1
    ends, left = (np.bincount(part[graph.degrees == 1], minlength=count) for graph in (curve, closed))
    loops = np.bincount(part[pairs[:, 0]], minlength=count)
    met = np.bincount(part[pairs[:, 0]][end[pairs].all(axis=1)], minlength=count)
    many = (loops >= np.maximum(MEETINGS, MET * ends)) if clear else (met >= MEETINGS) & (2 * met >= HEAD_ON * ends)
    return np.asarray(((left <= loops) | many)[part[pairs[:, 0]]])


def _meetings(curve: ConeCurve, sections: Sections, links: Links) -> tuple[Edges, list[int]]:
    """Return pairs of nodes (p, 2): ends, and what each of them points at, within reach and far along the curve.

    The nearest first, and what is closed already counts: of the two ends at a gap the second would
    close it once more. With them come the ends that meet nothing but what they run beside.
    """
    pairs = _candidates(curve, sections, links)
    way = curve.nodes[pairs[:, 1]] - curve.nodes[pairs[:, 0]]
    apart = np.linalg.norm(way, axis=1)
    least = np.maximum(DETOUR * links.spacing, RADII * curve.radii[pairs].sum(axis=1))
    heading = {int(path[0]): curve.heading(path) for path in curve.paths_from(ends=True)}
    steps = steps_of(curve)
    taken: set[int] = set()
    strands: set[int] = set()
    met: list[tuple[int, int]] = []
    for row in np.lexsort((pairs[:, 1], pairs[:, 0], apart)).tolist():
        end, node = pairs[row].tolist()
        if end in taken or node in taken or float(heading[end] @ way[row]) < FACING:
            continue
        detour = way_to(ways_from(steps, end, SLIVER * float(least[row]), node), node)
        if _beside(curve.nodes[detour], float(least[row]), links.spacing):
            strands.add(end)
            continue
        met.append((end, node))
        taken |= {end} | ({node} if curve.degrees[node] == 1 else set())
        steps[end].append((node, float(apart[row])))
        steps[node].append((end, float(apart[row])))
    return np.array(met, np.int32).reshape(-1, 2), sorted(strands - taken)


def _candidates(curve: ConeCurve, sections: Sections, links: Links) -> Edges:
    """Return pairs (p, 2) of an end and another node of its part whose points are within reach of each other."""
    near = links.lengths <= REACH * links.spacing
    node = curve.node_of_section[sections.section]
    one, other = node[links.first[near]], node[links.second[near]]
    part = component_labels(len(curve.nodes), curve.edges)
    chosen = (one >= 0) & (other >= 0) & (one != other) & (part[one] == part[other]) & (curve.degrees[one] == 1)
    return np.unique(np.stack([one[chosen], other[chosen]], axis=1), axis=0).reshape(-1, 2)


def _beside(places: Points, least: float, spacing: float) -> bool:
    """Tell whether a way over places (q, 3) closes no loop: it is short, or within reach from side to side."""
    if not len(places) or float(step_lengths(places).sum()) <= least:
        return len(places) > 0
    offset = places - places.mean(axis=0)
    across = offset @ np.linalg.svd(offset, full_matrices=False)[2][1]
    return bool(np.ptp(across) <= 2 * REACH * spacing)
