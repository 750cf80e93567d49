"""From sections to a curve skeleton: the graph, its clean-up, and the fit."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry import graph
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.oriented import Surface
from tiskel.geometry.solid import Body, body_of
from tiskel.methods.robust.branches import with_tips, without_contained_ends, without_explained_limb, without_stubs
from tiskel.methods.robust.bridges import bridged
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.cycles import without_filled_cycles
from tiskel.methods.robust.fit import Feet, fit_cones
from tiskel.methods.robust.fronts import front_from_aside
from tiskel.methods.robust.growth import with_missed_limbs
from tiskel.methods.robust.junctions import merged_joints, placed_joints
from tiskel.methods.robust.network import Network, neighbour_network
from tiskel.methods.robust.sections import section_curve

ROUNDS, ROUNDS_AGAIN = 4, 2  # of the fit, and after a change to the graph
DOUBTFUL = 0.012  # of the curve outside or of the points far off: other fronts are tried, fewer the less there is
PLACES, OUTSIDE, FAR = 200, 0.4, 0.35  # on the curve; winding number; local radii
THIN = 2.0  # spacings; thinner places say nothing of inside and outside
CLEARLY = 0.7  # of the doubt that another front may leave, to be taken
FRONTS = 6  # at most
TIPS = 3  # nodes that an end may grow by


@dataclass(frozen=True)
class Built:
    """A fitted curve, and what it was made from.

    Attributes
    ----------
    curve : the curve; feet : where the points stand on it.
    network : the neighbour graph; surface : the oriented cloud.
    body : the solid inside; gaps : how many were bridged.
    """

    curve: ConeCurve
    feet: Feet
    network: Network
    surface: Surface
    body: Body
    gaps: int

    @cached_property
    def places(self) -> tuple[Points, Numbers]:
        """The nodes and places along the curve (q, 3), and the radii there (q,)."""
        curve = self.curve
        if len(curve.edges) == 0:
            return curve.nodes, curve.radii
        between = curve_samples(curve.nodes, curve.edges, PLACES)
        radii = curve.radii[curve.edges[between.edges]].mean(axis=1)
        return np.concatenate([curve.nodes, between.points]), np.concatenate([curve.radii, radii])

    @cached_property
    def winding(self) -> Numbers:
        """Winding numbers (q,) of the body about these places."""
        return self.surface.winding_numbers(self.places[0])

    @property
    def loops(self) -> int:
        return graph.loop_count(len(self.curve.nodes), self.curve.edges)


def build(points: Points, contracted: Points, section: Indices, level: Indices, k: int) -> Built:
    """Return the curve of a cloud (n, 3) whose points contract to (n, 3), with their sections and levels (n,).

    The front fails where it runs along two limbs at once, which depends on where
    it began: while a curve is in doubt, others from further tips are tried.
    """
    network = neighbour_network(points, k)
    surface = network.oriented(contracted)
    body = body_of(surface)
    best = _built(network, surface, body, section, level)
    for times in range(1, FRONTS):
        if doubt(best) < times * DOUBTFUL:
            break
        again = front_from_aside(network, contracted, times)
        other = _built(network, surface, body, again.section, again.level)
        best = other if doubt(other) < CLEARLY * doubt(best) else best
    return best


def doubt(built: Built) -> float:
    """Return the share of places on the curve outside the body and of points far from its cones.

    And one for every loop more or less than the body has handles. Where the
    body is as thin as the points are apart, nothing is said.
    """
    off = 0 if built.body.handles is None else abs(built.loops - built.body.handles)
    spacing = built.network.spacing
    outside = (built.winding < OUTSIDE) & (built.places[1] > THIN * spacing)
    far = np.abs(built.feet.residual) > np.maximum(FAR * built.feet.radii(built.curve), spacing)
    return off + float(outside.mean()) + (float(far.mean()) if len(far) else 0.0)


def _built(network: Network, surface: Surface, body: Body, section: Indices, level: Indices) -> Built:
    points = network.points
    curve = section_curve(network, section, level)
    curve = without_filled_cycles(curve, network, surface, fitted=False)
    curve = merged_joints(without_stubs(curve, points))
    curve = placed_joints(without_contained_ends(curve), surface)
    curve, at = fit_cones(curve, points, ROUNDS)
    grown = with_missed_limbs(curve, network, at)
    if grown is not None:
        curve, at = fit_cones(placed_joints(without_contained_ends(grown), surface), points, ROUNDS)
    curve, at = _cleaned(curve, at, network, surface)
    curve, at = fit_cones(placed_joints(curve, surface), points, ROUNDS_AGAIN)  # now that the limbs are known
    for _ in range(TIPS):
        grown = with_tips(curve, points, at, network.spacing)
        if grown is None:
            break
        curve, at = fit_cones(grown, points, ROUNDS_AGAIN + 1)
    curve, gaps = bridged(curve, network)
    _, at = fit_cones(curve, points, 0)
    return Built(curve, at, network, surface, body, gaps)


def _cleaned(curve: ConeCurve, at: Feet, network: Network, surface: Surface) -> tuple[ConeCurve, Feet]:
    """Take away, now that nodes are where they should be, filled cycles and limbs that explain nothing."""
    closed = without_filled_cycles(curve, network, surface, fitted=True)
    if len(closed.nodes) < len(curve.nodes):
        curve, at = fit_cones(closed, network.points, ROUNDS_AGAIN)
    for _ in range(len(curve.nodes)):
        fewer = without_explained_limb(curve, network.points, network.spacing)
        if fewer is None:
            break
        curve, at = fit_cones(fewer, network.points, ROUNDS_AGAIN)
    return curve, at


def nodes_of_points(built: Built) -> Indices:
    """Return (n,) the node of every point; debris goes to the nearest."""
    from scipy.spatial import cKDTree

    node = built.curve.owner.copy()
    node[built.feet.rows] = built.feet.node(built.curve)
    lost = np.flatnonzero(node < 0)
    if len(lost):
        node[lost] = cKDTree(built.curve.nodes).query(built.network.points[lost])[1]
    return np.asarray(node)
