"""Curves of gallery shapes, measured, and held against the true curve."""

import base64
import sys
from pathlib import Path
from typing import Any

import numpy as np
from keys import KEYS
from subjects import distance, meaningful

from tiskel import (
    ConditioningParams,
    ContractionParams,
    ShapeParams,
    TiskelError,
    assess_stability,
    condition,
    contract,
    evaluate,
    extract_skeleton,
    make_shape,
    shape_graph,
)

Json = dict[str, Any]
CONDITIONS = ("as is", "noise 5 %", "a quarter of the points")


def judged(name: str, condition_name: str, method: str, count: int) -> Json:
    """Return measures, stability and true error of a shape's curve; "failed" where its contraction makes no step."""
    shape = shape_graph(name)
    fewer = count // 4 if condition_name == CONDITIONS[2] else count
    points = make_shape(shape, ShapeParams(count=fewer))[0]
    if condition_name == CONDITIONS[1]:
        points = condition(points, ConditioningParams(noise=0.05))[0]
    try:
        c = contract(points, ContractionParams(method=method))
    except TiskelError as error:
        return {"name": name, "failed": str(error)}
    s = extract_skeleton(c)
    quality = evaluate(c.cloud, c.points, s.nodes, s.edges, origin=c.origin)
    document, stability = quality.as_dict(), assess_stability(c)
    found = {key: document[a][b] for key, (a, b) in KEYS.items()}
    found |= {
        "inside curve": document["inside"]["curve"],
        "medialness": document["medialness"]["curve"],
        "air": document["air"]["curve"],
    }
    return found | {"name": name, "stable": stability.stable, "spread": stability.steps[-1].distance,
                    "right": meaningful(s, shape),
                    "error": distance(s, shape), "seconds": quality.seconds}  # fmt: skip


def demonstrated(root: Path) -> Json:
    """Return pictures of what each measure sees on drawn shapes, and their numbers."""
    sys.path.insert(0, str(root))
    import demonstrations as drawn

    cut, bent = zip(*(drawn.bars(name)[3].distances for name in drawn.SHAPES), strict=True)
    by_ellipse, by_mean = (float(np.nanmedian(values, axis=1)[-1]) for values in drawn.centres())
    pictures = {name: base64.b64encode(draw()).decode() for name, draw in drawn.PICTURES.items()}
    return {
        "cut": float(min(cut)),
        "bent": float(max(bent)),
        "ellipse": by_ellipse,
        "mean": by_mean,
        "pictures": pictures,
    }
