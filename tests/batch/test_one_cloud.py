"""Supervisor, pool and manifest where something comes between: a lease is lost, a disk is full, a batch is stopped."""

import json
import os
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tiskel.batch import Plan, Settled, Task
from tiskel.batch.leases import key_of
from tiskel.batch.manifest import Manifest
from tiskel.batch.pool import Pool
from tiskel.batch.supervisor import Supervisor

WORK = "reference.batch_works:obey"


def task_in(folder: Path, name: str = "a", words: str = "good one") -> Task:
    (folder / f"{name}.xyz").write_text(words)
    return Task(name, str(folder / f"{name}.xyz"))


@pytest.fixture
def supervisor(tmp_path: Path) -> Any:
    one = Supervisor(Plan(output=tmp_path / "out", work=WORK), 1)
    yield one
    one.kill_children()
    one.close()


def test_a_cloud_whose_lease_was_lost_meanwhile_is_left_to_who_has_it(
    supervisor: Supervisor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    task, mine = task_in(tmp_path), supervisor.leases.mine
    monkeypatch.setattr(supervisor.leases, "mine", lambda key: False)
    assert supervisor.settle(task).outcome == "busy"
    assert not (tmp_path / "out" / "a").exists()
    assert not supervisor.plan.manifest.exists() or supervisor.plan.manifest.read_text() == ""
    monkeypatch.setattr(supervisor.leases, "mine", mine)
    supervisor.leases.release(key_of("a"))
    assert supervisor.settle(task).outcome == "done"
    (child,) = supervisor._children
    supervisor.kill_children()
    assert child._process is None
    Path(task.path).unlink()  # what was made of it is not kept, then
    assert supervisor._known(task) is None


def pool_of(settle: Any, *names: str, jobs: int = 1) -> Pool:
    ended: list[str] = []
    stand_in = SimpleNamespace(
        stop=threading.Event(), settle=settle, ended=ended, close_child=lambda: ended.append("child")
    )
    return Pool(stand_in, [Task(name, name) for name in names], jobs)  # type: ignore[arg-type]


def test_what_a_job_raises_ends_the_batch_and_its_child() -> None:
    def full(task: Task, begun: Any) -> Settled:
        raise OSError(28, "No space left on device")

    pool = pool_of(full, "a")
    with pytest.raises(OSError, match="No space left"):
        list(pool.news())
    assert pool.supervisor.ended == ["child"]  # type: ignore[attr-defined]


def test_after_a_stop_no_other_cloud_is_begun() -> None:
    begun: list[str] = []

    def settle(task: Task, tell: Any) -> Settled:
        begun.append(task.name)
        pool.supervisor.stop.set()
        return Settled(task, "done", {})

    pool = pool_of(settle, "a", "b")
    news = pool.news()
    assert next(one for one in news if one is not None).task.name == "a"  # type: ignore[union-attr]
    news.close()
    assert begun == ["a"]


def test_a_signal_between_the_starts_of_two_jobs_stops_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []

    def settle(task: Task, tell: Any) -> Settled:
        pool.supervisor.stop.wait(10)
        done.append(task.name)
        return Settled(task, "done", {})

    pool = pool_of(settle, "a", "b", "c", jobs=2)
    monkeypatch.setattr(pool._jobs[1], "start", lambda: (_ for _ in ()).throw(SystemExit(143)))
    with pytest.raises(SystemExit):
        list(pool.news())
    assert done == ["a"]
    assert pool.supervisor.ended == ["child"]  # type: ignore[attr-defined]


def test_a_line_that_a_full_disk_cut_short_is_an_error_and_the_next_one_is_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = Manifest(tmp_path / "m")
    one.append({"name": "a"})
    write = os.write
    with monkeypatch.context() as full:
        full.setattr(os, "write", lambda handle, data: write(handle, data[:5]))
        with pytest.raises(OSError, match="only 5 of 14 bytes fit; is the disk full"):
            one.append({"name": "b"})
    one.append({"name": "c"})
    one.refresh()
    assert [record["name"] for record in one.records()] == ["a", "c"]


def test_lines_of_others_are_no_clouds(tmp_path: Path) -> None:
    path = tmp_path / "m"
    lines = ["[1, 2]", "{}", '"name"', '{"name": "a"}', '{"parameters": {}, "settings": "s"}']
    path.write_text("".join(f"{line}\n" for line in lines))
    one = Manifest(path)
    one.refresh()
    assert one.records() == [json.loads(lines[3])]
    assert one.settings == {"s"}
    assert one.end == path.stat().st_size
