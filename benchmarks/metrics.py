"""How fast the measures are, as ratios to yardsticks taken in the same process, alternating.

    python benchmarks/metrics.py                  # print; --write writes benchmarks/speed/metrics.{csv,md}
    python benchmarks/metrics.py --counts 4096    # only so many points
    python benchmarks/metrics.py --clouds 216     # contraction, skeleton and measures of so many clouds

Skeletal points, curve and loops of method robust are measured. Two yardsticks: the same of the shape hammer with as
many points, for shapes and cases that look like pipes, leaves and plants; and ripser(points, maxdim=0) on the dense
matrix of 4096 points. Peak memory is what a fresh process takes on top of what it holds after a small cloud. Cases are
taken from TISKEL_CASES, or ../shared/cases, where they are.
"""

import argparse
import csv
import multiprocessing
import os
import platform
import statistics
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from memory import held_from_now, peak
from ripser import ripser

from tiskel import Skeleton, contract, evaluate, extract_skeleton, load_cloud, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.params import ShapeParams

HERE = Path(__file__).parent
OUT = HERE / "speed"
CASES = Path(os.environ.get("TISKEL_CASES", HERE / ".." / ".." / "shared" / "cases"))
SHAPES, SCANS = ("helix", "tunnel", "knot"), ("leaf_fold", "maize", "aneurysm", "stent")
COUNTS = (4096, 16384, 65536)
ROUNDS = 3  # of each pair, after one to warm up
YARDSTICK = 4096
SMALL = ("hammer", "helix", "tunnel", "knot", "quadruped", "y", "tree", "hand", "torus")  # of the many clouds
COLUMNS = ("cloud", "points", "skeletal", "seconds", "hammer", "over_hammer", "over_ripser", "peak_mb", "largest")


def shape(name: str, count: int, seed: int = 0) -> Points:
    return make_shape(shape_graph(name), ShapeParams(count=count, seed=seed))[0]


def subjects(counts: list[int]) -> Iterator[tuple[str, Points]]:
    """Yield name and points of what is measured."""
    for count in counts:
        for name in SHAPES:
            yield f"{name} {count}", shape(name, count)
    for name in SCANS:
        if (CASES / f"{name}.xyz").exists():
            yield name, load_cloud(CASES / f"{name}.xyz").points


def timed(skeleton: Skeleton) -> tuple[float, dict[str, float]]:
    start = time.perf_counter()
    seconds = evaluate(skeleton).seconds
    return time.perf_counter() - start, seconds


def dense(points: Points) -> float:
    start = time.perf_counter()
    ripser(points[:YARDSTICK], maxdim=0)
    return time.perf_counter() - start


def taken(skeleton: Skeleton) -> float:
    """Return the megabytes that a fresh process takes for the measures, beyond what it held before."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return float(pool.apply(_taken, (skeleton,)))


def _taken(skeleton: Skeleton) -> float:
    evaluate(extract_skeleton(contract(shape("capsule", 500))))  # kernels are no part of it
    before = held_from_now()
    evaluate(skeleton)
    return peak() - before


def compare(name: str, points: Points, yardstick: Points) -> dict[str, object]:
    """Return a row of the table: medians of alternating rounds."""
    hammer = extract_skeleton(contract(shape("hammer", len(points))))
    skeleton = extract_skeleton(contract(points))
    timed(hammer), timed(skeleton)
    rounds = [(timed(skeleton), timed(hammer), dense(yardstick)) for _ in range(ROUNDS)]
    ours, theirs = (statistics.median(r[k][0] for r in rounds) for k in (0, 1))
    over_hammer = statistics.median(one[0] / other[0] for one, other, _ in rounds)
    over_ripser = statistics.median(one[0] / other for one, _, other in rounds)
    parts = {part: statistics.median(r[0][1][part] for r in rounds) for part in rounds[0][0][1]}
    largest = sorted(parts, key=lambda part: -parts[part])[:2]
    return {
        "cloud": name,
        "points": len(points),
        "skeletal": len(skeleton.contracted),
        "seconds": round(ours, 3),
        "hammer": round(theirs, 3),
        "over_hammer": round(over_hammer, 2),
        "over_ripser": round(over_ripser, 3),
        "peak_mb": round(taken(skeleton)),
        "largest": ", ".join(f"{part} {parts[part] / sum(parts.values()):.0%}" for part in largest),
    }


def many(count: int) -> str:
    """Return what so many small clouds take, one after the other, stage by stage."""
    stages = np.zeros((count, 3))
    for k in range(count):
        points = shape(SMALL[k % len(SMALL)], YARDSTICK, seed=k)
        marks = [time.perf_counter()]
        contraction = contract(points)
        marks.append(time.perf_counter())
        skeleton = extract_skeleton(contraction)
        marks.append(time.perf_counter())
        evaluate(skeleton)
        marks.append(time.perf_counter())
        stages[k] = np.diff(marks)
    parts = ", ".join(
        f"{name} {value:.2f}"
        for name, value in zip(("contraction", "skeleton", "measures"), np.median(stages, axis=0), strict=True)
    )
    return f"{count} clouds of {YARDSTICK} points: median {np.median(stages.sum(axis=1)):.2f} s ({parts})"


def page(rows: list[dict[str, object]], small: str) -> str:
    """Return the table in Markdown."""
    lines = [
        "# Measures: time and memory",
        "",
        f"`python benchmarks/metrics.py --write`; {platform.machine()}, {os.cpu_count()} cores, "
        f"TISKEL_NUM_THREADS={os.environ.get('TISKEL_NUM_THREADS', 'unset')}, NumPy {np.__version__}. "
        "Ratios are medians of alternating rounds in one process; seconds hang on what else the machine does.",
        "",
        small,
        "",
        "| " + " | ".join(COLUMNS) + " |",
        "|---" * len(COLUMNS) + "|",
    ]
    return "\n".join([*lines, *("| " + " | ".join(str(row[c]) for c in COLUMNS) + " |" for row in rows)]) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--counts", type=int, nargs="+", default=list(COUNTS))
    parser.add_argument("--clouds", type=int, default=0)
    chosen = parser.parse_args()
    small = many(chosen.clouds) if chosen.clouds else ""
    print(small)
    rows: list[dict[str, object]] = []
    yardstick = shape("hammer", YARDSTICK)
    for name, points in subjects(chosen.counts):
        rows.append(compare(name, points, yardstick))
        print(", ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
        if chosen.write:
            write(rows, small)


def write(rows: list[dict[str, object]], small: str) -> None:
    """Write the table as it is so far."""
    OUT.mkdir(exist_ok=True)
    with (OUT / "metrics.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        table.writerows(rows)
    (OUT / "metrics.md").write_text(page(rows, small))


if __name__ == "__main__":
    main()
