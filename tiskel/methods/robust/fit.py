"""Round cones fitted to a cloud: where nodes and radii have to be, so that the surface passes through the points.

As in Thiery, Guy and Boubekeur, Sphere-meshes, SIGGRAPH Asia 2013, the model is a
graph of balls whose edges are hulls of two of them, and the residual of a point its
signed distance to that hull. Departure: in the steps of the fit it is how far the
point is out of the radius at the foot of the perpendicular, so that a ball between
two larger ones, which the hull hides, is still pulled by its points; with exact
distances the curves of noisy clouds were a quarter further from the truth. Least
squares over all points (Gauss-Newton; Huber weights), with nodes held to the line
of their neighbours and radii to the mean of theirs. Arcs and caps determine their circles
and balls, so that scans with holes are centred and ends come to lie in the middle
of the last ball.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse

from tiskel.arrays import TINY, Indices, Lists, Mask, Numbers, Pairs, Points, Stack, Table
from tiskel.geometry.round_cones import bounding_balls
from tiskel.geometry.solve import BACKENDS
from tiskel.methods.robust.curve import ConeCurve

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
EVEN = 0.3  # weight of even radii, per node as heavy as its share of the points [14, 14]
DAMPING = 0.01  # weight against a step of nodes and radii, in the same share [14, 14]
HOLD = 0.005  # weight that holds a node where the fit began, in the same share [14, 14]
FIXED = 1e6  # weight that fixes a node, in the same share; any that is large against one
OUTLYING = 2.0  # standard deviations; residuals beyond count less (Huber) [14, 14]
MAD = 1.4826  # of the median absolute deviation: standard deviation of a normal distribution, by definition [14, 14]
HOPS = 2  # edges so near to a point's own node may be its edge [11, 4]
STEP = 0.5  # radii that a node moves in a step at most [9, 7]
SHRINK = 0.5  # of its radius that a node keeps in a step at least [1, 3]
GROW = 2.0  # of its radius that a node has after a step at most [5, 1]
THINNEST = 0.1  # median radii that every radius is at least [1, 1]


@dataclass(frozen=True, eq=False)
class ConeFit:
    """A curve of round cones, and the foot points of the cloud on it.

    Attributes
    ----------
    curve : ConeCurve
        The curve.
    rows : (p,) int32
        Rows of the cloud that have a foot point.
    edge : (p,) int32
        The edge that it is on.
    share : (p,) float64
        How much of the way along the edge.
    residual : (p,) float64
        Distance of the point to the surface of the cone, negative inside.
    """

    curve: ConeCurve
    rows: Indices
    edge: Indices
    share: Numbers
    residual: Numbers

    @property
    def deviation(self) -> float:
        """The robust standard deviation of the residuals."""
        return MAD * float(np.median(np.abs(self.residual))) if len(self.rows) else 0.0

    @cached_property
    def places(self) -> Points:
        """(p, 3) the foot points."""
        first, last = self.curve.edges[self.edge].T
        nodes = self.curve.nodes
        return np.asarray(nodes[first] + self.share[:, None] * (nodes[last] - nodes[first]))

    @cached_property
    def radii(self) -> Numbers:
        """(p,) the radii of the cones there."""
        first, last = self.curve.edges[self.edge].T
        return np.asarray((1 - self.share) * self.curve.radii[first] + self.share * self.curve.radii[last])

    @cached_property
    def nodes(self) -> Indices:
        """(p,) the nearer end of the edge."""
        return np.asarray(self.curve.edges[self.edge, (self.share > 0.5).astype(int)])


def fit_cones(
    curve: ConeCurve, points: Points, section: Indices, *, rounds: int, straightness: float, fixed: Mask | None = None
) -> ConeFit:
    """Return the curve fitted to the points (n, 3) of the cloud, and their foot points.

    section (n,) is the section of each point; straightness the weight that
    holds a node between its two neighbours; fixed (v,) nodes stay where they are.
    """
    if len(curve.edges) == 0:
        none = np.zeros(0)
        return ConeFit(curve, none.astype(np.int32), none.astype(np.int32), none, none)
    owner, nearby, start = curve.node_of_section[section], nearby_edges(curve), curve.nodes
    owned = np.flatnonzero(owner >= 0)
    rows: Indices = owned[(nearby[owner[owned]] >= 0).any(axis=1)].astype(np.int32)
    thinnest = THINNEST * np.median(curve.radii)
    curve = replace(curve, radii=np.maximum(curve.radii, thinnest))
    for _ in range(rounds):
        found = foot_points(curve, points, rows, owner[rows], nearby, radial=True)
        step = _step(found, points, start, straightness, fixed)
        length = np.linalg.norm(step[:, :3], axis=1)
        within = np.minimum(1, STEP * curve.radii / np.maximum(length, TINY))
        least = np.maximum(SHRINK * curve.radii, thinnest)
        radii = np.clip(curve.radii + step[:, 3], least, GROW * curve.radii)
        curve = replace(curve, nodes=curve.nodes + within[:, None] * step[:, :3], radii=radii)
    return foot_points(curve, points, rows, owner[rows], nearby)


def feet_of_own(curve: ConeCurve, points: Points, section: Indices) -> ConeFit:
    """Return the foot points of all points (n, 3) whose section (n,) has a node, each on an edge near its node."""
    node = curve.node_of_section[section]
    rows = np.flatnonzero(node >= 0).astype(np.int32)
    return foot_points(curve, points, rows, node[rows], nearby_edges(curve))


def nearby_edges(curve: ConeCurve) -> Lists:
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


def foot_points(
    curve: ConeCurve, points: Points, rows: Indices, lists: Indices, candidates: Lists, *,
    signed: bool = False, radial: bool = False,
) -> ConeFit:  # fmt: skip
    """Return the foot points of some points, each on the edge whose surface is nearest.

    Of the edges in its list of candidates (l, w), points without any left out;
    nearest in size, or, signed, where it lies deepest inside. Radial, the foot is that of the perpendicular
    to the edge, and the residual how far the point is out of the radius there.
    """
    from tiskel.kernels.cones import cone_feet

    count = len(rows)
    edge, share, residual = np.empty(count, np.int32), np.empty(count), np.empty(count)
    tables = [np.ascontiguousarray(table, np.int32) for table in (rows, lists, candidates)]
    held = bounding_balls(curve.nodes, curve.radii, curve.edges)
    cone_feet(points, *tables, curve.nodes, curve.radii, curve.edges, *held, signed, radial, edge, share, residual)
    on = edge >= 0
    return ConeFit(curve, tables[0][on], edge[on], share[on], residual[on])


def _step(fit: ConeFit, points: Points, start: Points, straightness: float, fixed: Mask | None) -> Table:
    """Return (v, 4) the Gauss-Newton step of nodes and radii."""
    count = len(fit.curve.nodes)
    heavy = len(fit.rows) / count
    terms = [_data(fit, points), *_smoothness(fit.curve, heavy, straightness)]
    held = np.tile([DAMPING + HOLD] * 3 + [DAMPING], count) * heavy
    if fixed is not None:
        held.reshape(count, 4)[fixed, :3] = FIXED * heavy
    right = np.zeros(4 * count)
    right.reshape(count, 4)[:, :3] = HOLD * heavy * (start - fit.curve.nodes)
    everyone = np.arange(4 * count)
    values, rows, columns = [held], [everyone], [everyone]
    for unknowns, blocks, sides in terms:
        width = unknowns.shape[1]
        values.append(blocks.ravel())
        rows.append(np.repeat(unknowns, width, axis=1).ravel())
        columns.append(np.tile(unknowns, (1, width)).ravel())
        right += np.bincount(unknowns.ravel(), sides.ravel(), minlength=len(right))
    where = np.concatenate(rows), np.concatenate(columns)
    matrix = sparse.coo_array((np.concatenate(values), where), shape=(4 * count, 4 * count)).tocsc()
    return BACKENDS["scipy"](matrix)(right).reshape(count, 4)


Term = tuple[Pairs, Stack, Table]  # unknowns (t, k), blocks (t, k, k) of the matrix, right-hand sides (t, k)


def _data(fit: ConeFit, points: Points) -> Term:
    """Return the residuals' share of the normal equations, summed by edge."""
    from tiskel.kernels.cone_sums import summed_products

    out = points[fit.rows] - fit.places
    # A point on the axis pulls in no direction.
    out /= np.maximum(np.linalg.norm(out, axis=1), 1e-9 * fit.curve.radii.max())[:, None]
    one, other = (1 - fit.share)[:, None], fit.share[:, None]
    slope = -np.concatenate([one * out, one, other * out, other], axis=1)
    weight = 1 / np.maximum(1, np.abs(fit.residual) / max(OUTLYING * fit.deviation, TINY))
    order = np.argsort(fit.edge, kind="stable").astype(np.int32)
    edge, starts = np.unique(fit.edge[order], return_index=True)
    blocks, sides = np.zeros((len(edge), 8, 8)), np.zeros((len(edge), 8))
    summed_products(slope, weight, fit.residual, order, np.append(starts, len(order)).astype(np.int32), blocks, sides)
    ends = fit.curve.edges[edge]
    return np.concatenate([4 * ends[:, :1] + np.arange(4), 4 * ends[:, 1:] + np.arange(4)], axis=1), blocks, -sides


def _smoothness(curve: ConeCurve, heavy: float, straightness: float) -> list[Term]:
    """Return the terms that hold every node of two neighbours between them."""
    triples = curve.passages
    if len(triples) == 0:
        return []
    values = np.concatenate([curve.nodes, curve.radii[:, None]], axis=1)
    before, after = (np.linalg.norm(curve.nodes[triples[:, i]] - curve.nodes[triples[:, 1]], axis=1) for i in (0, 2))
    whole = np.maximum(before + after, TINY)
    bend = np.stack([after / whole, -np.ones(len(triples)), before / whole], axis=1)
    blocks = bend[:, :, None] * bend[:, None, :]
    terms: list[Term] = []
    for axis, weight in enumerate([straightness] * 3 + [EVEN]):
        off = (bend * values[triples, axis]).sum(axis=1)
        terms.append((4 * triples + axis, weight * heavy * blocks, -weight * heavy * bend * off[:, None]))
    return terms
