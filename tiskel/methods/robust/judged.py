"""What the doubts about a curve are drawn from: curve, cloud and solid, as plain data; and how a doubt is told."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points, Table
from tiskel.geometry.curve import CurveSamples, curve_samples
from tiskel.geometry.doubt import CurveWarning, Severity, as_places
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.regime import Regime
from tiskel.geometry.representatives import few_places
from tiskel.geometry.solid import Solid
from tiskel.methods.robust import levels


@dataclass(frozen=True, eq=False)
class Judged:
    """A curve and all that its doubts are drawn from; lengths in one unit.

    Attributes
    ----------
    graph : CurveGraph
        The curve, with radii, their sources, regimes and bridges.
    points : (n, 3) float64
        The distinct points of the cloud.
    normals : (n, 3) float64
        Unit vectors, not oriented.
    spacings : (n,) float64
        How far the points are apart about each.
    node_of_point : (n,) int32
        The node of every point.
    contracted : (n, 3) float64
        Where each point contracts to.
    left_out : (n,) bool
        Points in small parts that have no curve.
    solid : Solid
        The body inside the cloud, trusted or not.
    axes : (3, 3) float64
        Of the solid, as rows: its coordinates are those of the curve @ axes.T.
    beside : float
        How far points lie from the cones of the curve, root mean square, in spacings.
    meshed : bool
        Whether the points lie on a known mesh: parts of it that overlap have an inside on both sides.
    side_by_side : bool
        Whether the cloud is taken for one wire whose turns lie side by side.
    """

    graph: CurveGraph
    points: Points
    normals: Points
    spacings: Numbers
    node_of_point: Indices
    contracted: Points
    left_out: Mask
    solid: Solid
    axes: Table
    beside: float = 0.0
    meshed: bool = False
    side_by_side: bool = False

    @cached_property
    def spacing(self) -> float:
        """The median spacing."""
        return float(np.median(self.spacings))

    @cached_property
    def bridged_share(self) -> float:
        """The share of the curve's length that leads over gaps."""
        return float(self.graph.lengths[self.graph.bridged].sum()) / max(self.graph.length, TINY)

    def share_at(self, nodes: Mask) -> float:
        """Return the share of the curve's length at some of its nodes (v,), half of each edge at either end."""
        return float((self.graph.lengths * nodes[self.graph.edges].mean(axis=1)).sum()) / max(self.graph.length, TINY)

    @cached_property
    def samples(self) -> CurveSamples:
        """As many places on the curve as the measures take."""
        return curve_samples(self.graph, levels.PLACES)

    @cached_property
    def sample_radii(self) -> Numbers:
        """(q,) the radius about each of these places."""
        return np.asarray(self.graph.radii[self.graph.edges[self.samples.edges]].mean(axis=1))

    @cached_property
    def thick(self) -> Mask:
        """(q,) at which of these places the body is thick enough to speak of inside and outside; no sheet is."""
        spacings = np.maximum(self.spacings[cKDTree(self.points).query(self.samples.points)[1]], self.spacing)
        sheet = (self.graph.regimes == Regime.SHEET)[self.graph.edges[self.samples.edges]].all(axis=1)
        return np.asarray((self.sample_radii > levels.THICK * spacings) & ~sheet)


def doubt(
    code: str, text: str, share: float, places: Points, weight: Numbers | None = None, grave: Severity = "warning"
) -> CurveWarning:
    """Return a warning or note with few of its places (p, 3), those of most weight (p,); text may name the {share}."""
    few = few_places(places, np.ones(len(places)) if weight is None else weight)
    return CurveWarning(
        code, text.format(share=f"{share:.0%}" if share >= 0.01 else "less than 1%"), grave, share, as_places(few)
    )


def severity(serious: bool) -> Severity:
    """Return what a doubt is that is serious or not."""
    return "warning" if serious else "note"
