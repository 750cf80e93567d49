"""From a thinned body to a curve of round cones: strands of cells, evened, and the points about each node."""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import breadth_first_order, dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points
from tiskel.geometry.body import Body
from tiskel.geometry.graph import tidy_edges
from tiskel.geometry.thinning import Grid
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections

# Found by trial on generated bodies: blocks and plates with holes, torsos, flat tubes, rings of rings.
EVENED = 4  # rounds in which nodes go half the way to the mean of their neighbours
APART = 0.55  # local radii from node to node, as the bins of the fronts
APART_CELLS = 2.0  # the same in cells, at least


def strands_of(body: Body, thin: Grid) -> ConeCurve:
    """Return the graph of the cells that thinning left: a node for each, with all their loops and no others."""
    number = np.full(body.inside.shape, -1)
    number[body.inside] = np.arange(len(body.cells))
    rows = number[thin]
    cells = body.cells[rows]
    pairs = np.sort(cKDTree(cells).query_pairs(1.8, output_type="ndarray"), axis=1)  # more than the root of three
    squares = ((cells[pairs[:, 0]] - cells[pairs[:, 1]]) ** 2).sum(axis=1)
    pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0], squares))].astype(np.int32)
    return plain_curve(body.places[rows], pairs[~_closing(pairs)], body.clearance[rows])


def _closing(pairs: Edges) -> Mask:
    """Return which pairs of touching cells, in the order in which they are joined, only close what triangles fill.

    Cells of a grid have a place in common where each two of them touch, so that
    these triangles have the loops of the cells (nerve theorem). Boundaries of
    triangles are reduced as for persistent homology: what remains of each is the
    loop that it fills, and the last pair of that closes it.
    """
    number = {pair: row for row, pair in enumerate(map(tuple, pairs.tolist()))}
    beyond: dict[int, set[int]] = {}
    for a, b in number:
        beyond.setdefault(a, set()).add(b)
    triangles = [
        {number[a, b], number[a, c], number[b, c]} for a, b in number for c in beyond[a] & beyond.get(b, set())
    ]
    filled: dict[int, set[int]] = {}
    for triangle in sorted(triangles, key=lambda rows: sorted(rows, reverse=True)):
        loop = triangle
        while loop and max(loop) in filled:
            loop = loop ^ filled[max(loop)]
        if loop:
            filled[max(loop)] = loop
    out = np.zeros(len(pairs), bool)
    out[list(filled)] = True
    return out


def plain_curve(nodes: Points, edges: Edges, radii: Numbers) -> ConeCurve:
    """Return a curve whose nodes stand for themselves."""
    count = len(nodes)
    own = np.append(np.arange(count), -1).astype(np.int32)
    levels = np.zeros(count, np.int32)
    return ConeCurve(
        nodes, tidy_edges(edges), radii, levels=levels, node_of_section=own, section_sizes=np.ones(count)
    )  # fmt: skip


def evened(curve: ConeCurve, body: Body, sizes: Numbers | None = None) -> ConeCurve:
    """Return the curve without the steps of the grid, nodes a part of their radius apart, or of other sizes (v,)."""
    nodes, degree = curve.nodes, curve.degrees
    for _ in range(EVENED):
        nodes = curve.halfway(nodes, degree > 1)
    curve, sizes = replace(curve, nodes=nodes), curve.radii if sizes is None else sizes
    links = [link for branch in curve.branches for link in _links(curve, branch, sizes, APART_CELLS * body.step)]
    edges = np.array(links, np.int32).reshape(-1, 2)
    kept = np.union1d(edges.ravel(), np.flatnonzero(degree == 0))
    name = np.full(len(nodes), -1, np.int32)
    name[kept] = np.arange(len(kept), dtype=np.int32)
    radii = np.maximum(body.clearance_at(nodes[kept]), body.step / 2)
    return plain_curve(nodes[kept], name[edges], radii)


def _links(curve: ConeCurve, branch: Indices, sizes: Numbers, least: float) -> list[tuple[int, int]]:
    """Return edges between some nodes of a branch; three at least of a ring."""
    way, wanted = curve.along(branch), np.maximum(APART * sizes[branch], least)
    share = np.concatenate([[0.0], np.cumsum(np.diff(way) * 2 / (wanted[1:] + wanted[:-1]))])
    parts = max(3 if branch[0] == branch[-1] else 2, int(np.round(share[-1])))
    chosen = np.unique([int(np.abs(share - share[-1] * k / parts).argmin()) for k in range(parts + 1)])
    chain = branch[chosen].tolist()
    return list(zip(chain[:-1], chain[1:], strict=True))


def with_sections(curve: ConeCurve, body: Body, network: Network) -> tuple[ConeCurve, Sections]:
    """Return the curve, and for every point the node whose ball is nearest on ways through the body."""
    cells = cKDTree(body.places)
    owner = _owners(curve, body, cells)
    section = owner[cells.query(network.points)[1]]
    count = len(curve.nodes)
    levels = np.zeros(count, np.int32)
    links = sparse.coo_array((np.ones(len(curve.edges)), tuple(curve.edges.T)), shape=(count, count)).tocsr()
    seen = np.zeros(count, bool)
    for start in [*np.flatnonzero(curve.degrees == 1).tolist(), *range(count)]:
        if not seen[start]:
            order, before = breadth_first_order(links, start, directed=False)
            seen[order] = True
            for node in order[1:].tolist():
                levels[node] = levels[before[node]] + 1
    sizes = np.bincount(section[section >= 0], minlength=count).astype(float)
    level = np.where(section < 0, -1, levels[section]).astype(np.int32)
    named = plain_curve(curve.nodes, curve.edges, curve.radii)
    return replace(named, levels=levels, section_sizes=sizes), Sections(section, level)


def _owners(curve: ConeCurve, body: Body, cells: cKDTree) -> Indices:
    """Return (m,) the node of every cell: least way through the body to its centre, less its radius."""
    count = len(body.cells)
    start, node = np.unique(cells.query(curve.nodes)[1], return_index=True)
    ahead = curve.radii.max() - curve.radii[node] + body.step
    graph = body.links.tocoo()
    rows, columns = np.concatenate([graph.row, np.full(len(start), count)]), np.concatenate([graph.col, start])
    links = sparse.coo_array((np.concatenate([graph.data, ahead]), (rows, columns)), shape=(count + 1, count + 1))
    before = dijkstra(links.tocsr(), directed=False, indices=count, return_predecessors=True)[1]
    owner = np.full(count + 1, -1, np.int32)
    owner[start] = node
    first = before == count
    owner[:count] = np.where(first[:count], owner[:count], -1)
    before = np.where((before < 0) | first, np.arange(count + 1), before)
    while (before != before[before]).any():
        before = before[before]
    return owner[before][:count]
