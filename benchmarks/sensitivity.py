"""Sensitivity of method robust: what happens when one of its constants is 0.7 or 1.4 times as large?

    python benchmarks/sensitivity.py                  # continue benchmarks/sensitivity.csv, write sensitivity.md anew
    python benchmarks/sensitivity.py --out other.csv  # another table, with its page beside it

Turns every numeric constant of tiskel.methods.robust, element by element where it has several, and every numeric
setting of RobustParams, and compares curves, foot points and warnings with those of the values as they are. Whole
numbers are rounded and differ by one at least; what is a cosine, a quantile or a share (AT_MOST_ONE in constants.py)
stops at 1, which for the limit of a comparison means that it never, or always, holds. Rows are kept as long as the
constant has the same value and the clouds are as many: after any other change of the method, delete the table.
"""

import argparse
import csv
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from constants import PARAMS, Constant, constants, patched, turned

from tiskel import (
    RobustParams,
    ShapeParams,
    TiskelError,
    contract,
    extract_skeleton,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Points
from tiskel.contraction import Contraction
from tiskel.geometry.round_cones import ConeGraph
from tiskel.metrics.truth import agreement
from tiskel.skeleton import Skeleton

HERE = Path(__file__).parent
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", HERE / ".." / ".." / "shared" / "reference")) / "clouds"
FACTORS = 0.7, 1.4
EQUAL = 1e-9  # of the diagonal of the cloud: smaller differences are none
SHAPES: dict[str, dict[str, float]] = {  # how each is sampled: the hard ones of the gallery, degraded, 1500 points
    "y": {"noise": 0.25},
    "hand": {"noise": 0.25},
    "mug": {"missing": 0.2},
    "ladder": {"noise": 0.25},
    "tree": {},
    "quadruped": {"uneven": 10.0},
    "duck": {"missing": 0.2},
    "fork": {"noise": 0.1, "missing": 0.1},
    "table": {"noise": 0.25},
    "torus": {"missing": 0.2},
    "banana": {"noise": 0.25, "missing": 0.2},
}
COUNT = 1500  # points of a shape
SCANS = ("hammer", "horse", "fertility")
CONTRACTING = ("axes", "fronts", "network", PARAMS)  # what contract reads; the rest only acts on the curve
COLUMNS = (
    "constant", "value", "turned", "clouds", "curves", "points", "warnings", "topology", "ends",
    "now wrong", "now right", "true ends", "failed", "distance", "changed clouds",
)  # fmt: skip

CELLS = COLUMNS[4:14]

Row = dict[str, Any]


@dataclass(frozen=True)
class Cloud:
    """A cloud, its shape where that is known, and what the method makes of it as it is."""

    name: str
    points: Points
    shape: ConeGraph | None
    contraction: Contraction
    skeleton: Skeleton


def clouds() -> Iterator[Cloud]:
    """Yield every cloud, and its skeleton; scans only where the folder of reference clouds is there."""
    for name, how in SHAPES.items():
        shape = shape_graph(name)
        sampling = ShapeParams(**{"count": COUNT, **how})  # type: ignore[arg-type]
        yield unturned(name, make_shape(shape, sampling)[0], shape)
    for name in SCANS:
        if (REFERENCE / f"{name}.ply").is_file():
            yield unturned(name, load_cloud(REFERENCE / f"{name}.ply").points, None)


def unturned(name: str, points: Points, shape: ConeGraph | None) -> Cloud:
    contraction = contract(points, RobustParams())
    return Cloud(name, points, shape, contraction, extract_skeleton(contraction))


def again(cloud: Cloud, constant: Constant, params: RobustParams) -> Skeleton | None:
    """Return the skeleton with a constant turned, None where that fails."""
    try:
        if constant.module in CONTRACTING:
            return extract_skeleton(contract(cloud.points, params))
        return extract_skeleton(cloud.contraction)
    except (TiskelError, ValueError, IndexError, ZeroDivisionError, np.linalg.LinAlgError):
        return None


def differ(one: np.ndarray, other: np.ndarray, tolerance: float) -> bool:
    return one.shape != other.shape or bool(np.abs(one - other).max(initial=0) > tolerance)


def compared(cloud: Cloud, other: Skeleton | None) -> Row:
    """Return what differs between the skeleton of a cloud and another, as numbers to be summed."""
    one = cloud.skeleton
    if other is None:
        return {"failed": 1, "name": cloud.name}
    equal = EQUAL * float(np.linalg.norm(np.ptp(cloud.points, axis=0)))
    pairs = (one.nodes, other.nodes), (one.edges, other.edges), (one.radii, other.radii)
    row: Row = {
        "curves": any(differ(a, b, equal) for a, b in pairs),
        "points": differ(one.contracted, other.contracted, equal),
        "warnings": [w.code for w in one.warnings] != [w.code for w in other.warnings],
        "topology": (one.components, one.loops) != (other.components, other.loops),
        "ends": one.ends != other.ends,
    }
    row["name"] = cloud.name if any(row.values()) else ""
    if row["curves"]:
        old = agreement(other, ConeGraph(one.nodes, one.edges, np.maximum(one.radii, 1e-3 * one.radii.max())))
        row |= {"distance": max(old.to_truth or 0.0, old.from_truth or 0.0), **judged(cloud, other)}
    return row


def judged(cloud: Cloud, other: Skeleton) -> Row:
    """Return whether components and loops become right or wrong, and how many more ends are right ones."""
    if cloud.shape is None:
        return {}
    was, now = agreement(cloud.skeleton, cloud.shape), agreement(other, cloud.shape)
    return {
        "now wrong": was.topology_right and not now.topology_right,
        "now right": now.topology_right and not was.topology_right,
        "true ends": (now.ends - now.spurious_ends) - (was.ends - was.spurious_ends),
    }


def measured(constant: Constant, value: float, known: list[Cloud]) -> Row:
    """Return the row of one turn: numbers of clouds, and the largest mean distance of curves in local radii."""
    with patched(constant, value) as params:
        found = [compared(cloud, again(cloud, constant, params)) for cloud in known]
    sums = {key: sum(int(row.get(key, 0)) for row in found) for key in CELLS[:-1]}
    head = {"constant": constant.label, "value": f"{constant.value:.6g}", "turned": f"{value:.6g}"}
    largest = max(float(row.get("distance", 0.0)) for row in found)
    names = " ".join(row["name"] for row in found if row["name"])
    return {**head, "clouds": len(known), **sums, "distance": f"{largest:.4f}", "changed clouds": names}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=HERE / "sensitivity.csv", help="table; the page lies beside it")
    out: Path = parser.parse_args().out
    old = list(csv.DictReader(out.read_text().splitlines())) if out.is_file() else []
    known = list(clouds())
    rows: list[Row] = []
    kept: dict[tuple[str, ...], Row] = {tuple(row[key] for key in COLUMNS[:4]): row for row in old}
    turns = [(constant, turned(constant, factor)) for constant in constants() for factor in FACTORS]
    for constant, value in turns:
        key = constant.label, f"{constant.value:.6g}", f"{value:.6g}", str(len(known))
        rows.append(kept.pop(key) if key in kept else measured(constant, value, known))
        write(out, [*rows, *kept.values()])
        print(*rows[-1].values(), flush=True)
    write(out, rows)
    out.with_suffix(".md").write_text(page(rows, [cloud.name for cloud in known]))


