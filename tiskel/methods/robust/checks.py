"""Whether a curve is right: the score that fronts compete by, and what its radii are worth."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tiskel.arrays import TINY, Numbers, Points
from tiskel.geometry.body import shares_of_depth
from tiskel.geometry.curve import CurveSamples, curve_samples
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.geometry.solid import Solid
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.fit import ConeFit
from tiskel.methods.robust.network import Network
from tiskel.methods.robust.thinning import given_to
from tiskel.methods.robust.wire.curve import bounds_of
from tiskel.methods.trace import Sections, Trace

# Found by trial on the shapes of the gallery, clean and degraded, and on seven scans. In brackets:
# how many of the 14 curves of benchmarks/sensitivity.md change with 0.7 and 1.4 times the value.
PLACES = 200  # on the curve, where winding numbers are asked for [1, 0]
OUTSIDE_SCORE = 0.4  # winding number below which a place counts against a curve [1, 0]
OFF_MIDDLE = 0.7  # of the depth that the body has across the curve; places less deep are off its middle
THIN = 2.0  # spacings in a radius; thinner places say nothing of inside and outside [0, 1]
UNSURE = 0.05  # misfit that a loop over a gap is worth where the body has no handle [0, 0; for patches]
FAR = 0.35  # local radii; points further from the cones count against a curve [1, 2]
FARTHEST = 3.0  # spacings; points that are further from the cones are no noise, and count as so far
NO_LESS = 0.5  # spacings; what a bound is at least: of limbs thinner than that the points cannot tell how thin they are
SPARSE = 1.5  # spacings in a radius; thinner nodes have too few points [0, 0; what radii are called]


@dataclass(frozen=True, eq=False)
class Candidate:
    """A fitted curve, and what it is judged by.

    Attributes
    ----------
    fit : ConeFit
        The curve, and where the points stand on it.
    sections : Sections
        What the front found, with the sections of missed branches.
    network : Network
        The neighbour graph.
    solid : Solid
        The body inside the cloud.
    gaps : int
        How many gaps were bridged.
    meetings : int
        How many ends of wires meet another part of the curve and are left open.
    side_by_side : bool
        Whether the cloud is one wire whose turns lie side by side, and links were only made along it.
    """

    fit: ConeFit
    sections: Sections
    network: Network
    solid: Solid
    gaps: int
    meetings: int = 0
    side_by_side: bool = False

    @property
    def curve(self) -> ConeCurve:
        """The curve, as the foot points are on it."""
        return self.fit.curve

    @cached_property
    def places(self) -> tuple[Points, Numbers]:
        """The nodes and places along the curve (q, 3), and the radii there (q,)."""
        curve = self.curve
        if len(curve.edges) == 0:
            return curve.nodes, curve.radii
        between = self._between
        radii = curve.radii[curve.edges[between.edges]].mean(axis=1)
        return np.concatenate([curve.nodes, between.points]), np.concatenate([curve.radii, radii])

    @cached_property
    def _between(self) -> CurveSamples:
        return curve_samples(self.curve, PLACES)

    @property
    def _measured_loops(self) -> int:
        """Loops without the bridges."""
        return replace(self.curve, edges=self.curve.edges[~self.curve.bridged], bridged=np.zeros(0, np.bool_)).loops

    @property
    def score(self) -> float:
        """The misfit, and a little for every loop that only bridges make, where the body has none."""
        known = self.curve.loops if self.solid.handles is None else self.solid.handles
        loops = min(self.curve.loops - known, self.curve.loops - self._measured_loops)
        return self.misfit + UNSURE * max(loops, 0)

    @cached_property
    def winding(self) -> Numbers:
        """Winding numbers (q,) of the body about these places."""
        return self.solid.oriented.winding_numbers(self.places[0])

    @cached_property
    def measured(self) -> npt.NDArray[np.bool_]:
        """Which places (q,) are on what was measured; on bridges the scan says nothing of inside and outside."""
        curve = self.curve
        nodes = np.isin(np.arange(len(curve.nodes)), curve.edges[curve.bridged], invert=True)
        return nodes if len(curve.edges) == 0 else np.concatenate([nodes, ~curve.bridged[self._between.edges]])

    @cached_property
    def misfit(self) -> float:
        """The share of places on the curve outside the body and of points far from its cones.

        And one for every loop more or less than the body has handles; loops that
        close over gaps may be handles or not. Where the body is as thin as the
        points are apart, where there is no inside to speak of, and on bridges,
        nothing is said of inside and outside.
        """
        known, off = self.solid.handles, 0
        if known is not None:
            off = max(known - self.curve.loops, self._measured_loops - known, 0)
        spacing = self.network.spacing
        thick = (self.places[1] > THIN * spacing) & self.measured & self.solid.trusted
        outside = (self.winding < OUTSIDE_SCORE) & thick
        far = np.abs(self.fit.residual) > np.maximum(FAR * self.fit.radii, spacing)
        return off + float(outside.mean()) + (float(far.mean()) if len(far) else 0.0)

    @property
    def beside(self) -> float:
        """How far points are from the cones, root mean square, in spacings, the furthest cut."""
        off = np.minimum(np.abs(self.fit.residual) / max(self.network.spacing, TINY), FARTHEST)
        return float(np.sqrt((off**2).mean())) if len(off) else 0.0

    @cached_property
    def off_middle(self) -> float:
        """The share of places on the curve that are off the middle of the body, where it is thick enough to tell."""
        body, curve = self.solid.body, self.curve
        if body is None or len(curve.edges) == 0:
            return 0.0
        between = curve_samples(curve, PLACES)
        thick = curve.radii[curve.edges[between.edges]].mean(axis=1) > THIN * self.network.spacing
        told = between.directed & thick
        deep = shares_of_depth(body, between.points[told], between.directions[told])
        return float((deep < OFF_MIDDLE).sum()) / len(told)


def radius_sources(found: Candidate) -> npt.NDArray[np.uint8]:
    """Return (v,) what the radius of each node is worth: thin ones are bounds, those on bridges come from a model."""
    curve = found.curve
    if (curve.radius_sources != RadiusSource.UNKNOWN).any():
        return curve.radius_sources  # wires know
    sources = np.full(len(curve.nodes), RadiusSource.MEASURED, np.uint8)
    sources[curve.radii < SPARSE * found.network.spacing] = RadiusSource.BOUNDED
    sources[curve.regimes == Regime.SHEET] = RadiusSource.BOUNDED  # half a width
    bridges = np.bincount(curve.edges[curve.bridged].ravel(), minlength=len(curve.nodes))
    sources[(bridges > 0) & (bridges == curve.degrees)] = RadiusSource.MODELLED
    return sources


def radii_of(found: Candidate, trace: Trace) -> Numbers:
    """Return (v,) the radii: bounds of wires are no less than their points can tell, those that were merged, too."""
    curve, fit = found.curve, found.fit
    bounds = (curve.regimes == Regime.WIRE) & (curve.radius_sources == RadiusSource.BOUNDED)
    if not bounds.any():
        return curve.radii
    size = np.bincount(fit.nodes, minlength=len(curve.nodes))
    radii, spacings, usual = curve.radii, found.network.spacings[fit.rows], found.network.spacing
    points, mean = given_to(trace)
    if len(points) > len(trace.rows):
        many = np.bincount(mean, minlength=len(found.network.points))  # in a row on a wire, so as many times closer
        spacings, usual = spacings / many[fit.rows], np.inf
        node = np.full(len(many), -1, np.int32)
        node[fit.rows] = fit.nodes
        on = np.flatnonzero(node[mean] >= 0)
        radii = np.minimum(radii, bounds_of(curve, points[on] @ found.network.axes.T, node[mean[on]]))
    total = np.bincount(fit.nodes, spacings, minlength=len(curve.nodes))
    spacing = np.minimum(np.where(size > 0, total / np.maximum(size, 1), found.network.spacing), usual)
    return np.asarray(np.where(bounds, np.maximum(radii, NO_LESS * spacing), curve.radii))
