"""One cloud contracted by lbc and by gls, one after the other in one process, with their raw curves."""

import contextlib
import time
from pathlib import Path
from typing import Any
from unittest.mock import patch

from subjects import generated, meaningful, scan

from tiskel import ContractionParams, TiskelError, contract, extract_skeleton
from tiskel.arrays import Points
from tiskel.geometry.round_cones import ConeGraph

METHODS = ("lbc", "gls")
FEW = 500  # points whose contraction loads the kernels, outside the clock


def pair(number: int, count: int, path: Path | None = None) -> dict[str, Any]:
    """Return processor seconds, points left, steps and topology of both methods on a generated cloud or a scan.

    Where a method makes no step, "error" says so.
    """
    if path is None:
        name, points, truth = generated(number, count)
    else:
        name, points, truth = path.stem, scan(path, count), None
    result: dict[str, Any] = {"name": name, "count": len(points)}
    with patch.object(time, "perf_counter", time.process_time):  # others at work on the machine do not count
        for method in METHODS:
            with contextlib.suppress(TiskelError):
                contract(points[:FEW], ContractionParams(method=method))
            try:
                result[method] = timed(points, method, truth)
            except TiskelError as error:
                return result | {"error": f"{method}: {error}"}
    return result


def timed(points: Points, method: str, truth: ConeGraph | None) -> dict[str, Any]:
    start = time.perf_counter()
    c = contract(points, ContractionParams(method=method, raw=True))
    middle = time.perf_counter()
    s = extract_skeleton(c)
    done = time.perf_counter()
    return {
        "contraction": middle - start - c.ring_seconds, "rings": c.ring_seconds, "curve": done - middle,
        "left": len(c.points) / len(points), "points": [step.points for step in c.steps],
        "ratio": [step.ring_ratio for step in c.steps], "score": [step.score for step in c.steps],
        "change": [step.score_change for step in c.steps], "components": s.components, "loops": s.loops,
        "right": None if truth is None else meaningful(s, truth), "status": c.status.value,
    }  # fmt: skip
