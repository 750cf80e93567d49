"""The Euclidean minimum spanning tree, and the shortest links between parts of a cloud.

Boruvka's: round by round every part of the tree takes the shortest link out of it, until one is left. What makes
it fast are boxes that know when all their points are of one part (March, Ram and Gray, Fast Euclidean minimum
spanning tree, KDD 2010), and what is known from the rounds before: parts only grow, so a point's nearest outside stays
its nearest as long as it is outside, and what is outside never comes nearer.

No triangulation is needed, so points on curves, on lattices and at one place cost no more than others.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points
from tiskel.geometry.forest import spanning_links


@dataclass(frozen=True, eq=False)
class BoxTree:
    """A complete binary tree of boxes, as a heap: node k has the children 2 k and 2 k + 1, the root is node 1.

    Attributes
    ----------
    points : (n, 3) float64
        In the order of the leaves, in any unit.
    order : (n,) int32
        Their rows in the cloud.
    low, high : (nodes, 3) float64
        The corners of the boxes; infinite where a node is empty.
    """

    points: Points
    order: Indices
    low: Points
    high: Points

    @property
    def leaves(self) -> int:
        """How many leaves there are, the empty ones included: a power of two."""
        return len(self.low) // 2

    def shared(self, labels: Indices) -> Indices:
        """Return (nodes,) the label that all points of a node have, of labels (n,) in the order of the leaves; or -1.

        An empty node has the label of the last point.
        """
        from tiskel.kernels.spanning import LEAF

        padded = np.full(self.leaves * LEAF, labels[-1])
        padded[: len(labels)] = labels
        level = padded.reshape(self.leaves, LEAF)
        levels = []
        while True:
            levels.append(np.where((level == level[:, :1]).all(axis=1), level[:, 0], -1))
            if len(level) == 1:
                return np.concatenate([[-1], *levels[::-1]]).astype(np.int32)
            level = levels[-1].reshape(-1, 2)


def box_tree(points: Points) -> BoxTree:
    """Return the tree of boxes of points (n, 3), of which there is at least one."""
    from tiskel.kernels.spanning import LEAF

    # Medians of many equal coordinates would take long; midpoints do not, and the boxes do not need them.
    order = cKDTree(points, LEAF, compact_nodes=False, balanced_tree=False).indices.astype(np.int32)
    ordered = np.ascontiguousarray(points[order])
    leaves = 1
    while leaves * LEAF < len(points):
        leaves *= 2
    starts = np.arange(0, len(points), LEAF)
    corners = []
    for reduce, empty in ((np.minimum, np.inf), (np.maximum, -np.inf)):
        level = np.full((leaves, 3), empty)
        level[: len(starts)] = reduce.reduceat(ordered, starts)
        levels = [level]
        while len(level) > 1:
            level = reduce(level[::2], level[1::2])
            levels.append(level)
        corners.append(np.concatenate([np.full((1, 3), empty), *levels[::-1]]))
    return BoxTree(ordered, order, *corners)


@dataclass(frozen=True, eq=False)
class SpanningTree:
    """A tree over points.

    Attributes
    ----------
    edges : (n - 1, 2) int32
        The two rows of every edge, the lower first, by length.
    lengths : (n - 1,) float64
        Ascending, in the unit of the points.
    """

    edges: Edges
    lengths: Numbers


def spanning_tree(points: Points) -> SpanningTree:
    """Return the Euclidean minimum spanning tree of points, exact; of equal lengths any of the possible trees.

    Parameters
    ----------
    points : (n, 3) float64
        In any unit; places may repeat.

    Returns
    -------
    SpanningTree

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.spanning import spanning_tree
    >>> spanning_tree(np.array([[0, 0, 0], [4, 0, 0], [1, 0, 0.0]])).edges.tolist()
    [[0, 2], [1, 2]]
    """
    if len(points) < 2:
        return SpanningTree(np.zeros((0, 2), np.int32), np.zeros(0))
    search, taken, squares = _Search(box_tree(points)), [], []
    labels = np.arange(len(points), dtype=np.int32)
    while labels.max() > 0:
        first, second, square = search.shortest(labels)
        joins = spanning_links(labels[first], labels[second], square)
        taken.append(np.stack([first[joins], second[joins]], axis=1))
        squares.append(square[joins])
        labels = _united(labels, labels[first[joins]], labels[second[joins]])
    edges = np.sort(search.tree.order[np.concatenate(taken)], axis=1)
    lengths = np.sqrt(np.concatenate(squares))
    order = np.lexsort((edges[:, 1], edges[:, 0], lengths))
    return SpanningTree(edges[order], lengths[order])


def shortest_links(points: Points, labels: Indices) -> tuple[Edges, Numbers]:
    """Return the shortest link out of every part of a cloud.

    Parameters
    ----------
    points : (n, 3) float64
        In any unit.
    labels : (n,) int32
        The part of each point, from 0 on, at least two in all.

    Returns
    -------
    links : (parts, 2) int32
        For every part the row in it and the row outside.
    lengths : (parts,) float64
        In the unit of the points.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.spanning import shortest_links
    >>> links, lengths = shortest_links(np.diag([1.0, 2, 3]), np.array([0, 0, 1], np.int32))
    >>> links.tolist(), (lengths**2).round(9).tolist()
    ([[0, 2], [2, 0]], [10.0, 10.0])
    """
    search = _Search(box_tree(points))
    first, second, square = search.shortest(labels[search.tree.order])
    return search.tree.order[np.stack([first, second], axis=1)], np.sqrt(square)


class _Search:
    """The links of points to other parts, round by round; rows are those of the tree."""

    def __init__(self, tree: BoxTree) -> None:
        count = len(tree.points)
        self.tree = tree
        self.target = np.full(count, -1, np.int32)  # the nearest outside the part of each point, -1 where not known
        self.square = np.zeros(count)  # its squared distance, or, where it is not known, what it has at least
        pairs = np.arange(count - 1, dtype=np.int32)
        self.pairs = np.concatenate([pairs, pairs + 1]), np.concatenate([pairs + 1, pairs])
        d = tree.points[1:] - tree.points[:-1]
        squares = d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1] + d[:, 2] * d[:, 2]
        self.pair_squares = np.concatenate([squares, squares])

    def shortest(self, labels: Indices) -> tuple[Indices, Indices, Numbers]:
        """Return for every part the two ends and the square of its shortest link to another.

        Asked again it must be with larger parts.
        """
        self.target[labels[self.target] == labels] = -1  # of no target too, whatever stands for it
        across = labels[self.pairs[0]] != labels[self.pairs[1]]
        seeds = self.pairs[0][across], self.pairs[1][across], self.pair_squares[across]
        parts = int(labels.max()) + 1
        known = self._least(parts, labels, [seeds, self._known()])
        self._ask(labels, (self.target < 0) & (self.square < known[labels]), known)
        return self._first(parts, labels, [seeds, self._known()])

    def _known(self) -> tuple[Indices, Indices, Numbers]:
        rows = np.flatnonzero(self.target >= 0).astype(np.int32)
        return rows, self.target[rows], self.square[rows]

    def _ask(self, labels: Indices, doubtful: Mask, known: Numbers) -> None:
        from tiskel.kernels.spanning import nearest_outside

        tree, rows = self.tree, np.flatnonzero(doubtful).astype(np.int32)
        target, square = np.empty(len(rows), np.int32), np.empty(len(rows))
        nearest_outside(
            tree.points, labels, tree.low, tree.high, tree.shared(labels), rows, known[labels[rows]], target, square
        )
        self.target[rows], self.square[rows] = target, square

    @staticmethod
    def _least(parts: int, labels: Indices, links: list[tuple[Indices, Indices, Numbers]]) -> Numbers:
        least = np.full(parts, np.inf)
        for first, _, square in links:
            np.minimum.at(least, labels[first], square)
        return least

    def _first(
        self, parts: int, labels: Indices, links: list[tuple[Indices, Indices, Numbers]]
    ) -> tuple[Indices, Indices, Numbers]:
        """Return for every part the first of its shortest links."""
        first, second, square = (np.concatenate(column) for column in zip(*links, strict=True))
        least = self._least(parts, labels, links)
        short = np.flatnonzero(square == least[labels[first]])[::-1]
        chosen = np.empty(parts, np.intp)
        chosen[labels[first[short]]] = short
        return first[chosen], second[chosen], square[chosen]


def _united(labels: Indices, one: Indices, other: Indices) -> Indices:
    """Return the labels after parts were joined."""
    parts = int(labels.max()) + 1
    joined = sparse.coo_array((np.ones(len(one)), (one, other)), shape=(parts, parts))
    return np.asarray(connected_components(joined, directed=False)[1].astype(np.int32)[labels])
