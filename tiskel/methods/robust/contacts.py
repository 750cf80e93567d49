"""Contacts: ends that lie at another part of the curve, as twigs do that touch, and wires that lie side by side."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.regime import Regime
from tiskel.geometry.ways import on_loops, steps_of, ways_from
from tiskel.methods.robust import levels
from tiskel.methods.robust.judged import Judged, doubt, severity
from tiskel.methods.robust.treelike import CROWN


def touching_ends(graph: CurveGraph, spacing: float) -> Indices:
    """Return the ends of a curve within reach of a node that is far from them along it."""
    ends = np.flatnonzero(graph.degrees == 1)
    reach = levels.TOUCHING * spacing
    widest = reach + float(graph.radii.max(initial=0))
    nearby = cKDTree(graph.nodes).query_ball_point(graph.nodes[ends], widest, return_sorted=True)
    steps, found = steps_of(graph), []
    for end, nodes in zip(ends.tolist(), nearby, strict=True):
        near: Indices = np.array(nodes, np.int32)
        near = near[np.linalg.norm(graph.nodes[near] - graph.nodes[end], axis=1) < reach + graph.radii[near]]
        least = np.maximum(levels.APART * spacing, levels.APART_RADII * (graph.radii[end] + graph.radii[near]))
        along = ways_from(steps, end, float(least.max()))
        if any(along.get(node, (np.inf, 0))[0] > far for node, far in zip(near.tolist(), least.tolist(), strict=True)):
            found.append(end)
    return np.array(found, np.int32)


def contacts(j: Judged) -> CurveWarning | None:
    """Return the doubt about ends that lie at another part of the curve, or wires that run together."""
    graph, wires = j.graph, (j.graph.regimes == Regime.WIRE).mean() > levels.MOSTLY
    if wires and graph.loops >= levels.NET and (each := graph.length / graph.loops / j.spacing) < levels.MESH:
        text = f"{graph.loops} loops of wire, one for {each:.0f} spacings of it: wires side by side may run together"
        return CurveWarning("contacts", text, share=1.0)
    if graph.ends >= CROWN and 0 < graph.loops <= levels.SELDOM * graph.ends:
        text = f"{graph.loops} loops in a crown of {graph.ends} ends: limbs that touch may run together"
        return doubt("contacts", text, graph.loops / graph.ends, graph.nodes[on_loops(graph)])
    ends = touching_ends(graph, j.spacing)
    if j.side_by_side or not len(ends) or (share := len(ends) / graph.ends) <= levels.CONTACTS:
        return None
    text = f"{len(ends)} of {graph.ends} ends lie at another part of the curve: which limbs go on there is a guess"
    serious = share > levels.CONTACTS_SERIOUS and j.beside > levels.NOISY
    return doubt("contacts", text, share, graph.nodes[ends], None, severity(serious))


def turns(j: Judged) -> CurveWarning | None:
    """Return the note that turns which lie side by side were taken for one wire."""
    if not j.side_by_side:
        return None
    text = "the points lie along one wire whose turns are side by side; for a surface in rows choose regime tube"
    return CurveWarning("turns", text, "note", 1.0)
