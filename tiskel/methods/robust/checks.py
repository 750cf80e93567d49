"""Whether a curve is right: the score that fronts compete by, and the warnings, from one table of levels."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.geometry.curve import CurveSamples, curve_samples
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.solid import Solid
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.fit import ConeFit
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections

# The table of levels. Found by trial on the shapes of the gallery, clean and degraded, and on seven scans. In brackets:
# how many of the 14 curves, or of their warnings, of benchmarks/sensitivity.md change with 0.7 and 1.4 times the value.
PLACES = 200  # on the curve, where winding numbers are asked for [1, 0]
OUTSIDE_SCORE = 0.4  # winding number below which a place counts against a curve [1, 0]
OUTSIDE_WARNING = 0.25  # winding number below which a place is worth a warning [warnings 0, 1]
OUTSIDE_SHARE = 0.02  # share of such places from which on there is a warning [0, 0; clouds are clearly on one side]
THIN = 2.0  # spacings in a radius; thinner places say nothing of inside and outside [0, 1]
UNSURE = 0.05  # misfit that a loop over a gap is worth where the body has no handle [0, 0; for patches]
FAR = 0.35  # local radii; points further from the cones count against a curve [1, 2]
FLAT = 0.15  # ratio of how much normals spread both ways across the curve; flat below it [0, 0; for plates]
FLAT_SHARE = 0.2  # share of points at such nodes from which on there is a warning [0, 0; for plates]
SPARSE = 1.5  # spacings in a radius; thinner nodes have too few points [warnings 8, 10]
SPARSE_SHARE = 0.05  # share of such nodes from which on there is a warning [0, 0; clouds are clearly on one side]
SHORT = 1.0  # largest radii that a curve is long at least, to be one [0, 0; for balls]


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
    """

    fit: ConeFit
    sections: Sections
    network: Network
    solid: Solid
    gaps: int

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


def radius_sources(found: Candidate) -> npt.NDArray[np.uint8]:
    """Return (v,) what the radius of each node is worth: thin ones are bounds, those on bridges come from a model."""
    curve = found.curve
    sources = np.full(len(curve.nodes), RadiusSource.MEASURED, np.uint8)
    sources[curve.radii < SPARSE * found.network.spacing] = RadiusSource.BOUNDED
    bridges = np.bincount(curve.edges[curve.bridged].ravel(), minlength=len(curve.nodes))
    sources[(bridges > 0) & (bridges == curve.degrees)] = RadiusSource.MODELLED
    return sources


def warnings_of(found: Candidate) -> tuple[str, ...]:
    """Return the warnings of a curve, each what, how much, and what to do."""
    told = (_small(found), _sparse(found), _short(found), _flat(found), _gaps(found), *_body(found))
    return tuple(warning for warning in told if warning)


def _small(found: Candidate) -> str:
    left_out = int((found.curve.node_of_section[found.sections.section] < 0).sum())
    return f"{left_out} points in small separate parts were left out" if left_out else ""


def _sparse(found: Candidate) -> str:
    thin = float((found.curve.radii < SPARSE * found.network.spacing).mean())
    few = f"{thin:.0%} of the nodes are thinner than {SPARSE} spacings of the points: too few points for the thickness"
    return few if thin > SPARSE_SHARE else ""


def _short(found: Candidate) -> str:
    curve = found.curve
    if len(curve.edges) and curve.length >= SHORT * curve.radii.max():
        return ""
    return "the body is hardly longer than it is thick: its curve skeleton says little about it"


def _flat(found: Candidate) -> str:
    """Find the nodes whose points' normals hardly turn about the curve, as those of a plate do not."""
    node, normals = found.fit.nodes, found.network.normals[found.fit.rows]
    scatter = np.zeros((len(found.curve.nodes), 3, 3))
    np.add.at(scatter, node, normals[:, :, None] * normals[:, None, :])
    _, across, most = np.linalg.eigvalsh(scatter).T
    flat = (across < FLAT * most)[node]
    share = float(flat.mean()) if len(flat) else 0.0
    told = (
        f"{share:.0%} of the points lie where the body is flat: it has no curve skeleton there and did not become thin"
    )
    return told if share > FLAT_SHARE else ""


def _gaps(found: Candidate) -> str:
    return f"{found.gaps} gaps in the scan were bridged by straight lines" if found.gaps else ""


def _body(found: Candidate) -> tuple[str, ...]:
    """Compare the curve with the solid inside the cloud, where there is one."""
    if not found.solid.trusted:
        return ()
    handles, loops = found.solid.handles, found.curve.loops
    outside = float((found.winding < OUTSIDE_WARNING).mean())
    return (
        "" if handles is None or handles <= loops else f"the body has {handles} handles, the curve only {loops} loops",
        "" if handles is None or handles >= loops else f"the curve has {loops} loops, the body only {handles} handles",
        f"{outside:.0%} of the curve lies outside the body" if outside > OUTSIDE_SHARE else "",
    )
