"""Curves with their clouds, as plain data that doubts are drawn from."""

import numpy as np

from tiskel import CurveGraph, ShapeParams, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.geometry.graph import tidy_edges
from tiskel.geometry.solid import solid_of
from tiskel.methods.robust.doubts import doubts_of
from tiskel.methods.robust.judged import Judged
from tiskel.methods.robust.network import prepared


def dense(graph: CurveGraph, step: float = 0.1) -> CurveGraph:
    """Return a curve with nodes a step apart."""
    nodes, radii, edges = list(graph.nodes), list(graph.radii), []
    for (a, b), length in zip(graph.edges.tolist(), graph.lengths.tolist(), strict=True):
        cuts = np.linspace(0, 1, max(1, round(length / step)) + 1)[1:-1]
        chain = [a, *range(len(nodes), len(nodes) + len(cuts)), b]
        nodes += [(1 - t) * graph.nodes[a] + t * graph.nodes[b] for t in cuts]
        radii += [(1 - t) * graph.radii[a] + t * graph.radii[b] for t in cuts]
        edges += list(zip(chain[:-1], chain[1:], strict=True))
    return CurveGraph(np.array(nodes), tidy_edges(np.array(edges, np.int32)), np.array(radii))


def judged(cloud: Points, graph: CurveGraph) -> Judged:
    """Return a curve with a cloud, each point of which contracts to its node."""
    network = prepared(cloud, 14)
    node = np.linalg.norm(cloud[:, None] - graph.nodes, axis=2).argmin(axis=1).astype(np.int32)
    solid = solid_of(network.oriented(graph.nodes[node] @ network.axes.T))
    return Judged(
        graph=graph, points=cloud, normals=network.normals @ network.axes, spacings=network.spacings,
        node_of_point=node, contracted=graph.nodes[node], left_out=np.zeros(len(cloud), bool), solid=solid,
        axes=network.axes,
    )  # fmt: skip


def true(name: str, **sampling: float) -> Judged:
    shape = shape_graph(name)
    cloud = make_shape(shape, ShapeParams(**{"count": 3000, **sampling}))[0]  # type: ignore[arg-type]
    return judged(cloud, dense(shape))


def codes(j: Judged) -> dict[str, str]:
    """Return the severity of each doubt by its code."""
    return {doubt.code: doubt.severity for doubt in doubts_of(j)}
