"""Skeletons against the truth: every shape, clean and degraded, and random graphs of round cones.

    python benchmarks/quality.py [SETTING...]     # names as in SETTINGS; all of them without

Writes benchmarks/quality/table.csv and table.md: for every method and setting how often components and loops are right,
the share of true ends found and of found ends that are spurious, distances to the truth and back in local radii, the
share of the curve inside, and time.
"""

import platform
import sys
import time
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from tiskel import ContractionParams, ShapeParams, contract, evaluate, extract_skeleton, make_shape, shape_graph
from tiskel.quality.tables import to_csv
from tiskel.quality.truth import agreement
from tiskel.shapes.catalogue import SHAPES
from tiskel.shapes.random_graphs import random_graph
from tiskel.shapes.round_cones import ConeGraph

OUT = Path(__file__).parent / "quality"
METHODS = ("lbc", "gls")
RANDOM, RANDOM_COUNT = "random graphs", 100
SETTINGS: dict[str, dict[str, float]] = {
    "clean": {},
    "noise 10 %": {"noise": 0.1},
    "noise 25 %": {"noise": 0.25},
    "missing 10 %": {"missing": 0.1},
    "missing 20 %": {"missing": 0.2},
    "missing 30 %": {"missing": 0.3},
    "density 10:1": {"uneven": 10.0},
    "1024 points": {"count": 1024},
    "16384 points": {"count": 16384},
    RANDOM: {},
}
PACKAGES = ("tiskel", "numpy", "scipy", "taichi")

Row = dict[str, Any]


def subjects(setting: str) -> Iterator[tuple[str, ConeGraph, ShapeParams]]:
    """Yield name, shape and sampling of everything that a setting holds."""
    if setting == RANDOM:
        for seed in range(RANDOM_COUNT):
            made = random_graph(seed)
            yield f"seed {seed}", made.shape, ShapeParams(count=made.count)
        return
    for name in SHAPES:
        yield name, shape_graph(name), ShapeParams(**SETTINGS[setting])  # type: ignore[arg-type]


def scored(name: str, shape: ConeGraph, params: ShapeParams, setting: str, method: str) -> Row:
    cloud = make_shape(shape, params)[0]
    start = time.perf_counter()
    c = contract(cloud, ContractionParams(method=method))  # type: ignore[arg-type]
    s = extract_skeleton(c)
    seconds = time.perf_counter() - start
    inside = evaluate(s.cloud, nodes=s.nodes, edges=s.edges).as_dict()["inside"]["curve"]
    found = agreement(s.nodes, s.edges, shape)
    row: Row = {"setting": setting, "shape": name, "method": method, "points": len(cloud), **found.as_dict()}
    return row | {"right": int(found.topology_right), "inside": inside, "seconds": round(seconds, 2)}


def summary(rows: list[Row], setting: str, method: str) -> str:
    """Return one line of the table."""
    chosen = [row for row in rows if (row["setting"], row["method"]) == (setting, method)]
    true, found, spurious = (sum(row[key] for row in chosen) for key in ("true_ends", "ends", "spurious_ends"))
    cells = [
        f"{sum(row['right'] for row in chosen)} of {len(chosen)}",
        f"{found / max(true, 1):.0%}",
        f"{spurious / max(true, 1):.0%}",
        *(f"{mean(chosen, key):.2f}" for key in ("to_truth", "to_truth_95", "from_truth", "from_truth_95", "inside")),
        f"{np.median([row['seconds'] for row in chosen]):.2f}",
    ]
    return f"| {setting} | {method} | " + " | ".join(cells) + " |"


def mean(rows: list[Row], key: str) -> float:
    return float(np.mean([row[key] for row in rows if row[key] is not None]))


COLUMNS = (
    "setting", "method", "components and loops right", "ends found", "spurious ends",
    "to truth", "95 %", "from truth", "95 %", "inside", "seconds",
)  # fmt: skip
HEAD = "| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS)


def page(rows: list[Row], settings: list[str]) -> str:
    packages = ", ".join(f"{package} {metadata.version(package)}" for package in PACKAGES)
    lines = [summary(rows, setting, method) for setting in settings for method in METHODS]
    wrong = [
        f"- {setting}, {method}: "
        + (
            ", ".join(r["shape"] for r in rows if (r["setting"], r["method"], r["right"]) == (setting, method, 0))
            or "none"
        )
        for setting in settings
        for method in METHODS
    ]
    return (
        "# Skeletons against the truth\n\n"
        f"Made by `python benchmarks/quality.py` with Python {platform.python_version()}, {packages}. Shapes have 4096 "
        "points unless said otherwise. Distances are means in local radii; spurious ends are shares of the true ones; "
        "seconds are medians of contraction and graph together.\n\n"
        f"{HEAD}\n" + "\n".join(lines) + "\n\n## Wrong components or loops\n\n" + "\n".join(wrong) + "\n"
    )


def main() -> None:
    settings = sys.argv[1:] or list(SETTINGS)
    rows = []
    for setting in settings:
        for name, shape, params in subjects(setting):
            rows += [scored(name, shape, params, setting, method) for method in METHODS]
            print(setting, name, flush=True)
    OUT.mkdir(exist_ok=True)
    (OUT / "table.csv").write_bytes(to_csv(rows))
    (OUT / "table.md").write_text(page(rows, settings))


if __name__ == "__main__":
    main()
