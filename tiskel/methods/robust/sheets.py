"""Sheets and one-sided scans: where the curve has to lie on what was seen.

The lines along the normals of an arc meet at its centre, and round cones fitted to
it have their axis there. Of a pipe with a third of its turn seen that is its axis.
Of a leaf, or of the front of a body in a depth image, it is a place in the air
behind a thing whose thickness nobody saw. Where the points of a node cover less
than that of the turn about it, the node goes to the middle of its points on the
sheet; its radius is half their width, a bound. Where the sensor is known, so does
a node that stands between it and its points: no body can be where it saw through.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.cycles import without_tight_cycles
from tiskel.methods.robust.fit import ConeFit, feet_of_own

# Found by trial on leaves, plants, fronts of bodies and pipes of which a third was seen.
TURN = np.radians(105)  # of the turn about a node that its points cover; less is a sheet, a third of a pipe 120 degrees
WIDER = np.radians(130)  # the same where the points are no circle: leaves bend by so much, chests of people too
MOSTLY = 0.3  # share of nodes on sheets, from which on half a turn is one, too: the cloud was seen from one side
CIRCLE = 0.97  # of the variance of the points' depth that a circle explains; of clean pipes 0.98 and more, leaves 0.96
MIDDLE = 0.9  # of a node's points, the middle by angle, that count: noise beside an arc does not widen it
FEWEST = 6  # points that tell the turn
NEAREST = 6  # points whose mean is the place on the sheet
WALL = 0.5  # half widths that a sheet is thick at most, for both its faces to be seen
BESIDE = 2.0  # spacings beside the way through a sheet, within which its faces are looked for
EVENED = 4  # rounds in which nodes between two others go half the way to the mean of these
WIDTH = 0.9  # quantile of the distance of its points across the curve: half the width
BEHIND = 0.9  # share of a node's points beyond it, from a known sensor, from which on the sensor saw through its place


def on_sheets(found: Candidate, seen_from: tuple[float, float, float] | None) -> Candidate:
    """Return the candidate with the nodes of sheets on them, and without the cycles that lie in a sheet."""
    curve, fit = found.curve, found.fit
    if not len(curve.edges) or (curve.regimes != Regime.UNKNOWN).any():
        return found
    points, owner = found.network.points[fit.rows], fit.nodes
    offset, sheet = _sheets(fit, found.network.points)
    if sheet.mean() > MOSTLY:
        sheet = _sheets(fit, found.network.points, np.pi)[1]
    if seen_from is not None:
        sheet |= _seen_through(points, offset, owner, len(curve.nodes), found.network.placed(seen_from))
    if not sheet.any():
        return found
    nodes, radii = _middles(found, offset, np.flatnonzero(sheet).astype(np.int32))
    regimes = np.where(sheet, Regime.SHEET, Regime.TUBE).astype(np.uint8)
    laid = replace(curve, nodes=nodes, radii=radii, regimes=regimes)
    laid = without_tight_cycles(laid)
    return replace(found, fit=feet_of_own(laid, found.network.points, found.sections.section))


def flat_share(found: Candidate) -> float:
    """Return the share of the nodes of a candidate that lie on sheets."""
    return float(sheet_nodes(found.fit, found.network.points).mean()) if len(found.curve.edges) else 0.0


def sheet_nodes(fit: ConeFit, points: Points) -> Mask:
    """Return (v,) which nodes of a curve that was fitted to points (n, 3) are on sheets."""
    return _sheets(fit, points)[1]


def _sheets(fit: ConeFit, points: Points, wider: float = WIDER) -> tuple[Points, Mask]:
    """Return the offsets (p, 3) of the points across the curve, and which nodes are on sheets.

    wider is the turn below which points that are no circle are a sheet.
    """
    curve = fit.curve
    offset = _across(curve, points[fit.rows] - curve.nodes[fit.nodes], fit.nodes)
    turns, circle = _turns(offset, fit.nodes, len(curve.nodes)), _roundness(offset, fit.nodes, len(curve.nodes))
    return offset, _agreed(curve, (turns < TURN) | ((turns < wider) & (circle < CIRCLE)))


def _across(curve: ConeCurve, offset: Points, owner: Indices) -> Points:
    """Return offsets (n, 3) from nodes without their share along the curve."""
    axis = curve.directions[owner]
    return np.asarray(offset - np.einsum("ij,ij->i", offset, axis)[:, None] * axis)


def _turns(offset: Points, owner: Indices, count: int) -> Numbers:
    """Return (v,) how much of the turn about each node its points cover, the middle of them; pi and more where few."""
    cosine = np.einsum("ij,ij->i", offset, _looks(offset, owner, count)[owner])
    cosine /= np.maximum(np.linalg.norm(offset, axis=1), TINY)
    angle = np.arccos(np.clip(cosine, -1, 1))  # to the middle of the arc, on either side
    order = np.lexsort((angle, owner))
    size = np.bincount(owner, minlength=count)
    starts = np.cumsum(size) - size
    place = np.minimum(starts + np.ceil(MIDDLE * size).astype(int), starts + np.maximum(size - 1, 0))
    turn = np.full(count, 2 * np.pi)
    known = size >= FEWEST
    turn[known] = 2 * angle[order][place[known]]
    return turn


def _looks(offset: Points, owner: Indices, count: int) -> Points:
    """Return (v, 3) the direction of the middle of the points of each node."""
    total = np.stack([np.bincount(owner, column, minlength=count) for column in offset.T], axis=1)
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1), TINY)[:, None])


def _roundness(offset: Points, owner: Indices, count: int) -> Numbers:
    """Return (v,) the share of the variance of the depth of each node's points that a circle about it explains."""
    size = np.maximum(np.bincount(owner, minlength=count), 1)
    depth, away = np.einsum("ij,ij->i", offset, _looks(offset, owner, count)[owner]), np.linalg.norm(offset, axis=1)

    def variance(values: Numbers) -> Numbers:
        mean = np.bincount(owner, values, minlength=count) / size
        return np.asarray(np.bincount(owner, (values - mean[owner]) ** 2, minlength=count) / size)

    return np.asarray(1 - variance(away) / np.maximum(variance(depth), TINY))


