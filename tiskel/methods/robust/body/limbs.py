"""Limbs of a body: which branches of its thinned curve are limbs, and where they meet."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY, Edges, Indices, Numbers, Points
from tiskel.geometry.body import Body
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, keeps_loops, without_path

# Found by trial on generated bodies: blocks and plates with holes, torsos, flat tubes, rings of rings.
STICKS_OUT = 1.0  # own radii that a limb sticks out of the ball of its joint at least
KEEPS = 0.5  # own radii that the middle of a limb goes on for, outside the ball of its joint
TAPERS = 0.45  # of the way that the clearance falls by: the corner of a block has 0.58, its edge 0.71, a horn less
BESIDE = -0.8  # cosine between two branches at a joint from which on they may be one limb, up to 143 degrees
WEB = 0.6  # of the smaller clearance at both ends: with so much all along the way there is no gap between two branches
FULL = 0.8  # of a limb's median radius, that its last full ball has
AS_LONG = 0.7  # of a branch, that another one is at least, to be held against it
PROBES = np.linspace(0, 1, 11)[1:-1]  # where such a way is probed
SHARED = 0.95  # of the larger clearance of two branches, that the middle between them has where they are one
ALIKE = 0.0  # cosine between two branches that may be one, up to 90 degrees


def without_corners(curve: ConeCurve, body: Body) -> ConeCurve:
    """Contract, the one that sticks out least first, the branches that are no limbs."""
    while True:
        corners = []
        paths = curve.paths_from(ends=False)
        for path in paths:
            if curve.degrees[path[-1]] == 1:
                out = _sticking_out(curve, path)
                if not (_is_limb(curve, path, out, body.step) and not in_web(curve, path, paths, body)):
                    corners.append((float(out.max()), int(path[-1]), path))
        if not corners:
            return curve
        curve = without_path(curve, min(corners, key=lambda corner: corner[:2])[2][::-1])


def _sticking_out(curve: ConeCurve, path: Indices) -> Numbers:
    """Return how far the balls along a path from a joint stick out of the joint's ball."""
    away = np.linalg.norm(curve.nodes[path] - curve.nodes[path[0]], axis=1)
    return np.asarray(away + curve.radii[path] - curve.radii[path[0]])


def _is_limb(curve: ConeCurve, path: Indices, out: Numbers, step: float) -> bool:
    """Tell whether a branch from a joint sticks out by its own radius, and keeps its thickness for a while."""
    radii = curve.radii[path]
    beyond = np.flatnonzero(out > radii)  # centres outside the ball of the joint
    if not len(beyond) or out.max() < STICKS_OUT * radii[beyond].max():
        return False
    way, last, first = curve.along(path), len(path) - 1, int(beyond[0])
    long_enough = bool((way[last] - way[beyond] >= np.maximum(KEEPS * radii[beyond], 2 * step)).any())
    return long_enough and bool(radii[first] - radii[last] < TAPERS * (way[last] - way[first]))


def in_web(curve: ConeCurve, path: Indices, paths: list[Indices], body: Body) -> bool:
    """Tell whether there is no gap between a branch and another one from its joint: both are in one flat part."""
    radii = curve.radii[path]
    beyond = radii[_sticking_out(curve, path) > radii]
    if not len(beyond):  # all of it is in the ball of its joint
        return True
    own = float(np.median(beyond))
    if own == 0:  # outside the body, or too thin for its grid
        return False
    last = int(np.flatnonzero(radii >= FULL * own)[-1])
    joint, tip, length = curve.nodes[path[0]], curve.nodes[path[last]], float(curve.along(path)[last])
    for other in paths:
        if other[0] != path[0] or other[1] == path[1]:
            continue
        way = curve.along(other)
        if way[-1] > AS_LONG * length:
            node = int(other[min(int(np.searchsorted(way, length)), len(other) - 1)])
            if _cosine(tip - joint, curve.nodes[node] - joint) > BESIDE:
                probes = tip + PROBES[:, None] * (curve.nodes[node] - tip)
                least = WEB * min(own, float(curve.radii[node]))
                if least > 0 and (body.clearance_at(probes) >= least).all():
                    return True
    return False


