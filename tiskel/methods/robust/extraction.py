"""Method "robust", its second half: from the sections of fronts to the best curve, with what may be wrong with it."""

import numpy as np

from tiskel.errors import TiskelError
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.solid import solid_of
from tiskel.methods.robust.body import body_curve
from tiskel.methods.robust.checks import Candidate, radii_of, radius_sources
from tiskel.methods.robust.doubts import doubts_of
from tiskel.methods.robust.ends import open_ends
from tiskel.methods.robust.fronts import further_front
from tiskel.methods.robust.judged import Judged
from tiskel.methods.robust.network import Network, prepared
from tiskel.methods.robust.pipeline import fitted_curve
from tiskel.methods.robust.regimes import maybe_wires, regimes_of, shorter, surely_wires, wires
from tiskel.methods.robust.rungs import without_rungs
from tiskel.methods.robust.sheets import flat_share, on_sheets
from tiskel.methods.robust.thinning import remembered, told
from tiskel.methods.robust.treelike import CROWN, without_contacts
from tiskel.methods.robust.wire.parallel import parallel_links
from tiskel.methods.trace import MethodCurve, Trace
from tiskel.params import RobustParams
from tiskel.progress import SILENT, Span

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
DOUBTFUL = 0.012  # misfit from which on a further front is tried; every one after it needs as much again [0, 1]
BULKY = 0.15  # misfit and share off the middle from which on the inside of the body is thinned
NEARLY_CLOSED = 0.85  # share of points between inside and outside, from which on a front shows limbs [leaves 0.78]
FLAT = 0.5  # share of the nodes on sheets, from which on a cloud is one
CLEARLY = 0.68  # of the misfit so far that another front may leave, to be taken [noisy mug 0.653, ring of tubes 0.700]


def curve(trace: Trace, params: RobustParams, span: Span = SILENT) -> MethodCurve:
    """Return the curve of round cones of a contracted cloud.

    Raises TiskelError where the trace has no sections: it is another method's.
    """
    if trace.sections is None:
        raise TiskelError("the contraction has no sections; run tiskel contract again with --method robust")
    network = trace.prepared or prepared(remembered(trace), params.neighbours_for(len(trace.rows)), trace.surface)
    found = without_rungs(without_contacts(_best(network, trace, params, span.within(0, 0.9)), params), params)
    best = on_sheets(found, params.seen_from)
    span.at(0.9, "doubts")
    return _translated(best, trace, network)


def _best(network: Network, trace: Trace, params: RobustParams, span: Span) -> Candidate:
    """Return the best curve, of tubes or of wires."""
    span.at(0, "solid")
    assert trace.sections is not None  # curve() has seen to that
    contracted = np.ascontiguousarray(trace.points @ network.axes.T)
    oriented, mesh = network.oriented(contracted), network.surface
    solid = solid_of(oriented) if mesh is None else solid_of(oriented, mesh.handles, mesh.outward)
    turns = None if params.regime == "tube" or mesh is not None else parallel_links(network)
    if turns is not None or params.regime == "wire" or (params.regime == "auto" and surely_wires(network)):
        return wires(network, solid, params, links=turns)
    best = fitted_curve(network, solid, trace.sections, params, span.within(0.1, 0.5))
    span.at(0.5, "other curves")
    if params.regime == "auto" and maybe_wires(best) and shorter(thin := wires(network, solid, params, best), best):
        return thin
    if flat_share(best) > FLAT:  # what encloses nothing has no inside to judge a curve by, though perhaps limbs
        inner = body_curve(network, solid, params) if solid.oriented.consistency > NEARLY_CLOSED else None
        return inner if inner is not None and inner.curve.ends > best.curve.ends and _alike(inner, best) else best
    crown = best.curve.ends >= CROWN  # neither the inside nor another front of one was ever better
    if not crown and best.misfit + best.off_middle >= BULKY:
        inner = body_curve(network, solid, params)
        if inner is not None and _alike(inner, best) and _clearly(inner, best) and not _in_mouths(inner, best):
            best = inner
    for number in range(1, params.extra_fronts + 1):
        if crown or best.misfit < number * DOUBTFUL:
            break
        span.at(0.6 + 0.4 * (number - 1) / params.extra_fronts, f"further front {number}")
        sections = further_front(network, contracted, params, number)
        other = fitted_curve(network, solid, sections, params)
        best = other if _clearly(other, best) else best
    return best


def _clearly(other: Candidate, best: Candidate) -> bool:
    """Tell whether another curve is clearly better than the best so far."""
    return other.score + other.off_middle < CLEARLY * (best.score + best.off_middle)


def _alike(inner: Candidate, best: Candidate) -> bool:
    """Tell whether a curve from the inside has the components of the best, and its loops where handles may be wrong.

    They are unknown, or the scan has gaps, which handles fall apart at.
    """
    known = inner.solid.handles is not None and best.gaps == 0
    return inner.curve.components == best.curve.components and (known or inner.curve.loops == best.curve.loops)


def _in_mouths(inner: Candidate, best: Candidate) -> bool:
    """Tell whether a curve from the inside has more ends than a tube open at both: its wide mouths have corners."""
    mouths = len(open_ends(best.curve, best.network, best.sections))
    return inner.curve.ends > best.curve.ends >= 2 and mouths == best.curve.ends


def _translated(best: Candidate, trace: Trace, network: Network) -> MethodCurve:
    """Return the curve in the axes of the trace, the node of every point, and the points' foot points."""
    from scipy.spatial import cKDTree

    curve, fit = best.curve, best.fit
    node = curve.node_of_section[best.sections.section]
    node[fit.rows] = fit.nodes
    left_out = node < 0  # in small components
    lost = np.flatnonzero(left_out)
    if len(lost):
        node[lost] = cKDTree(curve.nodes).query(network.points[lost])[1]
    contracted = trace.points.copy()
    contracted[fit.rows] = fit.places @ network.axes
    nodes = curve.nodes @ network.axes
    radii = radii_of(best, trace)
    graph = CurveGraph(nodes, curve.edges, radii, curve.bridged, radius_sources(best), regimes_of(best))
    judged = Judged(
        graph=graph,
        points=trace.cloud[trace.rows],
        normals=network.normals @ network.axes,
        spacings=network.spacings,
        node_of_point=node,
        contracted=contracted,
        left_out=left_out,
        solid=best.solid,
        axes=network.axes,
        beside=best.beside,
        meshed=network.surface is not None,
        side_by_side=best.side_by_side,
    )
    return MethodCurve(graph, node[trace.survivor_of()], contracted, (*doubts_of(judged), *told(trace)))
