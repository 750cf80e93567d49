"""Start Taichi once, silently, and only when a kernel is about to run.

Three things about Taichi 1.7 shape this file: it prints to stdout while it
starts, which would corrupt a pipe; its defaults are single precision and fast
maths, which would change results; and it neither survives a fork nor starts
outside the main thread.
"""

import contextlib
import functools
import io
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import taichi as ti

from .errors import TiskelError
from .folders import make_cache_folder

THREADS_VARIABLE = "TISKEL_NUM_THREADS"
MOST_THREADS = 1024  # Taichi starts as many as it is told, until the system refuses and it aborts

_started_in: list[int] = []
_F = TypeVar("_F", bound=Callable[..., Any])


def available_threads() -> int:
    """Return the threads that the affinity mask and the cgroup quota allow, at least one."""
    affinity = getattr(os, "sched_getaffinity", None)
    count = len(affinity(0)) if affinity else os.cpu_count() or 1
    return max(1, min(count, _cgroup_quota() or count, MOST_THREADS))


def requested_threads() -> int:
    """Return TISKEL_NUM_THREADS, or what the machine allows where it is unset.

    Raises
    ------
    TiskelError
        Where the variable is no whole number from 1 to 1024.
    """
    value = os.environ.get(THREADS_VARIABLE)
    if value is None:
        return available_threads()
    if not (value.isascii() and value.isdigit() and 1 <= int(value) <= MOST_THREADS):
        raise TiskelError(
            f"{THREADS_VARIABLE} must be a whole number from 1 to {MOST_THREADS}, got {value!r}; correct or unset it"
        )
    return int(value)


def ensure() -> None:
    """Start Taichi on the CPU in double precision, or do nothing where it runs already.

    Raises RuntimeError in a forked child or outside the main thread, where Taichi would hang or abort.
    """
    if _started_in:
        if _started_in[0] != os.getpid():
            raise RuntimeError("Taichi does not survive a fork; start workers with the 'spawn' or 'forkserver' method")
        return
    if threading.current_thread() is not threading.main_thread():
        raise RuntimeError("the first tiskel kernel must run in the main thread; call tiskel once there first")
    make_cache_folder()
    with contextlib.redirect_stdout(io.StringIO()):
        ti.init(
            arch=ti.cpu,
            default_fp=ti.f64,
            default_ip=ti.i32,
            fast_math=False,
            cpu_max_num_threads=requested_threads(),
            log_level="error",
        )
    _started_in.append(os.getpid())


def started(kernel: _F) -> _F:
    """Wrap a kernel so that calling it starts Taichi first."""

    @functools.wraps(kernel)
    def call(*arguments: Any) -> Any:
        ensure()
        return kernel(*arguments)

    return call  # type: ignore[return-value]


def _cgroup_quota() -> int | None:
    """Return the CPU quota of this cgroup (version 2) in whole cores, None where there is none."""
    try:
        quota, period = Path("/sys/fs/cgroup/cpu.max").read_text().split()
        return None if quota == "max" else max(1, int(quota) // int(period))
    except (OSError, ValueError):
        return None
