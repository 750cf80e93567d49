"""A batch as a whole, with a work that obeys its files: done once, resumed, redone where it must be, limits kept."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from reference.batch_works import FAILING
from tiskel.batch import Plan, Settled, find_tasks, run_batch
from tiskel.batch.owner import started
from tiskel.errors import TiskelError
from tiskel.params import BatchParams

WORK = "reference.batch_works:obey"
PARAMS = BatchParams(jobs=2, threads=1, lease=2.0)


@pytest.fixture
def scans(tmp_path: Path) -> Path:
    folder = tmp_path / "scans"
    folder.mkdir()
    for i in range(6):
        (folder / f"s{i}.xyz").write_text(f"good {i} {'x' * i}")
    return folder


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    return Plan(
        output=tmp_path / "out", work=WORK, settings={"log": str(tmp_path / "log")}, parameters={"a": 1}, params=PARAMS
    )


def settled(scans: Path, plan: Plan) -> dict[str, Settled]:
    news = run_batch(find_tasks([str(scans)], plan.output), plan)
    return {one.task.name: one for one in news if isinstance(one, Settled)}


def outcomes(scans: Path, plan: Plan) -> str:
    """Return the outcomes in the order of the names, a letter each."""
    return "".join(one.outcome[0] for _, one in sorted(settled(scans, plan).items()))


def begun(plan: Plan) -> Counter[str]:
    """Return how often each cloud was begun."""
    return Counter(line.split()[1] for line in Path(plan.settings["log"]).read_text().splitlines())


def tree(folder: Path) -> dict[str, bytes]:
    """Return all results of a batch, by path; what it says about itself is left out."""
    own = {"manifest.jsonl", "summary.csv", "failed.txt"}
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.name not in own)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def lines(plan: Plan) -> list[dict[str, Any]]:
    return [json.loads(line) for line in plan.manifest.read_text().splitlines()]


def test_every_cloud_gets_a_folder_a_line_and_a_row_and_nothing_else_is_left(scans: Path, plan: Plan) -> None:
    assert outcomes(scans, plan) == "dddddd"
    assert sorted(path.name for path in plan.output.iterdir()) == [
        "failed.txt", "manifest.jsonl", *(f"s{i}" for i in range(6)), "summary.csv",
    ]  # fmt: skip
    assert (plan.output / "s3" / "deep" / "back.txt").read_text() == "xxx 3 doog"
    first, *others = lines(plan)
    assert first["parameters"] == {"a": 1}
    assert {line["settings"] for line in others} == {first["settings"]}
    assert sorted(line["files"]["deep/back.txt"] for line in others) == [7, 8, 9, 10, 11, 12]
    rows = list(csv.DictReader((plan.output / "summary.csv").open()))
    assert [(row["name"], row["status"], row["length"]) for row in rows][2] == ("s2", "done", "9")
    assert float(rows[0]["seconds_all"]) == 0.5
    assert (plan.output / "failed.txt").read_text() == ""


def test_what_is_done_is_kept_and_what_is_not_as_it_was_is_done_again(scans: Path, plan: Plan) -> None:
    assert outcomes(scans, plan) == "dddddd"
    assert outcomes(scans, plan) == "kkkkkk"
    (scans / "s0.xyz").write_text("good 0 changed")  # of another size
    (scans / "s1.xyz").write_text("best 1 x")  # of the same size
    os.utime(scans / "s2.xyz")  # of another time and the same bytes
    (plan.output / "s3" / "half.txt").unlink()
    (plan.output / "s4" / "deep" / "back.txt").write_text("cut")
    assert outcomes(scans, plan) == "ddkddk"
    assert (plan.output / "s1" / "deep" / "back.txt").read_text() == "x 1 tseb"
    assert outcomes(scans, plan) == "kkkkkk"
    assert outcomes(scans, replace(plan, parameters={"a": 2})) == "dddddd"
    assert outcomes(scans, replace(plan, parameters={"a": 2}, params=replace(PARAMS, fresh=True))) == "dddddd"


def test_bad_clouds_fail_each_with_its_reason_and_cost_no_other(scans: Path, plan: Plan) -> None:
    for word in FAILING:
        (scans / f"{word}.xyz").write_text(f"{word} it")
    os.mkfifo(scans / "pipe.xyz")  # that nobody writes into
    plan = replace(plan, params=replace(PARAMS, timeout=4.0, memory=0.5))
    found = settled(scans, plan)
    assert found.pop("pipe").record["kind"] == "timeout"
    (scans / "pipe.xyz").unlink()
    assert {name: one.record["kind"] for name, one in found.items() if one.outcome == "failed"} == FAILING
    assert sum(one.outcome == "done" for one in found.values()) == 6
    message = {name: one.record["message"] for name, one in found.items()}
    assert "no cloud" in message["refuse"]
    assert message["raise"] == "unexpected RuntimeError: broken in two lines"
    assert "4 s" in message["wait"]
    assert "0.5" in message["eat"]
    assert "SIGABRT: assertion failed somewhere" in message["abort"]
    assert "exit code 3" in message["leave"]
    assert not any((plan.output / word).exists() for word in FAILING)
    failed = plan.output / "failed.txt"
    (scans / "pipe.xyz").write_text("good at last")
    assert [task.name for task in find_tasks([f"@{failed}"], plan.output)] == sorted([*FAILING, "pipe"])
    for word in FAILING:  # mended, and fed back in
        (scans / f"{word}.xyz").write_text("good again")
    again = [one for one in run_batch(find_tasks([f"@{failed}"], plan.output), plan) if isinstance(one, Settled)]
    assert [one.outcome for one in again] == ["done"] * (len(FAILING) + 1)
    assert failed.read_text() == ""


def test_results_of_a_cloud_that_fails_later_do_not_stay(scans: Path, plan: Plan) -> None:
    assert outcomes(scans, plan) == "dddddd"
    (scans / "s5.xyz").write_text("refuse it")
    assert outcomes(scans, plan) == "kkkkkf"
    assert not (plan.output / "s5").exists()


def test_a_folder_of_somebody_else_is_left_alone(scans: Path, plan: Plan) -> None:
    with pytest.raises(TiskelError, match="holds no manifest"):
        outcomes(scans, replace(plan, output=scans))
    assert len(list(scans.iterdir())) == 6


def test_shards_together_are_the_whole(scans: Path, plan: Plan, tmp_path: Path) -> None:
    assert outcomes(scans, plan) == "dddddd"
    shared = replace(plan, output=tmp_path / "shared")
    for part in range(1, 5):
        assert list(run_batch(find_tasks([str(scans)], shared.output, (part, 4)), shared))
    assert tree(shared.output) == tree(plan.output)
    assert begun(plan) == Counter({f"s{i}": 2 for i in range(6)})
    assert (shared.output / "summary.csv").read_text().count("\n") == 7


DRIVER = f"""
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a suite in the background hands on that it is ignored
sys.path[:] = {sys.path!r}
import json, os
from pathlib import Path
from tiskel.batch import Plan, Settled, find_tasks, run_batch
from tiskel.params import BatchParams
given = json.loads(sys.argv[1])
plan = Plan(output=Path(given["output"]), work={WORK!r}, settings=given["settings"], parameters={{"a": 1}},
            params=BatchParams(jobs=2, threads=1, lease=2.0))
