"""Wide limbs: the middle line of one that is flat, where thinning leaves any line through its middle sheet.

A line that bends to and fro within a flat limb has its sections askew, and goes
to the middle of these. Its nodes are taken further apart, as its width asks for,
and it ends in the middle of the limb's end rather than in one of its corners.
"""

from dataclasses import replace

import numpy as np

from tiskel.arrays import Indices, Numbers
from tiskel.geometry.body import Body
from tiskel.geometry.frames import unit
from tiskel.methods.robust.body.centres import RAYS, centred, free, ray_lengths, rays_across
from tiskel.methods.robust.body.strands import evened
from tiskel.methods.robust.curve import ConeCurve, contract_nodes

# Found by trial on flat tubes, straps, bands, plates with holes and scans of bodies.
WIDE = 2.0  # times the shortest way through the body across the curve, that the longest is from which on a limb is wide
REACH = 12.0  # clearances that half a width is at most
LEAST = 4  # nodes of a limb that are left when its ends are cut
MOSTLY = 0.5  # of the nodes of a limb that are wide, from which on it is


def middle_lines(curve: ConeCurve, body: Body) -> ConeCurve:
    """Return the curve with its wide limbs along their middle lines."""
    widths = _half_widths(curve, body)
    if not (widths > curve.radii).any():
        return curve
    curve, widths = _without_corners(*_without_offshoots(curve, widths))
    return _with_ends(centred(evened(curve, body, widths), body, REACH), body)


def _half_widths(curve: ConeCurve, body: Body) -> Numbers:
    """Return (v,) half the longest way through the body across wide limbs of the curve, elsewhere the radius."""
    triples = curve.passages
    triples = triples[free(curve, triples[:, 1])]
    length, ends = rays_across(curve.nodes, triples, body, REACH)[1:]
    half = (length[:, : RAYS // 2] + length[:, RAYS // 2 :]) / 2
    wide = (half.max(axis=1) > WIDE * half.min(axis=1)) & ends.all(axis=1)
    found, widths = curve.radii.copy(), curve.radii.copy()
    found[triples[wide, 1]] = half[wide].max(axis=1)
    for branch in curve.branches:
        if (found[branch] > curve.radii[branch]).mean() > MOSTLY:
            widths[branch] = found[branch]
    return np.asarray(widths)


def _without_offshoots(curve: ConeCurve, widths: Numbers) -> tuple[ConeCurve, Numbers]:
    """Return the curve without branches of wide limbs that stay within half the width of these."""
    into = np.arange(len(curve.nodes), dtype=np.int32)
    limbs = [(path, float(np.median(widths[path]))) for path in curve.paths_from(ends=False)]
    for path in curve.paths_from(ends=True):
        others = [width for limb, width in limbs if limb[0] == path[-1] and limb[1] != path[-2]]
        if len(others) == 2 and curve.along(path)[-1] < min(others):
            into[path[:-1]] = path[-1]
    return _contracted(curve, widths, into)


def _contracted(curve: ConeCurve, widths: Numbers, into: Indices) -> tuple[ConeCurve, Numbers]:
    return contract_nodes(curve, into), widths[into == np.arange(len(into))]


def _wide_limbs(curve: ConeCurve, widths: Numbers) -> list[tuple[Indices, float]]:
    """Return the branches, from their ends, that are wide, and half the width of each."""
    found = []
    for path in curve.paths_from(ends=True):
        wide = widths[path] > curve.radii[path]
        if wide.any():  # then most of it is
            found.append((path, float(np.median(widths[path[wide]]))))
    return found


def _without_corners(curve: ConeCurve, widths: Numbers) -> tuple[ConeCurve, Numbers]:
    """Return the curve without the ends of wide limbs, half their width long: there it turns into a corner."""
    into = np.arange(len(curve.nodes), dtype=np.int32)
    for path, width in _wide_limbs(curve, widths):
        last = int(np.searchsorted(curve.along(path), width))
        if 2 * last <= len(path) - LEAST:
            into[path[:last]] = path[last]
    return _contracted(curve, widths, into)


def _with_ends(curve: ConeCurve, body: Body) -> ConeCurve:
    """Return the curve with the ends of wide limbs straight ahead, a radius before the surface of the body."""
    paths = [path for path, _ in _wide_limbs(curve, _half_widths(curve, body))]
    if not paths:
        return curve
    ends = np.array([path[0] for path in paths])
    ahead = unit(np.array([curve.heading(path) for path in paths]))
    way, there = ray_lengths(curve.nodes[ends], ahead[:, None], body, REACH)
    move = np.where(there[:, 0], np.maximum(way[:, 0] - curve.radii[ends], 0), 0)
    nodes, radii = curve.nodes.copy(), curve.radii.copy()
    nodes[ends] += move[:, None] * ahead
    radii[ends] = np.maximum(body.clearance_at(nodes[ends]), body.step / 2)
    return replace(curve, nodes=nodes, radii=radii)
