"""From samples to a graph: joining neighbours, then collapsing triangles, as published."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Points
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
    edges = np.sort(first_foreign(rings, owner), axis=1)
    alone = np.setdiff1d(np.arange(len(nodes)), edges)
    if len(alone) and len(nodes) > 1:
        nearest = cKDTree(nodes).query(nodes[alone], k=2)[1]
        partner = np.where(nearest[:, 0] == alone, nearest[:, 1], nearest[:, 0])
        edges = np.concatenate([edges, np.sort(np.stack([alone, partner], axis=1), axis=1)])
    return np.unique(edges, axis=0).astype(np.int32)


def first_foreign(rings: Rings, owner: Indices) -> Edges:
    """Return (p, 2) the sample of each point with a foreign ring member, and that of the first one in ring order."""
    owners = np.where(rings.mask(), owner[rings.members], owner[:, None])
    foreign = owners != owner[:, None]
    found = foreign.any(axis=1)
    first = np.take_along_axis(owners, foreign.argmax(axis=1)[:, None], axis=1)[:, 0]
    return np.stack([owner[found], first[found]], axis=1)


def collapse_triangles(nodes: Points, edges: Edges) -> tuple[Points, Edges, Indices]:
    """Collapse edges of triangles until none is left.

    The edge of lowest mean degree goes first, the shortest among equals, and
    the end that survives moves to its midpoint (Cao et al. 2010, section 4).
    Departures of the toolbox, which makes the published curves and is followed
    to the letter: the table of edges is made once and then mended, so that keys
    of edges away from the survivor are those of an earlier time; an edge of two
    triangles stands in it twice; and a degree is that among nodes of higher
    number where it is the first of a triangle i < j < k, the whole one of the
    other two, and half of it in every row that was made or mended later.

    Parameters
    ----------
    nodes : (v, 3) float64
        Where the samples are, in any unit; edges to a NaN count as endless.
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
    work = _Collapse(nodes, edges)
    work.list_triangles()
    while work.table:
        work.collapse_cheapest()
    return work.compacted()


@dataclass
class _Row:
    """An edge of a triangle: both ends, and the key it is chosen by."""

    ends: list[int]
    degree: float
    length: float

    def other(self, place: int) -> int:
        return self.ends[1 - place]


class _Collapse:
    """The graph as it shrinks, and the table of the edges of its triangles."""

    def __init__(self, nodes: Points, edges: Edges) -> None:
        self.place = np.array(nodes, dtype=float)
        self.into = np.arange(len(nodes), dtype=np.int32)
        self.around: dict[int, set[int]] = {i: set() for i in range(len(nodes))}
        for a, b in edges.tolist():
            self.around[a].add(b)
            self.around[b].add(a)
        self.table: dict[int, _Row] = {}  # by serial number, so in the order in which they came
        self.rows_of: dict[int, set[int]] = {i: set() for i in self.around}
        self.serial = 0

    def length(self, a: int, b: int) -> float:
        length = float(np.linalg.norm(self.place[a] - self.place[b]))
        return length if length < np.inf else np.inf

    def half_degree(self, a: int, b: int) -> float:
        """Return the mean of half the degrees, as rows have it that are made or mended on the way."""
        return (len(self.around[a]) + len(self.around[b])) / 4

    def triangles_above(self, i: int) -> list[tuple[int, int]]:
        """Return the pairs j < k that make triangles i < j < k."""
        above = sorted(j for j in self.around[i] if j > i)
        return [(j, k) for at, j in enumerate(above) for k in above[at + 1 :] if k in self.around[j]]

    def list_triangles(self) -> None:
        degree = {i: len(others) for i, others in self.around.items()}
        for i in self.around:
            higher = sum(j > i for j in self.around[i])
            for j, k in self.triangles_above(i):
                self.add(i, j, (higher + degree[j]) / 2)
                self.add(j, k, (degree[j] + degree[k]) / 2)
                self.add(i, k, (higher + degree[k]) / 2)

    def add(self, a: int, b: int, degree: float) -> None:
        self.table[self.serial] = _Row([a, b], degree, self.length(a, b))
        self.rows_of[a].add(self.serial)
        self.rows_of[b].add(self.serial)
        self.serial += 1

    def drop(self, serials: set[int]) -> None:
        for serial in serials:
            for end in self.table.pop(serial).ends:
                self.rows_of[end].discard(serial)

    def rows_with(self, node: int) -> list[tuple[int, int]]:
        """Return the rows of a node and which end it is, those where it is the first end in front."""
        return [(s, end) for end in (0, 1) for s in sorted(self.rows_of[node]) if self.table[s].ends[end] == node]

    def collapse_cheapest(self) -> None:
        cheapest = min(self.table, key=lambda s: (self.table[s].degree, self.table[s].length))
        lost, kept = self.table[cheapest].ends
        self.drop({cheapest})
        self.place[kept] = (self.place[lost] + self.place[kept]) / 2
        for other in self.around.pop(lost):
            self.around[other].discard(lost)
            if other != kept:
                self.around[other].add(kept)
                self.around[kept].add(other)
        self.into[self.into == lost] = kept
        self.hand_over(lost, kept)
        self.mend(kept)

    def hand_over(self, lost: int, kept: int) -> None:
        """Give the rows of the lost end to the survivor, but for those that it has."""
        known = {self.table[s].other(end) for s, end in self.rows_with(kept)}
        gone: set[int] = set()
        for serial, end in self.rows_with(lost):
            if self.table[serial].other(end) in known:
                gone.add(serial)
            else:
                self.table[serial].ends[end] = kept
                self.rows_of[kept].add(serial)
                self.rows_of[lost].discard(serial)
        self.drop(gone)

    def mend(self, kept: int) -> None:
        """Let the table hold the edges of all triangles of the survivor, and none that is in no triangle."""
        near = sorted(self.around[kept])
        sides = [(j, k) for at, j in enumerate(near) for k in near[at + 1 :] if k in self.around[j]]
        corners = list(dict.fromkeys(corner for side in sides for corner in side))
        held = self.rows_with(kept)
        self.drop({s for s, end in held if self.table[s].other(end) not in corners})
        for a, b in [(kept, corner) for corner in corners] + sides:
            if not any(self.table[s].other(end) == b for s, end in self.rows_with(a)):
                self.add(a, b, self.half_degree(a, b))
        for serial, end in self.rows_with(kept):
            other = self.table[serial].other(end)
            self.table[serial].degree = self.half_degree(kept, other)
            self.table[serial].length = self.length(kept, other)

    def compacted(self) -> tuple[Points, Edges, Indices]:
        """Return the nodes that are left, numbered from zero, their edges, and the new number of every node."""
        left = sorted(self.around)
        number = {node: i for i, node in enumerate(left)}
        pairs = sorted((number[a], number[b]) for a in left for b in self.around[a] if a < b)
        edges = np.array(pairs, np.int32).reshape(-1, 2)
        return self.place[left].reshape(-1, 3), edges, np.array([number[int(n)] for n in self.into], np.int32)
