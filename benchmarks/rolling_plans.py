"""Random plans on a capsule, a hammer and a bunny: found, rolled and arrived, or refused, and whether that is true.

    python benchmarks/rolling_plans.py [--only capsule hammer bunny] [--numbers FIRST STOP] [--out DIR]

From a random place to another within thirty radii of the ball; four of five to a
random attitude, every fourth of these with spin. The ball is a quarter of the
median radius, of the bunny, where that stands at three of four places and gets from
one to another on 3 of 20 pairs (of an eighth on 15), a sixteenth: a second table says
where balls stand. What is refused is tried again, looked at twice as
closely and with a ball of half the radius. Rows are kept as they come, and what is
there is not planned again. The clouds come from TISKEL_REFERENCE, or ../shared/reference.
"""

import argparse
import csv
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rolling_body import body_of_cloud

from tiskel import PlanParams, TiskelError, plan_roll
from tiskel.arrays import Points
from tiskel.rolling import reachable
from tiskel.rolling.ambient import Ground, least_curvature
from tiskel.rolling.reachable import FITS, Standing
from tiskel.rolling.second import Surroundings
from tiskel.surfaces.implicit import projected
from tiskel.surfaces.implicit_bodies import Capsule

HERE = Path(__file__).parent / "rolling"
SHARES = {"capsule": 0.25, "hammer": 0.25, "bunny": 0.0625}  # of the median radius: the ball
APART = 30.0  # radii between start and goal at most
STANDS = (1 / 4, 1 / 8, 1 / 16, 1 / 32)  # of the median radius: balls of which it is told where they stand
CLOSER = 0.5  # of the spacing of places, for what is looked at again
HEAD = (
    "body", "plan", "attitude", "spin", "apart, radii", "way, radii", "seconds of CPU", "off, radii", "off, degrees",
    "rounds", "what", "looked at twice as closely", "half the ball",
)  # fmt: skip


def body_named(name: str) -> tuple[Any, Points, float]:
    """Return a surface, places on it to choose from, and its median radius."""
    if name != "capsule":
        body: Any = body_of_cloud(name)[1]
        return body, body.cloud, body.radius
    body, rng = Capsule((-1, 0, 0), (1, 0, 0), 0.5), np.random.default_rng(0)
    return body, projected(body, rng.uniform([-1.5, -0.5, -0.5], [1.5, 0.5, 0.5], (2000, 3))), 0.5


def params_of(number: int, places: Points, radius: float) -> PlanParams:
    """Return the task of a number: from where to where, and perhaps to which attitude."""
    rng = np.random.default_rng(number)
    start = places[rng.integers(len(places))]
    near = places[np.linalg.norm(places - start, axis=1) < APART * radius]
    goal = near[rng.integers(len(near))]
    attitude = tuple(rng.normal(size=4)) if number % 5 else None
    spin = attitude is not None and number % 4 == 3
    return PlanParams(start_at=tuple(start), goal=tuple(goal), attitude=attitude, spin=spin, radius=radius)


def planned(name: str, number: int, body: Any, places: Points, radius: float) -> list[Any]:
    """Return a row of the table."""
    params = params_of(number, places, radius)
    apart = float(np.linalg.norm(np.subtract(params.goal, params.start_at))) / radius
    begun = time.process_time()
    row: list[Any] = [name, number, params.attitude is not None, params.spin, apart]
    try:
        plan = plan_roll(body, params)
    except TiskelError as error:
        seconds = time.process_time() - begun
        with closer():
            again = told(body, replace(params, most_places=round(params.most_places / CLOSER**2)))
        return [*row, "", seconds, "", "", "", str(error), again, told(body, replace(params, radius=radius / 2))]
    seconds, way = time.process_time() - begun, plan.run.path_object / radius
    degrees = "" if plan.turned_off is None else plan.turned_off
    return [*row, way, seconds, plan.off, degrees, plan.rounds, "arrived", "", ""]


@contextmanager
def closer() -> Iterator[None]:
    """Let places be spread so much closer."""
    usual = reachable.SPACING
    reachable.SPACING = CLOSER * usual
    try:
        yield
    finally:
        reachable.SPACING = usual


def told(body: Any, params: PlanParams) -> str:
    """Return what becomes of a plan, in a word."""
    try:
        plan_roll(body, params)
    except TiskelError as error:
        return reason(str(error))
    return "arrived"


