"""Random plans on a capsule, a hammer and a bunny: found, rolled and arrived, or refused, and why.

    python benchmarks/rolling_plans.py [--plans 34 33 33] [--only capsule hammer bunny] [--write]

From a random place to another within thirty radii of the ball; four of five to a
random attitude, every fourth of these with spin. The ball is a quarter of the
median radius, of the bunny, whose fur has dents that bend sharper, a sixteenth. With
--write tables go to benchmarks/rolling/. The clouds come from TISKEL_REFERENCE,
or ../shared/reference.
"""

import argparse
import csv
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from rolling_body import body_of_cloud

from tiskel import PlanParams, TiskelError, plan_roll
from tiskel.arrays import Points
from tiskel.surfaces.implicit import projected
from tiskel.surfaces.implicit_bodies import Capsule

HERE = Path(__file__).parent / "rolling"
SHARES = {"capsule": 0.25, "hammer": 0.25, "bunny": 0.0625}  # of the median radius: the ball
APART = 30.0  # radii between start and goal at most
HEAD = ("body", "plan", "attitude", "spin", "apart, radii", "way, radii", "seconds", "off, radii", "off, degrees",
        "rounds", "what")  # fmt: skip


def body_named(name: str, rng: np.random.Generator) -> tuple[Any, Points, float]:
    """Return a surface, places on it to choose from, and the ball."""
    if name != "capsule":
        body: Any = body_of_cloud(name)[1]
        return body, body.cloud, SHARES[name] * body.radius
    body = Capsule((-1, 0, 0), (1, 0, 0), 0.5)
    return body, projected(body, rng.uniform([-1.5, -0.5, -0.5], [1.5, 0.5, 0.5], (2000, 3))), SHARES[name] * 0.5


def planned(name: str, number: int, body: Any, places: Points, radius: float, rng: np.random.Generator) -> list[Any]:
    """Return a row of the table."""
    start = places[rng.integers(len(places))]
    near = places[np.linalg.norm(places - start, axis=1) < APART * radius]
    goal = near[rng.integers(len(near))]
    attitude = tuple(rng.normal(size=4)) if number % 5 else None
    spin = attitude is not None and number % 4 == 3
    apart = float(np.linalg.norm(goal - start)) / radius
    params = PlanParams(start_at=tuple(start), goal=tuple(goal), attitude=attitude, spin=spin, radius=radius)
    begun = time.perf_counter()
    row: list[Any] = [name, number, attitude is not None, spin, apart]
    try:
        plan = plan_roll(body, params)
    except TiskelError as error:
        return [*row, "", time.perf_counter() - begun, "", "", "", str(error)]
    seconds, way = time.perf_counter() - begun, plan.run.path_object / radius
    degrees = "" if plan.turned_off is None else plan.turned_off
    return [*row, way, seconds, plan.off, degrees, plan.rounds, "arrived"]


def reason(said: str) -> str:
    """Return the class of a refusal."""
    known = {"cannot stand": "start or goal does not fit", "not connected": "not connected for this ball",
             "attitude is not reached": "attitude not reached", "places": "way too tight"}  # fmt: skip
    return next((word for part, word in known.items() if part in said), said)


def summary(rows: list[list[Any]]) -> str:
    """Return the table of the bodies as Markdown."""
    lines = [
        "| body | plans | with attitude | arrived | of these with attitude | median s | longest s | off, radii, most | "
        "off, degrees, most | refused |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name in [*dict.fromkeys(row[0] for row in rows), "all"]:
        own = [row for row in rows if name in (row[0], "all")]
        there = [row for row in own if row[-1] == "arrived"]
        seconds = [row[6] for row in there] or [float("nan")]
        refused = Counter(reason(row[-1]) for row in own if row[-1] != "arrived")
        lines.append(
            f"| {name} | {len(own)} | {sum(row[2] for row in own)} | {len(there)} | {sum(row[2] for row in there)} | "
            f"{np.median(seconds):.1f} | {max(seconds):.1f} | {max((row[7] for row in there), default=0):.1e} | "
            f"{max((row[8] for row in there if row[8] != ''), default=0):.2g} | "
            f"{'; '.join(f'{count} {what}' for what, count in refused.most_common())} |"
        )
    return "\n".join(lines)


def kept(without: set[str]) -> list[list[Any]]:
    """Return the rows of the stored table that are of other bodies."""
    path = HERE / "plans.csv"
    if not path.exists():
        return []
    rows = [row for row in list(csv.reader(path.open()))[1:] if row[0] not in without]
    numbers = [[float(cell) if cell else "" for cell in row[4:9]] for row in rows]
    return [
        [row[0], int(row[1]), row[2] == "True", row[3] == "True", *cells, row[9], row[10]]
        for row, cells in zip(rows, numbers, strict=True)
    ]


def main() -> None:
    """Plan, print the table, and write it where that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plans", type=int, nargs=3, default=[34, 33, 33])
    parser.add_argument("--only", nargs="*", default=list(SHARES))
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    rows: list[list[Any]] = []
    for seed, (name, count) in enumerate(zip(SHARES, given.plans, strict=True)):
        if name not in given.only:
            continue
        rng = np.random.default_rng(seed)
        body, places, radius = body_named(name, rng)
        for number in range(count):
            rows.append(planned(name, number, body, places, radius, rng))
            print(*rows[-1], flush=True)
    print(summary(rows))
    if given.write:
        rows = sorted(rows + kept({row[0] for row in rows}), key=lambda row: (list(SHARES).index(row[0]), row[1]))
        (HERE / "plans.md").write_text(f"# Random plans\n\n{summary(rows)}\n")
        with (HERE / "plans.csv").open("w", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(HEAD)
            table.writerows([[f"{v:.4g}" if isinstance(v, float) else v for v in row] for row in rows])


if __name__ == "__main__":
    main()
