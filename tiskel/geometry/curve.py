"""Places on a curve skeleton where it is measured, and what its vertices look like."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points, within_runs
from tiskel.geometry.frames import unit
from tiskel.geometry.graph import CurveGraph


@dataclass(frozen=True, eq=False)
class CurveSamples:
    """Places along a curve.

    Attributes
    ----------
    points : (q, 3) float64
        The places, in the curve's unit.
    edges : (q,) int32
        The edge that each lies on.
    directions : (q, 3) float64
        Unit tangents; zero where there is none (joints, edges without length).
    """

    points: Points
    edges: Indices
    directions: Points

    @property
    def directed(self) -> Mask:
        """(q,) which places have a direction."""
        return np.asarray(self.directions.any(axis=1))


def curve_samples(curve: CurveGraph, count: int) -> CurveSamples:
    """Return about so many places on a curve.

    Each edge gets its share of them by length, at least one, evenly, its first
    vertex excluded and its last included. The direction is the edge's; at a
    vertex with two neighbours the tangent of the circle through the three; at a
    joint there is none.

    Parameters
    ----------
    curve : CurveGraph
        With one edge at least.
    count : int
        How many places to aim at; every edge gets one at least.

    Returns
    -------
    CurveSamples
    """
    nodes, edges, lengths = curve.nodes, curve.edges, curve.lengths
    total = lengths.sum()
    shares = np.floor(count * lengths / total + 0.5) if total > 0 else np.zeros(len(edges))
    each = np.maximum(1, shares).astype(int)
    edge = np.repeat(np.arange(len(edges)), each)
    step = within_runs(each) + 1
    share = step / each[edge]
    first, last = edges[edge, 0], edges[edge, 1]
    at_vertex = step == each[edge]
    between = nodes[first] + share[:, None] * (nodes[last] - nodes[first])
    points = np.where(at_vertex[:, None], nodes[last], between)
    directions = unit(nodes[last] - nodes[first])
    tangents = vertex_tangents(curve)
    turning = at_vertex & (curve.degrees[last] != 1)
    directions[turning] = tangents[last[turning]]
    return CurveSamples(np.ascontiguousarray(points), edge.astype(np.int32), directions)


def vertex_tangents(curve: CurveGraph) -> Points:
    """Return (v, 3) the tangent of the circle through a vertex and its two neighbours, zero at other vertices.

    An inversion about the vertex maps the circle to the line through a / |a|^2
    and b / |b|^2, which is parallel to the tangent.
    """
    tangents = np.zeros_like(curve.nodes)
    vertices, before, after = two_sided(curve)
    inverse = [unit(side) / np.maximum(np.linalg.norm(side, axis=1), TINY)[:, None] for side in (before, after)]
    tangents[vertices] = unit(inverse[1] - inverse[0])
    return tangents


def two_sided(curve: CurveGraph) -> tuple[Indices, Points, Points]:
    """Return the vertices with exactly two neighbours, and the vectors to either.

    Parameters
    ----------
    curve : CurveGraph

    Returns
    -------
    vertices : (d,) int32
        Nodes, ascending.
    before : (d, 3) float64
        From each to one neighbour, the lower node, in the curve's unit.
    after : (d, 3) float64
        From each to the other.
    """
    before, vertices, after = curve.passages.T
    here = curve.nodes[vertices]
    return vertices, curve.nodes[before] - here, curve.nodes[after] - here


def turns(before: Points, after: Points) -> Numbers:
    """Return D_n, the angle between pairs of vectors.

    Parameters
    ----------
    before : (d, 3) float64
        The first of each pair, of any length.
    after : (d, 3) float64
        The second.

    Returns
    -------
    (d,) float64
        Shares of pi; NaN where one of the two has no length.
    """
    cosine = np.einsum("ij,ij->i", unit(before), unit(after))
    missing = ~(before.any(axis=1) & after.any(axis=1))
    return np.where(missing, np.nan, np.arccos(np.clip(cosine, -1, 1)) / np.pi)
