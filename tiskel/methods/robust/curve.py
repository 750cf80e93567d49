"""A curve of round cones while it is being built, and how its graph is changed."""

from dataclasses import dataclass, replace

import numpy as np

from tiskel.arrays import Indices, Numbers, Points, resolved
from tiskel.geometry import graph


@dataclass(frozen=True)
class ConeCurve:
    """Nodes with radii, joined by edges: every edge is a round cone.

    Attributes
    ----------
    nodes : (v, 3); radii : (v,); edges : (e, 2) int32, lower node first, each once.
    levels : (v,) int32, the stride of the front that a node comes from.
    owner : (n,) int32, the node each point of the cloud belongs to, -1 for debris.
    """

    nodes: Points
    radii: Numbers
    edges: Indices
    levels: Indices
    owner: Indices

    @property
    def counts(self) -> Numbers:
        """How many points each node has."""
        return np.bincount(self.owner[self.owner >= 0], minlength=len(self.nodes)).astype(float)

    @property
    def degrees(self) -> Indices:
        return graph.degrees(len(self.nodes), self.edges)

    def around(self) -> list[list[int]]:
        return graph.neighbour_lists(len(self.nodes), self.edges)

    def branches(self) -> tuple[Indices, ...]:
        return graph.branches(len(self.nodes), self.edges)

    def paths_from(self, *, ends: bool) -> list[Indices]:
        """Return every branch that starts at an end (or at a joint), from there; both ways where both are."""
        degree = self.degrees
        both = [path for branch in self.branches() if len(branch) > 1 for path in (branch, branch[::-1])]
        return [path for path in both if (degree[path[0]] == 1 if ends else degree[path[0]] > 2)]

    def heading(self, path: Indices) -> Numbers:
        """Return the direction that a path from an end looks in, taken over two edges where there are two."""
        return np.asarray(self.nodes[path[0]] - self.nodes[path[min(2, len(path) - 1)]])


def tidy_edges(edges: Indices) -> Indices:
    """Return edges with the lower node first, each once, none from a node to itself."""
    ordered = np.sort(np.asarray(edges, np.int32).reshape(-1, 2), axis=1)
    return np.unique(ordered[ordered[:, 0] != ordered[:, 1]], axis=0).reshape(-1, 2)


def keeps_loops(curve: ConeCurve, into: Indices) -> bool:
    """Tell whether contracting along edges keeps all loops."""
    into = resolved(into)
    left = len(tidy_edges(into[curve.edges])) - len(np.unique(into))
    return left == len(curve.edges) - len(curve.nodes)


def contract_nodes(curve: ConeCurve, into: Indices, *, mean: bool = False) -> ConeCurve:
    """Replace every node by another; that one stays where it is, or goes to the mean of all it stands for."""
    into = resolved(into)
    kept, name = np.unique(into, return_inverse=True)
    nodes, radii = curve.nodes[kept], curve.radii[kept]
    if mean:
        each = np.bincount(name, minlength=len(kept))
        nodes = np.stack([np.bincount(name, x, minlength=len(kept)) / each for x in curve.nodes.T], axis=1)
        radii = np.zeros(len(kept))
        np.maximum.at(radii, name, curve.radii)
    return ConeCurve(
        nodes, radii, tidy_edges(name[curve.edges].astype(np.int32)), curve.levels[kept],
        np.where(curve.owner < 0, -1, name[curve.owner]).astype(np.int32),
    )  # fmt: skip


def with_nodes(curve: ConeCurve, nodes: Points, radii: Numbers, edges: Indices, levels: Indices) -> ConeCurve:
    """Add nodes, and edges that may name old nodes and, from len(curve.nodes), new ones."""
    return replace(
        curve,
        nodes=np.concatenate([curve.nodes, np.reshape(nodes, (-1, 3))]),
        radii=np.concatenate([curve.radii, radii]),
        edges=tidy_edges(np.concatenate([curve.edges, np.reshape(edges, (-1, 2))])),
        levels=np.concatenate([curve.levels, levels]).astype(np.int32),
    )
