"""Links: the neighbour graph of a cloud of wires, its spacing, and its pieces joined across gaps.

The spacing of points on wires has to resist uneven density, so it is taken from
the Euclidean minimum spanning tree, which has one edge a point, and not from
nearest neighbours, whose distances shrink to nothing where points come in pairs.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Mask, Numbers, Pairs, Points, diagonal
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.geometry.spanning import shortest_links

# Found by trial on generated trees (tiskel.gallery.trees), N r / L of their twigs from 0.1 to 5.
NEIGHBOURS = 20  # points, itself included, that a point is linked with: they reach across a ring of so many
QUANTILE = 0.75  # of the edges of the minimum spanning tree: the spacing; 1.4 times the median of even clouds
ABOVE = 1 + 1e-7  # factor of the spacing, so that on even wires rounding does not decide what is within two or three
CLOSEST = 1e-6  # of the diagonal: the least spacing; what is closer is one place, to the precision of many files
BRIDGE = 4.0  # spacings: longer links lead over a gap
WIDEST = 0.2  # widest gap that is crossed, in the extent of the larger piece; patches cut from trees are narrower


@dataclass(frozen=True, eq=False)
class Links:
    """The neighbour graph.

    Attributes
    ----------
    first, second : (e,) int32
        The two points of every link, both ways.
    lengths : (e,) float64
        Its length.
    spacing : float
        How far the points are apart along wires.
    kept : (n,) bool
        Which points belong to the graph; the others are in small pieces far from all others.
    """

    first: Indices
    second: Indices
    lengths: Numbers
    spacing: float
    kept: Mask

    @property
    def graph(self) -> sparse.csr_array:
        """The symmetric matrix (n, n) of lengths."""
        return _matrix(self.first, self.second, self.lengths, len(self.kept))


def links_of(points: Points, least: int) -> Links:
    """Return the links of points (n, 3); pieces of less than least points that are far from all others are left out."""
    count = len(points)
    neighbours, squares = nearest_neighbours(points, min(NEIGHBOURS, count))
    first = np.repeat(np.arange(count, dtype=np.int32), neighbours.shape[1] - 1)
    second, lengths = neighbours[:, 1:].ravel(), np.sqrt(squares[:, 1:].ravel())
    graph = _symmetric(first, second, lengths, count)
    spacing = _spacing(points, graph)
    joins, kept = _joins(points, graph, spacing, least)
    ends = np.concatenate([joins, joins[:, ::-1]])
    graph = graph.tocoo()
    apart = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    return Links(
        np.concatenate([graph.row, ends[:, 0]]).astype(np.int32),
        np.concatenate([graph.col, ends[:, 1]]).astype(np.int32),
        np.maximum(np.concatenate([graph.data, apart]), TINY),
        spacing,
        kept,
    )


def linked(points: Points, pairs: Pairs) -> Links:
    """Return the links of given pairs (l, 2) of points (n, 3); kept are those of the largest piece."""
    one, other = pairs.astype(np.int32).T
    graph = _symmetric(one, other, np.linalg.norm(points[one] - points[other], axis=1), len(points))
    piece, both = connected_components(graph, directed=False)[1], graph.tocoo()
    kept = np.asarray(piece == np.bincount(piece).argmax())
    first, second = both.row.astype(np.int32), both.col.astype(np.int32)
    return Links(first, second, np.asarray(both.data), _spacing(points, graph), kept)


def _spacing(points: Points, graph: sparse.csr_array) -> float:
    """Return how far points (n, 3) are apart along wires."""
    steps = minimum_spanning_tree(graph).data
    return max(float(np.quantile(steps, QUANTILE)) * ABOVE if len(steps) else 0.0, CLOSEST * diagonal(points))


def _symmetric(first: Indices, second: Indices, lengths: Numbers, count: int) -> sparse.csr_array:
    graph = _matrix(first, second, np.maximum(lengths, TINY), count)
    return sparse.csr_array(graph.maximum(graph.T))


def _matrix(first: Indices, second: Indices, values: Numbers, count: int) -> sparse.csr_array:
    return sparse.csr_array(sparse.coo_array((values, (first, second)), shape=(count, count)))


def _joins(points: Points, graph: sparse.csr_array, spacing: float, least: int) -> tuple[Pairs, Mask]:
    """Return the shortest links (j, 2) between pieces, and which points are in the pieces that are kept (n,).

    Round by round every piece but the largest is joined to the nearest other
    (Boruvka's minimum spanning tree), where the gap is narrow against the larger
    of the two; where none is, to the largest, as two twigs that a gap cut off may
    be nearest to each other. A small piece further away is no part of the body.
    """
    piece = connected_components(graph, directed=False)[1].astype(np.int32)
    joins: set[tuple[int, int]] = set()  # both pieces may find the same
    while piece.max() > 0:
        sizes = np.bincount(piece)
        for shortest in (_shortest, _to_largest):
            links = shortest(points, piece, int(sizes.argmax()))
            found = [link for link in links if _narrow(points, piece, link, spacing, least)]
            if found:
                break
        else:
            break
        joins |= {(min(one, other), max(one, other)) for _, one, other in found}
        ends = np.array([(piece[one], piece[other]) for _, one, other in found])
        merged = sparse.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(sizes), len(sizes)))
        piece = connected_components(merged, directed=False)[1].astype(np.int32)[piece]
    sizes = np.bincount(piece)
    kept = (sizes >= min(least, sizes.max()))[piece]
    return np.array(sorted(joins), np.int32).reshape(-1, 2), np.asarray(kept)


def _shortest(points: Points, piece: Indices, largest: int) -> list[tuple[float, int, int]]:
    """Return the shortest link from every piece but the largest to another: its length and its two points."""
    links, lengths = shortest_links(points, piece)
    found = zip(lengths.tolist(), links[:, 0].tolist(), links[:, 1].tolist(), strict=True)
    return [link for number, link in enumerate(found) if number != largest]


def _to_largest(points: Points, piece: Indices, largest: int) -> list[tuple[float, int, int]]:
    """Return the shortest link from every other piece to the largest: its length and its two points."""
    rows, home = np.flatnonzero(piece != largest), np.flatnonzero(piece == largest)
    distance, near = cKDTree(points[home]).query(points[rows])
    order = np.lexsort((distance, piece[rows]))
    first = order[np.unique(piece[rows][order], return_index=True)[1]]
    return list(zip(distance[first].tolist(), rows[first].tolist(), home[near[first]].tolist(), strict=True))


def _narrow(points: Points, piece: Indices, link: tuple[float, int, int], spacing: float, least: int) -> bool:
    """Tell whether a gap is narrow against the larger of the pieces at its sides, and a small one against both."""
    sides = [points[piece == piece[end]] for end in link[1:]]
    extents = [float(np.linalg.norm(np.ptp(side, axis=0))) for side in sides]
    widest = WIDEST * max(extents)
    if min(map(len, sides)) < least:
        widest = min(widest, *extents)
    return link[0] <= max(BRIDGE * spacing, widest)
