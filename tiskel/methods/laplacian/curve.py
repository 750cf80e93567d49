"""The published curve of a contracted cloud (Cao et al. 2010, section 4), and its spurs taken away.

A front of balls samples the contracted cloud, first foreign ring members join
the samples, and edges of triangles collapse until none is left. Departure from
print, unless ``raw``: spurs of a single edge shorter than the local radius go.
With ``raw``, lbc has the nodes and edges of its toolbox, and gls of variant
"toolbox" those of the toolbox of GLSkeleton; which they are depends on the order
of the points, since the front of balls starts at the first.
"""

from dataclasses import replace

import numpy as np

from tiskel.arrays import Edges, Indices, Points, diagonal
from tiskel.errors import TiskelError
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.graph import CurveGraph, node_radii
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.rings import Rings
from tiskel.methods.laplacian.collapse import collapse_triangles, inherited_edges
from tiskel.methods.laplacian.sampling import front_samples
from tiskel.methods.laplacian.toolbox_curve import join_counts, without_lost, without_straight
from tiskel.methods.trace import MethodCurve, Trace
from tiskel.params import GlsParams, LaplacianParams
from tiskel.progress import SILENT, Span

SINGLE = CurveWarning(
    "short", "the cloud contracted to a single node: it has no elongated part at this sampling radius", share=1.0
)


def curve(trace: Trace, params: LaplacianParams, span: Span = SILENT) -> MethodCurve:
    """Return the curve of a contracted cloud.

    Parameters
    ----------
    trace : Trace
        Of lbc or gls, in normalised coordinates.
    params : LaplacianParams
        ``radius`` of the balls, in diagonals of the cloud, and ``raw`` count.
    span : Span
        Told as parts begin.

    Returns
    -------
    MethodCurve

    Raises
    ------
    TiskelError
        Where the trace has no rings: it is another method's.
    """
    if trace.rings is None:
        raise TiskelError("the contraction has no rings; run tiskel contract again with --method lbc or gls")
    span.at(0, "samples")
    samples, owner = front_samples(trace.points, params.radius * diagonal(trace.cloud))
    nodes, edges, into = _graph(trace.rings, owner, trace.points[samples], params, span)
    node_of_point = into[owner][trace.survivor_of()]
    owned = np.isin(np.arange(len(nodes)), node_of_point)
    sources = np.where(owned, RadiusSource.MEASURED, RadiusSource.UNKNOWN).astype(np.uint8)
    graph = CurveGraph(nodes, edges, node_radii(nodes, trace.cloud, node_of_point), radius_sources=sources)
    warnings = (SINGLE,) if len(nodes) <= 1 else ()
    if not params.raw:
        graph, node_of_point = without_spurs(graph, trace.cloud, node_of_point)
    return MethodCurve(graph, node_of_point, trace.points, warnings)


def _graph(
    rings: Rings, owner: Indices, samples: Points, params: LaplacianParams, span: Span
) -> tuple[Points, Edges, Indices]:
    """Return the nodes and edges of a curve through samples, and the node of every sample."""
    if isinstance(params, GlsParams) and params.variant == "toolbox":
        placed, joined = without_straight(join_counts(rings, owner, samples), samples)
    else:
        placed, joined = samples, inherited_edges(rings, owner, samples)
    span.at(0.5, "triangles")
    nodes, edges, into = collapse_triangles(placed, joined)
    return without_lost(nodes, edges, into, samples)


def without_spurs(graph: CurveGraph, cloud: Points, node_of_point: Indices) -> tuple[CurveGraph, Indices]:
    """Return a graph without its spurs; their points go to the junctions that they hung on.

    Parameters
    ----------
    graph : CurveGraph
    cloud : (n, 3) float64
        The points, in the unit of the graph.
    node_of_point : (n,) int32
        The node of every point.

    Returns
    -------
    graph : CurveGraph
        With the radii of what is left.
    node_of_point : (n,) int32
        In its nodes.
    """
    into = graph.without_spurs()
    kept = np.flatnonzero(into == np.arange(len(into)))
    place = np.full(len(into), -1, np.int32)
    place[kept] = np.arange(len(kept), dtype=np.int32)
    left = (place[graph.edges] >= 0).all(axis=1)
    nodes, owner = graph.nodes[kept], place[into[node_of_point]]
    fewer = replace(
        graph, nodes=nodes, edges=place[graph.edges[left]], radii=node_radii(nodes, cloud, owner),
        bridged=graph.bridged[left], radius_sources=graph.radius_sources[kept],
    )  # fmt: skip
    return fewer, owner