def reason(said: str) -> str:
    """Return the class of a refusal."""
    known = {
        "bends as sharply": "bends too sharply at start or goal",
        "would lie in it": "another part at start or goal",
        "most_places": "more places than the limit, and not there yet",
        "not connected": "not connected for this ball",
        "attitude is not reached": "attitude not reached",
        "places": "way too tight",
    }
    return next((word for part, word in known.items() if part in said), said)


def standing(name: str, body: Any, places: Points, usual: float) -> list[str]:
    """Return the rows of where balls stand."""
    lines = []
    for share in STANDS:
        ground = Ground(body, 1.0, share * usual)
        shape = ground.touches(at := projected(body, places))[2]
        fits = least_curvature(shape) * ground.radius + 1 > FITS
        stands = Standing(ground, Surroundings.of(ground), np.zeros((0, 4))).stands(at)
        lines.append(f"| {name} | 1/{1 / share:.0f} | {fits.mean():.1%} | {stands.mean():.1%} |")
    return lines


def summary(rows: Sequence[Sequence[Any]]) -> list[str]:
    """Return the table of the bodies as Markdown."""
    lines = [
        "| body | plans | with attitude | arrived | of these with attitude | median s of CPU | longest | "
        "off, radii, most | off, degrees, most | refused |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name in [*dict.fromkeys(row[0] for row in rows), "all"]:
        own = [row for row in rows if name in (row[0], "all")]
        there = [row for row in own if row[10] == "arrived"]
        seconds = [row[6] for row in there] or [float("nan")]
        refused = Counter(reason(row[10]) for row in own if row[10] != "arrived")
        lines.append(
            f"| {name} | {len(own)} | {sum(row[2] for row in own)} | {len(there)} | {sum(row[2] for row in there)} | "
            f"{np.median(seconds):.1f} | {max(seconds):.1f} | {max((row[7] for row in there), default=0):.1e} | "
            f"{max((row[8] for row in there if row[8] != ''), default=0):.2g} | "
            f"{'; '.join(f'{count} {what}' for what, count in refused.most_common())} |"
        )
    return lines


def refusals(rows: Sequence[Sequence[Any]]) -> list[str]:
    """Return the table of what was refused and tried again."""
    lines = ["| body | plan | refused | looked at twice as closely | half the ball |", "|---|---|---|---|---|"]
    for row in rows:
        if row[10] != "arrived":
            lines.append(f"| {row[0]} | {row[1]} | {row[10]} | {row[11]} | {row[12]} |")
    return lines


def kept(path: Path) -> list[list[Any]]:
    """Return the rows that are there."""
    if not path.exists():
        return []
    rows = list(csv.reader(path.open()))[1:]
    numbers = [[float(cell) if cell else "" for cell in row[4:9]] for row in rows]
    return [
        [row[0], int(row[1]), row[2] == "True", row[3] == "True", *cells, *row[9:]]
        for row, cells in zip(rows, numbers, strict=True)
    ]


def write(path: Path, rows: Sequence[Sequence[Any]]) -> None:
    """Write rows, those of a body together."""
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HEAD)
        table.writerows([[f"{v:.4g}" if isinstance(v, float) else v for v in row] for row in rows])


def main() -> None:
    """Plan what is not there yet, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plans", type=int, nargs=3, default=[34, 33, 33])
    parser.add_argument("--only", nargs="*", default=list(SHARES))
    parser.add_argument(
        "--numbers", type=int, nargs=2, default=[0, 10**9], help="the first, and the one after the last"
    )
    parser.add_argument("--out", type=Path, default=HERE)
    given = parser.parse_args()
    given.out.mkdir(exist_ok=True, parents=True)
    path = given.out / "plans.csv"
    rows, first, stands = (
        kept(path),
        0,
        ["| body | ball, radii of the body | bent gently enough | stands |", "|---" * 4 + "|"],
    )
    for name, count in zip(SHARES, given.plans, strict=True):
        if name in given.only:
            body, places, usual = body_named(name)
            stands += standing(name, body, places, usual)
            there = {row[1] for row in rows}
            for number in range(max(first, given.numbers[0]), min(first + count, given.numbers[1])):
                if number not in there:
                    rows = sorted(
                        [*rows, planned(name, number, body, places, SHARES[name] * usual)], key=lambda r: r[1]
                    )
                    write(path, rows)
        first += count
    text = ["# Random plans", "", *summary(rows), "", "## Where balls stand", "", *stands, "", "## Refusals", ""]
    (given.out / "plans.md").write_text("\n".join([*text, *refusals(rows)]) + "\n")


if __name__ == "__main__":
    main()
