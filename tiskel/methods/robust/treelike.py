"""Tree-like bodies: a crown of many ends has no loops but those that handles of its body confirm.

Where limbs touch, fronts run together, and the curve closes a loop over the
contact. It is cut there: at the edge that has the fewest points for its surface.
"""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY
from tiskel.geometry.forest import spanning_links
from tiskel.methods.robust.branches import without_spurs
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.fit import feet_of_own
from tiskel.methods.robust.wire import CLEAR
from tiskel.params import RobustParams

CROWN = 15  # ends from which on a body is tree-like [tubes with loops, sampled coarsely, have up to 9]


def without_contacts(found: Candidate, params: RobustParams) -> Candidate:
    """Return a curve without loops, where it is to have none, or has more ends than these and its body no handles."""
    curve = found.curve
    clear = found.network.linear_share > CLEAR  # lines that meet are a lattice, whatever ends it has
    crown = (
        params.topology == "auto" and curve.ends >= max(CROWN, curve.loops) and not found.solid.handles and not clear
    )
    if not curve.loops or not (params.topology == "tree" or crown):
        return found
    surface = np.maximum(curve.lengths * curve.radii[curve.edges].sum(axis=1), TINY)
    support = np.bincount(found.fit.edge, minlength=len(curve.edges)) / surface
    kept = spanning_links(curve.edges[:, 0], curve.edges[:, 1], -support)
    curve = replace(curve, edges=curve.edges[kept], bridged=curve.bridged[kept])
    points, sections = found.network.points, found.sections
    curve = without_spurs(curve, points, sections)
    return replace(found, fit=feet_of_own(curve, points, sections.section))
