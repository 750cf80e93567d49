"""Loops: where the two halves of a ring of wire meet, which a tree of shortest ways has to cut.

The ways around a loop part at one place and meet at another, head on, so that a
limb ends where another is near and points at it. In a crown twigs end near others
by chance; there are many more ends than such meetings, and none is taken for a
loop unless the user says so.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, dijkstra

from tiskel.arrays import Edges, Mask, Numbers, Points
from tiskel.geometry.graph import component_labels
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.wire.links import Links
from tiskel.methods.trace import Sections
from tiskel.params import Topology

# Found by trial on rings, stents and generated trees.
REACH = 3.0  # spacings between the points of an end and of what it meets, at most
DETOUR = 10.0  # spacings along the curve between the two, at least
RADII = 4.0  # the same in the sum of the radii at both
HEAD_ON = 0.25  # share of ends that meet another end, from which on a part is no tree [trees to 0.15, lattices 0.4]
MEETINGS = 2  # of ends with ends in a part, at least: one is chance, and a quarter of the ends of a small tree
BLOCK = 256  # ends whose ways are known at a time, to bound memory
FACING = 0.0  # cosine of the end's direction to what it meets, at least


def with_loops(
    curve: ConeCurve, points: Points, sections: Sections, links: Links, topology: Topology
) -> ConeCurve:  # fmt: skip
    """Return the curve with the edges that close its loops; topology says whether there are any.

    Of its own accord only in parts that are no trees.
    """
    if topology == "tree":
        return curve
    pairs = _meetings(curve, sections, links)
    if topology == "auto" and len(pairs):
        pairs = pairs[_looped(curve, pairs)]
    return with_nodes(curve, np.zeros((0, 3)), np.zeros(0), pairs, np.zeros(0, np.int32)) if len(pairs) else curve


def _looped(curve: ConeCurve, pairs: Edges) -> Mask:
    """Tell which pairs (p, 2) are in parts that have no more ends left than loops, or where many ends meet head on."""
    part = component_labels(len(curve.nodes), curve.edges)
    closed = with_nodes(curve, np.zeros((0, 3)), np.zeros(0), pairs, np.zeros(0, np.int32))
    count, end = int(part.max()) + 1, curve.degrees == 1
    ends, left = (np.bincount(part[graph.degrees == 1], minlength=count) for graph in (curve, closed))
    loops = np.bincount(part[pairs[:, 0]], minlength=count)
    met = np.bincount(part[pairs[:, 0]][end[pairs].all(axis=1)], minlength=count)
    many = (met >= MEETINGS) & (2 * met >= HEAD_ON * ends)
    return np.asarray(((left <= loops) | many)[part[pairs[:, 0]]])


def _meetings(curve: ConeCurve, sections: Sections, links: Links) -> Edges:
    """Return pairs of nodes (p, 2): ends, and what each of them points at, within reach and far along the curve."""
    ends = np.flatnonzero(curve.degrees == 1)
    near = links.lengths <= REACH * links.spacing
    node = curve.node_of_section[sections.section]
    one, other = node[links.first[near]], node[links.second[near]]
    chosen = (one >= 0) & (other >= 0) & (one != other) & np.isin(one, ends)
    pairs = np.unique(np.stack([one[chosen], other[chosen]], axis=1), axis=0)
    if not len(pairs) or not len(ends):
        return np.zeros((0, 2), np.int32)
    count, (first, second) = len(curve.nodes), curve.edges.T
    graph = sparse.coo_array((np.maximum(curve.lengths, 1e-300), (first, second)), shape=(count, count)).tocsr()
    least = np.maximum(DETOUR * links.spacing, RADII * (curve.radii[pairs[:, 0]] + curve.radii[pairs[:, 1]]))
    along = _ways(graph, pairs, 2 * float(least.max()))
    heading = {int(path[0]): curve.heading(path) for path in curve.paths_from(ends=True)}
    found: dict[int, tuple[float, int]] = {}
    for (end, node), far, detour in zip(pairs.tolist(), least.tolist(), along.tolist(), strict=True):
        way = curve.nodes[node] - curve.nodes[end]
        apart = float(np.linalg.norm(way))
        if far < detour < np.inf and float(heading[end] @ way) >= FACING:
            found[end] = min(found.get(end, (apart, node)), (apart, node))
    # An end that another end has met already is closed.
    taken: set[int] = set()
    met: list[tuple[int, int]] = []
    nearest = sorted((apart, end, node) for end, (apart, node) in found.items())
    for _, end, meets in nearest:
        if end not in taken and meets not in taken:
            met.append((end, meets))
            taken |= {end} | ({meets} if curve.degrees[meets] == 1 else set())
    return np.array(met, np.int32).reshape(-1, 2)


def _ways(graph: sparse.csr_array, pairs: Edges, most: float) -> Numbers:
    """Return the length of the way between the nodes of pairs (p, 2), ordered by the first; inf where there is none.

    Of longer ways than most it is enough to know that they are.
    """
    part = connected_components(graph, directed=False)[1]
    out = np.empty(len(pairs))
    starts = np.unique(pairs[:, 0])
    for some in np.array_split(starts, -(-len(starts) // BLOCK)):
        mine = np.isin(pairs[:, 0], some)
        rows = np.searchsorted(some, pairs[mine, 0])
        out[mine] = dijkstra(graph, directed=False, indices=some, limit=most)[rows, pairs[mine, 1]]
    joined = part[pairs[:, 0]] == part[pairs[:, 1]]
    return np.where(joined & np.isinf(out), most, np.where(joined, out, np.inf))
