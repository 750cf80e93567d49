"""Two curves made one across a plane."""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Mask, Numbers, Pairs, Points
from tiskel.geometry.graph import component_labels
from tiskel.tiles.clusters import Cut, Slab
from tiskel.tiles.web import Web, together

NEAR = 1.5  # reaches to the other curve, at most, for a crossing without a partner to be joined to it
AROUND = 6.0  # reaches of way: what is joined so closely already needs no second way
STUB = 3.0  # reaches of a cut end that goes because its limb goes on another way; about a hole it is 2 pi at least
BLEND = 4.0  # times what two curves are apart: so long each bends towards the other


def stitched(low: Web, high: Web, axis: int, place: float, half: float, step: float) -> Web:
    """Return the curves of two sides as one.

    Parameters
    ----------
    low, high : Web
        Each knows its side and a margin of at least half beyond the plane; edges there are no longer than a step.
    axis : int
        The plane is across it.
    place : float
        Where the plane is.
    half : float
        How far from the plane the curves may be cut.
    step : float
        In the unit of the curves, as the two before.

    Returns
    -------
    Web
        Where a limb could not be continued it is torn.
    """
    slab = Slab(low, high, axis, place, half, step)
    cuts = slab.cuts()
    keep = slab.kept(np.arange(len(slab.x)), 0.0)
    for cut in cuts:
        keep[cut.members] = slab.kept(cut.members, cut.place)
    both = together([low, high])
    _adopt(both, slab, cuts, keep)
    pairs = _all([cut.pairs for cut in cuts], 4)
    pairs = pairs[keep[pairs[:, 0]] & keep[pairs[:, 3]]]
    alone = _all([cut.alone for cut in cuts], 2)
    alone = alone[keep[alone[:, 0]] & ~keep[alone[:, 1]]]
    number = np.cumsum(keep) - 1
    torn = both.torn.copy()
    web = replace(both, nodes=_blended(both, keep, pairs), torn=torn).kept(keep)
    joins = np.stack([number[pairs[:, 0]], number[pairs[:, 3]]], axis=1)
    web = _joined(web, joins, both.torn[pairs[:, 0]] | both.torn[pairs[:, 3]])
    web = _without_short_loops(web, joins)
    web = _attached(web, number[alone[:, 0]], slab.is_high[keep], np.abs(slab.x[keep]) <= 2 * half)
    gone = web.node == GONE
    return web.kept(~gone) if gone.any() else web


def _all(tables: list[Pairs], width: int) -> Pairs:
    return np.concatenate([np.zeros((0, width), np.int32), *tables])


def _joined(web: Web, joins: Pairs, still_torn: Mask | None = None) -> Web:
    """Return the web with more edges, whose nodes are torn no more."""
    torn = web.torn.copy()
    torn[joins] = False
    if still_torn is not None and len(still_torn):
        torn[joins[still_torn]] = True
    edges = np.concatenate([web.edges, joins]).astype(np.int32)
    return replace(web, torn=torn, edges=edges, bridged=np.concatenate([web.bridged, np.zeros(len(joins), bool)]))


def _adopt(both: Web, slab: Slab, cuts: list[Cut], keep: Mask) -> None:
    """Keep limbs that end beyond the plane and that only their own side knows."""
    fate = {int(node): cut for cut in cuts for node in cut.alone[:, 1]}
    if not fate:
        return
    lost = ~keep
    same = lost[both.edges].all(axis=1) & (slab.is_high[both.edges[:, 0]] == slab.is_high[both.edges[:, 1]])
    label = component_labels(len(keep), both.edges[same])
    unknown = np.bincount(label, both.torn | (slab.partner >= 0), minlength=int(label.max()) + 1) == 0
    for node in fate:
        if unknown[label[node]]:
            keep[label == label[node]] = True


