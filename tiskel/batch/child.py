"""What runs in a child process: one cloud after the other, as its parent says, and never without a parent.

Started as a program of its own, not forked: kernels do not survive a fork, and
their first call needs the main thread. An answer is a mapping of JSON values.
"""

import contextlib
import ctypes
import hashlib
import importlib
import os
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from tiskel.errors import TiskelError

Answer = dict[str, Any]
READY: Answer = {"status": "ready"}
COMPILED: Answer = {"status": "compiled"}  #: it ends, to keep the kernels that it compiled: Taichi does so at the end
COLD = 20.0  # seconds of preparation above which kernels were compiled
KILLED_FIRST = 700  # out of 1000: the kernel, out of memory, takes the child and not its parent
SLACK = 2 << 30  # bytes above the limit that the system lets a child reserve, before its parent has noticed
PR_SET_PDEATHSIG = 1  # of prctl(2)
INPUT = ("size", "mtime_ns", "sha256")  #: what a record says of an input
BLOCK = 1 << 20  # bytes read at a time
IDLE = 600.0  # seconds without a word from the parent after which the child ends; it is started again when needed


class CloudError(TiskelError):
    """Why a cloud failed, and of which kind the failure is."""

    def __init__(self, kind: str, message: str) -> None:
        super().__init__(message)
        self.kind = kind


def main(handle: int, parent: int) -> None:
    """Do what comes down the pipe until it ends."""
    for ignored in (signal.SIGINT, signal.SIGTERM):  # sent to the whole group; the parent decides
        signal.signal(ignored, signal.SIG_IGN)
    _end_with(parent)
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(str(KILLED_FIRST))
    pipe = Connection(handle)
    with contextlib.suppress(EOFError, OSError):
        name, settings, memory, again = pipe.recv()
        work = _function(name)
        if _prepare(name, settings) > COLD and again:
            pipe.send(COMPILED)
            return
        _limit(memory)
        pipe.send(READY)
        while pipe.poll(IDLE):
            path, folder = pipe.recv()
            known = _input(Path(path))  # here, where the limits hold: a file may be a pipe that nobody writes into
            pipe.send({**_answer(lambda: work(Path(path), Path(folder), settings)), "input": known})  # noqa: B023


def _function(name: str) -> Callable[..., dict[str, Any]]:
    module, _, function = name.partition(":")
    found: Callable[..., dict[str, Any]] = getattr(importlib.import_module(module), function)
    return found


def _prepare(name: str, settings: Any) -> float:
    """Call the function prepare of the same module, where there is one; return the seconds that it took."""
    start = time.perf_counter()
    prepare = getattr(importlib.import_module(name.partition(":")[0]), "prepare", None)
    if prepare is not None:
        prepare(settings)
    return time.perf_counter() - start


def _answer(work: Callable[[], dict[str, Any]]) -> Answer:
    """Do a cloud, and say how it went."""
    _forget_peak()
    start = time.perf_counter()
    try:
        answer: Answer = {"status": "done", "kind": "", "message": "", "facts": work()}
    except CloudError as error:
        answer = _failed(error.kind, str(error))
    except TiskelError as error:
        answer = _failed("refused", str(error))
    except MemoryError:
        answer = _failed("memory", "out of memory; thin the cloud, or allow more")
    except Exception as error:
        answer = _failed("error", f"unexpected {type(error).__name__}: {error}")
    return answer | {"seconds": time.perf_counter() - start, "peak_mb": peak_mb()}


def _failed(kind: str, message: str) -> Answer:
    return {"status": "failed", "kind": kind, "message": " ".join(message.split())}


def _input(path: Path) -> Answer:
    """Return size, time and hash of an input; nothing where it cannot be read, which its reader will say."""
    try:
        stat = path.stat()
        return dict(zip(INPUT, (stat.st_size, stat.st_mtime_ns, sha256(path)), strict=True))
    except OSError:
        return dict.fromkeys(INPUT)


def sha256(path: Path) -> str:
    """Return the hash of a file."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _forget_peak() -> None:
    """Begin to count the peak of memory anew."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak_mb() -> float | None:
    """Return the most memory that the process held, in 10^6 bytes, None where the system does not say."""
    try:
        words = Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()
        return round(int(words[0]) * 1024 / 1e6, 1)
    except (OSError, ValueError, IndexError):
        return None


def _limit(memory: float | None) -> None:
    """Let the system refuse what is far beyond a limit in GB; what is just beyond, the parent sees."""
    if memory is not None:
        import resource

        most = int(memory * 1e9) + SLACK
        resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def _end_with(parent: int) -> None:
    """See to it that the process dies with its parent, whatever kills that one."""
    try:
        asked = ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL) == 0
    except (OSError, AttributeError):
        asked = False
    if os.getppid() != parent:
        os._exit(1)
    if not asked:
        threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(1.0)
    os._exit(1)
