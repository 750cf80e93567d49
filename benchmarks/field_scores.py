"""What benchmarks/field.py says of one curve: counts, inside, medialness, air, distances, trees, radii, warnings."""

import time
from collections import Counter
from typing import Any

import numpy as np
from field_methods import curve_of, missing
from field_subjects import Counts, Subject
from scipy.spatial import cKDTree

from tiskel import CurveGraph, Regime, TiskelError
from tiskel.gallery.body import Body, is_inside, least_thickness, surface_distance
from tiskel.geometry.curve import CurveSamples, curve_samples
from tiskel.geometry.graph import tidy_edges
from tiskel.geometry.round_cones import ConeGraph
from tiskel.geometry.spacing import spacing_of
from tiskel.metrics.truth import agreement

PLACES = 1000  # on each curve, by length
HALF = 0.5  # of the local radius: how far a one-sided curve may be from the middle of what was seen
CLOSE, MOST_PLACES = 0.1, 100_000  # radii from place to place on the truth, and how many places at most
CLIMBS = 200  # places of these from which the best clearance is climbed to
SLACK = 0.5  # spacings beside a wire that count as inside
SEEN = 3  # points about a place of the truth from which on their mean is the middle of what was seen

# From where on a curve is wrong, when warnings are scored as a classifier: one part in twenty.
IN_AIR, OUTSIDE, UNREACHED = 0.05, 0.05, 0.05
TREE_F = 0.9  # and a tree below this F

Row = dict[str, Any]


def scored(subject: Subject, setting: str, method: str) -> Row:
    """Return everything about one curve; nothing but why where there is none."""
    row: Row = {"setting": setting, "shape": subject.name, "group": subject.group, "kind": subject.kind}
    row |= {"method": method, "points": len(subject.cloud)}
    if why := missing(method):
        return row | {"skipped": why}
    start = time.perf_counter()
    try:
        curve, warnings = curve_of(subject.cloud, method)
    except TiskelError as error:
        return row | {"refused": str(error), "wrong": "no curve"}
    except Exception as error:  # whatever it is, it is what the benchmark is for
        return row | {"crashed": f"{type(error).__name__}: {error}"[:200], "wrong": "crash"}
    row["seconds"] = round(time.perf_counter() - start, 3)
    row |= {"warnings": len(warnings), "codes": "; ".join(map(_code, warnings))}
    row |= {"components": curve.components, "loops": curve.loops, "ends": curve.ends}
    row |= compared(curve, subject.right)
    row |= in_space(curve, subject)
    if subject.again is not None:
        row |= once_more(curve, subject.again, method)
    elif subject.truth is not None:
        row |= against(curve, subject)
    return row | {"wrong": ", ".join(faults(row, subject.kind))}


def _code(warning: object) -> str:
    return str(getattr(warning, "code", warning))


def once_more(curve: CurveGraph, again: np.ndarray, method: str) -> Row:
    """Return how alike the curve of another cloud of the same body is."""
    from tiskel.metrics.repeatability import repeatability

    try:
        alike = repeatability(curve, curve_of(again, method)[0])
    except Exception:  # a crash is counted where it is the first
        return {"same_graph": 0}
    return {"same_graph": int(alike.same_graph), "same_tips": alike.tips_share, "same_radii_95": alike.radii_95}


def compared(curve: CurveGraph, right: Counts) -> Row:
    """Return whether counts are right, of those that are known."""
    found = {"components": curve.components, "loops": curve.loops, "ends": curve.ends}
    row: Row = {}
    for (name, value), wanted in zip(found.items(), right, strict=True):
        if wanted is not None:
            row[f"{name}_right"] = int(value in (wanted if isinstance(wanted, tuple) else (wanted,)))
    return row


def in_space(curve: CurveGraph, subject: Subject) -> Row:
    """Return what asks only the points, or the exact surface."""
    if curve.length == 0:
        return {}
    from tiskel.geometry.air import in_the_air

    cloud = np.unique(subject.cloud[np.isfinite(subject.cloud).all(axis=1)], axis=0)
    samples = curve_samples(curve, PLACES)
    row: Row = {"air": in_the_air(curve, samples, cloud).share}
    if solid(subject.truth) and subject.kind == "whole":
        row |= in_body(curve, samples, subject.truth, spacing_of(cloud))
    return row


def solid(shape: object) -> bool:
    """Return whether a shape has an inside everywhere."""
    return isinstance(shape, ConeGraph) or (isinstance(shape, Body) and shape.solid)


def in_body(curve: CurveGraph, samples: CurveSamples, shape: Any, spacing: float) -> Row:
    """Return the share inside, and medialness.

    What is thinner than its points are apart cannot be asked to be followed more closely: there half a spacing beside
    is inside, and nothing is medial.
    """
    if least_thickness(shape) < spacing:
        near = surface_distance(samples.points, shape) <= SLACK * spacing
        return {"inside": by_length(curve, samples.edges, near)}
    from tiskel.geometry.clearance import ConeBody
    from tiskel.metrics.medialness import medialness

    found = medialness(curve, ConeBody(shape) if isinstance(shape, ConeGraph) else shape, CLIMBS)
    return {"inside": by_length(curve, samples.edges, is_inside(samples.points, shape)), "medialness": found.mean}


def by_length(curve: CurveGraph, edges: np.ndarray, chosen: np.ndarray) -> float:
    """Return the share of the length of a curve that chosen places (q,) on its edges stand for."""
    weight = (curve.lengths / np.maximum(np.bincount(edges, minlength=len(curve.edges)), 1))[edges]
    return float(weight[chosen].sum() / weight.sum())


