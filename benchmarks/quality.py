"""Skeletons against the truth: every shape, clean and degraded, random graphs of round cones, and scans.

    python benchmarks/quality.py [SETTING...]     # names as in SETTINGS; all of them without
    python benchmarks/quality.py clean --methods robust --out before     # a part of it, to compare two commits

Writes table.csv and table.md into benchmarks/quality, or the folder of --out: for every method and setting how often
components and loops are right, the share of true ends found and of found ends that are spurious, distances to the
truth and back in local radii, the qualities of the curve, and time. Two settings run side by side, one thread each.
The seeds of the random graphs come from the hash of the commit that is scored, so that nobody can have tuned to them.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from tiskel import (
    ContractionParams,
    ShapeParams,
    TiskelError,
    contract,
    evaluate,
    extract_skeleton,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.gallery.catalogue import SHAPES
from tiskel.gallery.make import analytic_skeleton
from tiskel.gallery.random_graphs import random_graph
from tiskel.geometry.round_cones import ConeGraph
from tiskel.metrics.tables import to_csv
from tiskel.metrics.truth import agreement

HERE = Path(__file__).parent
OUT = HERE / "quality"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", HERE / ".." / ".." / "shared" / "reference")) / "clouds"
TRUTH = "truth"  # the analytic skeleton, under the same measures: what they can be at best
METHODS = ("lbc", "gls", "robust", TRUTH)
SCORED = "TISKEL_SCORED_COMMIT"
RANDOM, RANDOM_COUNT = "random graphs", 100
BODIES, SCANS = "no curve skeleton", "scans and models"
DEGRADED: dict[str, dict[str, float]] = {
    "noise 10 %": {"noise": 0.1},
    "noise 25 %": {"noise": 0.25},
    "missing 10 %": {"missing": 0.1},
    "missing 20 %": {"missing": 0.2},
    "missing 30 %": {"missing": 0.3},
    "density 10:1": {"uneven": 10.0},
    "1024 points": {"count": 1024},
    "16384 points": {"count": 16384},
}
HARSHER: dict[str, dict[str, float]] = {  # reported only
    "noise 50 %": {"noise": 0.5},
    "missing 50 %": {"missing": 0.5},
    "density 50:1": {"uneven": 50.0},
    "512 points": {"count": 512},
}
SETTINGS: dict[str, dict[str, float]] = {"clean": {}, **DEGRADED, **HARSHER}
EVERY = (*SETTINGS, RANDOM, BODIES, SCANS)
QUALITIES = ("inside", "boundedness", "centredness", "smoothness")
PACKAGES = ("tiskel", "numpy", "scipy", "taichi")

Row = dict[str, Any]


def commit() -> str:
    """Return the hash of the commit that is scored: what HEAD was when the run began."""
    if SCORED not in os.environ:
        words = ["git", "rev-parse", "HEAD"]
        os.environ[SCORED] = subprocess.run(words, cwd=HERE, capture_output=True, text=True, check=True).stdout.strip()
    return os.environ[SCORED]


def random_seeds() -> list[int]:
    return [int(seed) for seed in np.random.SeedSequence(int(commit(), 16)).generate_state(RANDOM_COUNT)]


def subjects(setting: str) -> Iterator[tuple[str, ConeGraph, ShapeParams]]:
    """Yield name, shape and sampling of everything that a setting holds."""
    if setting == RANDOM:
        for seed in random_seeds():
            made = random_graph(seed)
            yield f"seed {seed}", made.shape, ShapeParams(count=made.count)
        return
    for name in SHAPES:
        yield name, shape_graph(name), ShapeParams(**SETTINGS[setting])  # type: ignore[arg-type]


def clouds(setting: str) -> Iterator[tuple[str, np.ndarray]]:
    """Yield clouds that have no analytic skeleton."""
    if setting == SCANS:
        for path in sorted(REFERENCE.glob("*.ply")):
            yield path.stem, load_cloud(path).points
        return
    generator = np.random.default_rng(0)
    ball = generator.normal(size=(4096, 3))
    yield "plate", block(np.array([1.0, 0.7, 0.05]), generator)
    yield "box", block(np.array([1.0, 0.8, 0.6]), generator)
    yield "ball", ball / np.linalg.norm(ball, axis=1)[:, None]


def block(half: np.ndarray, generator: np.random.Generator) -> np.ndarray:
    """Return 4096 points on a block of these half sides, even by area."""
    points = generator.uniform(-1, 1, (4096, 3))
    side = generator.choice(3, len(points), p=(1 / half) / (1 / half).sum())
    points[np.arange(len(points)), side] = np.sign(points[np.arange(len(points)), side])
    return points * half


def scored(name: str, cloud: np.ndarray, shape: ConeGraph | None, setting: str, method: str) -> Row:
    """Return everything about one skeleton; nothing but why where there is none."""
    row: Row = {"setting": setting, "shape": name, "method": method, "points": len(cloud)}
    start = time.perf_counter()
    try:
        if method == TRUTH and shape is not None:
            s = analytic_skeleton(shape, cloud)
        else:
            s = extract_skeleton(contract(cloud, ContractionParams(method=method)))  # type: ignore[arg-type]
    except TiskelError as error:
        return row | {"right": 0, "warnings": str(error)}
    seconds = time.perf_counter() - start
    quality = evaluate(s.cloud, nodes=s.nodes, edges=s.edges).as_dict()
    row |= {name: quality[name]["curve"] for name in QUALITIES}
    row |= {"found_components": s.components, "found_loops": s.loops, "found_ends": s.ends}
    if shape is not None:
        found = agreement(s, shape)
        row |= {**found.as_dict(), "right": int(found.topology_right)}
    return row | {"seconds": round(seconds, 2), "warnings": "; ".join(map(str, s.warnings))}


def rows_of(setting: str, methods: list[str]) -> list[Row]:
    """Score all of a setting with all of some methods."""
    given: Iterator[tuple[str, np.ndarray, ConeGraph | None]]
    if setting in (BODIES, SCANS):
        given = ((name, cloud, None) for name, cloud in clouds(setting))
    else:
        given = ((name, make_shape(shape, params)[0], shape) for name, shape, params in subjects(setting))
    warm = make_shape(shape_graph("capsule"), ShapeParams(count=500))[0]
    for method in methods:  # kernels compile once
        scored("capsule", warm, shape_graph("capsule"), setting, method)
    return [
        scored(name, cloud, shape, setting, method)
        for name, cloud, shape in given
        for method in methods
        if shape is not None or method != TRUTH
    ]


def in_process(setting: str, methods: list[str]) -> list[Row]:
    """Score a setting in a process of its own."""
    words = [sys.executable, __file__, "--rows", setting, "--methods", *methods]
    done = subprocess.run(
        words, env={**os.environ, "TISKEL_NUM_THREADS": "1"}, capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(f"{setting}: {done.stderr}")
    print(setting, flush=True)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def summary(rows: list[Row], setting: str, method: str) -> str:
    """Return one line of the table."""
    chosen = [row for row in rows if (row["setting"], row["method"]) == (setting, method)]
    true, found, spurious = (sum(row.get(key) or 0 for row in chosen) for key in ("true_ends", "ends", "spurious_ends"))
    measured = ("to_truth", "to_truth_95", "from_truth", "from_truth_95", *QUALITIES)
    cells = [
        f"{sum(row['right'] for row in chosen)} of {len(chosen)}",
        f"{found / max(true, 1):.0%}",
        f"{spurious / max(true, 1):.0%}",
        *(f"{mean(chosen, key):.3f}" for key in measured),
        f"{np.median([row['seconds'] for row in chosen if 'seconds' in row]):.2f}",
    ]
    return f"| {setting} | {method} | " + " | ".join(cells) + " |"


def mean(rows: list[Row], key: str) -> float:
    return float(np.mean([row[key] for row in rows if row.get(key) is not None]))


COLUMNS = (
    "setting", "method", "components and loops right", "ends found", "spurious ends",
    "to truth", "95 %", "from truth", "95 %", *QUALITIES, "seconds",
)  # fmt: skip
HEAD = "| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS)
COUNTED = ("cloud", "method", "components", "loops", "ends", *QUALITIES, "seconds", "warnings")


def counted(row: Row) -> str:
    """Return the line of a cloud without a known skeleton."""
    values = [row.get(key) for key in ("found_components", "found_loops", "found_ends", *QUALITIES, "seconds")]
    cells = ["" if v is None else f"{v:.3f}" if isinstance(v, float) else str(v) for v in values]
    return f"| {row['shape']} | {row['method']} | " + " | ".join([*cells, row["warnings"]]) + " |"


def totals(rows: list[Row], method: str) -> str:
    """Return what the degraded settings come to together."""
    chosen = [row for row in rows if row["setting"] in DEGRADED and row["method"] == method]
    true, found = (sum(row.get(key) or 0 for row in chosen) for key in ("true_ends", "ends"))
    return f"{method} {sum(row['right'] for row in chosen)} of {len(chosen)}, ends {found / max(true, 1):.0%}"


def page(rows: list[Row], settings: list[str], every: list[str]) -> str:
    methods = [method for method in every if method != TRUTH]
    packages = ", ".join(f"{package} {metadata.version(package)}" for package in PACKAGES)
    with_truth = [setting for setting in settings if setting not in (BODIES, SCANS)]
    lines = [summary(rows, setting, method) for setting in with_truth for method in every]
    wrong = [f"- {setting}, {method}: {missed(rows, setting, method)}" for setting in with_truth for method in methods]
    others = [counted(row) for row in rows if row["setting"] in (BODIES, SCANS)]
    return (
        "# Skeletons against the truth\n\n"
        f"Made by `python benchmarks/quality.py` with Python {platform.python_version()}, {packages}, on commit "
        f"`{commit()}`, whose digits seed the random graphs. Shapes have 4096 points unless said otherwise. Distances "
        "are means in local radii; spurious ends are shares of the true ones; inside, boundedness, centredness and "
        "smoothness are those of the curve; seconds are medians of contraction and graph together, one thread, two "
        "processes side by side. The lines called truth are the analytic skeletons under the same measures. "
        f"The targets are those of the clean and the degraded settings; {', '.join(HARSHER)} are reported only.\n\n"
        f"{HEAD}\n" + "\n".join(lines) + "\n\n"
        f"Components and loops right on the degraded clouds ({', '.join(DEGRADED)}) together: "
        + "; ".join(totals(rows, method) for method in methods)
        + ".\n\n## Wrong components or loops\n\n" + "\n".join(wrong) + "\n"
        + "\n## Without a known skeleton\n\n| " + " | ".join(COUNTED) + " |\n|" + "---|" * len(COUNTED) + "\n"
        + "\n".join(others) + "\n"
    )  # fmt: skip


def missed(rows: list[Row], setting: str, method: str) -> str:
    chosen = [row for row in rows if (row["setting"], row["method"], row.get("right", 1))
              == (setting, method, 0)]  # fmt: skip
    return ", ".join(
        f"{r['shape']} (components {r['components']:+d}, loops {r['loops']:+d})" if "loops" in r else r["shape"]
        for r in chosen
    ) or "none"  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("settings", nargs="*", metavar="SETTING", choices=[[], *EVERY])
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=list(METHODS))
    parser.add_argument("--out", type=Path, default=OUT, help="folder of the tables")
    parser.add_argument("--rows", metavar="SETTING", help="print the rows of one setting as lines of JSON")
    options = parser.parse_args()
    if options.rows:
        for row in rows_of(options.rows, options.methods):
            print(json.dumps(row), flush=True)
        return
    settings = [s for s in options.settings or EVERY if s != SCANS or REFERENCE.is_dir()]
    commit()
    with ThreadPoolExecutor(2) as pool:
        rows = [row for found in pool.map(in_process, settings, [options.methods] * len(settings)) for row in found]
    options.out.mkdir(exist_ok=True, parents=True)
    keys = dict.fromkeys(key for row in rows for key in row)
    (options.out / "table.csv").write_bytes(to_csv([{key: row.get(key) for key in keys} for row in rows]))
    (options.out / "table.md").write_text(page(rows, settings, options.methods))


if __name__ == "__main__":
    main()
