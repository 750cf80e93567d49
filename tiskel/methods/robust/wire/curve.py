"""The curve of the limbs: where its nodes are, and what their radii are worth."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points
from tiskel.geometry.distinct import distinct
from tiskel.geometry.graph import tidy_edges
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.axes import sums
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.fit import fit_cones
from tiskel.methods.robust.wire.levels import Levels, widest_gaps
from tiskel.methods.robust.wire.limbs import Limbs
from tiskel.methods.trace import Sections
from tiskel.params import RobustParams

MEASURING = 8  # points that measure a radius, at least, over
TURN = np.pi  # half a turn about the limb: three points of a circle anywhere on it determine it, and noise with them
THICK = 1.0  # spacings in a radius, from which on a limb is a tube


def curve_of(
    points: Points, spacing: float, levels: Levels, limbs: Limbs, params: RobustParams
) -> tuple[ConeCurve, Sections]:
    """Return the curve with the nodes that limbs pass through, and its sections, one for each node."""
    roots = np.flatnonzero(levels.parents < 0)
    passed = np.union1d(limbs.edges.ravel(), roots)
    name = np.full(len(levels.centres), -1, np.int32)
    name[passed] = np.arange(len(passed), dtype=np.int32)
    section = np.append(name[limbs.owner], np.int32(-1))[levels.section]
    rows, count = np.flatnonzero(section >= 0), len(passed)
    label = section[rows]
    size = np.bincount(label, minlength=count)
    nodes = sums(points[rows], label, count) / size[:, None]
    order = np.sort(name[limbs.edges], axis=1)
    edges = tidy_edges(order)
    bridges = {tuple(edge) for edge, bridge in zip(order.tolist(), limbs.bridged, strict=True) if bridge}
    curve = ConeCurve(
        nodes=nodes, edges=edges, radii=np.zeros(count),
        bridged=np.array([tuple(edge) in bridges for edge in edges.tolist()], bool),
        levels=np.zeros(count, np.int32), node_of_section=np.append(np.arange(count), -1).astype(np.int32),
        section_sizes=size.astype(float),
    )  # fmt: skip
    curve = _with_radii(curve, points[rows], label, spacing)
    return _fitted(curve, points, section, params), Sections(section, np.where(section >= 0, 0, -1).astype(np.int32))


def _with_radii(curve: ConeCurve, points: Points, label: Indices, spacing: float) -> ConeCurve:
    """Return the curve with radii, what they are worth, and regimes; label (n,) is the node of each point."""
    count, offset = len(curve.nodes), _beside(curve, points, label)
    size = np.bincount(label, minlength=count)
    mean = np.bincount(label, np.linalg.norm(offset, axis=1), minlength=count) / np.maximum(size, 1)
    measured = (size >= MEASURING) & (widest_gaps(offset, curve.directions, label) < TURN)
    radii = np.where(measured, mean, bounds_of(curve, points, label))
    radii, sources = _modelled(curve, radii, measured)
    thick = measured & (radii > THICK * spacing)
    regimes = np.where(thick, Regime.TUBE, Regime.WIRE).astype(np.uint8)
    return replace(curve, radii=np.maximum(radii, TINY), radius_sources=sources, regimes=regimes)


def bounds_of(curve: ConeCurve, points: Points, label: Indices) -> Numbers:
    """Return (v,) how far points (n, 3) are from the line of their node or of its neighbours, at most."""
    most = np.zeros(len(curve.nodes))
    np.maximum.at(most, label, np.linalg.norm(_beside(curve, points, label), axis=1))
    return _even(curve, most)


def _beside(curve: ConeCurve, points: Points, label: Indices) -> Points:
    """Return the ways (n, 3) to points from the lines of the nodes that label (n,) names, at right angles to them."""
    offset, axis = points - curve.nodes[label], curve.directions[label]
    return np.asarray(offset - np.einsum("ij,ij->i", offset, axis)[:, None] * axis)


def _even(curve: ConeCurve, values: Numbers) -> Numbers:
    """Return the largest value of every node and its neighbours: one point less must not shrink a bound."""
    found: Numbers = values.copy()
    for one, other in (curve.edges.T, curve.edges[:, ::-1].T):
        np.maximum.at(found, one, values[other])
    return found


def _modelled(
    curve: ConeCurve, radii: Numbers, measured: Mask
) -> tuple[Numbers, np.ndarray[tuple[int], np.dtype[np.uint8]]]:
    """Return radii, interpolated between two measured nodes of a branch, and their sources."""
    radii, sources = radii.copy(), np.where(measured, RadiusSource.MEASURED, RadiusSource.BOUNDED).astype(np.uint8)
    for branch in curve.branches:
        known = np.flatnonzero(measured[branch])
        if len(known) < 2:
            continue
        way = curve.along(branch)
        inner = np.arange(known[0] + 1, known[-1])
        inner = inner[~measured[branch[inner]]]
        radii[branch[inner]] = np.interp(way[inner], way[known], radii[branch[known]])
        sources[branch[inner]] = RadiusSource.MODELLED
    return radii, sources


def _fitted(curve: ConeCurve, points: Points, section: Indices, params: RobustParams) -> ConeCurve:
    """Return the curve with round cones fitted where it is a tube; wires stay as they are, joined to it as before."""
    inside = np.flatnonzero(curve.regimes == Regime.TUBE)
    name = np.full(len(curve.nodes) + 1, -1, np.int32)
    name[inside] = np.arange(len(inside), dtype=np.int32)
    edges = name[curve.edges]
    edges = edges[(edges >= 0).all(axis=1)]
    if not len(edges):
        return curve
    part = ConeCurve(
        nodes=curve.nodes[inside], edges=edges, radii=curve.radii[inside], levels=curve.levels[inside],
        node_of_section=np.append(np.arange(len(inside)), -1).astype(np.int32),
        section_sizes=curve.section_sizes[inside],
    )  # fmt: skip
    fitted = fit_cones(part, points, name[section], rounds=params.rounds, straightness=params.straightness).curve
    nodes, radii = curve.nodes.copy(), curve.radii.copy()
    linked = distinct(edges)
    nodes[inside[linked]], radii[inside[linked]] = fitted.nodes[linked], fitted.radii[linked]
    return replace(curve, nodes=nodes, radii=radii)
