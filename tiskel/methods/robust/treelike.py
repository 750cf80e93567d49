"""Tree-like bodies: a crown of many ends has no loops but those that handles of its body confirm.

Where limbs touch, fronts run together, and the curve closes a loop over the
contact. It is cut there: at the edge that has the fewest points for its surface.
"""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import minimum_spanning_tree

from tiskel.arrays import TINY
from tiskel.methods.robust.branches import without_spurs
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.fit import foot_points, nearby_edges
from tiskel.params import RobustParams

CROWN = 15  # ends from which on a body is tree-like [tubes with loops, sampled coarsely, have up to 9]


def without_contacts(found: Candidate, params: RobustParams) -> Candidate:
    """Return a curve without loops, where it is to have none, or has more ends than these and its body no handles."""
    curve = found.curve
    crown = params.topology == "auto" and curve.ends >= max(CROWN, curve.loops) and not found.solid.handles
    if not curve.loops or not (params.topology == "tree" or crown):
        return found
    fit = found.fit
    points = np.bincount(fit.edge, minlength=len(curve.edges))
    surface = np.maximum(curve.lengths * curve.radii[curve.edges].sum(axis=1), TINY)
    support = points / surface
    # The spanning tree of the best supported edges: weights are positive, and smaller where support is larger.
    weight = 1 + np.argsort(np.argsort(-support, kind="stable"), kind="stable").astype(float)
    count = len(curve.nodes)
    graph = sparse.coo_array((weight, (curve.edges[:, 0], curve.edges[:, 1])), shape=(count, count))
    kept = np.isin(weight, minimum_spanning_tree(graph).data)
    curve = replace(curve, edges=curve.edges[kept], bridged=curve.bridged[kept])
    network = found.network
    curve = without_spurs(curve, network.points, found.sections)
    node = curve.node_of_section[found.sections.section]
    owned = np.flatnonzero(node >= 0).astype(np.int32)
    fit = foot_points(curve, network.points, owned, node[owned], nearby_edges(curve))
    return replace(found, fit=fit)
