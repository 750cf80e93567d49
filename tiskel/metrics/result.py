"""The result of :func:`tiskel.evaluate`, and the document it becomes."""

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from tiskel.metrics.loops import Loops
from tiskel.metrics.places import CurveQuality, PointQuality, bounded_share, inside_share, mean_medialness
from tiskel.metrics.shares import settled, share
from tiskel.metrics.topology import Topology
from tiskel.params import MetricParams

Document = dict[str, Any]

NO_POINTS = "no skeletal points were given"
NO_CURVE = "no curve with edges was given"
SAID = ("boundedness", "inside", "medialness", "air", "centredness", "smoothness", "loops")  # in one line
NO_LENGTH = "all of it is at one place"


@dataclass(frozen=True, eq=False, repr=False)
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

    def __repr__(self) -> str:
        return f"<Quality {' '.join(f'{name}={value:.4g}' for name, value in self._overall().items())}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{name}</td><td>{value:.4g}</td></tr>" for name, value in self._overall().items())
        return f"<table><tr><th>measure</th><th>value</th></tr>{rows}</table>"

    def _overall(self) -> dict[str, float]:
        """Return what there is a value of: "inside_curve" and the like."""
        sections = {name: section for name, section in self.as_dict().items() if name in SAID}
        values = {f"{name}_{key}": value for name, section in sections.items() for key, value in section.items()}
        return {name: value for name, value in values.items() if isinstance(value, (int, float))}

    def as_dict(self) -> Document:
        """Return the overall values as plain JSON values: never NaN, the same keys always."""
        p, c = self.points, self.curve
        return {
            "topology": self._topology(),
            "boundedness": self._pair(bounded_share(p), bounded_share(c)),
            "inside": self._pair(inside_share(p), inside_share(c), self.unoriented),
            "medialness": self._medialness(),
            "air": self._air(),
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

    def _medialness(self) -> Document:
        value, missing = mean_medialness(self.curve), self.unoriented or "the curve has no direction anywhere"
        reasons = {"curve": NO_CURVE if self.curve is None else missing} if value is None else {}
        return {"curve": value, "reasons": reasons}

    def _air(self) -> Document:
        """Return the share of the curve in the air, and a few places of it."""
        c = self.curve
        if c is None or c.air_share is None:
            return {"curve": None, "places": [], "reasons": {"curve": NO_CURVE if c is None else NO_LENGTH}}
        return {"curve": c.air_share, "places": c.air_where.tolist(), "reasons": {}}

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
        return self._pair(points, None if c is None else c.overall_smoothness, NO_LENGTH)

    def counts(self) -> dict[str, int | float]:
        """Return how many places were measured, and how many were invalid or special."""
        counts: dict[str, int | float] = {"cloud": self.cloud_points, "oriented": round(self.orientation, 6)}
        counts |= {"loop_points": self.loops.points}
        if self.points is not None:
            counts |= {f"points_{key}": value for key, value in settled(self.points.boundedness).items()}
            counts["points_without_tangent"] = int(np.isnan(self.points.smoothness).sum())
        if self.curve is not None:
            c = self.curve
            counts |= {"nodes": len(c.nodes), "edges": len(c.edges)}
            counts |= {f"curve_{key}": value for key, value in settled(c.boundedness).items()}
            counts |= {
                "curve_valid_sections": int((~np.isnan(c.centredness)).sum()),
                "curve_without_direction": int(c.sections.directionless.sum()),
                "curve_sparse_sections": int(c.sections.sparse.sum()),
                "curve_stand_ins": int(c.sections.stand_in.sum()),
                "hairpins": c.hairpins,
            }
        return counts
