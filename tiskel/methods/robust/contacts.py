"""Contacts: ends that lie at another part of the curve, as twigs do that touch, or loops that were left open."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.ways import steps_of, ways_from
from tiskel.methods.robust import levels


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