def _agreed(curve: ConeCurve, sheet: Mask) -> Mask:
    """Return which nodes are on a sheet by the majority of themselves and their neighbours."""
    votes: Numbers = sheet.astype(float)
    voters: Numbers = np.ones(len(sheet))
    for one, other in (curve.edges.T, curve.edges[:, ::-1].T):
        votes += np.bincount(one, sheet[other], minlength=len(sheet))
        voters += np.bincount(one, minlength=len(sheet))
    return np.asarray(votes > voters / 2)


def _seen_through(points: Points, offset: Points, owner: Indices, count: int, sensor: Numbers) -> Mask:
    """Tell which nodes stand between the sensor and their points: what it saw through is the air."""
    behind = np.einsum("ij,ij->i", sensor - points, offset) < 0
    size = np.bincount(owner, minlength=count)
    enough = (size >= FEWEST) & (np.bincount(owner, behind, minlength=count) >= BEHIND * size)
    return np.asarray(enough & (_turns(offset, owner, count) < np.pi))


def _middles(found: Candidate, offset: Points, sheets: Indices) -> tuple[Points, Numbers]:
    """Return all nodes and radii, those of sheets in the middle of their points on the sheet, and half their width.

    Between two others they are evened: what points are a node's was found with a curve that bends to and fro.
    """
    curve, owner = found.curve, found.fit.nodes
    nodes, radii = curve.nodes.copy(), curve.radii.copy()
    order = np.argsort(owner, kind="stable")
    stops = np.searchsorted(owner[order], np.arange(len(nodes) + 1))
    own = {node: rows for node in sheets.tolist() if len(rows := order[stops[node] : stops[node + 1]])}
    for node, rows in own.items():
        middle = offset[rows].mean(axis=0)
        nodes[node] = curve.nodes[node] + middle
        radii[node] = max(float(np.quantile(np.linalg.norm(offset[rows] - middle, axis=1), WIDTH)), TINY)
    inner = np.isin(np.arange(len(nodes)), sheets) & (curve.degrees == 2)
    for _ in range(EVENED):
        nodes = curve.halfway(nodes, inner)
    return _laid(found, nodes, radii, sheets), radii


def _laid(found: Candidate, nodes: Points, radii: Numbers, sheets: Indices) -> Points:
    """Return the nodes, those of sheets at the nearest points, or between both faces of it where both were seen."""
    points, normals, spacing = found.network.points, found.network.normals, found.network.spacing
    tree, out = cKDTree(points), nodes.copy()
    nearest = np.reshape(tree.query(nodes[sheets], k=min(NEAREST, len(points)))[1], (len(sheets), -1))
    for node, rows in zip(sheets.tolist(), nearest, strict=True):
        place = points[rows].mean(axis=0)
        across = np.linalg.eigh(normals[rows].T @ normals[rows])[1][:, -1]
        about = np.array(tree.query_ball_point(place, WALL * radii[node], return_sorted=True), np.int32)
        offset = points[about] - place
        height = offset @ across
        beside = ((offset**2).sum(axis=1) - height**2) < (BESIDE * spacing) ** 2
        if beside.any():
            place += across * (height[beside].min() + height[beside].max()) / 2
        out[node] = place
    return np.asarray(out)
