"""The memory that this process holds, and the most that it held since a moment.

On Linux from /proc. Elsewhere there is only ru_maxrss, which nothing sets back; and that of a process begins at what
the one that started it held, as fork and exec hand it down: no figure for one that a large process has started.
"""

import contextlib
import resource
import sys
from pathlib import Path

SELF = Path("/proc/self")
RESET = "5"  # written to clear_refs: the peak is what is held now, proc(5)


def held_from_now() -> float:
    """Return the resident memory of this process in 2^20 bytes, and let the peak begin there."""
    with contextlib.suppress(OSError):
        (SELF / "clear_refs").write_text(RESET)
    return _megabytes("VmRSS")


def peak() -> float:
    """Return the most resident memory of this process since that call, or in all, in 2^20 bytes."""
    return _megabytes("VmHWM")


def _megabytes(field: str) -> float:
    if (SELF / "status").exists():
        line = next(line for line in (SELF / "status").read_text().splitlines() if line.startswith(field))
        return int(line.split()[1]) / 1024
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most / (1 << 20 if sys.platform == "darwin" else 1024)  # there in bytes, elsewhere in kilobytes
