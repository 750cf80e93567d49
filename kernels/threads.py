"""How many threads there may be: what affinity mask and cgroups leave, or what a variable says."""

import os
from collections.abc import Iterator
from pathlib import Path

from .errors import TiskelError

THREADS_VARIABLE = "TISKEL_NUM_THREADS"
MOST_THREADS = 1024  # Taichi starts as many as it is told, until the system refuses and it aborts
CGROUPS = Path("/sys/fs/cgroup")
MINE = Path("/proc/self/cgroup")  #: which of them this process is in


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


def _cgroup_quota() -> int | None:
    """Return the least CPU quota of this cgroup and those above it, in whole cores, None where there is none."""
    quotas = [quota for folder in _cgroups() if (quota := _quota(folder)) is not None]
    return min(quotas, default=None)


def _cgroups() -> Iterator[Path]:
    """Yield the folders of the cgroups (version 2) that this process is in, inside a container as far as it sees."""
    yield CGROUPS
    try:
        own = next(line[3:] for line in MINE.read_text().splitlines() if line.startswith("0::"))
    except (OSError, StopIteration):
        return
    folder = CGROUPS
    for part in Path(own).parts[1:]:
        folder /= part
        yield folder


def _quota(folder: Path) -> int | None:
    """Return the quota that one folder sets."""
    try:
        quota, period = (folder / "cpu.max").read_text().split()
        return None if quota == "max" else max(1, int(quota) // int(period))
    except (OSError, ValueError):
        return None
