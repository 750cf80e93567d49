"""What the code for a Dask cluster does with its answers: a stand-in for its client runs all of it in this process."""

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tiskel.batch import Plan, Settled, Task, cluster
from tiskel.batch.cluster import Cluster
from tiskel.batch.pool import AGAIN
from tiskel.batch.supervisor import Outcome, Supervisor
from tiskel.errors import TiskelError
from tiskel.kernels.threads import available_threads
from tiskel.params import BatchParams
from tiskel.version import version

ADDRESS = "tcp://127.0.0.1:1"


class Future:
    """What a client hands out: done at once."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self.status, self._result, self._error = "finished", None, None
        try:
            self._result = work()
        except Exception as error:
            self.status, self._error = "error", error

    def add_done_callback(self, tell: Callable[["Future"], None]) -> None:
        tell(self)

    def result(self) -> Any:
        return self._result

    def exception(self) -> Any:
        return self._error


@dataclass
class Client:
    """One worker: this process; it may answer introductions as others would."""

    introduced: tuple[str, bool] | None = None
    alone: bool = False
    open: bool = True
    submitted: list[str] = field(default_factory=list)

    def submit(self, work: Any, plan: Plan, task: Task, **how: object) -> Future:
        self.submitted.append(task.name)
        return Future(lambda: work(plan, task))

    def run(self, work: Any, *given: Any, on_error: str = "raise") -> dict[str, Any]:
        if self.alone:
            return {}
        if work is cluster.introduce and self.introduced is not None:
            return {"tcp://w": self.introduced}
        return {"tcp://w": work(*given)}

    def close(self) -> None:
        self.open = False


@pytest.fixture
def client(monkeypatch: pytest.MonkeyPatch) -> Client:
    one = Client()
    worker = SimpleNamespace(get_worker=lambda: SimpleNamespace(state=SimpleNamespace(nthreads=2)))
    monkeypatch.setattr(cluster, "_client", lambda address: one)
    monkeypatch.setitem(sys.modules, "distributed", worker)
    return one


@pytest.fixture
def plan(tmp_path: Path) -> Iterator[Plan]:
    one = Plan(output=tmp_path / "out", work="reference.batch_works:obey", params=BatchParams(lease=60.0))
    one.output.mkdir()
    one.manifest.touch()
    yield one
    cluster.leave(cluster.key_of_plan(one))


def tasks_in(folder: Path, count: int) -> list[Task]:
    for i in range(count):
        (folder / f"s{i}.xyz").write_text(f"good {i}")
    return [Task(f"s{i}", str(folder / f"s{i}.xyz")) for i in range(count)]


def test_every_cloud_is_handed_out_once_and_nothing_is_left_in_the_workers(
    client: Client, plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "WINDOW", 2)
    made: list[Supervisor] = []

    def supervisor(*given: Any) -> Supervisor:
        made.append(Supervisor(*given))
        return made[-1]

    monkeypatch.setattr(cluster, "Supervisor", supervisor)
    settled = [news for news in Cluster(plan, tasks_in(tmp_path, 5), ADDRESS).news() if isinstance(news, Settled)]
    assert [(one.task.name, one.outcome) for one in settled] == [(f"s{i}", "done") for i in range(5)]
    assert client.submitted == [f"s{i}" for i in range(5)]
    assert (plan.output / "s4" / "deep" / "back.txt").read_text() == "4 doog"
    assert not client.open
    (one,) = made  # for all clouds of a batch
    assert one.threads == max(1, available_threads() // 2)
    assert one.stop.is_set()
    assert [child._process for child in one._children] == [None]
    assert cluster._here == {}
    assert not plan.leases.exists()


def test_a_cloud_that_another_is_at_is_waited_for(
    client: Client, plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers: list[Outcome] = ["busy", "busy", "done"]
    waited: list[float] = []
    monkeypatch.setattr(Supervisor, "settle", lambda self, task: Settled(task, answers.pop(0), {}))
    monkeypatch.setattr(cluster, "time", SimpleNamespace(sleep=waited.append))
    (task,) = tasks_in(tmp_path, 1)
    assert cluster.settle_there(plan, task).outcome == "done"
    assert waited == [AGAIN] * 2


def test_a_cloud_that_the_cluster_gives_up_is_an_error(
    client: Client, plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lost(plan: Plan, task: Task) -> Settled:
        raise RuntimeError(f"{task.name} killed three workers")

    monkeypatch.setattr(cluster, "settle_there", lost)
    with pytest.raises(TiskelError, match=r"gave up a cloud: RuntimeError\('s0 killed three workers'\); look at"):
        list(Cluster(plan, tasks_in(tmp_path, 2), ADDRESS).news())
    assert not client.open


def test_no_news_is_no_end(client: Client, plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "TICK", 0.01)
    monkeypatch.setattr(Future, "add_done_callback", lambda self, tell: None)
    monkeypatch.setattr(cluster, "settle_there", lambda plan, task: None)
    news = Cluster(plan, tasks_in(tmp_path, 1), ADDRESS).news()
    assert next(news) is None
    news.close()
    assert not client.open


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ((("0.0.1", True), False), f"worker tcp://w has tiskel 0.0.1, this is {version()}; install the same"),
        (((version(), False), False), "worker tcp://w does not see .*out; choose a folder that all share"),
        ((None, True), f"the scheduler at {ADDRESS} has no workers; start some with: dask worker {ADDRESS}"),
    ],
)
def test_workers_that_cannot_do_it_are_named_before_the_work(
    answer: Any, said: str, client: Client, plan: Plan, tmp_path: Path
) -> None:
    client.introduced, client.alone = answer
    with pytest.raises(TiskelError, match=said):
        Cluster(plan, tasks_in(tmp_path, 1), ADDRESS)
    assert client.submitted == []
    assert not client.open


def test_who_sees_the_manifest_says_so(plan: Plan) -> None:
    assert cluster.introduce(str(plan.manifest)) == (version(), True)
    assert cluster.introduce(str(plan.output / "gone")) == (version(), False)


def test_without_dask_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(TiskelError, match=r"needs Dask; pip install 'tiskel\[cluster\]'"):
        cluster._client(ADDRESS)
