"""Nodes to the middle of the body's section across the curve, seen from where they are."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY, Indices, Lists, Mask, Masks, Numbers, Points, Stack, Table
from tiskel.geometry.body import Body
from tiskel.geometry.frames import unit
from tiskel.methods.robust.curve import ConeCurve

# Found by trial on generated bodies: blocks and plates with holes, torsos, flat tubes, rings of rings.
ROUNDS = 4  # of evening and centring
RAYS = 16  # directions across the curve
REACH = 6.0  # clearances that a ray reaches at most: a section that is wider is no section of one limb
CLOSED = 0.85  # share of the rays that get to the surface, at least
WIDE = 1.6  # of the shortest ray, that rays are long in the mean, from which on a section is not round about a node
PLACES = 6  # where a ray is probed, on each clearance of its reach
FURTHEST = 0.5  # clearances that a node moves in a round at most
KEPT = 0.9  # of the clearance, that a move leaves at least
TURN = np.arange(RAYS) * (2 * np.pi / RAYS)


def centred(curve: ConeCurve, body: Body, reach: float = REACH) -> ConeCurve:
    """Return the curve evened, and its nodes between two others in the middle of the body's section there.

    reach is how many clearances rays across the curve reach at most.
    """
    triples = curve.passages
    triples = triples[free(curve, triples[:, 1])]
    nodes, inner = curve.nodes, curve.degrees > 1
    for _ in range(ROUNDS):
        nodes = _kept(nodes, curve.halfway(nodes, inner), body)
        middles = nodes.copy()
        middles[triples[:, 1]] = _section(nodes, triples, body, reach)[0]
        nodes = _kept(nodes, middles, body)
    radii = np.where(inner, np.maximum(body.clearance_at(nodes), body.step / 2), curve.radii)
    return replace(curve, nodes=nodes, radii=radii)


def not_round(curve: ConeCurve, body: Body) -> Mask:
    """Return (v,) which nodes no ball can be fitted at: in the balls of joints, and where the section is not round.

    That of an end is taken for the one before it.
    """
    triples = curve.passages
    rows = triples[:, 1]
    out = curve.degrees > 2
    out[rows] = ~free(curve, rows) | (_section(curve.nodes, triples, body, REACH)[1] > WIDE)
    for tip in np.flatnonzero(curve.degrees == 1).tolist():
        out[tip] = out[curve.neighbours[tip][0]]
    return out


def free(curve: ConeCurve, rows: Indices) -> Mask:
    """Return which nodes are outside the balls of the joints, where sections are those of more than one limb."""
    joints = np.flatnonzero(curve.degrees > 2)
    away = np.linalg.norm(curve.nodes[rows, None] - curve.nodes[joints], axis=2) - curve.radii[joints]
    return np.asarray(away.min(axis=1, initial=np.inf) > 0)


def _kept(nodes: Points, moved: Points, body: Body) -> Points:
    """Return the nodes where they moved to, as far as the clearance allows."""
    clear = body.clearance_at(nodes)
    move = moved - nodes
    move *= np.minimum(1, FURTHEST * clear / np.maximum(np.linalg.norm(move, axis=1), TINY))[:, None]
    good = body.clearance_at(nodes + move) >= KEPT * clear
    return np.asarray(nodes + np.where(good[:, None], move, 0))


def _section(nodes: Points, triples: Lists, body: Body, reach: float) -> tuple[Points, Numbers]:
    """Return the centroid (t, 3) of what is seen of the body's section about the middle one of three nodes.

    And how long rays to its surface are in the mean, in the shortest. Where too
    many rays do not get there, the node stays where it is.
    """
    rays, length, ends = rays_across(nodes, triples, body, reach)
    weight = np.maximum((length**2).sum(axis=1), TINY)
    move = (2 / 3) * ((length**3)[..., None] * rays).sum(axis=1) / weight[:, None]
    closed = ends.mean(axis=1) > CLOSED
    wide = length.mean(axis=1) / np.maximum(length.min(axis=1), TINY)
    return nodes[triples[:, 1]] + np.where(closed[:, None], move, 0), wide


def rays_across(nodes: Points, triples: Lists, body: Body, reach: float) -> tuple[Stack, Table, Masks]:
    """Return rays (t, RAYS, 3) across the curve about the middle ones of three nodes, how long, and which end."""
    before, here, after = nodes[triples.T]
    directions = unit(after - before)
    u = unit(np.cross(directions, np.eye(3)[np.abs(directions).argmin(axis=1)]))
    v = np.cross(directions, u)
    rays = np.cos(TURN)[:, None] * u[:, None] + np.sin(TURN)[:, None] * v[:, None]
    return rays, *ray_lengths(here, rays, body, reach)


def ray_lengths(places: Points, rays: Stack, body: Body, reach: float) -> tuple[Table, Masks]:
    """Return (q, r) how far it is along rays (q, r, 3) to the surface, and which get there within reach clearances."""
    far, count = np.maximum(reach * body.clearance_at(places), 2 * body.step), round(reach * PLACES)
    share = np.arange(1, count + 1) / count
    way = far[:, None] * share
    probes = places[:, None, None] + rays[:, :, None] * way[:, None, :, None]
    depth = body.winding_at(probes.reshape(-1, 3)).reshape(*rays.shape[:2], count)
    out = depth < body.level
    ends = out.any(axis=2)
    first = np.where(ends, out.argmax(axis=2), count - 1)[..., None]
    after, before = (np.take_along_axis(depth, np.maximum(first - back, 0), axis=2)[..., 0] for back in (0, 1))
    back = np.clip((body.level - after) / np.maximum(before - after, TINY), 0, 1) * ends
    return np.asarray((first[..., 0] + 1 - back) / count * far[:, None]), np.asarray(ends)