def _blended(both: Web, keep: Mask, pairs: Pairs) -> Points:
    """Return the nodes, bent so that the ends of each pair meet halfway."""
    nodes: Points = both.nodes.copy()
    around = _around(both.edges[keep[both.edges].all(axis=1)], len(nodes))
    for low, cut_low, cut_high, high in pairs.tolist():
        middle = [(both.nodes[a] + both.nodes[b]) / 2 for a, b in ((low, cut_low), (high, cut_high))]
        apart = middle[1] - middle[0]
        across = apart - _along(both.nodes[cut_low] - both.nodes[low], apart)
        for start, way in ((low, across / 2), (high, -across / 2)):
            _bend(nodes, around, start, way, BLEND * float(np.linalg.norm(across)))
    return nodes


def _along(direction: Numbers, vector: Numbers) -> Numbers:
    square = float(direction @ direction)
    return direction * (float(vector @ direction) / square if square > 0 else 0.0)


def _bend(nodes: Points, around: dict[int, list[int]], start: int, way: Numbers, length: float) -> None:
    """Move nodes along a limb from its cut on, less and less."""
    done, before, at = 0.0, -1, start
    while done < length:
        old = nodes[at].copy()
        nodes[at] += way * (1 - done / length)
        others = [node for node in around.get(at, []) if node != before]
        if len(others) != 1:
            return
        before, at = at, others[0]
        done += float(np.linalg.norm(nodes[at] - old))


def _around(edges: Edges, count: int) -> dict[int, list[int]]:
    found: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        found.setdefault(a, []).append(b)
        found.setdefault(b, []).append(a)
    return found


def _attached(web: Web, ends: Indices, is_high: Mask, near: Mask) -> Web:
    """Join cut ends without a partner to the other side's curve beside them, or take them off where none is needed."""
    for end in ends.tolist():
        others = np.flatnonzero((is_high != is_high[end]) & near)
        if len(others) == 0:
            continue
        distance, nearest = cKDTree(web.nodes[others]).query(web.nodes[end])
        target = int(others[nearest])
        reach = max(web.reach[end], web.reach[target])
        if distance > NEAR * reach:
            continue
        if _way(web, end, target, AROUND * reach) <= AROUND * reach:
            web = _without_stub(web, end, STUB * reach)
        else:
            web = _joined(web, np.array([[end, target]]))
    return web


GONE = -2  # number of a node that is taken off when all ends are done


def _without_short_loops(web: Web, joins: Pairs) -> Web:
    """Return the web without those joins beside which a short way leads on, too: a joint that both sides have."""
    for one, other in joins.tolist():
        there = (web.edges == [one, other]).all(axis=1)
        without = replace(web, edges=web.edges[~there], bridged=web.bridged[~there])
        reach = float(max(web.reach[one], web.reach[other]))
        if _way(without, one, other, STUB * reach) <= STUB * reach:
            web = _without_stub(_without_stub(without, one, STUB * reach), other, STUB * reach)
    return web


def _way(web: Web, start: int, goal: int, limit: float) -> float:
    """Return how far it is along the curve, infinite beyond a limit."""
    a, b = web.edges.T
    graph = sparse.coo_array((np.maximum(web.lengths, 1e-300), (a, b)), shape=(len(web.nodes),) * 2).tocsr()
    return float(dijkstra(graph, directed=False, indices=start, limit=limit)[goal])


def _without_stub(web: Web, end: int, longest: float) -> Web:
    """Return the web without the way from an end to its joint, where that is short."""
    around = _around(web.edges, len(web.nodes))
    way, done = [end], 0.0
    while len(others := [node for node in around.get(way[-1], []) if node not in way[-2:]]) == 1:
        done += float(np.linalg.norm(web.nodes[others[0]] - web.nodes[way[-1]]))
        if done > longest:
            return web
        way.append(others[0])
    if len(way) > 1 and len(around.get(way[-1], [])) < 3:
        return web
    gone = way[:-1]
    keep = ~np.isin(web.edges, gone).any(axis=1)
    node, torn = web.node.copy(), web.torn.copy()
    node[gone], torn[way] = GONE, False
    return replace(web, edges=web.edges[keep], bridged=web.bridged[keep], node=node, torn=torn)
