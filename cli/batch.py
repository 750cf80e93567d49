"""``tiskel batch``."""

import json
import signal
from collections import Counter
from collections.abc import Mapping
from contextlib import closing
from dataclasses import asdict
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

import typer

from tiskel.cli import batch_options as b
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli import surface_options as so
from tiskel.cli.batch_board import Board
from tiskel.cli.common import common, contracts, curves, reads_cloud, rolls
from tiskel.errors import TiskelError
from tiskel.params import BatchParams, PipelineParams, SkeletonParams, SurfaceParams

if TYPE_CHECKING:
    from tiskel.batch import Plan, Settled, Task

TERMINATED = 128 + signal.SIGTERM  # exit code, as a shell reports a process that this signal ended


@common
@reads_cloud
@contracts
@curves
@rolls
def batch(
    sources: b.Sources,
    output: b.Folder,
    method: o.MethodName = o.METHOD,
    weights: o.Weights = None,
    history: o.History = False,
    branch: so.Branch = so.SURFACE.branch,
    stage_list: b.Stages = b.ALL,
    jobs: b.Jobs = b.BATCH.jobs,
    timeout: b.Timeout = b.BATCH.timeout,
    memory: b.Memory = b.BATCH.memory,
    shard: b.Shard = "1/1",
    scheduler: b.Scheduler = "",
    lease: b.Lease = b.BATCH.lease,
    fresh: b.Fresh = b.BATCH.fresh,
    as_json: b.Summary = False,
    *,
    conditioning: Mapping[str, Any],
    contracting: Mapping[str, Any],
    curving: Mapping[str, Any],
    rolling: Mapping[str, Any],
) -> None:
    """Do many clouds: all that run does, a sub-folder each; resumable, on one machine or many.

    `tiskel batch scans/ -o out/ --jobs 8 --timeout 600` and, with what failed, `tiskel batch @out/failed.txt -o out/`
    """
    wanted, pictures = b.stages_of(stage_list)
    params = PipelineParams(
        conditioning=stages.conditioning_params(conditioning),
        contraction=stages.contraction_params(method, contracting),
        skeleton=SkeletonParams(**curving),
        surface=SurfaceParams(branch=branch),
        roll=so.roll_settings(**rolling),
        stages=wanted,
    )
    extras = {"weights": weights, "history": history, "pictures": pictures}
    from tiskel.batch import Plan, find_tasks

    plan = Plan(
        output=output,
        work="tiskel.cli.batch_work:work",
        settings={"params": params, **extras},
        parameters=json.loads(json.dumps(asdict(params) | extras)),
        params=BatchParams(
            jobs=jobs, threads=_threads(), timeout=timeout, memory=memory, fresh=fresh, shard=b.shard_of(shard),
            lease=lease,
        ),
    )  # fmt: skip
    tasks = find_tasks(sources, output, plan.params.shard)
    settled = _work(tasks, plan, scheduler)
    counts = Counter(one.outcome for one in settled)
    if as_json:
        typer.echo(json.dumps({"done": counts["done"], "failed": counts["failed"], "kept": counts["kept"]}))
    _judge(settled, plan)


def _threads() -> int | None:
    """Return what --threads or its variable says."""
    import os

    from tiskel.kernels.threads import THREADS_VARIABLE, requested_threads

    return requested_threads() if THREADS_VARIABLE in os.environ else None


def _work(tasks: "list[Task]", plan: "Plan", scheduler: str) -> "list[Settled]":
    """Do all clouds, and show how far it is."""
    from tiskel.batch import Settled, run_batch

    settled: list[Settled] = []
    signal.signal(signal.SIGTERM, _end)
    with Board(len(tasks)) as board, closing(run_batch(tasks, plan, scheduler)) as news:
        for new in news:
            board.tell(new)
            if isinstance(new, Settled):
                settled.append(new)
    return settled


def _judge(settled: "list[Settled]", plan: "Plan") -> None:
    """Raise where clouds failed; warn where some have warnings, which --strict makes an error."""
    from tiskel.batch.summary import by_kind

    failed = [one.record for one in settled if one.outcome == "failed"]
    doubtful = sum(1 for one in settled if one.outcome != "failed" and one.record.get("warnings"))
    if failed:
        clouds = f"{len(failed)} of {len(settled)} clouds failed"
        raise TiskelError(f"{clouds}: {by_kind(failed)}; reasons in {plan.output / 'failed.txt'}")
    if doubtful:
        console.warn((f"{doubtful} of {len(settled)} clouds have warnings; see {plan.output / 'summary.csv'}",))


def _end(signum: int, frame: FrameType | None) -> NoReturn:
    """End as at Ctrl-C, with the exit code of the signal: batch systems send it before they kill."""
    raise SystemExit(TERMINATED)
