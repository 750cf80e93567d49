"""Ends and the limbs they belong to: which are real, and how far they reach."""

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, with_nodes
from tiskel.methods.robust.fit import Feet, distances

BARELY = 1.0  # a limb that reaches no further from its joint, in the joint's radius, is none
CONTAINED = 1.15  # of a node's radius: balls within so much are part of its ball
STICKS_OUT = 0.5  # of the smaller of the limb's and the joint's radius: what a limb sticks out of the rest at least
STICKS_OUT_SPACINGS = 1.5
FARTHEST = 0.98  # quantile of its points that says how far
TIP_SHARE, TIP_LEAST = 0.05, 3  # the farthest points ahead of an end
AHEAD = 0.5  # cosine to the direction of the end
GROWS, GROWS_SPACINGS, GROWS_DEVIATIONS = 0.2, 1.0, 3.0  # the end does not reach the tip: in radii, and at least
TINY = np.finfo(float).tiny  # stands in for the radius of a node whose points lie on it
TAPER = 0.5, 0.9  # radius of a new tip in that of the end: the first guess, and at most


def without_stubs(curve: ConeCurve, points: Points) -> ConeCurve:
    """Contract, the shortest first, limbs whose points do not even leave the ball of their joint."""
    while True:
        stubs, degree, around = [], curve.degrees, curve.around()
        for path in curve.paths_from(ends=True):
            joint = int(path[-1])
            rows = np.flatnonzero(np.isin(curve.owner, path[:-1]))
            if degree[joint] > 2 and len(rows):
                others = [curve.radii[node] for node in around[joint] if node != path[-2]]
                radius = max(min(float(curve.radii[joint]), float(np.mean(others))), TINY)
                stubs.append((float(np.linalg.norm(points[rows] - curve.nodes[joint], axis=1).max()) / radius, path))
        shortest = min(stubs, key=lambda stub: (stub[0], int(stub[1][0])), default=None)
        if shortest is None or shortest[0] >= BARELY:
            return curve
        curve = _without(curve, shortest[1])


def without_contained_ends(curve: ConeCurve) -> ConeCurve:
    """Cut ends back to the innermost node whose ball holds the balls of all nodes after it.

    The sections of a round cap are such balls; its skeleton ends in the middle
    of the last full one.
    """
    into = np.arange(len(curve.nodes), dtype=np.int32)
    for path in curve.paths_from(ends=True):
        for last in range(len(path) - 2, 0, -1):
            reach = (
                np.linalg.norm(curve.nodes[path[:last]] - curve.nodes[path[last]], axis=1) + curve.radii[path[:last]]
            )
            if (reach <= CONTAINED * curve.radii[path[last]]).all():
                into[path[:last]] = path[last]
                break
    return contract_nodes(curve, into)


def without_explained_limb(curve: ConeCurve, points: Points, spacing: float) -> ConeCurve | None:
    """Contract the limb that sticks out least of what the rest of the curve explains; None where all do enough."""
    limbs, degree = [], curve.degrees
    for path in curve.paths_from(ends=True):
        if degree[path[-1]] > 2:
            radius = min(float(curve.radii[path[:-1]].max()), float(curve.radii[path[-1]]))
            asked = max(STICKS_OUT * radius, STICKS_OUT_SPACINGS * spacing)
            limbs.append((_protrusion(curve, points, path) / asked, path))
    least = min(limbs, key=lambda limb: (limb[0], int(limb[1][0])), default=None)
    return None if least is None or least[0] >= 1 else _without(curve, least[1])


def _protrusion(curve: ConeCurve, points: Points, path: Indices) -> float:
    """Return how far the points of a limb lie from the surface of the rest, 0 where it has none."""
    own = np.isin(curve.owner, path[:-1])
    near = curve.owner == path[-1]
    near[near] = np.linalg.norm(points[near] - curve.nodes[path[0]], axis=1) < 1.3 * curve.radii[path[0]]
    rows: Indices = np.flatnonzero(own | near).astype(np.int32)
    rest: Indices = np.flatnonzero(~np.isin(curve.edges, path[:-1]).any(axis=1)).astype(np.int32)
    if not len(rows):
        return 0.0
    if not len(rest):
        return np.inf
    return float(np.quantile(distances(curve, points, rows, rest), FARTHEST))


def with_tips(curve: ConeCurve, points: Points, at: Feet, spacing: float) -> ConeCurve | None:
    """Add a node where points lie further ahead of an end than its ball reaches; None where none do."""
    edges, least = curve.edges[at.edge], max(GROWS_SPACINGS * spacing, GROWS_DEVIATIONS * at.deviation)
    tips = []
    for path in curve.paths_from(ends=True):
        end = int(path[0])
        stands = ((edges[:, 0] == end) & (at.share == 0)) | ((edges[:, 1] == end) & (at.share == 1))
        mine = at.rows[stands | (curve.owner[at.rows] == end)]
        tip = _tip(points[mine] - curve.nodes[end], curve.heading(path))
        reach, radius = float(np.linalg.norm(tip)), float(curve.radii[end])
        if reach - radius > max(GROWS * radius, least):
            new = min(max(TAPER[0] * radius, 0.5 * spacing), TAPER[1] * radius)
            tips.append((end, curve.nodes[end] + tip * (1 - new / reach), new))
    if not tips:
        return None
    ends, nodes, radii = (np.array(column) for column in zip(*tips, strict=True))
    links = np.stack([ends, len(curve.nodes) + np.arange(len(ends))], axis=1)
    return with_nodes(curve, nodes, radii, links, curve.levels[ends])


def _tip(offsets: Points, direction: Numbers) -> Numbers:
    """Return the mean of the farthest offsets (p, 3) ahead, zero where there are too few."""
    distance = np.linalg.norm(offsets, axis=1)
    ahead = np.flatnonzero(offsets @ direction > AHEAD * distance * np.linalg.norm(direction))
    if len(ahead) < TIP_LEAST:
        return np.zeros(3)
    farthest = ahead[np.argsort(-distance[ahead], kind="stable")]
    return np.asarray(offsets[farthest[: max(TIP_LEAST, int(TIP_SHARE * len(ahead)))]].mean(axis=0))


def _without(curve: ConeCurve, path: Indices) -> ConeCurve:
    into = np.arange(len(curve.nodes), dtype=np.int32)
    into[path[:-1]] = path[-1]
    return contract_nodes(curve, into)
