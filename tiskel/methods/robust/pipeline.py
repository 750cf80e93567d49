"""The passes from sections to a fitted curve, on one page."""

from tiskel.geometry.solid import Solid
from tiskel.methods.robust.branches import (
    with_missed_branches,
    with_tips,
    without_contained_ends,
    without_explained_branches,
    without_spurs,
)
from tiskel.methods.robust.bridges import bridged
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.corners import without_false_limbs
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.cycles import without_filled_cycles
from tiskel.methods.robust.ends import with_stubs
from tiskel.methods.robust.fit import ConeFit, fit_cones
from tiskel.methods.robust.junctions import merged_junctions, placed_junctions
from tiskel.methods.robust.network import Network
from tiskel.methods.robust.pieces import joined_pieces
from tiskel.methods.robust.sections import section_graph
from tiskel.methods.robust.sheets import sheet_nodes
from tiskel.methods.trace import Sections
from tiskel.params import RobustParams
from tiskel.progress import SILENT, Span


def fitted_curve(
    network: Network, solid: Solid, sections: Sections, params: RobustParams, span: Span = SILENT
) -> Candidate:  # fmt: skip
    """Return the curve of round cones that the sections of a front lead to, and what judges it.

    A change to the graph needs half as many rounds of the fit as its first form,
    and a new end one more.
    """
    again = max(1, params.rounds // 2)

    def fit(curve: ConeCurve, rounds: int) -> ConeFit:
        return fit_cones(curve, network.points, sections.section, rounds=rounds, straightness=params.straightness)

    # The graph of the sections, without what chance and holes made.
    span.at(0, "graph")
    curve = section_graph(network, sections)
    curve = without_filled_cycles(curve, network, sections, solid, fitted=False)
    curve = merged_junctions(without_spurs(curve, network.points, sections), params.merge_junctions)
    span.at(0.1, "fit")
    found = fit(placed_junctions(without_contained_ends(curve), solid), params.rounds)
    # Branches that the front took in sideways.
    grown = with_missed_branches(found, network, sections, params)
    if grown is not None:
        curve, sections = grown
        found = fit(placed_junctions(without_contained_ends(curve), solid), params.rounds)
    span.at(0.4, "cycles and branches")
    # Now that nodes are where they should be: cycles without a hole, branches that explain nothing.
    curve = without_filled_cycles(found.curve, network, sections, solid, fitted=True)
    if len(curve.nodes) < len(found.curve.nodes):
        found = fit(curve, again)
    least, points = params.least_branch, network.points
    while True:
        fewer = without_explained_branches(found.curve, network, sections, least, sheet_nodes(found, points))
        if fewer is None:
            break
        found = fit(fewer, again)
    found = fit(placed_junctions(found.curve, solid), again)  # now that the branches are known
    span.at(0.8, "ends")
    for _ in range(params.grow_ends):
        longer = with_tips(found, network, sections)
        if longer is None:
            break
        found = fit(longer, again + 1)
    if solid.body is not None and (fewer := without_false_limbs(found.curve, solid.body)) is not None:
        found = fit(fewer, again)
    curve = with_stubs(found.curve, network, sections)
    widest = params.bridge_gaps if network.surface is None else 0  # a mesh knows what is connected
    curve, gaps = bridged(curve, network, sections, widest)
    if network.surface is None and widest > 0:
        pieces, curve = curve.components, joined_pieces(curve)
        gaps += pieces - curve.components
    return Candidate(fit(curve, 0), sections, network, solid, gaps)
