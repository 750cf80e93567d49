"""The result of :func:`tiskel.evaluate`, and the document it becomes."""

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points
from tiskel.geometry.curve import CurveSamples
from tiskel.metrics.boundedness import COVERED, HULL, OUTSIDE, Boundedness
from tiskel.metrics.centredness import Sections
from tiskel.metrics.loops import Loops
from tiskel.metrics.topology import Topology
from tiskel.params import MetricParams

Document = dict[str, Any]

NO_POINTS = "no skeletal points were given"
NO_CURVE = "no curve with edges was given"


@dataclass(frozen=True)
class PointQuality:
    """Measures of skeletal points, one row each; coordinates in the input's units.

    Attributes
    ----------
    points : (m, 3) float64
        The skeletal points.
    originals : (m, 3) float64
        The points of the cloud that they stand for.
    boundedness : Boundedness
        How each is surrounded by the cloud.
    inside : (m,) bool or None
        Whether each is inside the surface; None where the normals cannot be oriented.
    centredness : (m,) float64
        c from 0 to 1; 0 where unbounded.
    raw_centredness : (m,) float64
        c wherever the point is.
    smoothness : (m,) float64
        s from 0 to 1; NaN where a tangent is undefined.
    """

    points: Points
    originals: Points
    boundedness: Boundedness
    inside: Mask | None
    centredness: Numbers
    raw_centredness: Numbers
    smoothness: Numbers


@dataclass(frozen=True)
class CurveQuality:
    """Measures of a curve at samples and at its vertices; coordinates in the input's units.

    Attributes
    ----------
    nodes : (v, 3) float64
        Where the nodes are.
    edges : (e, 2) int32
        The two nodes of every edge.
    samples : CurveSamples
        The q places on the curve that are measured.
    boundedness : Boundedness
        How each sample is surrounded by the cloud.
    inside : (q,) bool or None
        Whether each sample is inside the surface; None where the normals cannot be oriented.
    sections : Sections
        The section of the cloud across each sample.
    centredness : (q,) float64
        c from 0 to 1; 0 where unbounded, NaN where the section is invalid.
    vertices : (d,) int32
        The nodes with two neighbours.
    smoothness : (d,) float64
        s from 0 to 1 at each of these.
    overall_smoothness : float or None
        Mean of s weighted by length; None for a curve without length.
    hairpins : int
        Vertices where the curve turns back.
    """

    nodes: Points
    edges: Edges
    samples: CurveSamples
    boundedness: Boundedness
    inside: Mask | None
    sections: Sections
    centredness: Numbers
    vertices: Indices
    smoothness: Numbers
    overall_smoothness: float | None
    hairpins: int


