"""Curve graphs: nodes with radii, joined by straight edges; skeletons, cone models and curves of other programs."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from tiskel.arrays import Edges, Indices, Lists, Mask, Numbers, Pairs, Points
from tiskel.geometry.branches import branches_of
from tiskel.geometry.distinct import distinct
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class CurveGraph(Shown):
    """A graph in space; coordinates and radii in one unit.

    Attributes
    ----------
    nodes : (v, 3) float64
        Where the nodes are.
    edges : (e, 2) int32
        The two nodes of every edge, the lower first, each edge once.
    radii : (v,) float64
        How thick the body is about each node; NaN where that is not known.
    bridged : (e,) bool
        Which edges were laid over a gap; the others follow points.
    radius_sources : (v,) uint8
        What each radius is worth, see :class:`RadiusSource`.
    regimes : (v,) uint8
        What the body is like about each node, see :class:`Regime`.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import CurveGraph
    >>> y = CurveGraph(np.eye(4, 3), np.array([[0, 3], [1, 3], [2, 3]], np.int32))
    >>> y.components, y.loops, y.ends, y.junctions
    (1, 0, 3, 1)
    >>> round(y.length, 6)
    3.0
    """

    _said: ClassVar[tuple[str, ...]] = ("nodes", "components", "loops", "ends", "junctions", "length")

    nodes: Points
    edges: Edges
    radii: Numbers = field(default_factory=lambda: np.zeros(0))
    bridged: Mask = field(default_factory=lambda: np.zeros(0, np.bool_))
    radius_sources: npt.NDArray[np.uint8] = field(default_factory=lambda: np.zeros(0, np.uint8))
    regimes: npt.NDArray[np.uint8] = field(default_factory=lambda: np.zeros(0, np.uint8))

    def __post_init__(self) -> None:
        nodes, edges = len(self.nodes), len(self.edges)
        unsaid = {
            "radii": np.full(nodes, np.nan),
            "bridged": np.zeros(edges, np.bool_),
            "radius_sources": np.full(nodes, RadiusSource.UNKNOWN, np.uint8),
            "regimes": np.full(nodes, Regime.UNKNOWN, np.uint8),
        }
        for name, values in unsaid.items():
            if len(getattr(self, name)) != len(values):
                object.__setattr__(self, name, values)

    @cached_property
    def degrees(self) -> Indices:
        """(v,) the number of edges at each node."""
        return np.bincount(self.edges.ravel(), minlength=len(self.nodes)).astype(np.int32)

    @cached_property
    def components(self) -> int:
        """The number of connected components."""
        return int(component_labels(len(self.nodes), self.edges).max(initial=-1)) + 1

    @property
    def loops(self) -> int:
        """The number of independent loops, e - v + components."""
        return len(self.edges) - len(self.nodes) + self.components

    @property
    def ends(self) -> int:
        """The number of nodes with one edge."""
        return int((self.degrees == 1).sum())

    @property
    def junctions(self) -> int:
        """The number of nodes with more than two edges."""
        return int((self.degrees > 2).sum())

    @cached_property
    def lengths(self) -> Numbers:
        """(e,) the length of every edge."""
        return edge_lengths(self.nodes, self.edges)

    @property
    def length(self) -> float:
        """The length of all edges together."""
        return float(self.lengths.sum())

    @cached_property
    def branches(self) -> tuple[Indices, ...]:
        """The branches as ordered node lists.

        A branch runs from junction or end to junction or end; a loop without a
        junction repeats its first node at its end; an isolated node is a branch
        of one.
        """
        return branches_of(self.neighbours)

    @cached_property
    def neighbours(self) -> list[list[int]]:
        """The neighbours of every node, ascending."""
        first, second = np.concatenate([self.edges, self.edges[:, ::-1]]).T
        order = np.lexsort((second, first))
        others, stops = second[order].tolist(), np.cumsum(np.bincount(first, minlength=len(self.nodes))).tolist()
        return [others[start:stop] for start, stop in zip([0, *stops], stops, strict=False)]

    @cached_property
    def passages(self) -> Lists:
        """(d, 3) one neighbour, the node, and the other neighbour, of every node with exactly two."""
        found = [(o[0], node, o[1]) for node, o in enumerate(self.neighbours) if len(o) == 2]
        return np.array(found, np.int32).reshape(-1, 3)

    def counts(self) -> dict[str, float]:
        """Return components, loops, ends, joints and length by name, as the documents have them."""
        return {
            "components": self.components,
            "loops": self.loops,
            "ends": self.ends,
            "joints": self.junctions,
            "length": self.length,
        }

    def without_spurs(self) -> Indices:
        """Return (v,) for each node the one that takes its place: itself, or the junction its spur hangs on.

        A spur is an end whose single edge leads to a junction and is shorter than
        the junction's radius. The shortest goes first, and what is left is looked
        at again: a junction of three that loses one edge is none any more.
        """
        into = np.arange(len(self.nodes), dtype=np.int32)
        around = [set(others) for others in self.neighbours]
        for e in np.argsort(self.lengths, kind="stable"):
            for end, joint in (self.edges[e], self.edges[e][::-1]):
                if len(around[end]) == 1 and len(around[joint]) > 2 and self.lengths[e] < self.radii[joint]:
                    around[joint].discard(end)
                    around[end].clear()
                    into[end] = joint
        return into


def tidy_edges(edges: Edges) -> Edges:
    """Return edges with the lower node first, each once, none from a node to itself.

    Parameters
    ----------
    edges : (e, 2) int32
        Pairs of nodes in either order, repeats allowed.

    Returns
    -------
    (f, 2) int32
        In ascending order.
    """
    keys = distinct(edge_keys(edges))
    return np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1).astype(np.int32)


def edge_keys(edges: Edges) -> npt.NDArray[np.int64]:
    """Return (f,) a number for every edge (e, 2) that is no loop: the same whatever its direction, in their order."""
    a, b = np.asarray(edges, np.int64).reshape(-1, 2).T
    return np.asarray((np.minimum(a, b) << 32 | np.maximum(a, b))[a != b])


def node_radii(nodes: Points, cloud: Points, node_of_point: Indices) -> Numbers:
    """Return (v,) the mean distance of each node's points to it, 0 where it has none.

    Parameters
    ----------
    nodes : (v, 3) float64
        In any unit.
    cloud : (n, 3) float64
        The points, in the same unit.
    node_of_point : (n,) int32
        The node of every point.

    Returns
    -------
    (v,) float64
        In the same unit.
    """
    distance = np.linalg.norm(cloud - nodes[node_of_point], axis=1)
    counts = np.bincount(node_of_point, minlength=len(nodes))
    return np.asarray(np.bincount(node_of_point, distance, minlength=len(nodes)) / np.maximum(counts, 1))


def edge_lengths(nodes: Points, edges: Edges) -> Numbers:
    """Return (e,) the lengths of edges (e, 2) between nodes (v, 3), in their unit."""
    return np.asarray(np.linalg.norm(nodes[edges[:, 0]] - nodes[edges[:, 1]], axis=1))


def component_labels(count: int, links: Pairs) -> Indices:
    """Return which connected set each thing is in.

    Parameters
    ----------
    count : int
        How many things there are; they are numbered from 0.
    links : (l, 2) int
        Pairs of them that hang together, in either order, repeats allowed.

    Returns
    -------
    (count,) int32
        The number of the set, from 0, in the order of the sets' first members.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.graph import component_labels
    >>> component_labels(4, np.array([[3, 1]], np.int32)).tolist()
    [0, 1, 2, 1]
    """
    if count == 0:
        return np.zeros(0, np.int32)
    graph = sparse.coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], np.int32)


def connected_sets(count: int, links: Pairs) -> list[Indices]:
    """Return the connected sets of things 0 to count - 1 that links (l, 2) join, each ascending, (k,) int32."""
    label = component_labels(count, links)
    return [np.flatnonzero(label == number).astype(np.int32) for number in range(int(label.max(initial=-1)) + 1)]
