"""From samples to a graph: joining neighbours, then collapsing triangles, as published."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Numbers, Points
from tiskel.geometry.rings import Rings


def inherited_edges(rings: Rings, owner: Indices, nodes: Points) -> Edges:
    """Join samples that are neighbours.

    For each point the first member of its ring, in ring order, that belongs to
    another sample joins the two; a sample without neighbours is joined to its
    nearest one (Cao et al. 2010, section 4).

    Parameters
    ----------
    rings : Rings
        Of the n contracted points.
    owner : (n,) int32
        The sample that owns each point.
    nodes : (v, 3) float64
        Where the samples are.

    Returns
    -------
    (e, 2) int32
        Pairs of samples, the lower first, ascending, each once.
    """
    owners = np.where(rings.mask(), owner[rings.members], owner[:, None])
    foreign = owners != owner[:, None]
    found = foreign.any(axis=1)
    first = np.take_along_axis(owners, foreign.argmax(axis=1)[:, None], axis=1)[:, 0]
    edges = np.sort(np.stack([owner[found], first[found]], axis=1), axis=1)
    alone = np.setdiff1d(np.arange(len(nodes)), edges)
    if len(alone) and len(nodes) > 1:
        nearest = cKDTree(nodes).query(nodes[alone], k=2)[1]
        partner = np.where(nearest[:, 0] == alone, nearest[:, 1], nearest[:, 0])
        edges = np.concatenate([edges, np.sort(np.stack([alone, partner], axis=1), axis=1)])
    return np.unique(edges, axis=0).astype(np.int32)


def collapse_triangles(nodes: Points, edges: Edges) -> tuple[Points, Edges, Indices]:
    """Collapse edges of triangles until none is left.

    The toolbox means to take the edge of lowest mean degree first and the
    shortest among equals. What it computes, and what reproduces its published
    curves, is: each triangle i < j < k offers (i, j), (j, k) and (k, i); the
    second end survives, at the midpoint; the key is the row sum of the second
    end in an adjacency matrix where a survivor joins the *columns* of the
    edges it inherits and its own row stays as it was. When that finds no
    triangle any more, both ends are told of every edge and the search goes on.

    Parameters
    ----------
    nodes : (v, 3) float64
        Where the samples are, in any unit.
    edges : (e, 2) int32
        Pairs of them.

    Returns
    -------
    nodes : (w, 3) float64
        Those that are left, in their order.
    edges : (f, 2) int32
        Pairs of them, the lower first, ascending; no three make a triangle.
    into : (v,) int32
        For each node before the one after.
    """
    position = dict(enumerate(nodes))
    around: dict[int, set[int]] = {i: set() for i in range(len(nodes))}
    for a, b in edges.tolist():
        around[a].add(b)
        around[b].add(a)
    into = np.arange(len(nodes), dtype=np.int32)
    while True:
        best = _cheapest(position, around)
        if best is None:
            if _symmetrise(around):
                continue
            break
        lost, kept = best
        position[kept] = (position.pop(lost) + position[kept]) / 2
        knew = around.pop(lost)
        for other, neighbours in around.items():
            if other != kept and (other in knew or lost in neighbours):
                neighbours.add(kept)
            neighbours.discard(lost)
        into[into == lost] = kept
    return _compacted(position, around, into)


def _symmetrise(around: dict[int, set[int]]) -> bool:
    """Let both ends of every edge know of it; return whether one did not."""
    missing = [(b, a) for a, others in around.items() for b in others if a not in around[b]]
    for a, b in missing:
        around[a].add(b)
    return bool(missing)


def _cheapest(position: dict[int, Numbers], around: dict[int, set[int]]) -> tuple[int, int] | None:
    """Return the edge (lost, kept) with the lowest key, the first found among equals."""
    best, key = None, (np.inf, np.inf)
    for i in sorted(around):
        higher = sorted(j for j in around[i] if j > i)
        for at, j in enumerate(higher):
            for k in higher[at + 1 :]:
                if k not in around[j]:
                    continue
                for lost, kept in ((i, j), (j, k), (k, i)):
                    candidate = (len(around[kept]), float(np.linalg.norm(position[lost] - position[kept])))
                    if candidate < key:
                        best, key = (lost, kept), candidate
    return best


def _compacted(
    position: dict[int, Numbers], around: dict[int, set[int]], into: Indices
) -> tuple[Points, Edges, Indices]:
    """Number the nodes that are left from zero and return the edges that either end knows of."""
    left = sorted(position)
    place = {node: i for i, node in enumerate(left)}
    pairs = {(min(place[a], place[b]), max(place[a], place[b])) for a in left for b in around[a]}
    nodes = np.array([position[node] for node in left]).reshape(-1, 3)
    edges = np.array(sorted(pairs), np.int32).reshape(-1, 2)
    return nodes, edges, np.array([place[int(node)] for node in into], np.int32)
