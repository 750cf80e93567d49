"""The plain baseline for trees: a shortest-path tree through the points of a cloud, thinned to its long ways.

Greedy ways back from the farthest point are those of TEASAR (Sato et al., Pacific Graphics 2000), shortest paths
through a neighbour graph those of tree reconstruction (AdTree, Du et al. 2019; RayExtract). On wires, where a limb is
thinner than its points are apart, a method that models thickness has to be at least as good as this.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, dijkstra, minimum_spanning_tree
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers, Points
from tiskel.geometry.graph import CurveGraph, node_radii, tidy_edges

NEIGHBOURS = 20  # nearest others in the graph
QUANTILE = 0.75  # of the edges of the minimum spanning tree: the spacing h
TAKEN = 2.0  # a: points so many h from a limb belong to it
SHORTEST = 3.0  # m: a limb is so many h long outside what is taken
BRIDGE = 4.0  # links longer than so many h lie over a gap
ROOT = 0.03  # of the diagonal: the ball in which the root has most neighbours
ROUNDS = 2  # of smoothing, half a step each


def path_tree(points: Points) -> CurveGraph:
    """Return the tree of a cloud (n, 3) in any unit; every node was a point, its ends still are."""
    points = np.unique(points, axis=0)
    if len(points) < 2:
        return CurveGraph(points, np.zeros((0, 2), np.int32))
    tree = cKDTree(points)
    graph = _joined(points, tree)
    h = float(np.quantile(minimum_spanning_tree(graph).data, QUANTILE))
    reach = ROOT * float(np.linalg.norm(np.ptp(points, axis=0)))
    root = int(np.argmax(tree.query_ball_point(points, reach, return_length=True)))
    before = dijkstra(graph.power(2), directed=False, indices=root, return_predecessors=True)[1].astype(np.int64)
    before[root] = root
    edges = _limbs(points, tree, before, root, h)
    nodes, links = np.unique(edges, return_inverse=True) if len(edges) else (np.array([root]), edges)
    links = tidy_edges(links.reshape(-1, 2).astype(np.int32))
    bridged = np.linalg.norm(points[nodes[links[:, 0]]] - points[nodes[links[:, 1]]], axis=1) > BRIDGE * h
    places = _smooth(points[nodes], CurveGraph(points[nodes], links))
    owner = cKDTree(places).query(points)[1].astype(np.int32)
    return CurveGraph(places, links, node_radii(places, points, owner), bridged)


def _joined(points: Points, tree: cKDTree) -> sparse.csr_array:
    """Return the symmetric graph of nearest neighbours; the smallest piece joins its nearest until one is left."""
    count = len(points)
    near = tree.query(points, k=min(NEIGHBOURS + 1, count))[1][:, 1:]
    pairs = np.stack([np.repeat(np.arange(count), near.shape[1]), near.ravel()], axis=1)
    label = connected_components(_graph(points, pairs), directed=False)[1]
    while label.any():
        sizes = np.bincount(label)
        piece = int(np.argmin(np.where(sizes > 0, sizes, count)))
        own, others = np.flatnonzero(label == piece), np.flatnonzero(label != piece)
        apart, nearest = cKDTree(points[others]).query(points[own])
        a, b = own[np.argmin(apart)], others[nearest[np.argmin(apart)]]
        pairs = np.concatenate([pairs, [[a, b]]])
        label[np.isin(label, label[[a, b]])] = label[[a, b]].min()
    return _graph(points, pairs)


def _graph(points: Points, pairs: np.ndarray) -> sparse.csr_array:
    a, b = np.unique(np.sort(pairs, axis=1), axis=0).T
    lengths = np.linalg.norm(points[a] - points[b], axis=1)
    return sparse.csr_array((np.concatenate([lengths] * 2), (np.append(a, b), np.append(b, a))), (len(points),) * 2)


def _limbs(points: Points, tree: cKDTree, before: np.ndarray, root: int, h: float) -> np.ndarray:
    """Return edges (e, 2): the way back of the farthest point that is not taken, as long as such ways are long."""
    along, taken, drawn = _along(points, before), np.zeros(len(points), bool), np.zeros(len(points), bool)
    taken[root] = drawn[root] = True
    edges: list[tuple[int, int]] = []
    for tip in np.argsort(-along, kind="stable"):
        if taken[tip]:
            continue
        way = [int(tip)]
        while not drawn[way[-1]]:
            way.append(int(before[way[-1]]))
        outside = int(np.argmax(taken[way]))  # the first place that is taken
        taken[way] = True
        if along[tip] - along[way[outside]] > SHORTEST * h:
            drawn[way] = True
            edges += zip(way[:-1], way[1:], strict=True)
            taken[np.concatenate(tree.query_ball_point(points[way], TAKEN * h)).astype(int)] = True
    return np.array(edges, np.int64).reshape(-1, 2)


def _along(points: Points, before: np.ndarray) -> Numbers:
    """Return the length of every point's way to the root, by pointer doubling."""
    length = np.linalg.norm(points - points[before], axis=1)
    while (before != before[before]).any():
        length, before = length + length[before], before[before]
    return np.asarray(length)


def _smooth(places: Points, curve: CurveGraph) -> Points:
    """Return the nodes after rounds of half a step towards the mean of their neighbours; ends stay."""
    a, b = curve.edges.T
    for _ in range(ROUNDS):
        total = np.zeros_like(places)
        np.add.at(total, a, places[b])
        np.add.at(total, b, places[a])
        inner = curve.degrees > 1
        places = np.where(inner[:, None], (places + total / np.maximum(curve.degrees, 1)[:, None]) / 2, places)
    return places
