"""Regimes: whether a cloud is one of tubes or of wires, decided by what describes it better.

Fronts and round cones need points all about a limb; on twigs thinner than their
points are apart sections fall apart, and cones span the crown. A cloud is surely
of wires where many neighbourhoods are lines. Where tubes enclose no inside, the
wire regime is tried, and kept where its limbs are thin and it explains the cloud:
as well as tubes for a crown of many ends, better for a few twigs.
"""

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Numbers
from tiskel.geometry.frames import unit
from tiskel.geometry.regime import Regime
from tiskel.geometry.solid import Solid
from tiskel.methods.robust.checks import FAR, Candidate
from tiskel.methods.robust.fit import feet_of_own
from tiskel.methods.robust.network import Network
from tiskel.methods.robust.sheets import flat_share
from tiskel.methods.robust.treelike import CROWN
from tiskel.methods.robust.wire import wire_curve
from tiskel.methods.robust.wire.links import Links
from tiskel.params import RobustParams

# Found by trial on generated trees, the shapes of the gallery, clean and degraded, and on scans.
SURELY = 0.09  # linear share from which on a cloud is of wires [tubes at most 0.07, thin trees 0.12 to 0.63]
NOISY = 0.3  # linear share below which thin limbs are noisy [noisy twigs to 0.21, stents from 0.88]
THIN = 2.2  # spacings: median radius up to which limbs are wires [generated trees to 2.0, noisy tubes from 2.3]
CUT = 3.0  # most that a point counts as unexplained
NO_WORSE = 2.0  # of what tubes leave unexplained, what wires may leave of a crown [trees to 1.52, sheets from 2.9]
THICKET = 40  # ends of a crown in which loops that no handle confirms are contacts of limbs
NET = 10  # meetings, besides two for every other end, from which on wires are a net [ladders to 5, sheets from 54]
SHEETS = 0.2  # share of nodes on sheets, from which on a body is one [crowns of twigs none, plates of two faces 1]
SLENDER = 3.0  # spacings: median radius of such limbs, at most
RUNGS = 2  # loops of tubes with few ends, from which on they are no chance [noisy twigs to 1, coarse ladders 4]
BETTER = 0.85  # the same of a body with few ends [twigs 0.77, tubes from 0.98]

# What a limb of tubes has to have to be kept among wires, whose crown no tube explains [limbs of scanned and generated
# trees 0.04 to 0.15 and 0.44 up; what fronts make of noisy twigs 0.07 to 0.25 and 0.12 to 0.6].
WIDE = 2.0  # spacings in its radius, at least
SHARP = 0.125  # root mean square of the distances of its points from it, in radii, at most
OUTWARD = 0.5  # mean squared cosine of its normals and the ways from its axis, at least; by chance it is a third [limbs
# of scans, and of trees as noisy as their points are apart, from 0.63; noisy crowns taken for limbs to 0.49]
COVERED = 0.4  # share of its surface with points, at least
MANY = 0.2  # share of points on such limbs from which on there are some [scans 0.34 up, noisy twigs to 0.10]
SHORTEST = 0.5  # radii in the length of an edge, when its surface is asked for: shorter ones have the points of a ball


def surely_wires(network: Network) -> bool:
    """Tell whether so many neighbourhoods are lines, or so few points linked, that no tube needs to be looked for."""
    return not len(network.edges) or network.linear_share > SURELY


def maybe_wires(found: Candidate) -> bool:
    """Tell whether wires are worth a try: where tubes enclose no inside, or their loops are not the handles of it.

    The faces of a sheet enclose something by chance; fewer loops say nothing there.
    """
    loops, handles = found.curve.loops, found.solid.handles or 0
    return not found.solid.trusted or loops > handles or (loops < handles and flat_share(found) < SHEETS)


