"""Who a process is, so that others can tell whether it still lives."""

import functools
import os
import socket
import uuid
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

START_FIELD = 21 - 2  # of /proc/PID/stat behind the name in brackets: when it started, in clock ticks since the boot


@dataclass(frozen=True)
class Owner:
    """A process.

    Attributes
    ----------
    token : str
        Its own and nobody else's.
    machine : str
        Boot and process namespace: where both are the same, process numbers mean the same.
    host : str
        The name of the machine, for people.
    pid, start : int
        Its number and when it started; 0 where the system does not say.
    """

    token: str
    machine: str
    host: str
    pid: int
    start: int

    def gone(self) -> bool:
        """Tell whether the process surely lives no more; False for those of other machines."""
        if not self.machine or self.machine != machine():
            return False
        return started(self.pid) != self.start

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON values."""
        return asdict(self)


def myself() -> Owner:
    """Return this process."""
    return _myself(os.getpid())


@functools.cache
def _myself(pid: int) -> Owner:
    return Owner(uuid.uuid4().hex[:12], machine(), socket.gethostname(), pid, started(pid))


@functools.cache
def machine() -> str:
    """Return what is the same for two processes only where they see each other; empty where the system has no word."""
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
        return f"{boot} {Path('/proc/self/ns/pid').readlink()}"
    except OSError:
        return ""


def started(pid: int) -> int:
    """Return when a process started; 0 where there is none, or it is dead and only waited for."""
    try:
        words = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return 0 if words[0] in {"Z", "X"} else int(words[START_FIELD])
    except (OSError, ValueError, IndexError):
        return 0
