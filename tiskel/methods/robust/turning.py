"""How far the points of a node turn about the curve: flat places, and such as were seen from one side."""

import numpy as np

from tiskel.arrays import Indices, Mask, Points
from tiskel.geometry.curve import vertex_tangents
from tiskel.geometry.frames import across, unit
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime

FEWEST = 8  # points that say on which sides of a node there are some
ONE_SIDE = np.deg2rad(200.0)  # radians without points about a node, from which on it was seen from one side


def flat_points(graph: CurveGraph, normals: Points, node_of_point: Indices, flat: float) -> Mask:
    """Tell which points belong to nodes whose points' normals hardly turn about the curve, as those of a plate do not.

    Parameters
    ----------
    graph : CurveGraph
        The curve.
    normals : (n, 3) float64
        Unit vectors, not oriented.
    node_of_point : (n,) int32
        The node of every point.
    flat : float
        Ratio of the second to the largest spread of normals, below which a node is flat.

    Returns
    -------
    (n,) bool
        False at wires, at nodes whose radius is a bound and at those with fewer than 8 points: normals mean nothing.
    """
    told = np.bincount(node_of_point, minlength=len(graph.nodes)) >= FEWEST
    told &= (graph.regimes != Regime.WIRE) & (graph.radius_sources != RadiusSource.BOUNDED)
    scatter = np.zeros((len(graph.nodes), 3, 3))
    np.add.at(scatter, node_of_point, normals[:, :, None] * normals[:, None, :])
    _, second, most = np.linalg.eigvalsh(scatter).T
    return np.asarray((told & (second < flat * most))[node_of_point])


def one_sided_nodes(graph: CurveGraph, points: Points, node_of_point: Indices) -> Mask:
    """Tell about which nodes the points leave 200 degrees of the turn about the curve empty.

    Parameters
    ----------
    graph : CurveGraph
        The curve, in the unit of the points.
    points : (n, 3) float64
        The cloud.
    node_of_point : (n,) int32
        The node of every point.

    Returns
    -------
    (v,) bool
        False at joints, which have no direction, and at nodes with fewer than 8 points.
    """
    tangents = vertex_tangents(graph)
    for side in (0, 1):  # ends look along their only edge
        ends = graph.degrees[graph.edges[:, side]] == 1
        a, b = graph.edges[ends].T
        tangents[graph.edges[ends, side]] = unit(graph.nodes[b] - graph.nodes[a])
    counts = np.bincount(node_of_point, minlength=len(graph.nodes))
    told = tangents.any(axis=1) & (counts >= FEWEST)
    rows = np.flatnonzero(told[node_of_point])
    if len(rows) == 0:
        return told
    node = node_of_point[rows]
    frames = np.zeros((len(graph.nodes), 2, 3))
    frames[told] = across(tangents[told])
    flat = np.einsum("nij,nj->ni", frames[node], points[rows] - graph.nodes[node])
    angle = np.arctan2(flat[:, 1], flat[:, 0])
    order = np.lexsort((angle, node))
    node, angle = node[order], angle[order]
    first = np.flatnonzero(np.append(True, node[1:] != node[:-1]))
    following = np.append(angle[1:], 0.0)
    last = np.append(first[1:] - 1, len(node) - 1)
    following[last] = angle[first] + 2 * np.pi
    widest = np.maximum.reduceat(following - angle, first)
    found = np.zeros(len(told), np.bool_)
    found[node[first]] = widest >= ONE_SIDE
    return found
