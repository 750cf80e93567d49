"""The measures of gls and lbc over all shapes and reference clouds, as they are, noisy, and thinned.

    python benchmarks/measures.py [reference folder]

Writes benchmarks/measures/table.csv and table.md, with the versions that made them and what the numbers say about the
papers' findings. Without the reference folder the table holds the shapes alone.
"""

import platform
import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from tiskel import (
    ConditioningParams,
    ContractionParams,
    MetricParams,
    ShapeParams,
    TiskelError,
    assess_stability,
    condition,
    contract,
    evaluate,
    extract_skeleton,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Points
from tiskel.gallery.catalogue import SHAPES
from tiskel.metrics.tables import COLUMNS, row_of, said, to_csv

OUT = Path(__file__).parent / "measures"
REFERENCE = Path(__file__).parents[1] / ".." / "shared" / "reference"
CLOUDS = ("hammer", "horse", "joint", "fertility", "cave")
BY_GRID = ("cave",)  # thinned by grid average, as the published tables have caves and trees
THINNED, NOISE, POINTS = 1024, 0.05, 4096
CONDITIONS = ("as is", "noise 5 %", "1024 points")
METHODS = ("lbc", "gls")
PACKAGES = ("tiskel", "numpy", "scipy", "taichi", "ripser")

Row = dict[str, Any]


def clouds(folder: Path) -> Iterator[tuple[str, Points]]:
    for name in SHAPES:
        yield name, make_shape(shape_graph(name), ShapeParams(count=POINTS))[0]
    for name in CLOUDS:
        path = folder / "clouds" / f"{name}.ply"
        if path.exists():
            yield f"{name} (reference)", load_cloud(path).points


def degraded(name: str, points: Points, how: str) -> Points:
    if how == "noise 5 %":
        return condition(points, ConditioningParams(noise=NOISE))[0]
    if how == "1024 points":
        by_grid = name.split(maxsplit=1)[0] in BY_GRID
        params = ConditioningParams(voxel=voxel_for(points)) if by_grid else ConditioningParams(sample=THINNED)
        return condition(points, params)[0]
    return points


def voxel_for(points: Points) -> float:
    """Return the side of the cubes that leave about 1024 points, by bisection."""
    low, high = 0.0, float(np.ptp(points, axis=0).max())
    for _ in range(30):
        side = (low + high) / 2
        left = len(condition(points, ConditioningParams(voxel=side))[0])
        low, high = (side, high) if left > THINNED else (low, side)
    return high


def measured(name: str, points: Points, how: str, method: str) -> Row:
    row: Row = {"cloud": name, "condition": how, "method": method}
    try:
        c = contract(degraded(name, points, how), ContractionParams(method=method))  # type: ignore[arg-type]
        s = extract_skeleton(c)
        document = evaluate(c.cloud, c.points, s.nodes, s.edges, origin=c.origin, params=MetricParams()).as_dict()
        stability = assess_stability(c)
        row |= {"points": len(c.cloud), "left": len(c.points), "status": c.status.value}
        return (
            row
            | row_of(document)
            | {"stable": "yes" if stability.stable else "no", "distance": stability.steps[-1].distance}
        )
    except TiskelError as error:
        raise SystemExit(f"{name}, {how}, {method}: {error}") from error


def table_of(rows: list[Row]) -> str:
    """Return the table in Markdown; shares and distances with three digits."""
    shown = [c for c in COLUMNS if c.key not in ("graph_length", "graph_joints")]
    heads = ["cloud", "condition", "method", "points", "left", *(c.heading for c in shown), "stable"]
    keys = ["cloud", "condition", "method", "points", "left", *(c.key for c in shown), "stable"]
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for row in rows:
        cells = [f"{v:.3f}" if isinstance(v := row[key], float) else said(v) for key in keys]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def values(rows: list[Row], key: str, **where: str) -> dict[tuple[str, str], float]:
    """Return the known values of a measure by cloud and method."""
    chosen = [row for row in rows if all(row[k] == v for k, v in where.items())]
    return {(row["cloud"], row["method"]): row[key] for row in chosen if row[key] is not None}


MEASURES = [f"{m}_{of}" for m in ("boundedness", "inside", "centredness", "smoothness") for of in ("points", "curve")]


def effect(rows: list[Row], key: str, how: str, method: str) -> str:
    """Return by how much a measure changes under a condition, and on how many clouds it falls and rises."""
    before, after = (values(rows, key, condition=c, method=method) for c in ("as is", how))
    change = np.array([after[k] - before[k] for k in before if k in after])
    return f"{change.mean():+.3f} ({(change < 0).sum()} fall, {(change > 0).sum()} rise of {len(change)})"


def explained(rows: list[Row], key: str, by: str) -> float:
    """Return the share of a measure's variance between the groups of one column (eta squared)."""
    known = [row for row in rows if row[key] is not None]
    everything = np.array([row[key] for row in known])
    groups: dict[str, list[float]] = {}
    for row in known:
        groups.setdefault(row[by], []).append(row[key])
    between = sum(len(g) * (np.mean(g) - everything.mean()) ** 2 for g in groups.values())
    total = ((everything - everything.mean()) ** 2).sum()
    return float(between / total) if total > 0 else 0.0


def findings(rows: list[Row]) -> str:
    """Return the effects of noise and thinning, and what the variance of each measure lies between."""
    lines = ["| measure | method | noise 5 % | 1024 points |", "|---|---|---|---|"]
    for key in MEASURES:
        for method in METHODS:
            effects = " | ".join(effect(rows, key, how, method) for how in CONDITIONS[1:])
            lines.append(f"| {key.replace('_', ' of ')} | {method} | {effects} |")
    lines += ["", "Share of the variance between clouds, conditions and methods:", ""]
    lines += ["| measure | cloud | condition | method |", "|---|---|---|---|"]
    for key in MEASURES:
        shares = " | ".join(f"{explained(rows, key, by):.2f}" for by in ("cloud", "condition", "method"))
        lines.append(f"| {key.replace('_', ' of ')} | {shares} |")
    return "\n".join(lines)


def statements(rows: list[Row]) -> str:
    """Return what the numbers say about the published findings, whichever way they fall."""
    lines = []
    for measure in ("boundedness", "centredness"):
        for how, cause in zip(CONDITIONS[1:], ("Noise", "Thinning to 1024 points"), strict=True):
            parts = [
                f"{of} {method} {mean_change(rows, f'{measure}_{of}', how, method):+.3f}"
                for of in ("points", "curve")
                for method in METHODS
            ]
            said_so = verdict(
                [mean_change(rows, f"{measure}_{of}", how, m) for of in ("points", "curve") for m in METHODS]
            )
            lines.append(f"- *{cause} lowers {measure}*: {said_so} ({', '.join(parts)}).")
    for of in ("points", "curve"):
        cloud, how, method = (explained(rows, f"smoothness_{of}", by) for by in ("cloud", "condition", "method"))
        follows = "yes" if cloud > 2 * max(how, method) else "not mainly"
        lines.append(
            f"- *Smoothness of {of} follows the shape*: {follows}; {cloud:.0%} of its variance lie between clouds, "
            f"{how:.0%} between conditions, {method:.0%} between methods."
        )
    return "\n".join(lines)


def verdict(changes: list[float]) -> str:
    """Return in words how many of the mean changes are falls of more than 0.01."""
    falls = sum(change < -0.01 for change in changes)
    return {0: "not here", len(changes): "yes"}.get(falls, f"in {falls} of {len(changes)} cases")


def mean_change(rows: list[Row], key: str, how: str, method: str) -> float:
    before, after = (values(rows, key, condition=c, method=method) for c in ("as is", how))
    return float(np.mean([after[k] - before[k] for k in before if k in after]))


def versions() -> str:
    packages = ", ".join(f"{package} {metadata.version(package)}" for package in PACKAGES)
    return f"Made by `python benchmarks/measures.py` with Python {platform.python_version()}, {packages}."


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else REFERENCE
    rows = []
    for name, points in clouds(folder):
        for how in CONDITIONS:
            for method in METHODS:
                rows.append(measured(name, points, how, method))
                print(name, how, method, flush=True)
    OUT.mkdir(exist_ok=True)
    (OUT / "table.csv").write_bytes(to_csv(rows))
    page = (
        f"# Measures over shapes and reference clouds\n\n{versions()}\n\n{ABOUT}\n\n## The published findings\n\n"
        f"{statements(rows)}\n\n## Effects\n\n{findings(rows)}\n\n"
        f"## Table\n\n{table_of(rows)}\n"
    )
    (OUT / "table.md").write_text(page)


ABOUT = """Shapes have 4096 points. Noise is Gaussian with 5 % of each centred coordinate; 1024 points are a random
subset, of the cave a grid average. Bars by the toolbox's rule, the published settings throughout. An empty cell has no
value; `tiskel metrics` says why. `stable` is the verdict of `tiskel stability`. These curves are those of the published
methods, with their faults: what the measures say of them is the point."""

if __name__ == "__main__":
    main()
