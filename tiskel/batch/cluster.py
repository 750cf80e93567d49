"""The same clouds on a Dask cluster: its workers do what the jobs of a pool do, in children of their own.

Dask hands clouds out, and out again where a worker is lost; results, leases
and the manifest are in the folder of the output, which all machines share. A
worker keeps its children until the batch ends, since a kernel's first call
costs most.
"""

import itertools
import queue
import threading
import time
from collections.abc import Generator, Sequence
from typing import Any

from tiskel.batch.plan import Plan
from tiskel.batch.pool import AGAIN, TICK, News
from tiskel.batch.supervisor import Settled, Supervisor
from tiskel.batch.tasks import Task
from tiskel.errors import TiskelError
from tiskel.version import version

WINDOW = 1000  # clouds that the scheduler knows of at a time
RETRIES = 3  # times that a cloud is tried again after an error on a worker that is no failure of the cloud
PATIENCE = 10.0  # seconds to reach the scheduler

_here: dict[str, Supervisor] = {}  # of a worker: what it is at, by output, settings and beginning
_lock = threading.Lock()


class Cluster:
    """A Dask cluster that works through a list.

    Parameters
    ----------
    plan : Plan
    tasks : sequence of Task
    address : str
        Of the scheduler, as tcp://host:port.

    Raises
    ------
    TiskelError
        Where Dask is not installed, no scheduler answers, no worker is there, or one has another version of tiskel or
        does not see the folder of the output.
    """

    def __init__(self, plan: Plan, tasks: Sequence[Task], address: str) -> None:
        self.plan, self._tasks, self._count = plan, iter(tasks), len(tasks)
        self._news: queue.Queue[Any] = queue.Queue()
        self._client = _client(address)
        try:
            self._check(address)
        except BaseException:
            self._client.close()
            raise

    def news(self) -> Generator[News, None, None]:
        """Yield what becomes of every cloud as it happens, and None now and then."""
        try:
            for task in itertools.islice(self._tasks, WINDOW):
                self._submit(task)
            while self._count:
                yield self._next()
        finally:
            self._client.run(leave, key_of_plan(self.plan), on_error="ignore")
            self._client.close()

    def _next(self) -> News:
        try:
            future = self._news.get(timeout=TICK)
        except queue.Empty:
            return None
        if future.status != "finished":
            error = future.exception() if future.status == "error" else future.status
            raise TiskelError(f"the cluster gave up a cloud: {error!r:.200}; look at the logs of its workers")
        self._count -= 1
        for task in itertools.islice(self._tasks, 1):
            self._submit(task)
        settled: Settled = future.result()
        return settled

    def _submit(self, task: Task) -> None:
        future = self._client.submit(settle_there, self.plan, task, pure=False, retries=RETRIES)
        future.add_done_callback(self._news.put)

    def _check(self, address: str) -> None:
        told: dict[str, tuple[str, bool]] = self._client.run(introduce, str(self.plan.manifest))
        if not told:
            raise TiskelError(f"the scheduler at {address} has no workers; start some with: dask worker {address}")
        for worker, (theirs, sees) in told.items():
            if theirs != version():
                raise TiskelError(f"worker {worker} has tiskel {theirs}, this is {version()}; install the same there")
            if not sees:
                raise TiskelError(f"worker {worker} does not see {self.plan.output}; choose a folder that all share")


def _client(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError:
        raise TiskelError("--scheduler needs Dask; pip install 'tiskel[cluster]'") from None
    client: Any = Client
    try:
        return client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        why = str(error) or type(error).__name__
        raise TiskelError(f"no scheduler at {address}: {why:.100}; start one with: dask scheduler") from None


def key_of_plan(plan: Plan) -> str:
    """Return what tells a batch from others in the workers' memory."""
    return f"{plan.output} {plan.digest} {plan.since}"


def introduce(manifest: str) -> tuple[str, bool]:
    """Return the version of a worker, and whether it sees the manifest."""
    from pathlib import Path

    return version(), Path(manifest).exists()


def settle_there(plan: Plan, task: Task) -> Settled:
    """Do a cloud in a worker; where somebody else is at it, wait for them, or for the end of their lease."""
    supervisor = _supervisor(plan)
    while (settled := supervisor.settle(task)).outcome == "busy":
        time.sleep(AGAIN)
    return settled


def leave(key: str) -> None:
    """End a batch in a worker: kill its children, and clean up."""
    with _lock:
        supervisor = _here.pop(key, None)
    if supervisor is not None:
        supervisor.stop.set()
        supervisor.kill_children()
        supervisor.close()


def _supervisor(plan: Plan) -> Supervisor:
    from distributed import get_worker

    from tiskel.kernels.threads import available_threads

    key = key_of_plan(plan)
    with _lock:
        if key not in _here:
            threads = plan.params.threads or max(1, available_threads() // get_worker().state.nthreads)
            _here[key] = Supervisor(plan, threads)
        return _here[key]
