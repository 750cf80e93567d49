"""How many clouds a minute a batch does, with jobs and threads divided in three ways that take turns."""

import statistics
import time
from pathlib import Path

from tables import Row

from tiskel import PipelineParams, ShapeParams, make_shape, named_shape
from tiskel.batch import Plan, Settled, Task, find_tasks, run_batch
from tiskel.io.clouds import dump_cloud
from tiskel.params import BatchParams

WAYS = {"1 job, 1 thread": (1, 1), "2 jobs, 1 thread each": (2, 1), "1 job, 2 threads": (1, 2)}


def throughput(folder: Path, rounds: int, count: int) -> list[Row]:
    """Return clouds per minute of every way, and its ratio to the first, medians over rounds in turn."""
    alike = folder / "alike"
    alike.mkdir()
    for seed in range(count):
        points = make_shape(named_shape("hand"), ShapeParams(count=1000, seed=seed))[0]
        (alike / f"{seed:04}.ply").write_bytes(dump_cloud(points, "a.ply"))
    tasks = find_tasks([str(alike)], folder / "any")
    rates: dict[str, list[float]] = {way: [] for way in WAYS}
    for number in range(rounds):
        for way, (jobs, threads) in WAYS.items():
            rates[way].append(_rate(tasks, folder / f"{jobs}-{threads}-{number}", jobs, threads))
    first = rates[next(iter(WAYS))]
    return [
        {
            "way": way,
            "clouds per minute": f"{statistics.median(of):.1f}",
            "to the first": f"{statistics.median(a / b for a, b in zip(of, first, strict=True)):.2f}",
            "rounds": " ".join(f"{a / b:.2f}" for a, b in zip(of, first, strict=True)),
        }
        for way, of in rates.items()
    ]


def _rate(tasks: list[Task], output: Path, jobs: int, threads: int) -> float:
    params = PipelineParams(stages=("contract", "skeleton", "metrics"))
    plan = Plan(
        output=output, work="tiskel.cli.batch_work:work", params=BatchParams(jobs=jobs, threads=threads),
        settings={"params": params, "weights": None, "history": False, "pictures": False},
    )  # fmt: skip
    times = [time.perf_counter() for news in run_batch(tasks, plan) if isinstance(news, Settled)]
    return 60.0 * (len(times) - 2 * jobs + 1) / (times[-jobs] - times[jobs - 1])  # all are at work in between