for news in run_batch(find_tasks([given["scans"]], plan.output), plan):
    if isinstance(news, Settled):
        print(news.outcome, news.here, flush=True)
"""


def start(scans: Path, plan: Plan) -> "subprocess.Popen[str]":
    told = {"output": str(plan.output), "settings": plan.settings, "scans": str(scans)}
    return subprocess.Popen([sys.executable, "-c", DRIVER, json.dumps(told)], stdout=subprocess.PIPE, text=True)


def wait_until(condition: Any, seconds: float = 60.0) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def children(plan: Plan) -> list[int]:
    return sorted({int(line.split()[2]) for line in Path(plan.settings["log"]).read_text().splitlines()})


def test_a_killed_batch_goes_on_where_it_was_and_leaves_no_orphans(scans: Path, plan: Plan) -> None:
    plan.settings["pause"] = 0.3
    for kill_at in (1, 3):
        process = start(scans, plan)
        wait_until(lambda at=kill_at: plan.manifest.exists() and len(lines(plan)) > at)
        process.kill()
        process.communicate()
        wait_until(lambda: not any(started(pid) for pid in children(plan)), 10.0)
    done = {line["name"] for line in lines(plan) if "name" in line}
    before = begun(plan)
    assert settled(scans, plan).keys() == {f"s{i}" for i in range(6)}
    assert all(begun(plan)[name] == before[name] for name in done)
    assert Counter(line["name"] for line in lines(plan) if "name" in line) == Counter(f"s{i}" for i in range(6))
    assert not (plan.output / ".batch").exists()
    plain = replace(plan, output=plan.output.with_name("plain"), settings=None)
    settled(scans, plain)
    assert tree(plain.output) == tree(plan.output)


def test_two_processes_on_one_list_do_each_cloud_once(scans: Path, plan: Plan) -> None:
    plan.settings["pause"] = 0.3
    processes = [start(scans, plan) for _ in range(2)]
    told = [process.communicate(timeout=120)[0].split("\n")[:-1] for process in processes]
    assert [len(one) for one in told] == [6, 6]
    assert set(begun(plan).values()) == {1}
    assert sum(line.endswith("True") for one in told for line in one) == 6
    assert not (plan.output / ".batch").exists()


def test_a_batch_that_is_stopped_ends_its_children_and_can_go_on(scans: Path, plan: Plan) -> None:
    plan.settings["pause"] = 5.0
    process = start(scans, plan)
    wait_until(lambda: Path(plan.settings["log"]).exists() and len(begun(plan)) == 2)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=30)
    assert process.returncode != 0
    assert not any(started(pid) for pid in children(plan))
    assert not (plan.output / ".batch").exists()
    plan.settings["pause"] = 0.0
    assert outcomes(scans, plan) == "dddddd"
