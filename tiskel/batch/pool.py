"""Clouds by several processes of this machine: a thread for each of them, which waits and watches."""

import contextlib
import queue
import threading
import time
from collections import deque
from collections.abc import Generator, Sequence

from tiskel.batch.supervisor import Settled, Supervisor
from tiskel.batch.tasks import Task
from tiskel.batch.worker import Stopped

TICK = 0.25  # seconds that whoever listens waits for news at most
AGAIN = 1.0  # seconds between two looks at a cloud that somebody else is at
JOIN = 15.0  # seconds that a thread gets to end its child


class Begun(str):
    """The name of a cloud that somebody begins with."""


News = Settled | Begun | None


class Pool:
    """Jobs that work through a list.

    Parameters
    ----------
    supervisor : Supervisor
    tasks : sequence of Task
    jobs : int
        Processes at once.
    """

    def __init__(self, supervisor: Supervisor, tasks: Sequence[Task], jobs: int) -> None:
        self.supervisor = supervisor
        self._left, self._count = deque(tasks), len(tasks)
        self._later: deque[tuple[float, Task]] = deque()
        self._news: queue.Queue[Settled | Begun | BaseException] = queue.Queue()
        self._jobs = [threading.Thread(target=self._job, name=f"job {i}") for i in range(min(jobs, len(tasks)))]

    def news(self) -> Generator[News, None, None]:
        """Yield what becomes of every cloud as it happens, and None now and then; the jobs end with it."""
        try:  # also about the starts: a signal may come between two of them
            for job in self._jobs:
                job.start()
            while self._count:
                yield self._next()
        finally:
            self.supervisor.stop.set()
            for job in self._jobs:
                if job.ident is not None:
                    job.join(JOIN)

    def _next(self) -> News:
        try:
            new = self._news.get(timeout=TICK)
        except queue.Empty:
            return None
        if isinstance(new, BaseException):
            raise new
        self._count -= isinstance(new, Settled)
        return new

    def _job(self) -> None:
        try:
            while (task := self._take()) is not None:
                settled = self.supervisor.settle(task, lambda name: self._news.put(Begun(name)))
                if settled.outcome == "busy":
                    self._later.append((time.monotonic() + AGAIN, task))
                else:
                    self._news.put(settled)
        except Stopped:
            pass
        except BaseException as error:
            self._news.put(error)
        finally:
            self.supervisor.close_child()

    def _take(self) -> Task | None:
        """Return the next cloud; when nothing else is left, one that somebody else was at, after a while."""
        if self.supervisor.stop.is_set():
            return None
        with contextlib.suppress(IndexError):
            return self._left.popleft()
        with contextlib.suppress(IndexError):
            at, task = self._later.popleft()
            return None if self.supervisor.stop.wait(max(0.0, at - time.monotonic())) else task
        return None
