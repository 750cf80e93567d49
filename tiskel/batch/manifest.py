"""The manifest: JSON lines that only ever grow, written by several processes, maybe of several machines.

A line is one write under a lock (``flock``, which network file systems pass on
to their servers; where they do not, the append mode alone keeps lines apart on
one machine). A line that was cut short, by a full disk or a power cut, is
ended by whoever writes next, and read by nobody.
"""

import contextlib
import fcntl
import json
import os
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

Record = dict[str, Any]  #: one line: JSON values by key


@contextlib.contextmanager
def locked(path: Path) -> Iterator[int]:
    """Hold a file, open for reading and appending, against everybody else; yield its descriptor."""
    handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        with contextlib.suppress(OSError):  # some file systems have no locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield handle
    finally:
        os.close(handle)


class Manifest:
    """The last record of every cloud, as far as the file has been read; for any thread.

    Parameters
    ----------
    path : Path
        The file; it need not exist.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.end, self.settings = path, 0, set[str]()
        self._last: dict[str, tuple[Record, int]] = {}
        self._lock = threading.Lock()

    def refresh(self) -> None:
        """Read what was written since; a last line without its end is left for the next time."""
        with self._lock:
            try:
                with self.path.open("rb") as file:
                    file.seek(self.end)
                    data = file.read()
            except FileNotFoundError:
                return
            whole = data[: data.rfind(b"\n") + 1]
            for line in whole.splitlines(keepends=True):
                self._take(line)
                self.end += len(line)

    def _take(self, line: bytes) -> None:
        try:
            record = json.loads(line)
        except ValueError:
            return
        if isinstance(record, dict) and "name" in record:
            self._last[record["name"]] = record, self.end
        elif isinstance(record, dict) and "parameters" in record:
            self.settings.add(record["settings"])

    def last(self, name: str) -> tuple[Record, int] | None:
        """Return the last record of a cloud and the bytes before it."""
        with self._lock:
            return self._last.get(name)

    def records(self) -> list[Record]:
        """Return the last record of every cloud, by name."""
        with self._lock:
            return [self._last[name][0] for name in sorted(self._last)]

    def append(self, record: Record) -> None:
        """Write one line."""
        line = (json.dumps(record, allow_nan=False) + "\n").encode()
        with locked(self.path) as handle:
            size = os.fstat(handle).st_size
            torn = size > 0 and os.pread(handle, 1, size - 1) != b"\n"
            data = b"\n" + line if torn else line
            written = os.write(handle, data)
            if written != len(data):
                raise OSError(None, f"only {written} of {len(data)} bytes fit; is the disk full?", str(self.path))
            with contextlib.suppress(OSError):
                os.fsync(handle)
