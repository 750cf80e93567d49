"""A Dask cluster on this machine: the same results, and a worker that is lost costs nothing."""

import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tiskel.batch import Plan, Settled, find_tasks, run_batch
from tiskel.batch.owner import started
from tiskel.errors import TiskelError
from tiskel.params import BatchParams

pytest.importorskip("distributed")
PATIENCE = 120.0  # seconds for a process to start on a busy machine
HERE = ["--host", "127.0.0.1", "--no-dashboard"]


def dask(*words: str) -> "subprocess.Popen[bytes]":
    code = f"import sys; sys.path[:] = {sys.path!r}; from distributed.cli.{words[0]} import main; main()"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.Popen([sys.executable, "-c", code, *words[1:]], env=environment, stderr=subprocess.DEVNULL)


@pytest.fixture
def scheduler(tmp_path: Path) -> Iterator[str]:
    file = tmp_path / "scheduler.json"
    process = dask("dask_scheduler", *HERE, "--port", "0", "--scheduler-file", str(file))
    try:
        deadline = time.monotonic() + PATIENCE
        while not (file.exists() and file.read_text()):
            assert time.monotonic() < deadline
            time.sleep(0.1)
        yield json.loads(file.read_text())["address"]
    finally:
        process.kill()
        process.wait()


@pytest.fixture
def workers(scheduler: str, tmp_path: Path) -> "Iterator[list[subprocess.Popen[bytes]]]":
    words = ["--no-nanny", "--nthreads", "1", "--local-directory", str(tmp_path), *HERE]
    processes = [dask("dask_worker", scheduler, *words) for _ in range(2)]
    try:
        _all_there(scheduler, len(processes))
        yield processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


def _all_there(scheduler: str, count: int) -> None:
    from distributed import Client

    connect: Any = Client
    with connect(scheduler) as client:
        client.wait_for_workers(count, timeout=PATIENCE)


def files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*.txt"))}


@pytest.mark.slow
def test_a_cluster_does_the_same_and_a_lost_worker_costs_nothing(
    scheduler: str, workers: "list[subprocess.Popen[bytes]]", tmp_path: Path
) -> None:
    scans = tmp_path / "scans"
    scans.mkdir()
    for i in range(12):
        (scans / f"s{i}.xyz").write_text(f"good {i}")
    (scans / "bad.xyz").write_text("kill it")
    log = tmp_path / "log"
    plan = Plan(
        output=tmp_path / "out", work="reference.batch_works:obey", settings={"pause": 0.3, "log": str(log)},
        params=BatchParams(jobs=1, threads=1, lease=2.0),
    )  # fmt: skip
    tasks, settled = find_tasks([str(scans)], plan.output), []
    for news in run_batch(tasks, plan, scheduler):
        settled += [news] if isinstance(news, Settled) else []
        if len(settled) == 4:
            workers[0].send_signal(signal.SIGKILL)
    assert Counter(one.outcome for one in settled) == {"done": 12, "failed": 1}
    records = [json.loads(line) for line in plan.manifest.read_text().splitlines()][1:]
    assert sorted(record["name"] for record in records) == sorted(task.name for task in tasks)
    children = {int(line.split()[2]) for line in log.read_text().splitlines()}
    assert not any(started(pid) for pid in children)
    assert not (plan.output / ".batch").exists()
    plain = replace(plan, output=tmp_path / "plain", settings=None)
    assert list(run_batch(tasks, plain))
    assert files(plain.output) == files(plan.output)


@pytest.mark.slow
def test_a_cluster_without_workers_says_so(scheduler: str, tmp_path: Path) -> None:
    (tmp_path / "a.xyz").write_text("good")
    plan = Plan(output=tmp_path / "out", work="reference.batch_works:obey")
    with pytest.raises(TiskelError, match="has no workers"):
        list(run_batch(find_tasks([str(tmp_path / "a.xyz")], plan.output), plan, scheduler))


def test_a_cluster_that_is_not_there_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tiskel.batch.cluster.PATIENCE", 0.5)
    (tmp_path / "a.xyz").write_text("good")
    plan = Plan(output=tmp_path / "out", work="reference.batch_works:obey")
    with pytest.raises(TiskelError, match=r"no scheduler at tcp://127.0.0.1:1: .*dask scheduler"):
        list(run_batch(find_tasks([str(tmp_path / "a.xyz")], plan.output), plan, "tcp://127.0.0.1:1"))