def wires(
    network: Network, solid: Solid, params: RobustParams, tubes: Candidate | None = None, links: Links | None = None
) -> Candidate:
    """Return the curve of the wire regime, and what judges it; thick limbs are those of tubes that are known."""
    known = None if tubes is None else on_sure_tubes(tubes)
    curve, sections, meetings = wire_curve(network, params, known, network.linear_share < NOISY, links)
    fit = feet_of_own(curve, network.points, sections.section)
    return Candidate(fit, sections, network, solid, int(curve.bridged.sum()), meetings, links is not None)


def on_sure_tubes(tubes: Candidate) -> Indices:
    """Return (n,) for every point the node of the tube that it lies on, -1 where there is none, or none to rely on.

    Where few points are on limbs that are surely resolved, fronts made up the
    others, too; where many are, limbs that are half as sure are kept as well.
    """
    sure = _on_tubes(tubes, SHARP, COVERED)
    return _on_tubes(tubes, 2 * SHARP, COVERED / 2) if (sure >= 0).mean() > MANY else np.full_like(sure, -1)


def _on_tubes(tubes: Candidate, sharp: float, covered: float) -> Indices:
    fit, curve = tubes.fit, tubes.curve
    many = np.maximum(np.bincount(fit.edge, minlength=len(curve.edges)), 1)
    spacings = tubes.network.spacings[fit.rows]
    away = unit(tubes.network.points[fit.rows] - fit.places)
    outward = np.einsum("ij,ij->i", away, tubes.network.normals[fit.rows])
    spacing, radius, spread, outward = (
        np.bincount(fit.edge, values, minlength=len(curve.edges)) / many
        for values in (spacings, fit.radii, fit.residual**2, outward**2)
    )
    area = 2 * np.pi * radius * np.maximum(curve.lengths, SHORTEST * radius)
    good = (radius > WIDE * spacing) & (many * spacing**2 > covered * area)
    good &= (np.sqrt(spread) < sharp * radius) & (outward > OUTWARD)
    node = np.full(len(tubes.network.points), -1, np.int32)
    on = good[fit.edge] & (fit.residual < np.maximum(fit.radii, spacings))
    node[fit.rows[on]] = fit.nodes[on]
    return node


def shorter(thin: Candidate, thick: Candidate) -> bool:
    """Tell whether wires describe a cloud better than tubes do; strands through a sheet do so, too, and are a net."""
    if thin.curve.loops + thin.meetings > NET + 2 * (thin.curve.ends - thin.meetings):
        return False
    crown = thin.curve.ends >= CROWN
    if not crown and thick.curve.loops >= max(RUNGS, thin.curve.loops + 1):  # of coarse tubes, which wires run across
        return False
    worse = NO_WORSE if crown else BETTER
    if _unexplained(thin) >= worse * _unexplained(thick):
        return False
    contacts = thick.curve.loops != (thick.solid.handles or 0) and thin.curve.ends >= THICKET and not thin.curve.loops
    return _thickness(thin) < (SLENDER if contacts else THIN) and (contacts or not thick.solid.trusted)


def _thickness(found: Candidate) -> float:
    """Return the median radius about the points, in spacings; of a curve without edges there is none."""
    return float(np.median(found.fit.radii)) / found.network.spacing if len(found.fit.radii) else np.inf


def _unexplained(found: Candidate) -> float:
    """Return how far the points are from the cones, in spacings or shares of the radius, in the mean."""
    unit = np.maximum(found.network.spacing, FAR * found.fit.radii)
    rest: Numbers = np.minimum(np.abs(found.fit.residual) / unit, CUT)
    return float(rest.sum() + CUT * (len(found.network.points) - len(rest))) / len(found.network.points)


def regimes_of(found: Candidate) -> npt.NDArray[np.uint8]:
    """Return (v,) the regime of each node: what the wire regime said, else that of tubes."""
    if (found.curve.regimes != Regime.UNKNOWN).any():
        return found.curve.regimes
    return np.full(len(found.curve.nodes), Regime.TUBE, np.uint8)
