"""Bulky bodies: a curve from the inside of a body instead of from fronts over its surface.

Where a body is as wide as it is long, fronts over its surface say little of its
inside: they run into holes and out of them again, and joints come to lie
anywhere in it. The solid inside the cloud says more. Its cells are thinned in the
order of their clearance, without a change of topology, to curves that join its
dead ends and close about its handles.
"""

from tiskel.geometry.body import Body
from tiskel.geometry.solid import Solid
from tiskel.geometry.thinning import thinned
from tiskel.methods.robust.body.centres import centred, not_round
from tiskel.methods.robust.body.limbs import without_corners, zipped
from tiskel.methods.robust.body.strands import evened, strands_of, with_sections
from tiskel.methods.robust.body.wide import middle_lines
from tiskel.methods.robust.branches import with_tips, without_contained_ends, without_explained_branches
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.fit import ConeFit, fit_cones
from tiskel.methods.robust.junctions import merged_junctions
from tiskel.methods.robust.network import Network
from tiskel.params import RobustParams

LIMB = 0.5  # of least_branch, that a limb has to stick out of the cones: it was held against its own radius before


def body_curve(network: Network, solid: Solid, params: RobustParams) -> Candidate | None:
    """Return the curve of round cones in the inside of a solid, and what judges it; None where there is no inside.

    Nodes are fitted where the body is round about them; elsewhere they stay in its middle.
    """
    body = solid.body
    if body is None:
        return None
    curve = _thinned(body)
    curve = merged_junctions(evened(zipped(curve, body), body), params.merge_junctions)
    curve, sections = with_sections(middle_lines(centred(curve, body), body), body, network)

    def fit(curve: ConeCurve, rounds: int) -> ConeFit:
        still = not_round(curve, body)
        return fit_cones(
            curve, network.points, sections.section, rounds=rounds, straightness=params.straightness, fixed=still
        )

    again = max(1, params.rounds // 2)
    found = fit(without_contained_ends(fit(curve, params.rounds).curve), again)
    least = LIMB * params.least_branch
    while (fewer := without_explained_branches(found.curve, network, sections, least)) is not None:
        found = fit(zipped(fewer, body), again)
    for _ in range(params.grow_ends):
        longer = with_tips(found, network, sections)
        if longer is None:
            break
        found = fit(longer, again + 1)
    return Candidate(found, sections, network, solid, 0)


def _thinned(body: Body) -> ConeCurve:
    """Return what thinning leaves of a body, without corners, and ends in the middle of their last full ball."""
    slack = body.step / 2  # what clearances on the grid are unsure of
    curve = without_contained_ends(strands_of(body, thinned(body.inside, body.order, body.tips)), slack)
    return without_contained_ends(without_corners(curve, body), slack)
