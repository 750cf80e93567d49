"""The curve stage of GLSkeleton as its toolbox ships it, with the fault of its index (`--variant toolbox`).

Between joining samples and collapsing triangles the toolbox means to take samples out that lie on a straight line
between two neighbours. It reads how often two samples were joined as the number of a sample: what is straight is then
asked of others, and their links change. A sample that is taken out loses its place, but not its links; what collapses
into it is lost as well, and so are pieces of the curve.
"""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Lists, Points
from tiskel.geometry.rings import Rings
from tiskel.methods.laplacian.collapse import first_foreign

STRAIGHT = -0.98  # cosine between the ways to both neighbours [T]


def join_counts(rings: Rings, owner: Indices, nodes: Points) -> Lists:
    """Return how often two samples (v, v) are joined by a point of one whose first foreign ring member is the other's.

    A sample that is joined to none is joined to its nearest one, once.
    """
    counts = np.zeros((len(nodes), len(nodes)), np.int32)
    np.add.at(counts, tuple(first_foreign(rings, owner).T), 1)
    counts += counts.T
    alone = np.flatnonzero(~counts.any(axis=1))
    if len(alone) and len(nodes) > 1:
        for i, near in zip(alone, cKDTree(nodes).query(nodes[alone], k=2)[1], strict=True):
            for j in near[near != i]:
                counts[i, j] = counts[j, i] = 1
    return counts


def without_straight(counts: Lists, nodes: Points) -> tuple[Points, Edges]:
    """Take samples out as the toolbox does, numbers of joins read as numbers of samples from 1.

    Parameters
    ----------
    counts : (v, v) int32
        How often samples are joined.
    nodes : (v, 3) float64
        Where they are.

    Returns
    -------
    nodes : (v, 3) float64
        NaN where a sample was taken out.
    edges : (e, 2) int32
        Pairs of samples, the lower first.
    """
    counts, left = counts.copy(), nodes.copy()
    for i in range(len(nodes)):
        joins = counts[i][counts[i] > 0]
        if len(joins) != 2 or (joins > len(nodes)).any():
            continue
        a, b = (int(join) - 1 for join in joins)
        ways = nodes[i] - nodes[[a, b]]
        lengths = np.linalg.norm(ways, axis=1)
        if lengths.all() and ways[0] @ ways[1] < STRAIGHT * lengths.prod():
            left[i] = np.nan
            counts[i, [a, b]] = counts[[a, b], i] = 0
            counts[a, b] = counts[b, a] = 1
    return left, np.argwhere(np.triu(counts, 1) > 0).astype(np.int32)


def without_lost(nodes: Points, edges: Edges, into: Indices, before: Points) -> tuple[Points, Edges, Indices]:
    """Return a curve without the nodes that have no place; what they stood for goes to the nearest that has one.

    Parameters
    ----------
    nodes : (w, 3) float64
        NaN where a place was lost.
    edges : (e, 2) int32
        Pairs of nodes.
    into : (v,) int32
        The node of every sample.
    before : (v, 3) float64
        Where the samples were.
    """
    placed = np.flatnonzero(np.isfinite(nodes).all(axis=1))
    if len(placed) == len(nodes):
        return nodes, edges, into
    if len(placed) == 0:
        return before[:1], np.zeros((0, 2), np.int32), np.zeros(len(into), np.int32)
    number = np.full(len(nodes), -1, np.int32)
    number[placed] = np.arange(len(placed), dtype=np.int32)
    nearest = cKDTree(nodes[placed]).query(before)[1]
    owner = np.where(number[into] >= 0, number[into], nearest)
    return nodes[placed], number[edges[(number[edges] >= 0).all(axis=1)]], owner.astype(np.int32)