def against(curve: CurveGraph, subject: Subject) -> Row:
    """Return distances to the truth; of views also to what was seen; of trees the measures of those instead."""
    truth = subject.truth
    assert truth is not None
    if subject.kind == "tree":
        return of_tree(curve, truth, subject.cloud)
    truth = no_thinner(truth, spacing_of(subject.cloud))
    row: Row = {k: v for k, v in agreement(curve, truth).as_dict().items() if k not in ("components", "loops", "ends")}
    row["true_ends_found"] = agreement(curve, truth).ends
    if subject.kind == "view" and curve.length > 0:
        row |= reach(curve, truth, subject.cloud)
    return row


def no_thinner(truth: CurveGraph, spacing: float) -> CurveGraph:
    """Return the truth with radii of a spacing at least, which distances to wires are measured in."""
    return CurveGraph(truth.nodes, truth.edges, np.maximum(truth.radii, spacing))


def reach(curve: CurveGraph, truth: CurveGraph, cloud: np.ndarray) -> Row:
    """Return the share of the curve near the middle of what was seen, or near the truth, and with it what is told.

    Of sheets and bridges the curve itself says that they are beside the body's middle, or not measured.

    The middle of what was seen at a place of the truth is the mean of the points that are nearest to it.
    """
    fine = divided(truth, 4)
    along = curve_samples(truth, int(np.clip(truth.length / (CLOSE * truth.radii.min()), PLACES, MOST_PLACES)))
    owner = cKDTree(fine.nodes).query(cloud)[1]
    count = np.bincount(owner, minlength=len(fine.nodes))
    means = np.stack([np.bincount(owner, x, len(fine.nodes)) for x in cloud.T], axis=1) / np.maximum(count, 1)[:, None]
    seen = count >= SEEN
    places = np.concatenate([means[seen], along.points])
    radii = np.concatenate([fine.radii[seen], truth.radii[truth.edges[along.edges]].mean(axis=1)])
    samples = curve_samples(curve, PLACES)
    apart, nearest = cKDTree(places).query(samples.points)
    near = apart <= HALF * radii[nearest]
    said = (curve.regimes == Regime.SHEET)[curve.edges[samples.edges]].any(axis=1) | curve.bridged[samples.edges]
    return {
        "reached": by_length(curve, samples.edges, near),
        "reached_or_said": by_length(curve, samples.edges, near | said),
    }


def divided(curve: CurveGraph, parts: int) -> CurveGraph:
    """Return a curve with each edge in so many parts."""
    share = (np.arange(1, parts) / parts)[None, :]
    (a, b), count = curve.edges.T, len(curve.nodes)
    inner = curve.nodes[a][:, None] * (1 - share[..., None]) + curve.nodes[b][:, None] * share[..., None]
    radii = curve.radii[a][:, None] * (1 - share) + curve.radii[b][:, None] * share
    new = count + np.arange(len(curve.edges) * (parts - 1)).reshape(len(curve.edges), parts - 1)
    chain = np.concatenate([a[:, None], new, b[:, None]], axis=1)
    edges = np.stack([chain[:, :-1], chain[:, 1:]], axis=2).reshape(-1, 2)
    nodes = np.concatenate([curve.nodes, inner.reshape(-1, 3)])
    return CurveGraph(nodes, tidy_edges(edges.astype(np.int32)), np.concatenate([curve.radii, radii.ravel()]))


def of_tree(curve: CurveGraph, truth: CurveGraph, cloud: np.ndarray) -> Row:
    """Return precision, recall and F of length, tips, joints, and errors of radii by what they are said to be worth."""
    from tiskel.metrics.tree_truth import tree_agreement

    document = tree_agreement(curve, truth, cloud).as_dict()
    radii = document.pop("radii")
    document = {f"tree_{key}": value for key, value in document.items()}
    for source in {error["source"] for error in radii}:
        chosen = [error for error in radii if error["source"] == source]
        total = sum(error["share"] for error in chosen)
        document[f"radius_share_{source.lower()}"] = total
        document[f"radius_error_{source.lower()}"] = sum(e["share"] * e["error"] for e in chosen) / total
    return document


def faults(row: Row, kind: str) -> list[str]:
    """Return what is wrong with a curve, by name."""
    found = [name for name in ("components", "loops", "ends") if row.get(f"{name}_right") == 0]
    found += ["air"] if (row.get("air") or 0) > IN_AIR else []
    found += ["outside"] if row.get("inside", 1) < 1 - OUTSIDE else []
    found += ["unreached"] if kind == "view" and row.get("reached_or_said", 1) < 1 - UNREACHED else []
    found += ["tree"] if (row.get("tree_f") or 1) < TREE_F else []
    return found


def classified(rows: list[Row], method: str) -> Counter[str]:
    """Return how many curves are wrong or right, and of these how many carry a warning."""
    total: Counter[str] = Counter()
    for row in rows:
        if row["method"] == method and "seconds" in row:
            word = "wrong" if row["wrong"] else "right"
            total[word] += 1
            total[f"{word}, warned"] += row["warnings"] > 0
    return total


def by_code(rows: list[Row], method: str) -> dict[str, Counter[str]]:
    """Return for each code how many wrong and how many right curves carry it."""
    found: dict[str, Counter[str]] = {}
    for row in rows:
        if row["method"] == method:
            for code in filter(None, set(row.get("codes", "").split("; "))):
                found.setdefault(code, Counter())["wrong" if row["wrong"] else "right"] += 1
    return found
