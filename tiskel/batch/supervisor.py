"""One cloud, from the question whether it is done to its record; on this machine or in a worker of a cluster."""

import contextlib
import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tiskel.batch.child import INPUT, Answer, sha256
from tiskel.batch.leases import Leases, key_of
from tiskel.batch.manifest import Manifest, Record
from tiskel.batch.plan import Plan
from tiskel.batch.tasks import Task
from tiskel.batch.worker import Worker
from tiskel.version import version

#: done, failed: just now, here or elsewhere; kept: it was done; busy: somebody else is at it.
Outcome = Literal["done", "failed", "kept", "busy"]


@dataclass(frozen=True)
class Settled:
    """What became of a cloud.

    Attributes
    ----------
    task : Task
    outcome : "done", "failed", "kept" or "busy"
    record : dict
        The line of the manifest; empty where somebody else is at the cloud.
    here : bool
        Whether this process did it.
    """

    task: Task
    outcome: Outcome
    record: Record
    here: bool = False


class Supervisor:
    """Sees to the clouds of a plan in this process; each thread that calls it has a child process of its own.

    Parameters
    ----------
    plan : Plan
    threads : int
        Of the kernels in each child.
    """

    def __init__(self, plan: Plan, threads: int) -> None:
        self.plan, self.threads, self.stop = plan, threads, threading.Event()
        self.manifest = Manifest(plan.manifest)
        self.manifest.refresh()
        self.leases = Leases(plan.leases, plan.manifest, plan.params.lease)
        self._local = threading.local()
        self._children: list[Worker] = []

    def settle(self, task: Task, begun: Callable[[str], None] = lambda name: None) -> Settled:
        """Do a cloud, unless it is done or somebody else is at it; tell its name when it begins.

        Raises
        ------
        Stopped
            Where the batch is to end; then the cloud is left as it was.
        """
        if (known := self._known(task)) is not None:
            return known
        key = key_of(task.name)
        if not self.leases.take(key):
            self.manifest.refresh()
            return self._known(task) or Settled(task, "busy", {})
        folder = self.plan.unfinished / f"{key}.{self.leases.me.token}"
        try:
            self.manifest.refresh()  # somebody may have done it a moment ago
            return self._known(task) or self._do(task, key, folder, begun)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
            self.leases.release(key)

    def sweep(self) -> None:
        """Remove what the dead have left: their leases, and results that are not complete."""
        folders = sorted(self.plan.unfinished.glob("*.*"))
        self.leases.sweep()
        for folder in folders:  # of the living, the lease was there when the folder was
            key, token = folder.name.split(".")[:2]
            if self.leases.holder(key) != token:
                shutil.rmtree(folder, ignore_errors=True)

    def close_child(self) -> None:
        """End the child of this thread."""
        child: Worker | None = getattr(self._local, "child", None)
        if child is not None:
            child.close()

    def kill_children(self) -> None:
        """Kill the children of all threads, which have ended or are about to."""
        for child in self._children:
            child.kill()

    def close(self) -> None:
        """Leave nothing behind but results, unless others are still at work."""
        self.leases.close()
        for folder in (self.plan.unfinished, self.plan.unfinished.parent):
            with contextlib.suppress(OSError):
                folder.rmdir()

    def _known(self, task: Task) -> Settled | None:
        """Return what the manifest says of a cloud, as far as it still holds."""
        last = self.manifest.last(task.name)
        if last is None:
            return None
        record, place = last
        new = place >= self.plan.since
        if record.get("settings") != self.plan.digest or (self.plan.params.fresh and not new):
            return None
        if record["status"] == "failed":
            return Settled(task, "failed", record) if new else None
        if self._whole(record) and _same_input(record, Path(task.path)):
            return Settled(task, "done" if new else "kept", record)
        return None

    def _whole(self, record: Record) -> bool:
        """Tell whether the files of a record are all there, of their sizes."""
        folder = self.plan.folder(record["name"])
        try:
            return all((folder / name).stat().st_size == size for name, size in record["files"].items())
        except OSError:
            return False

    def _do(self, task: Task, key: str, folder: Path, begun: Callable[[str], None]) -> Settled:
        begun(task.name)
        folder.mkdir(parents=True)
        answer = self._child().do(task.path, folder)
        if not self.leases.mine(key):  # we slept for too long, and somebody else has taken the cloud over
            return Settled(task, "busy", {})
        record = self._record(task, answer, folder)
        self._put(task.name, folder if record["status"] == "done" else None)
        self.manifest.append(record)
        return Settled(task, record["status"], record, here=True)

    def _child(self) -> Worker:
        child: Worker | None = getattr(self._local, "child", None)
        if child is None:
            p = self.plan
            child = Worker(p.work, p.settings, self.threads, p.params.memory, p.params.timeout, self.stop)
            self._local.child = child
            self._children.append(child)
        return child

    def _put(self, name: str, folder: Path | None) -> None:
        """Put complete results in their place; of a cloud that failed, take what an earlier run left there away."""
        place, old = self.plan.folder(name), self.plan.unfinished / f"{key_of(name)}.{self.leases.me.token}.old"
        place.parent.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(FileNotFoundError):
            place.rename(old)
        if folder is not None:
            folder.rename(place)
        shutil.rmtree(old, ignore_errors=True)

    def _record(self, task: Task, answer: Answer, folder: Path) -> Record:
        """Return the line of the manifest."""
        done = answer["status"] == "done"
        me, files = self.leases.me, sorted(path for path in folder.rglob("*") if path.is_file()) if done else []
        return {
            "name": task.name,
            "path": task.path,
            "status": answer["status"],
            "kind": answer["kind"],
            "message": answer["message"],
            "settings": self.plan.digest,
            "version": version(),
            **(answer.get("input") or dict.fromkeys(INPUT)),
            "seconds": round(answer["seconds"], 3),
            "peak_mb": answer["peak_mb"],
            **answer["facts"],
            "files": {path.relative_to(folder).as_posix(): path.stat().st_size for path in files},
            "host": me.host,
            "pid": me.pid,
            "at": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        }


def _same_input(record: Record, path: Path) -> bool:
    """Tell whether an input is what it was: of the same size and time, or else of the same bytes."""
    try:
        stat = path.stat()
        if record["sha256"] is None or stat.st_size != record["size"]:
            return False
        return bool(stat.st_mtime_ns == record["mtime_ns"]) or sha256(path) == record["sha256"]
    except OSError:
        return False
