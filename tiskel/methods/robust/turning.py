"""How normals and points turn: flat places, such as were seen from one side, and how rough a surface is."""

import numpy as np

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points
from tiskel.geometry.curve import vertex_tangents
from tiskel.geometry.frames import across, unit
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime

BESIDE = 8  # nearest points whose planes say how rough a surface is
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


def empty_turns(graph: CurveGraph, points: Points, node_of_point: Indices) -> Numbers:
    """Return how much of the turn about each node the points leave empty, in one piece.

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
    (v,) float64
        Radians; 0 at joints, which have no direction, and at nodes with fewer than 8 points.
    """
    tangents = vertex_tangents(graph)
    for side in (0, 1):  # ends look along their only edge
        ends = graph.degrees[graph.edges[:, side]] == 1
        a, b = graph.edges[ends].T
        tangents[graph.edges[ends, side]] = unit(graph.nodes[b] - graph.nodes[a])
    counts = np.bincount(node_of_point, minlength=len(graph.nodes))
    told = tangents.any(axis=1) & (counts >= FEWEST)
    rows = np.flatnonzero(told[node_of_point])
    found = np.zeros(len(told))
    if len(rows) == 0:
        return found
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
    found[node[first]] = np.maximum.reduceat(following - angle, first)
    return found


def roughness(points: Points, normals: Points, spacings: Numbers) -> float:
    """Return how far points are beside the tangent planes of those nearest to them, in spacings, in the median.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    normals : (n, 3) float64
        Unit vectors, not oriented.
    spacings : (n,) float64
        How far the points are apart about each.

    Returns
    -------
    float
        0 on a plane, about half where noise is as large as the spacing; more it cannot be.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.methods.robust.turning import roughness
    >>> grid = np.argwhere(np.ones((9, 9, 1)))
    >>> roughness(grid, np.tile([0.0, 0, 1], (81, 1)), np.ones(81))
    0.0
    """
    near = nearest_neighbours(np.ascontiguousarray(points, float), min(BESIDE + 1, len(points)))[0][:, 1:]
    beside = np.einsum("nkc,nc->nk", points[near] - points[:, None], normals)
    return float(np.median(np.sqrt((beside**2).mean(axis=1)) / np.maximum(spacings, TINY)))
