"""A child process and its parent's view of it: it ends when idle or alone, and however it ends, somebody hears why."""

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tiskel.batch import child, worker
from tiskel.batch.owner import started
from tiskel.batch.worker import Worker, resident_gb
from tiskel.errors import TiskelError

WORK = "reference.batch_works:obey"
LAST = "main(int(sys.argv[2]), int(sys.argv[3]))"


@pytest.fixture
def made() -> Iterator[Worker]:
    one = Worker(WORK, None, 1, None, None, threading.Event())
    yield one
    one.kill()


def pid_of(one: Worker) -> int:
    assert one._process is not None
    return one._process.pid


def done(one: Worker, folder: Path, name: str) -> child.Answer:
    (folder / name).write_text("good")
    (folder / f"{name}.out").mkdir()
    return one.do(str(folder / name), folder / f"{name}.out")


@pytest.mark.parametrize("then", ["", "; time.sleep(600)"], ids=["ends", "stays"])
def test_a_child_that_waited_for_too_long_ends_and_the_next_one_does_the_cloud(
    then: str, made: Worker, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its pipe is closed before the process is gone; one that stays is killed."""
    idle = f"import time; import tiskel.batch.child as c; c.IDLE = 0.5; {LAST}{then}"
    monkeypatch.setattr(worker, "BOOT", worker.BOOT.replace(LAST, idle))
    made.kill()  # of none: nothing
    assert done(made, tmp_path, "a")["status"] == "done"
    first = pid_of(made)
    wait_for_the_end(made, stays=bool(then))
    assert done(made, tmp_path, "b")["status"] == "done"
    assert pid_of(made) != first
    assert started(first) == 0
    second = pid_of(made)
    wait_for_the_end(made, stays=bool(then))
    monkeypatch.setattr(worker, "ENDS", 0.2)
    made.close()
    assert started(second) == 0


def wait_for_the_end(one: Worker, stays: bool) -> None:
    assert one._pipe.poll(60)  # closed from the other side
    if not stays:
        assert one._process is not None
        assert one._process.wait(60) == 0


def test_a_child_that_cannot_start_is_an_error_with_its_last_words(made: Worker, tmp_path: Path) -> None:
    made.work = "nowhere:work"
    with pytest.raises(TiskelError, match=r"does not start: .* exit code 1: ModuleNotFoundError: .*'nowhere'"):
        made.do("a", tmp_path)


def test_a_child_that_closes_its_pipe_and_stays_is_killed(
    made: Worker, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        worker, "BOOT", "import os, sys, time; time.sleep(0.5); os.close(int(sys.argv[2])); time.sleep(600)"
    )
    monkeypatch.setattr(worker, "ENDS", 0.2)
    began, pids = made._start, list[int]()

    def start() -> Any:
        process = began()
        pids.append(process.pid)
        return process

    monkeypatch.setattr(made, "_start", start)
    with pytest.raises(TiskelError, match="does not start"):
        made.do("a", tmp_path)
    assert [started(pid) for pid in pids] == [0]


def test_without_the_help_of_the_system_a_thread_watches_the_parent(monkeypatch: pytest.MonkeyPatch) -> None:
    parents, codes, ended = iter([7, 7, 7, 1]), list[int](), threading.Event()

    def leave(code: int) -> None:
        codes.append(code)
        ended.set()

    def refuse(name: object) -> None:
        raise OSError("no C library")

    monkeypatch.setattr(child, "os", SimpleNamespace(getppid=lambda: next(parents), _exit=leave))
    monkeypatch.setattr(child, "time", SimpleNamespace(sleep=lambda seconds: None))
    monkeypatch.setattr(child, "ctypes", SimpleNamespace(CDLL=refuse))
    child._end_with(7)
    assert ended.wait(30)
    assert codes == [1]
    assert list(parents) == []


def test_a_child_whose_parent_is_dead_already_ends_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def leave(code: int) -> None:
        raise SystemExit(code)

    monkeypatch.setattr(child, "os", SimpleNamespace(getppid=lambda: 1, _exit=leave))
    monkeypatch.setattr(child, "ctypes", SimpleNamespace(CDLL=lambda name: SimpleNamespace(prctl=lambda *given: 0)))
    with pytest.raises(SystemExit) as end:
        child._end_with(7)
    assert end.value.code == 1


def test_memory_is_no_failure_of_another_kind_and_inputs_that_are_gone_have_no_hash(tmp_path: Path) -> None:
    def greedy() -> dict[str, Any]:
        raise MemoryError

    answer = child._answer(greedy)
    assert (answer["status"], answer["kind"]) == ("failed", "memory")
    assert "thin the cloud" in answer["message"]
    assert child._input(tmp_path / "gone") == {"size": None, "mtime_ns": None, "sha256": None}


def test_where_the_system_does_not_say_how_much_memory_is_held(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(child, "Path", lambda name: tmp_path / name.lstrip("/"))
    assert child.peak_mb() is None
    (tmp_path / "proc" / "self").mkdir(parents=True)
    (tmp_path / "proc" / "self" / "status").write_text("Name:\tx\nVmHWM:\t  250000 kB\n")
    assert child.peak_mb() == 256.0
    assert resident_gb(2**22 + 1) == 0.0  # no process has this number


def test_a_limit_of_memory_is_asked_of_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    import resource

    asked: list[Any] = []
    monkeypatch.setattr(resource, "setrlimit", lambda *given: asked.append(given))
    child._limit(None)
    assert asked == []
    child._limit(1.5)
    most = 1_500_000_000 + 2 * 1024**3
    assert asked == [(resource.RLIMIT_DATA, (most, most))]


def test_a_stopped_batch_stops_who_waits_for_a_child(made: Worker, tmp_path: Path) -> None:
    (tmp_path / "w").write_text("wait")
    threading.Timer(0.5, made.stop.set).start()
    began = time.monotonic()
    with pytest.raises(worker.Stopped):
        made.do(str(tmp_path / "w"), tmp_path)
    assert made._process is None
    assert time.monotonic() - began < 300
