"""Open ends: ends of a curve where the scan stops, though the body goes on.

The end of a branch is round: points lie ahead of it. Where none do, the end is
open, a cut or the mouth of a tube.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Numbers
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections

# Found by trial on the shapes of the gallery, whole and with patches missing.
AROUND = 1.4  # radii about an end in which its cap is looked for
AHEAD = 0.6  # cosine to the direction of the end, from which on a point is of its cap; the wall of a tube is aside
OPEN = 0.6  # share of a ball's cap, by area: an end with less is open
FEWEST = 12  # points of a piece of a tube
INNER = 0.9  # quantile of where the points are along a piece, at which its edge ends
TUBE = 0.4  # ratio of how much normals spread along and across a piece, up to which it is one of a tube


@dataclass(frozen=True, eq=False)
class OpenEnd:
    """An end without a cap.

    Attributes
    ----------
    node : int
        Its node.
    direction : (3,) float64
        The direction it looks in, a unit vector.
    branch : frozenset of int
        The nodes of its branch.
    """

    node: int
    direction: Numbers
    branch: frozenset[int]


def open_ends(curve: ConeCurve, network: Network, sections: Sections) -> list[OpenEnd]:
    """Return the ends that have no cap."""
    rows = np.flatnonzero(curve.node_of_section[sections.section] >= 0)
    tree, found = cKDTree(network.points[rows]), []
    whole = 2 * np.pi * (1 - AHEAD)  # area of a ball's cap, in squared radii
    for path in curve.paths_from(ends=True):
        end, radius = int(path[0]), float(curve.radii[path[0]])
        direction = curve.heading(path)
        direction /= max(float(np.linalg.norm(direction)), TINY)
        near = rows[np.sort(np.array(tree.query_ball_point(curve.nodes[end], AROUND * radius), int))]
        offset = network.points[near] - curve.nodes[end]
        cap = near[offset @ direction > AHEAD * np.linalg.norm(offset, axis=1)]
        if network.areas[cap].sum() < OPEN * whole * radius**2:
            found.append(OpenEnd(end, direction, frozenset(path.tolist())))
    return found


def with_stubs(curve: ConeCurve, network: Network, sections: Sections) -> ConeCurve:
    """Replace nodes without an edge, whose points are a short piece of a tube open at both ends, by an edge."""
    owner = curve.node_of_section[sections.section]
    for node in np.flatnonzero(curve.degrees == 0).tolist():
        rows: Indices = np.flatnonzero(owner == node).astype(np.int32)
        longer = _stub(curve, network, node, rows) if len(rows) >= FEWEST else None
        if longer is not None:
            opened = {end.node for end in open_ends(longer, network, sections)}
            curve = longer if {node, len(curve.nodes)} <= opened else curve
    return curve


def _stub(curve: ConeCurve, network: Network, node: int, rows: Indices) -> ConeCurve | None:
    """Return the curve with an edge along the axis of a piece in place of its node, None where it has no axis."""
    offset = network.points[rows] - curve.nodes[node]
    values, vectors = np.linalg.eigh(network.normals[rows].T @ network.normals[rows])
    axis = vectors[:, 0]
    along = offset @ axis
    low, high = np.quantile(along, [1 - INNER, INNER])
    if values[0] > TUBE * values[1] or high - low < network.spacing:
        return None
    nodes, radii = curve.nodes.copy(), curve.radii.copy()
    nodes[node] = curve.nodes[node] + low * axis
    radii[node] = np.linalg.norm(offset - along[:, None] * axis, axis=1).mean()
    return with_nodes(
        replace(curve, nodes=nodes, radii=radii), curve.nodes[node] + high * axis, radii[[node]],
        np.array([[node, len(nodes)]], np.int32), curve.levels[[node]],
    )  # fmt: skip
