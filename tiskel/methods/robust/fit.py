"""Round cones fitted to a cloud: where nodes and radii have to be, so that the surface passes through the points.

The residual of a point is its distance to the foot on its edge less the radius
there. Least squares over all points (Gauss-Newton; Huber weights), with nodes
held to the line of their neighbours and radii to the mean of theirs. Arcs and
caps determine their circles and balls, so that scans with holes are centred and
ends come to lie in the middle of the last ball.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry import graph
from tiskel.geometry.solve import BACKENDS
from tiskel.methods.robust.curve import ConeCurve

STRAIGHT, EVEN = 0.1, 0.3  # weights of straightness and of even radii, each per node as heavy as its share of points
DAMPING, HOLD = 0.01, 0.005  # weights of a step, and of the place where the fit began
OUTLYING = 2.0  # residuals beyond so many deviations count less
MAD = 1.4826  # of the median absolute deviation: the standard deviation of a normal distribution
HOPS = 2  # edges so near to a point's own node may be its edge
STEP, SHRINK, GROW, THINNEST = 0.5, 0.5, 2.0, 0.1  # limits of a step, in radii; least radius, in the median radius


@dataclass(frozen=True)
class Feet:
    """Where points stand on a curve.

    Attributes
    ----------
    rows : (p,) their rows in the cloud; edge : (p,); share : (p,) of the way along it.
    residual : (p,) distance to the surface of the cone, negative inside.
    """

    rows: Indices
    edge: Indices
    share: Numbers
    residual: Numbers

    @property
    def deviation(self) -> float:
        """The robust standard deviation of the residuals."""
        return MAD * float(np.median(np.abs(self.residual))) if len(self.rows) else 0.0

    def places(self, curve: ConeCurve) -> Points:
        """Return the feet (p, 3)."""
        first, last = curve.edges[self.edge].T
        return np.asarray(curve.nodes[first] + self.share[:, None] * (curve.nodes[last] - curve.nodes[first]))

    def radii(self, curve: ConeCurve) -> Numbers:
        """Return (p,) the radii of the cones there."""
        first, last = curve.edges[self.edge].T
        return np.asarray((1 - self.share) * curve.radii[first] + self.share * curve.radii[last])

    def node(self, curve: ConeCurve) -> Indices:
        """Return (p,) the nearer end of the edge."""
        return np.asarray(curve.edges[self.edge, (self.share > 0.5).astype(int)])


def fit_cones(curve: ConeCurve, points: Points, rounds: int) -> tuple[ConeCurve, Feet]:
    """Return the curve fitted to the points (n, 3) of the cloud, and their feet on it."""
    if len(curve.edges) == 0:
        none = np.zeros(0)
        return curve, Feet(none.astype(np.int32), none.astype(np.int32), none, none)
    nearby = nearby_edges(curve)
    owned = np.flatnonzero(curve.owner >= 0)
    rows: Indices = owned[(nearby[curve.owner[owned]] >= 0).any(axis=1)].astype(np.int32)
    lists, start = curve.owner[rows], curve.nodes
    thinnest = THINNEST * np.median(curve.radii)
    curve = replace(curve, radii=np.maximum(curve.radii, thinnest))
    for _ in range(rounds):
        step = _step(curve, points, feet(curve, points, rows, lists, nearby), start)
        length = np.linalg.norm(step[:, :3], axis=1)
        within = np.minimum(1, STEP * curve.radii / np.maximum(length, np.finfo(float).tiny))
        radii = np.clip(
            curve.radii + step[:, 3], np.maximum(SHRINK * curve.radii, thinnest), GROW * curve.radii
        )  # fmt: skip
        curve = replace(curve, nodes=curve.nodes + within[:, None] * step[:, :3], radii=radii)
    return curve, feet(curve, points, rows, lists, nearby)


def nearby_edges(curve: ConeCurve) -> Indices:
    """Return (v, w) the edges within a few hops of each node, padded with -1."""
    count, edges = len(curve.nodes), curve.edges
    number = np.tile(np.arange(len(edges)), 2)
    ends = edges.T.ravel()
    incidence = sparse.coo_array((np.ones(len(ends)), (ends, number)), shape=(count, len(edges))).tocsr()
    near = incidence
    for _ in range(HOPS):
        near = sparse.csr_array(incidence @ (incidence.T @ near))
    near.sort_indices()
    sizes = np.diff(near.indptr)
    out = np.full((count, max(1, int(sizes.max(initial=1)))), -1, np.int32)
    out[np.arange(out.shape[1]) < sizes[:, None]] = near.indices
    return out


def feet(curve: ConeCurve, points: Points, rows: Indices, lists: Indices, candidates: Indices) -> Feet:
    """Return the feet of some points, each on the edge of its list of candidates (l, w) whose surface is nearest."""
    return _placed(curve, points, rows, lists, candidates, signed=False)


def distances(curve: ConeCurve, points: Points, rows: Indices, edges: Indices) -> Numbers:
    """Return (p,) the signed distances of some points to the union of the cones of some edges, negative inside."""
    return _placed(curve, points, rows, np.zeros(len(rows), np.int32), edges[None], signed=True).residual


def _placed(
    curve: ConeCurve, points: Points, rows: Indices, lists: Indices, candidates: Indices, signed: bool
) -> Feet:  # fmt: skip
    from tiskel.kernels.cones import cone_feet

    count = len(rows)
    edge, share, residual = np.empty(count, np.int32), np.empty(count), np.empty(count)
    tables = [np.ascontiguousarray(table, np.int32) for table in (rows, lists, candidates)]
    cone_feet(points, *tables, curve.nodes, curve.radii, curve.edges, signed, edge, share, residual)
    return Feet(tables[0], edge, share, residual)


def _step(curve: ConeCurve, points: Points, at: Feet, start: Points) -> Numbers:
    """Return (v, 4) the Gauss-Newton step of nodes and radii."""
    count = len(curve.nodes)
    heavy = len(at.rows) / count
    terms = [_data(curve, points, at), *_smoothness(curve, heavy)]
    held = np.tile([DAMPING + HOLD] * 3 + [DAMPING], count) * heavy
    matrix = sparse.diags_array(held, format="csc")
    right = np.zeros(4 * count)
    right.reshape(count, 4)[:, :3] = HOLD * heavy * (start - curve.nodes)
    for unknowns, blocks, sides in terms:
        width = unknowns.shape[1]
        where = np.repeat(unknowns, width, axis=1).ravel(), np.tile(unknowns, (1, width)).ravel()
        matrix = matrix + sparse.coo_array((blocks.ravel(), where), shape=matrix.shape).tocsc()
        right += np.bincount(unknowns.ravel(), sides.ravel(), minlength=len(right))
    return BACKENDS["scipy"](matrix.tocsc())(right).reshape(count, 4)


Term = tuple[Indices, Numbers, Numbers]  # unknowns (t, k), blocks (t, k, k) of the matrix, right-hand sides (t, k)


def _data(curve: ConeCurve, points: Points, at: Feet) -> Term:
    """Return the residuals' share of the normal equations, summed by edge."""
    out = points[at.rows] - at.places(curve)
    # A point on the axis pulls in no direction.
    out /= np.maximum(np.linalg.norm(out, axis=1), 1e-9 * curve.radii.max())[:, None]
    one, other = (1 - at.share)[:, None], at.share[:, None]
    slope = -np.concatenate([one * out, one, other * out, other], axis=1)
    weight = 1 / np.maximum(1, np.abs(at.residual) / max(OUTLYING * at.deviation, np.finfo(float).tiny))
    order = np.argsort(at.edge, kind="stable")
    edge, starts = np.unique(at.edge[order], return_index=True)
    weighted = (weight[:, None] * slope)[order]
    blocks = np.add.reduceat(weighted[:, :, None] * slope[order][:, None, :], starts)
    sides = -np.add.reduceat(weighted * at.residual[order, None], starts)
    ends = curve.edges[edge]
    return np.concatenate([4 * ends[:, :1] + np.arange(4), 4 * ends[:, 1:] + np.arange(4)], axis=1), blocks, sides


def _smoothness(curve: ConeCurve, heavy: float) -> list[Term]:
    """Return the terms that hold every node of two neighbours between them."""
    triples = graph.passages(len(curve.nodes), curve.edges)
    if len(triples) == 0:
        return []
    values = np.concatenate([curve.nodes, curve.radii[:, None]], axis=1)
    before, after = (np.linalg.norm(curve.nodes[triples[:, i]] - curve.nodes[triples[:, 1]], axis=1) for i in (0, 2))
    whole = np.maximum(before + after, np.finfo(float).tiny)
    bend = np.stack([after / whole, -np.ones(len(triples)), before / whole], axis=1)
    blocks = bend[:, :, None] * bend[:, None, :]
    terms = []
    for axis, weight in enumerate([STRAIGHT] * 3 + [EVEN]):
        off = (bend * values[triples, axis]).sum(axis=1)
        terms.append((4 * triples + axis, weight * heavy * blocks, -weight * heavy * bend * off[:, None]))
    return terms