def page(rows: list[Row], names: list[str]) -> str:
    """Return the table, the constants of most effect first, and the names of those without any."""
    of: dict[str, list[Row]] = {}
    for row in rows:
        of.setdefault(row["constant"], []).append(row)
    touched = [name for name, both in of.items() if any(row["changed clouds"] for row in both)]
    untouched = [f"- `{name}` = {both[0]['value']}" for name, both in of.items() if name not in touched]
    lines = [line(name, of[name]) for name in sorted(touched, key=lambda name: weight(of[name]), reverse=True)]
    return (
        "# Sensitivity of method robust\n\n"
        f"Made by `python benchmarks/sensitivity.py` on {len(names)} clouds: {', '.join(names)}. Every constant is "
        f"turned by {FACTORS[0]} and {FACTORS[1]}; each cell gives both, and is empty where both are 0. Curves, points "
        "(feet on the curve), warnings, topology (components or loops) and ends: number of clouds on which they "
        "change. Wrong and right: components and loops that become so, of the shapes whose skeleton is known. True "
        "ends: how many more ends are right ones, less spurious ones. Distance: of the changed curve to the unchanged "
        "one, in local radii, mean over the curve, on the cloud where it is largest.\n\n"
        "| constant | value | turned | " + " | ".join(CELLS) + " |\n|" + "---|" * (len(CELLS) + 3) + "\n"
        + "\n".join(lines) + "\n\n## Changes nothing\n\n" + "\n".join(untouched) + "\n"
    )  # fmt: skip


def line(name: str, both: list[Row]) -> str:
    """Return the line of a constant: what turning it down and up does."""
    pairs = ([str(row[key]) for row in both] for key in CELLS)
    cells = ["" if not any(float(one) for one in pair) else ", ".join(pair) for pair in pairs]
    return f"| `{name}` | {both[0]['value']} | {both[0]['turned']}, {both[1]['turned']} | " + " | ".join(cells) + " |"


def weight(both: list[Row]) -> tuple[float, ...]:
    """Return what constants are sorted by: wrong or failed clouds, changed topology, ends, distance, curves, rest."""
    sums = {key: sum(float(row[key]) for row in both) for key in CELLS}
    return sums["now wrong"] + sums["failed"], *(sums[key] for key in ("topology", "ends", "distance", "curves"))


def write(path: Path, rows: list[Row]) -> None:
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


if __name__ == "__main__":
    main()
