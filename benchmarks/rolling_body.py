"""Random rolls over whole bodies: do they slip, sink, hang, and do they cross joints and ends?

    python benchmarks/rolling_body.py [--rolls 40] [--write]

Five real clouds through contract, skeleton and slice; from random points, in
random directions with some spin, the ball a quarter of the local radius, 20 s at
about a radian per second. With --write the tables of benchmarks/rolling/ are
written. The clouds come from TISKEL_REFERENCE, or ../shared/reference.
"""

import argparse
import csv
import os
import time
from collections import Counter
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from tiskel import RollParams, Skeleton, TiskelError, contract, extract_skeleton, load_cloud, roll_on
from tiskel.slicing.body import fit_body
from tiskel.surfaces.patches import BodySurface

CLOUDS = {"hammer": "outside", "bunny": "outside", "fertility": "outside", "cave": "inside", "horse": "outside"}
HERE = Path(__file__).parent / "rolling"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", "../shared/reference"))
HEAD = (
    "cloud",
    "roll",
    "radius",
    "seconds of CPU",
    "status",
    "time",
    "way, radii",
    "slip",
    "deepest",
    "branches",
    "ends",
)


def body_of_cloud(name: str) -> tuple[Skeleton, BodySurface]:
    """Return skeleton and surface of a reference cloud."""
    skeleton = extract_skeleton(contract(load_cloud(REFERENCE / "clouds" / f"{name}.ply").points))
    from tiskel import fit_surface

    return skeleton, fit_body(skeleton, fit_surface(skeleton))


def random_roll(name: str, skeleton: Skeleton, body: BodySurface, tree: cKDTree, rng: np.random.Generator) -> list:
    """Return a row of the table: a roll from a random point at which the ball can stand."""
    degree = np.bincount(skeleton.edges.ravel(), minlength=len(skeleton.nodes))
    branch_of = {int(node): number for number, branch in enumerate(skeleton.branches) for node in branch[1:-1]}
    refused = 0
    while True:
        start, angle = body.cloud[rng.integers(len(body.cloud))], rng.uniform(0, 2 * np.pi)
        radius = float(body.local_radius(start[None])[0]) / 4
        spin = rng.uniform(-0.5, 0.5)
        if not radius > 0:
            continue
        params = RollParams(
            radius=radius, side=CLOUDS[name], start_at=tuple(start), duration=20.0, rate=20.0,
            omega=(np.cos(angle), np.sin(angle), spin),
        )  # fmt: skip
        begun = time.process_time()
        try:
            r = roll_on(body, params)
        except TiskelError:
            refused += 1
            continue
        seconds = time.process_time() - begun
        slip = abs(r.path_object - r.path_sphere) / max(r.path_object, 1e-12)
        deepest = float((1 - tree.query(r.centre)[0] / radius).max())
        nodes = skeleton.node_of_point[tree.query(r.contact)[1]]
        branches = {branch_of[int(node)] for node in nodes if int(node) in branch_of}
        ends = {int(node) for node in nodes if degree[node] == 1}
        return [name, refused, radius, seconds, r.status.value, r.t[-1], r.path_object / radius, slip, deepest,
                len(branches), len(ends)]  # fmt: skip


def summary(rows: list[list]) -> str:
    """Return the table of the clouds as Markdown."""
    lines = [
        "| cloud | rolls | refused starts | median s of CPU | longest | slip, most | deepest, radii "
        "| several branches | over an end | ended |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name in [*CLOUDS, "all"]:
        own = [row for row in rows if name in (row[0], "all")]
        if not own:
            continue
        seconds = [row[3] for row in own]
        ended = ", ".join(f"{count} {what}" for what, count in Counter(row[4] for row in own).most_common())
        lines.append(
            f"| {name} | {len(own)} | {sum(row[1] for row in own)} | {np.median(seconds):.2f} | {max(seconds):.2f} | "
            f"{max(row[7] for row in own):.1e} | {max(row[8] for row in own):.2f} | "
            f"{np.mean([row[9] > 1 for row in own]):.0%} | {np.mean([row[10] > 0 for row in own]):.0%} | {ended} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Roll, print the table, and write it where that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rolls", type=int, default=40)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    rows: list[list] = []
    for seed, name in enumerate(CLOUDS):
        skeleton, body = body_of_cloud(name)
        body.level(body.cloud[:1])  # the kernel is compiled before anything is timed
        tree, rng = cKDTree(body.cloud), np.random.default_rng(seed)
        rows += [random_roll(name, skeleton, body, tree, rng) for _ in range(given.rolls)]
        print(summary(rows[-given.rolls :]), flush=True)
    text = summary(rows)
    print(text)
    if given.write:
        (HERE / "body.md").write_text(f"# Rolls over whole bodies\n\n{text}\n")
        with (HERE / "body.csv").open("w", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(HEAD)
            table.writerows([[f"{v:.6g}" if isinstance(v, float) else v for v in row] for row in rows])


if __name__ == "__main__":
    main()
