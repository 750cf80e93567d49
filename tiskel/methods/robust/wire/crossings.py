"""Crossings: two wires that pass each other closely, and hang together in a graph of neighbours.

About a place where they pass, a graph of neighbours leads from one wire to the other. Each goes straight on there, so
that a curve through the arms at both sides, without what lies between, says where a wire passes. Where the two curves
are further apart than the points are, the wires do not touch. Where they are not, the wires are joined, as in a
lattice.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from tiskel.arrays import TINY, Indices, Mask, Points
from tiskel.geometry.graph import component_labels, edge_keys
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.wire.links import Links

# In spacings of the points along the wires, by trial on wires that cross one to three spacings apart at 30 to 90
# degrees, and on lattices.
ABOUT = 3.0  # about a joint: what lies so near is of either wire
ARM = 12.0  # length of an arm that says where its wire goes
SHORTEST = 4.0  # the same at least
APART = 1.0  # between two wires that pass, at least
STRAIGHT = np.cos(np.radians(30))  # of what an arm goes on in, at least
FEWEST = 4  # nodes of an arm
SAMPLES = 200  # on a strand


@dataclass(frozen=True, eq=False)
class Crossing:
    """Two strands (q, 3) each that pass each other, from arm to arm."""

    one: Points
    other: Points


def parted(links: Links, points: Points, found: list[Crossing]) -> Links:
    """Return the links without those that lead from one strand of a crossing to the other.

    A scan may have a gap where wires pass each other, so that links lead over it by way of the other wire alone: along
    each strand there is one over its widest gap.
    """
    kept, added = np.ones(len(links.first), bool), set[tuple[int, int]]()
    for crossing in found:
        strand, place = _strands(points, crossing, ABOUT * links.spacing)
        first, second = strand[links.first], strand[links.second]
        kept &= (first == 0) | (second == 0) | (first == second)
        added |= {pair for side in (1, -1) for pair in _over_gap(strand == side, place)}
    first, second, lengths = links.first[kept], links.second[kept], links.lengths[kept]
    new = np.array(sorted(added), np.int32).reshape(-1, 2)
    new = new[~np.isin(edge_keys(new), edge_keys(np.stack([first, second], axis=1)))]
    apart = np.maximum(np.linalg.norm(points[new[:, 0]] - points[new[:, 1]], axis=1), TINY)
    return replace(
        links, first=np.concatenate([first, new[:, 0]]), second=np.concatenate([second, new[:, 1]]),
        lengths=np.concatenate([lengths, apart]),
    )  # fmt: skip


def _strands(points: Points, crossing: Crossing, reach: float) -> tuple[Indices, Indices]:
    """Return (n,) the strand that each point is on, 1 or -1, 0 where it is near to neither, and where along it."""
    (one, along_one), (other, along_other) = (
        cKDTree(strand).query(points, distance_upper_bound=reach) for strand in (crossing.one, crossing.other)
    )
    strand = np.where(np.isinf(np.minimum(one, other)), 0, np.where(one <= other, 1, -1))
    return strand, np.where(strand > 0, along_one, along_other)


def _over_gap(on: Mask, place: Indices) -> list[tuple[int, int]]:
    """Return the two points of a strand (n,) at the sides of its widest gap, both ways; places (n,) are along it."""
    rows = np.flatnonzero(on)
    if len(rows) < 2:
        return []
    rows = rows[np.argsort(place[rows], kind="stable")]
    gap = int(np.diff(place[rows]).argmax())
    one, other = int(rows[gap]), int(rows[gap + 1])
    return [(one, other), (other, one)]


def crossings_of(curve: ConeCurve, spacing: float) -> list[Crossing]:
    """Return the crossings of a curve at whose joints two wires pass each other, apart."""
    found = [_crossing(arms, spacing) for arms in _joints(curve, spacing)]
    return [crossing for crossing in found if crossing is not None]


def _joints(curve: ConeCurve, spacing: float) -> list[list[Points]]:
    """Return for every joint of four arms the places (a, 3) on each, from near the joint outwards.

    Junctions that a short branch links are one joint.
    """
    paths = curve.paths_from(ends=False)
    length = [curve.along(path) for path in paths]
    short = [path[[0, -1]] for path, way in zip(paths, length, strict=True) if way[-1] <= 2 * ABOUT * spacing]
    linked = np.array([pair for pair in short if (curve.degrees[pair] > 2).all()], np.int32).reshape(-1, 2)
    joint = component_labels(len(curve.nodes), linked)
    arms: dict[int, list[Points]] = {}
    for path, way in zip(paths, length, strict=True):
        if joint[path[0]] != joint[path[-1]]:
            on = (way >= ABOUT * spacing) & (way <= (ABOUT + ARM) * spacing)
            arms.setdefault(int(joint[path[0]]), []).append(curve.nodes[path[on]])
    return [sides for _, sides in sorted(arms.items()) if len(sides) == 4]


def _crossing(arms: list[Points], spacing: float) -> Crossing | None:
    """Return the two strands of four arms, None where the arms do not go straight on in pairs, or meet."""
    if min(map(len, arms)) < FEWEST or min(np.linalg.norm(arm[-1] - arm[0]) for arm in arms) < SHORTEST * spacing:
        return None
    way = [arm[-1] - arm[0] for arm in arms]
    out = [step / np.linalg.norm(step) for step in way]
    pairings = [((0, 1), (2, 3)), ((0, 2), (1, 3)), ((0, 3), (1, 2))]
    straight = [min(-float(out[a] @ out[b]) for a, b in pairing) for pairing in pairings]
    best = int(np.argmax(straight))
    if straight[best] < STRAIGHT:
        return None
    one, other = (strand(arms[a], arms[b]) for a, b in pairings[best])
    return Crossing(one, other) if cdist(one, other).min() > APART * spacing else None


def strand(arm: Points, opposite: Points) -> Points:
    """Return places (q, 3) on the curve of second degree through two arms, from the end of one to that of the other."""
    places = np.concatenate([arm, opposite])
    way = opposite.mean(axis=0) - arm.mean(axis=0)
    along = (places - places.mean(axis=0)) @ way / (way @ way)
    powers = np.linalg.lstsq(np.vander(along, 3), places, rcond=None)[0]
    return np.asarray(np.vander(np.linspace(along.min(), along.max(), SAMPLES), 3) @ powers)