@dataclass(frozen=True)
class Quality:
    """How good a skeleton is; :meth:`as_dict` gives the overall values, None with a reason where there is none.

    Attributes
    ----------
    topology : Topology or None
        Distances of H0 barcodes, in normalised units; None without skeletal points.
    loops : Loops
        Numbers of loops of surface, solid and curve.
    points : PointQuality or None
        Values per skeletal point; None without any.
    curve : CurveQuality or None
        Values per sample and vertex; None without an edge.
    graph : dict or None
        Components, loops, ends, junctions ("joints") and length (input's units) of the curve; None without one.
    cloud_points : int
        Points of the cloud that counted.
    correspondence : str
        How originals were found: "given", "rows", "nearest" or "none".
    oriented_by : str
        What the normals were oriented by.
    orientation : float
        Share of points where the normals agree.
    unoriented : str
        Why there is no inside test; empty where there is one.
    params : MetricParams
        The settings.
    warnings : tuple of str
        What was left out of the input.
    seconds : dict of str to float
        Wall time per part; no part of the document.

    Examples
    --------
    >>> from tiskel import ShapeParams, evaluate, make_shape, shape_graph
    >>> quality = evaluate(make_shape(shape_graph("y"), ShapeParams(count=1000))[1])
    >>> quality.graph["ends"], quality.points, quality.as_dict()["centredness"]["reasons"]
    (3, None, {'points': 'no skeletal points were given'})
    """

    topology: Topology | None
    loops: Loops
    points: PointQuality | None
    curve: CurveQuality | None
    graph: dict[str, float] | None
    cloud_points: int
    correspondence: str
    oriented_by: str
    orientation: float
    unoriented: str
    params: MetricParams
    warnings: tuple[str, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict, compare=False)

    def as_dict(self) -> Document:
        """Return the overall values as plain JSON values: never NaN, the same keys always."""
        p, c = self.points, self.curve
        return {
            "topology": self._topology(),
            "boundedness": self._pair(bounded_share(p), bounded_share(c)),
            "inside": self._pair(inside_share(p), inside_share(c), self.unoriented),
            "centredness": self._centredness(),
            "smoothness": self._smoothness(),
            "loops": {
                "surface": self.loops.surface,
                "solid": self.loops.solid,
                "graph": self.loops.graph,
                "reasons": self.loops.reasons,
            },
            "graph": self.graph or dict.fromkeys(("components", "loops", "ends", "joints", "length")),
            "counts": self.counts(),
            "settings": asdict(self.params) | {"correspondence": self.correspondence, "oriented_by": self.oriented_by},
            "warnings": list(self.warnings),
        }

    def _pair(self, points: float | None, curve: float | None, missing: str = "", **more: float | None) -> Document:
        """Return both values with the reasons why one of them is missing."""
        reasons = {}
        for name, value, measured, absent in (
            ("points", points, self.points, NO_POINTS),
            ("curve", curve, self.curve, NO_CURVE),
        ):
            if value is None:
                reasons[name] = absent if measured is None else missing
        return {"points": points, "curve": curve, **more, "reasons": reasons}

    def _topology(self) -> Document:
        t = self.topology
        return {
            "bottleneck": t.bottleneck if t else None,
            "wasserstein": t.wasserstein if t else None,
            "bars": t.bars if t else None,
            "threshold": self.params.similar,
            "similar": t.similar if t else None,
            "reasons": {} if t and not t.reason else {"bottleneck": t.reason if t else NO_POINTS},
        }

    def _centredness(self) -> Document:
        limit, p, c = self.params.threshold, self.points, self.curve
        curve = None if c is None else share(c.centredness[~np.isnan(c.centredness)] > limit)
        points, raw = (None, None) if p is None else (share(p.centredness > limit), share(p.raw_centredness > limit))
        return self._pair(points, curve, "no place on the curve has a section", points_raw=raw)

    def _smoothness(self) -> Document:
        p, c = self.points, self.curve
        known = np.zeros(0) if p is None else p.smoothness[~np.isnan(p.smoothness)]
        points = float(known.mean()) if len(known) else None
        return self._pair(points, None if c is None else c.overall_smoothness, "all of it is at one place")

    def counts(self) -> dict[str, int | float]:
        """Return how many places were measured, and how many were invalid or special."""
        counts: dict[str, int | float] = {"cloud": self.cloud_points, "oriented": round(self.orientation, 6)}
        counts |= {"loop_points": self.loops.points}
        if self.points is not None:
            counts |= {f"points_{key}": value for key, value in _settled(self.points.boundedness).items()}
            counts["points_without_tangent"] = int(np.isnan(self.points.smoothness).sum())
        if self.curve is not None:
            c = self.curve
            counts |= {"nodes": len(c.nodes), "edges": len(c.edges)}
            counts |= {f"curve_{key}": value for key, value in _settled(c.boundedness).items()}
            counts |= {
                "curve_valid_sections": int((~np.isnan(c.centredness)).sum()),
                "curve_without_direction": int(c.sections.directionless.sum()),
                "curve_sparse_sections": int(c.sections.sparse.sum()),
                "curve_stand_ins": int(c.sections.stand_in.sum()),
                "hairpins": c.hairpins,
            }
        return counts


def share(mask: Mask | None) -> float | None:
    """Return the share of True in a mask; None for no mask or an empty one."""
    return None if mask is None or len(mask) == 0 else float(mask.mean())


def bounded_share(measured: PointQuality | CurveQuality | None) -> float | None:
    """Return the share of places that are bounded."""
    return None if measured is None else share(measured.boundedness.bounded)


def inside_share(measured: PointQuality | CurveQuality | None) -> float | None:
    """Return the share of places that are inside, None where that is not known."""
    return None if measured is None else share(measured.inside)


def _settled(b: Boundedness) -> dict[str, int]:
    return {
        "measured": len(b),
        "settled_by_coverage": int((b.settled_by == COVERED).sum()),
        "settled_by_outside": int((b.settled_by == OUTSIDE).sum()),
        "settled_by_hull": int((b.settled_by == HULL).sum()),
        "at_a_cloud_point": int((b.coincident > 0).sum()),
    }
