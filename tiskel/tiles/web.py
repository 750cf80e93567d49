"""Curves of tiles while they are joined: graphs whose nodes know where they come from and where they were cut."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points, within_runs
from tiskel.geometry.graph import CurveGraph, edge_lengths

Kinds = npt.NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Web:
    """A curve, or a part of one.

    Attributes
    ----------
    nodes : (v, 3) float64
        In the cloud's unit.
    radii : (v,) float64
        How thick the body is, in the same unit.
    sources, regimes : (v,) uint8
        See :class:`tiskel.CurveGraph`.
    reach : (v,) float64
        How far another curve of the same limb may be off: the radius, or how far nodes are apart where that is more.
    tile, node : (v,) int32
        The tile that the node is from, and its number there; -1 where it only divides an edge.
    torn : (v,) bool
        Where an edge was cut off that nothing continues yet.
    edges : (e, 2) int32
        In any order.
    bridged : (e,) bool
        Which edges were laid over gaps.
    """

    nodes: Points
    radii: Numbers
    sources: Kinds
    regimes: Kinds
    reach: Numbers
    tile: Indices
    node: Indices
    torn: Mask
    edges: Edges
    bridged: Mask

    @property
    def lengths(self) -> Numbers:
        """(e,) the length of every edge."""
        return edge_lengths(self.nodes, self.edges)

    def kept(self, keep: Mask) -> "Web":
        """Return the nodes of a mask (v,) and the edges between them; nodes that lose an edge are torn."""
        inside = keep[self.edges]
        torn = self.torn.copy()
        torn[self.edges[inside != inside[:, ::-1]]] = True
        number = np.cumsum(keep) - 1
        whole = inside.all(axis=1)
        columns = {name: getattr(self, name)[keep] for name in OF_NODES if name != "torn"}
        edges = number[self.edges[whole]].astype(np.int32)
        return Web(**columns, torn=torn[keep], edges=edges, bridged=self.bridged[whole])

    def graph(self) -> CurveGraph:
        """Return the curve, its edges in ascending order."""
        edges = np.sort(self.edges, axis=1)
        keys = edges[:, 0].astype(np.int64) << 32 | edges[:, 1]
        _, first = np.unique(keys, return_index=True)
        bridged = self.bridged[first]
        return CurveGraph(self.nodes, edges[first], self.radii, bridged, self.sources, self.regimes)


OF_NODES = ("nodes", "radii", "sources", "regimes", "reach", "tile", "node", "torn")


def web_of(curve: CurveGraph, tile: int) -> Web:
    """Return the curve of a tile (its number) as a web, nothing of it cut off."""
    count, lengths = len(curve.nodes), curve.lengths
    ends = np.concatenate([curve.edges[:, 0], curve.edges[:, 1]])
    apart = np.bincount(ends, np.tile(lengths, 2), count) / np.maximum(np.bincount(ends, minlength=count), 1)
    reach = np.maximum(np.nan_to_num(curve.radii), apart)
    everyone = np.arange(count, dtype=np.int32)
    return Web(
        curve.nodes, curve.radii, curve.radius_sources, curve.regimes, reach, np.full(count, tile, np.int32), everyone,
        np.zeros(count, bool), curve.edges, curve.bridged,
    )  # fmt: skip


def together(webs: Sequence[Web]) -> Web:
    """Return webs as one, side by side."""
    starts = np.cumsum([0, *(len(web.nodes) for web in webs)])
    columns = {name: np.concatenate([getattr(web, name) for web in webs]) for name in (*OF_NODES, "bridged")}
    edges = np.concatenate([web.edges + start for web, start in zip(webs, starts[:-1], strict=True)])
    return Web(**columns, edges=edges.astype(np.int32))


def divided(web: Web, step: float, near: Mask) -> Web:
    """Return the web with edges (e,) of a mask divided, so that none of them is longer than a step.

    What is between is interpolated; radii are worth what the first node's are.
    """
    lengths = web.lengths
    parts = np.where(near, np.maximum(np.ceil(lengths / step), 1), 1).astype(np.int64)
    long = np.flatnonzero(parts > 1)
    if len(long) == 0:
        return web
    edge = np.repeat(long, parts[long] - 1)
    number = within_runs(parts[long] - 1) + 1
    share = number / parts[edge]
    a, b = web.edges[edge].T
    fresh: dict[str, Any] = {
        name: (getattr(web, name)[a].T * (1 - share) + getattr(web, name)[b].T * share).T
        for name in ("nodes", "radii", "reach")
    }
    fresh |= {"sources": web.sources[a], "regimes": web.regimes[a], "tile": web.tile[a]}
    fresh |= {"node": np.full(len(edge), -1, np.int32), "torn": np.zeros(len(edge), bool)}
    place = len(web.nodes) + np.arange(len(edge))
    first, last = number == 1, number == parts[edge] - 1
    chain = np.concatenate([
        np.stack([a[first], place[first]], axis=1), np.stack([place[:-1], place[1:]], axis=1)[~last[:-1]],
        np.stack([place[last], b[last]], axis=1), web.edges[parts == 1],
    ])  # fmt: skip
    bridged = web.bridged[np.concatenate([edge[first], edge[:-1][~last[:-1]], edge[last], np.flatnonzero(parts == 1)])]
    columns = {name: np.concatenate([getattr(web, name), fresh[name]]) for name in OF_NODES}
    return Web(**columns, edges=chain.astype(np.int32), bridged=bridged)


def undivided(web: Web) -> Web:
    """Return the web without the nodes that only divide edges, where these have two neighbours."""
    around: list[dict[int, bool]] = [{} for _ in range(len(web.nodes))]
    for (a, b), bridged in zip(web.edges.tolist(), web.bridged.tolist(), strict=True):
        around[a][b] = around[b][a] = bridged
    keep = np.ones(len(web.nodes), bool)
    for node in np.flatnonzero(web.node < 0).tolist():
        if len(around[node]) != 2:
            continue
        (a, one), (b, other) = around[node].items()
        if b in around[a]:
            continue  # without it there would be two edges between the same nodes
        keep[node] = False
        del around[a][node], around[b][node]
        around[a][b] = around[b][a] = one or other
        around[node] = {}
    pairs = [(a, b, bridged) for a, others in enumerate(around) for b, bridged in others.items() if a < b]
    edges = np.array([pair[:2] for pair in pairs], np.int32).reshape(-1, 2)
    return replace(web, edges=edges, bridged=np.array([pair[2] for pair in pairs], bool)).kept(keep)
