"""Rungs: short branches through the air between two limbs that pass each other closely, as noise in the gap makes them.

Such a rung leads from one limb to another, each of which goes straight on past it. Its limbs do not touch: the curves
through their arms are further apart than both their radii, and somewhere on the rung is outside the body, by the
winding number of the cloud. The rung of a ladder is inside the body all the way.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial.distance import cdist

from tiskel.arrays import Indices, Points
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.curve import ConeCurve, contract_nodes
from tiskel.methods.robust.fit import fit_cones
from tiskel.methods.robust.wire.crossings import strand
from tiskel.params import RobustParams

# In radii of the limb, by trial on bars and pipes that pass each other, and on ladders.
ABOUT, ARM = 1.5, 8.0  # an arm that says where a limb goes: from where to where on, from the rung
SHORTEST = 2.5  # length of an arm, at least
STRAIGHT = np.cos(np.radians(35))  # of what an arm goes on in, at least
CLOSE = 1.6  # sums of both radii between two limbs, at most: longer rungs are no chance, but may have holes
OUTSIDE = 0.5  # winding number below which a place is outside the body
STEPS = 9  # places on an edge of a rung where it is asked for


def without_rungs(found: Candidate, params: RobustParams) -> Candidate:
    """Return the curve without the rungs that lead through the air."""
    if not found.solid.trusted:
        return found
    rungs = _rungs(found)
    if not rungs:
        return found
    curve = _without(found.curve, rungs)
    rounds = max(1, params.rounds // 2)
    points, section = found.network.points, found.sections.section
    fit = fit_cones(curve, points, section, rounds=rounds, straightness=params.straightness)
    return replace(found, fit=fit)


def _without(curve: ConeCurve, rungs: list[Indices]) -> ConeCurve:
    """Return the curve with rungs cut in the middle, and each half taken into the node that it hangs on."""
    kept, into = np.ones(len(curve.edges), bool), np.arange(len(curve.nodes), dtype=np.int32)
    for path in rungs:
        half = len(path) // 2
        kept[(curve.edges == np.sort(path[half - 1 : half + 1])).all(axis=1)] = False
        into[path[:half]], into[path[half:]] = path[0], path[-1]
    return contract_nodes(replace(curve, edges=curve.edges[kept], bridged=curve.bridged[kept]), into)


def _rungs(found: Candidate) -> list[Indices]:
    curve = found.curve
    paths: dict[int, list[Indices]] = {}
    for path in curve.paths_from(ends=False):
        paths.setdefault(int(path[0]), []).append(path)
    rungs = []
    for path in curve.branches:
        ends = [int(path[0]), int(path[-1])]
        if ends[0] != ends[1] and all(len(paths.get(end, ())) == 3 for end in ends):
            arms = [[_arm(curve, arm) for arm in paths[end] if not np.isin(arm[1], path)] for end in ends]
            if all(len(pair) == 2 for pair in arms) and _apart(*arms) and _in_air(found, path):
                rungs.append(path)
    return rungs


def _in_air(found: Candidate, path: Indices) -> bool:
    """Tell whether a place on a path is outside the body."""
    nodes = found.curve.nodes[path]
    share = np.linspace(0, 1, STEPS)[:, None, None]
    places = (nodes[:-1] + share * np.diff(nodes, axis=0)).reshape(-1, 3)
    return bool(found.solid.oriented.winding_numbers(places).min() < OUTSIDE)


def _arm(curve: ConeCurve, path: Indices) -> tuple[Points, float]:
    """Return the places (a, 3) on a limb beside a joint that say where it goes, and its radius."""
    radius = float(np.median(curve.radii[path[1:]]))
    way = curve.along(path)
    return curve.nodes[path[(way >= ABOUT * radius) & (way <= ARM * radius)]], radius


def _apart(one: list[tuple[Points, float]], other: list[tuple[Points, float]]) -> bool:
    """Tell whether both limbs, of two arms each, go straight on, and pass each other closely without touching."""
    strands, radii = [], 0.0
    for (arm, radius), (opposite, its) in (one, other):
        if min(len(arm), len(opposite)) < 2 or not _straight(arm, opposite, SHORTEST * min(radius, its)):
            return False
        strands.append(strand(arm, opposite))
        radii += max(radius, its)
    return bool(radii < cdist(*strands).min() < CLOSE * radii)


def _straight(arm: Points, opposite: Points, least: float) -> bool:
    """Tell whether one arm goes on in the other's direction, both long enough to say so."""
    out = [places[-1] - places[0] for places in (arm, opposite)]
    lengths = [float(np.linalg.norm(way)) for way in out]
    return min(lengths) >= least and float(out[0] @ out[1]) <= -STRAIGHT * lengths[0] * lengths[1]
