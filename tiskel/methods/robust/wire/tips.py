"""Ends of noisy wires: the mean of the last points lies beside the limb, by as much as they are noisy."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY, Mask, Points
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.axes import sums
from tiskel.methods.robust.curve import ConeCurve

# Found by trial on generated trees, spreading ones and neurons, clean, noisy and uneven.
ZIGZAG = 0.15  # median distance of a node from the line between those beside it, in their distance, that is noise
ROUNDS = 3  # in which nodes go halfway to the mean of those beside them, to find the line of their limb
STRAIGHT = 5  # nodes from an end on that make its line [to move these nodes as well cuts corners: F -0.015]


def on_their_lines(curve: ConeCurve) -> ConeCurve:
    """Return the curve with the ends of noisy wires put on the lines of their limbs; of clear wires they are there."""
    wires = curve.regimes == Regime.WIRE
    if zigzag(curve, wires) < ZIGZAG:
        return curve
    even, nodes = _evened(curve, wires & (curve.degrees > 1)), curve.nodes.copy()
    for path in curve.paths_from(ends=True):
        some = path[: STRAIGHT + 1]
        if len(some) > 2 and wires[some].all():
            start, along = even[some[1:]].mean(axis=0), even[some[1]] - even[some[-1]]
            along /= max(float(np.linalg.norm(along)), TINY)
            nodes[some[0]] = start + max(float((nodes[some[0]] - start) @ along), 0.0) * along
    return replace(curve, nodes=nodes)


def zigzag(curve: CurveGraph, wires: Mask) -> float:
    """Return the median distance of nodes from the line between the two beside them, in their distance; 0 of none."""
    triples = curve.passages
    triples = triples[wires[triples].all(axis=1)] if len(triples) else triples
    if not len(triples):
        return 0.0
    before, here, after = (curve.nodes[column] for column in triples.T)
    offset, along = here - before, after - before
    length = np.maximum(np.linalg.norm(along, axis=1), TINY)
    return float(np.median(np.linalg.norm(np.cross(offset, along), axis=1) / length / length))


def _evened(curve: ConeCurve, moved: Mask) -> Points:
    """Return the nodes (v, 3), some of them evened out among those beside them."""
    first, second = curve.edges.T
    nodes, count, rows = curve.nodes.copy(), len(curve.nodes), np.flatnonzero(moved)
    for _ in range(ROUNDS):
        beside = sums(nodes[second], first, count) + sums(nodes[first], second, count)
        nodes[rows] = (nodes[rows] + beside[rows] / curve.degrees[rows, None]) / 2
    return np.asarray(nodes)
