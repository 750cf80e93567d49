"""The graph of the sections: one node for each, an edge where points of two are neighbours."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tiskel.arrays import Edges, Indices
from tiskel.geometry.graph import node_radii, tidy_edges
from tiskel.methods.robust.axes import line_centres
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections


def section_graph(network: Network, sections: Sections) -> ConeCurve:
    """Return the graph of sections, nodes in the middle of them."""
    section, count = sections.section, sections.count
    levels = np.zeros(count, np.int32)
    levels[section[section >= 0]] = sections.level[section >= 0]
    curve = ConeCurve(
        nodes=np.zeros((count, 3)),
        edges=_links(section[network.edges], levels),
        radii=np.zeros(count),
        levels=levels,
        node_of_section=np.append(np.arange(count), -1).astype(np.int32),
        section_sizes=np.bincount(section[section >= 0], minlength=count).astype(float),
    )
    return centred(curve, network, sections)


def centred(curve: ConeCurve, network: Network, sections: Sections) -> ConeCurve:
    """Return the curve with every node in the middle of its points, and their mean distance as its radius."""
    owner = curve.node_of_section[sections.section]
    rows = np.flatnonzero(owner >= 0)
    label, count = owner[rows], len(curve.nodes)
    nodes = line_centres(network.points[rows], network.normals[rows], label, count)[0]
    return replace(curve, nodes=nodes, radii=node_radii(nodes, network.points[rows], label))


def _links(pairs: Edges, levels: Indices) -> Edges:
    """Return the edges between sections.

    Neighbours further than one level apart, as at gaps, only count where
    nothing between their levels joins them already.
    """
    pairs = tidy_edges(pairs[(pairs >= 0).all(axis=1)])
    apart = np.abs(levels[pairs[:, 0]] - levels[pairs[:, 1]])
    edges, far = pairs[apart == 1], pairs[apart > 1]
    around: list[set[int]] = [set() for _ in levels]
    for a, b in edges.tolist():
        around[a].add(b)
        around[b].add(a)
    added = []
    for a, b in far[np.argsort(apart[apart > 1], kind="stable")].tolist():
        low, high = sorted((int(levels[a]), int(levels[b])))
        if not _joined(a, b, around, levels.tolist(), low - 1, high + 1):
            around[a].add(b)
            around[b].add(a)
            added.append((a, b))
    return tidy_edges(np.concatenate([edges, np.array(added, np.int32).reshape(-1, 2)]))


def _joined(a: int, b: int, around: Sequence[set[int]], levels: list[int], low: int, high: int) -> bool:
    """Tell whether a way leads from a to b through levels from low to high."""
    seen, todo = {a}, [a]
    while todo:
        for node in around[todo.pop()] - seen:
            if node == b:
                return True
            if low <= levels[node] <= high:
                seen.add(node)
                todo.append(node)
    return False
