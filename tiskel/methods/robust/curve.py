"""A curve of round cones while it is being built, and how its graph is changed."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points, resolved
from tiskel.geometry.distinct import distinct
from tiskel.geometry.frames import step_lengths
from tiskel.geometry.graph import CurveGraph, edge_keys, tidy_edges


@dataclass(frozen=True, eq=False, repr=False)
class ConeCurve(CurveGraph):
    """A curve graph whose edges are round cones, and what of the cloud its nodes stand for.

    The cloud is labelled once, by its sections; when nodes become one, only the
    sections change hands.

    Attributes
    ----------
    levels : (v,) int32
        The bin of the front that a node comes from.
    node_of_section : (s + 1,) int32
        The node that every section belongs to; last -1, for points without a section.
    section_sizes : (s,) float64
        The number of points of every section.
    """

    levels: Indices = field(kw_only=True)
    node_of_section: Indices = field(kw_only=True)
    section_sizes: Numbers = field(kw_only=True)

    @property
    def point_counts(self) -> Numbers:
        """(v,) the number of points of every node."""
        owned = self.node_of_section[:-1]
        known = owned >= 0
        return np.asarray(np.bincount(owned[known], self.section_sizes[known], minlength=len(self.nodes)), float)

    @cached_property
    def averaging(self) -> sparse.csr_array:
        """The matrix (v, v) that replaces values of nodes by the mean over their neighbours."""
        first, second = np.concatenate([self.edges, self.edges[:, ::-1]]).T
        share = 1 / np.maximum(self.degrees, 1)[first]
        return sparse.coo_array((share, (first, second)), shape=(len(self.nodes), len(self.nodes))).tocsr()

    def halfway(self, nodes: Points, chosen: Mask) -> Points:
        """Return nodes (v, 3), those chosen (v,) half the way to the mean of their neighbours."""
        return np.asarray(np.where(chosen[:, None], (nodes + self.averaging @ nodes) / 2, nodes))

    @cached_property
    def directions(self) -> Points:
        """(v, 3) the direction of the curve at every node, either way: that of the edges there, the longest first."""
        first, second = self.edges.T
        along = self.nodes[second] - self.nodes[first]
        scatter = np.zeros((len(self.nodes), 3, 3))
        for ends in (first, second):
            np.add.at(scatter, ends, along[:, :, None] * along[:, None, :])
        return np.asarray(np.linalg.eigh(scatter)[1][:, :, 2])

    def paths_from(self, *, ends: bool) -> list[Indices]:
        """Return every branch that starts at an end (or at a junction), from there; both ways where both are."""
        degree = self.degrees
        both = [path for branch in self.branches if len(branch) > 1 for path in (branch, branch[::-1])]
        return [path for path in both if (degree[path[0]] == 1 if ends else degree[path[0]] > 2)]

    def along(self, path: Indices) -> Numbers:
        """Return (p,) how far each node of a path is from its first, along it."""
        return np.append(0.0, np.cumsum(step_lengths(self.nodes[path])))

    def heading(self, path: Indices) -> Numbers:
        """Return the direction that a path from an end looks in, taken over two edges where there are two."""
        return np.asarray(self.nodes[path[0]] - self.nodes[path[min(2, len(path) - 1)]])


def keeps_loops(curve: ConeCurve, into: Indices) -> bool:
    """Tell whether contracting along edges keeps all loops."""
    into = resolved(into)
    left = len(tidy_edges(into[curve.edges])) - len(distinct(into))
    return left == len(curve.edges) - len(curve.nodes)


def contract_nodes(curve: ConeCurve, into: Indices, *, mean: bool = False) -> ConeCurve:
    """Replace every node by another; that one stays where it is, or goes to the mean of all it stands for."""
    into = resolved(into)
    kept, inverse = np.unique(into, return_inverse=True)
    name = inverse.astype(np.int32)
    nodes, radii = curve.nodes[kept], curve.radii[kept]
    if mean:
        each = np.bincount(name, minlength=len(kept))
        nodes = np.stack([np.bincount(name, x, minlength=len(kept)) / each for x in curve.nodes.T], axis=1)
        radii = np.zeros(len(kept))
        np.maximum.at(radii, name, curve.radii)
    return replace(
        curve, nodes=nodes, radii=radii, edges=tidy_edges(name[curve.edges]),
        bridged=_bridged(name[curve.edges], curve), levels=curve.levels[kept],
        radius_sources=curve.radius_sources[kept], regimes=curve.regimes[kept],
        node_of_section=np.append(name, np.int32(-1))[curve.node_of_section],
    )  # fmt: skip


def _bridged(renamed: Edges, curve: ConeCurve) -> Mask:
    """Return which edges are bridges under new names of their nodes: those that stand for nothing but bridges."""
    edges, number = np.unique(edge_keys(renamed), return_inverse=True)
    apart = renamed[:, 0] != renamed[:, 1]
    measured = np.bincount(number.ravel(), ~curve.bridged[apart], minlength=len(edges))
    return np.asarray(measured == 0)


def without_path(curve: ConeCurve, path: Indices) -> ConeCurve:
    """Contract a branch from its end into the node that it hangs on, the last of its path."""
    into = np.arange(len(curve.nodes), dtype=np.int32)
    into[path[:-1]] = path[-1]
    return contract_nodes(curve, into)


def with_nodes(
    curve: ConeCurve, nodes: Points, radii: Numbers, edges: Edges, levels: Indices, *, bridge: bool = False
) -> ConeCurve:
    """Add nodes, and edges that may name old nodes and, from len(curve.nodes), new ones.

    An edge that is there already stays what it is.
    """
    tidy = tidy_edges(np.concatenate([curve.edges, np.reshape(edges, (-1, 2))]))
    known = dict(zip(map(tuple, curve.edges.tolist()), curve.bridged.tolist(), strict=True))
    bridged: list[bool] = [known.get((a, b), bridge) for a, b in tidy.tolist()]
    return replace(
        curve,
        nodes=np.concatenate([curve.nodes, np.reshape(nodes, (-1, 3))]),
        radii=np.concatenate([curve.radii, radii]),
        edges=tidy,
        bridged=np.array(bridged, bool),
        levels=np.concatenate([curve.levels, levels]).astype(np.int32),
    )