def _cosine(one: Numbers, other: Numbers) -> float:
    return float(one @ other) / max(float(np.linalg.norm(one) * np.linalg.norm(other)), TINY)


def zipped(curve: ConeCurve, body: Body) -> ConeCurve:
    """Join branches that leave a joint side by side, as far as the middle between them is as deep in the body.

    A wide body is thinned along the shortest ways to its middle; the limbs on
    either side of it meet where it is widest. Their joint belongs where they part.
    """
    for _ in range(len(curve.branches)):
        found = _longest_zip(curve, body)
        if found is None:
            break
        into, kept, middles = found
        nodes = curve.nodes.copy()
        nodes[kept] = middles
        curve = contract_nodes(replace(curve, nodes=nodes, radii=_with(curve.radii, kept, body, middles)), into)
    return curve


def _with(radii: Numbers, rows: Indices, body: Body, places: Points) -> Numbers:
    radii = radii.copy()
    radii[rows] = body.clearance_at(places)
    return radii


def _longest_zip(curve: ConeCurve, body: Body) -> tuple[Indices, Indices, Points] | None:
    best: tuple[float, Indices, Indices, Points] | None = None
    paths = curve.paths_from(ends=False)
    for number, one in enumerate(paths):
        for other in paths[:number]:
            if one[0] == other[0] and one[1] != other[1]:
                found = _zip(curve, one, other, body)
                if found is not None and (best is None or found[0] > best[0]):
                    best = found
    return None if best is None else best[1:]


def _zip(curve: ConeCurve, one: Indices, other: Indices, body: Body) -> tuple[float, Indices, Indices, Points] | None:
    """Return how far two branches from a joint are one, who takes whose place, and where these go."""
    ways = [curve.along(path) for path in (one, other)]
    pairs = _side_by_side(ways[0], ways[1], min(_limit(curve, one, ways[0]), _limit(curve, other, ways[1])))
    if len(pairs) < 2:
        return None
    first, second = one[pairs[:, 0]], other[pairs[:, 1]]
    middles = (curve.nodes[first] + curve.nodes[second]) / 2
    joint = curve.nodes[one[0]]
    shared = body.clearance_at(middles) >= SHARED * np.maximum(curve.radii[first], curve.radii[second])
    shared &= np.einsum("ij,ij->i", curve.nodes[first] - joint, curve.nodes[second] - joint) > ALIKE
    last = len(shared) if shared.all() else int(shared.argmin())
    if last < 2:
        return None
    into = np.arange(len(curve.nodes), dtype=np.int32)
    into[second[:last]] = first[:last]
    into[first[:last]] = first[:last]
    kept, once = np.unique(first[:last], return_index=True)
    if not keeps_loops(curve, into):
        return None
    return float(ways[0][pairs[last - 1, 0]]), into, kept, middles[:last][once]


def _limit(curve: ConeCurve, path: Indices, way: Numbers) -> float:
    """Return how far along a path from a joint it may be joined to another: a limb in full, half the way to a joint."""
    return float(way[-1]) / (2 if curve.degrees[path[-1]] > 2 else 1)


def _side_by_side(one: Numbers, other: Numbers, limit: float) -> Edges:
    """Return pairs (p, 2) of places along two ways, a step along one of them or both from pair to pair."""
    i, j = 0, 0
    pairs: list[tuple[int, int]] = []
    while True:
        following = [(i + 1, j + 1), (i + 1, j), (i, j + 1)]
        there = [(a, b) for a, b in following if a < len(one) and b < len(other) and max(one[a], other[b]) < limit]
        if not there:
            return np.array(pairs, np.int32).reshape(-1, 2)
        i, j = min(there, key=lambda pair: (abs(one[pair[0]] - other[pair[1]]), -sum(pair)))
        if i > 0 and j > 0:
            pairs.append((i, j))
