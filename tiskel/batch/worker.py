"""A child process as its parent sees it: given one cloud at a time, watched, and killed where it takes too much."""

import fcntl
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from multiprocessing import Pipe
from pathlib import Path
from typing import Any

from tiskel.batch.child import COMPILED, READY, Answer
from tiskel.errors import TiskelError

LOOK = 0.05  # seconds between two looks at a child
STARTS = 600.0  # seconds that a child gets to start: cold disks, and all others starting at once
ENDS = 10.0  # seconds that a child gets to end, in which it keeps the kernels that it compiled
LAST_WORDS = 200  # characters of what a child said last
BOOT = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from tiskel.batch.child import main; "
    "main(int(sys.argv[2]), int(sys.argv[3]))"
)
#: Variables that say how many threads libraries may start.
THREADS = ("TISKEL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Stopped(BaseException):
    """The batch is to end, and the child with it."""


class Worker:
    """A child process; started where it is first needed, and again after it died.

    To be used by one thread, which must outlive it: on Linux a child dies with the thread that started it.

    Parameters
    ----------
    work : str
        What it does, as "module:function".
    settings : object
        What the function is handed; sent by pickle.
    threads : int
        That it may run.
    memory : float or None
        GB (10^9 bytes) that it may hold.
    timeout : float or None
        Seconds that a cloud may take.
    stop : threading.Event
        When set, the child is killed and :class:`Stopped` raised.
    """

    def __init__(
        self, work: str, settings: Any, threads: int, memory: float | None, timeout: float | None, stop: threading.Event
    ) -> None:
        self.work, self.settings, self.threads = work, settings, threads
        self.memory, self.timeout, self.stop = memory, timeout, stop
        self._process: subprocess.Popen[bytes] | None = None

    def do(self, path: str, folder: Path) -> Answer:
        """Have one cloud done, its files written into a folder; a child that dies is an answer, too."""
        process = self._ready()
        self._log.truncate(0)
        start = time.monotonic()
        try:
            self._pipe.send((path, str(folder)))
        except OSError:  # it ended of itself, having been idle: the next one takes the cloud
            process = self._ready(anew=True)
            self._pipe.send((path, str(folder)))
        answer = self._answer(process, None if self.timeout is None else start + self.timeout)
        if answer["status"] == "failed" and answer["kind"] in {"memory", "error"}:
            self.close()  # whatever is left behind in the process is no burden to the next cloud
        return {"seconds": time.monotonic() - start, "peak_mb": None, "facts": {}, **answer}

    def close(self) -> None:
        """End the child in its own time, by closing its pipe."""
        if self._process is not None:
            self._pipe.close()
            try:
                self._process.wait(ENDS)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            self._forget()

    def kill(self) -> None:
        """End the child at once."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._pipe.close()
            self._forget()

    def _forget(self) -> None:
        self._process = None
        self._log.close()

    def _ready(self, anew: bool = False) -> "subprocess.Popen[bytes]":
        """Return the child, started and heard of."""
        if self._process is not None and (anew or self._process.poll() is not None):
            self.kill()
        for again in (True, False):
            if self._process is not None:
                break
            self._process = self._start()
            self._pipe.send((self.work, self.settings, self.memory, again))
            answer = self._answer(self._process, time.monotonic() + STARTS, memory=None)
            if answer == COMPILED:
                self.close()
            elif answer != READY:
                raise TiskelError(f"a worker process does not start: {answer['message']}")
        assert self._process is not None
        return self._process

    def _start(self) -> "subprocess.Popen[bytes]":
        self._log = tempfile.TemporaryFile("w+b", buffering=0)  # noqa: SIM115  # what libraries print, for when it dies
        fcntl.fcntl(self._log, fcntl.F_SETFL, fcntl.fcntl(self._log, fcntl.F_GETFL) | os.O_APPEND)
        self._pipe, theirs = Pipe()
        words = [json.dumps(sys.path), str(theirs.fileno()), str(os.getpid())]
        process = subprocess.Popen(
            [sys.executable, "-c", BOOT, *words],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log,
            env={**os.environ, **dict.fromkeys(THREADS, str(self.threads))},
        )  # fmt: skip
        theirs.close()
        return process

    def _answer(self, process: "subprocess.Popen[bytes]", deadline: float | None, memory: float | None = -1) -> Answer:
        """Wait for an answer, for the child's end, for a limit, or for the end of the batch."""
        most = self.memory if memory is not None else None
        while not self._pipe.poll(LOOK):
            if self.stop.is_set():
                self.kill()
                raise Stopped
            if deadline is not None and time.monotonic() > deadline:
                self.kill()
                return _failed("timeout", f"not done in {self.timeout or STARTS:g} s; allow more, or thin the cloud")
            held = resident_gb(process.pid)
            if most is not None and held > most:
                self.kill()
                return _failed("memory", f"held {held:.3g} GB, allowed are {most:g}; allow more, or thin the cloud")
        try:
            answer: Answer = self._pipe.recv()
        except (EOFError, OSError):
            return self._death(process)
        return answer

    def _death(self, process: "subprocess.Popen[bytes]") -> Answer:
        """Say how a child died that nobody here killed."""
        try:
            code = process.wait(ENDS)
        except subprocess.TimeoutExpired:
            code = 0
        words = self._last_words()
        self.kill()
        if code == -signal.SIGKILL:
            return _failed("killed", "the process was killed from outside; by the kernel, most likely: out of memory")
        how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
        return _failed("crashed", f"the process died by {how}{words}")

    def _last_words(self) -> str:
        """Return the last line of what the child or its libraries printed."""
        try:
            self._log.seek(0)
            lines = self._log.read().decode(errors="replace").split("\n")
        except (OSError, ValueError):
            return ""
        last = next((line.strip() for line in reversed(lines) if line.strip()), "")
        return f": {last[:LAST_WORDS]}" if last else ""


def _failed(kind: str, message: str) -> Answer:
    return {"status": "failed", "kind": kind, "message": message}


def resident_gb(pid: int) -> float:
    """Return how much memory a process holds, in 10^9 bytes; 0 where the system does not say."""
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e9
