"""Who is at which cloud: one small file each, made by who takes it, touched while they live, taken over when dead.

Making a file that must not exist is atomic, on network file systems too. Of a
dead owner on the same machine everybody knows at once; one elsewhere is dead
when nobody touched the file for the time of a lease, by the clock of the file
system, not of any machine. Takeovers happen one at a time, under a lock, and
look again once they have it.
"""

import contextlib
import hashlib
import json
import os
import threading
from pathlib import Path

from tiskel.batch.manifest import locked
from tiskel.batch.owner import Owner, myself

BEATS = 4  # touches in the time of a lease: three may fail before others think the owner dead


def key_of(name: str) -> str:
    """Return the name of the lease of a cloud, whose own may be long and have slashes."""
    return hashlib.sha256(name.encode()).hexdigest()[:24]


class Leases:
    """The leases in a folder; for any thread.

    Parameters
    ----------
    folder : Path
    guard : Path
        A file that stays, held while a lease is taken over.
    seconds : float
        Without a touch, after which an owner on another machine is dead.
    """

    def __init__(self, folder: Path, guard: Path, seconds: float) -> None:
        self.folder, self.guard, self.seconds, self.me = folder, guard, seconds, myself()
        self._held: set[str] = set()
        self._lock, self._over = threading.Lock(), threading.Event()
        self._beat: threading.Thread | None = None

    def take(self, key: str) -> bool:
        """Take a lease, also one whose owner is dead; tell whether it is ours now."""
        if self._make(key) or self._take_over(key):
            with self._lock:
                self._held.add(key)
                if self._beat is None:
                    self._beat = threading.Thread(target=self._touch, name="leases", daemon=True)
                    self._beat.start()
            return True
        return False

    def release(self, key: str) -> None:
        """Give a lease back."""
        with self._lock:
            self._held.discard(key)
        if self.mine(key):
            self._path(key).unlink(missing_ok=True)

    def mine(self, key: str) -> bool:
        """Tell whether a lease is ours still: who slept for too long has lost it."""
        owner = self._owner(key)
        return owner is not None and owner.token == self.me.token

    def holder(self, key: str) -> str:
        """Return the token of the living owner of a lease, empty where there is none."""
        owner = self._owner(key)
        return owner.token if owner is not None and not self._stale(key, owner) else ""

    def sweep(self) -> None:
        """Remove the leases of the dead."""
        for path in sorted(self.folder.glob("*.lease")):
            with locked(self.guard):
                owner = self._owner(path.stem)
                if owner is None or self._stale(path.stem, owner):
                    path.unlink(missing_ok=True)

    def close(self) -> None:
        """End the thread that touches leases; where nobody is at any cloud, leave nothing behind."""
        self._over.set()
        if self._beat is not None:
            self._beat.join(self.seconds)
        self._probe.unlink(missing_ok=True)
        if any(self.folder.glob("*.lease")):
            return
        for left in self.folder.glob("*"):  # of those who were killed; the living make theirs anew
            if left.suffix != ".lease":
                left.unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            self.folder.rmdir()

    @property
    def _probe(self) -> Path:
        return self.folder / f"{self.me.token}.clock"

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.lease"

    def _make(self, key: str) -> bool:
        """Write the lease beside its place and link it there, so that it is never seen half-written."""
        beside = self._written(key)
        try:
            os.link(beside, self._path(key))
        except FileExistsError:
            return False
        except OSError:  # a file system without links
            return self._make_plainly(key)
        finally:
            beside.unlink(missing_ok=True)
        return True

    def _make_plainly(self, key: str) -> bool:
        try:
            with self._path(key).open("x") as file:
                file.write(json.dumps(self.me.as_dict()))
        except (FileExistsError, FileNotFoundError):
            return False
        return True

    def _written(self, key: str) -> Path:
        """Return a file of ours that says who we are; somebody who thought himself the last may remove the folder."""
        beside = self.folder / f"{key}.{self.me.token}.{threading.get_ident()}"
        try:
            beside.write_text(json.dumps(self.me.as_dict()))
        except FileNotFoundError:
            self.folder.mkdir(parents=True, exist_ok=True)
            beside.write_text(json.dumps(self.me.as_dict()))
        return beside

    def _take_over(self, key: str) -> bool:
        """Replace the lease of a dead owner."""
        if not self._free(key):
            return False
        with locked(self.guard):
            if not self._free(key):
                return False
            try:
                self._written(key).replace(self._path(key))
            except FileNotFoundError:
                return False
        return True

    def _free(self, key: str) -> bool:
        """Tell whether a lease is there, of a dead owner."""
        owner = self._owner(key)
        return owner is not None and self._stale(key, owner)

    def _owner(self, key: str) -> Owner | None:
        """Return who a lease is of; nobody where there is none, or it was never written to its end and is old."""
        try:
            return Owner(**json.loads(self._path(key).read_text()))
        except FileNotFoundError:
            return None
        except (ValueError, TypeError, OSError):
            return Owner("?", "", "", 0, 0)

    def _stale(self, key: str, owner: Owner) -> bool:
        """Tell whether the owner of a lease is dead."""
        if owner.gone():
            return True
        if owner.machine and owner.machine == self.me.machine:
            return False
        try:
            self._probe.touch()
            return self._probe.stat().st_mtime - self._path(key).stat().st_mtime > self.seconds
        except FileNotFoundError:
            return False

    def _touch(self) -> None:
        while not self._over.wait(self.seconds / BEATS):
            with self._lock:
                held = list(self._held)
            for key in held:
                with contextlib.suppress(OSError):
                    os.utime(self._path(key))
