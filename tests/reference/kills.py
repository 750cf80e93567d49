"""Runs of the program that are killed at random moments, what they leave behind, and whether the next goes on."""

import json
import os
import random
import signal
import subprocess
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from reference.fixtures import PROGRAM
from tiskel.batch.owner import started
from tiskel.io.streams import BESIDE, STALE

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
SHAPES = ("y", "capsule", "cross")  #: one cloud of each; `run` takes the first, `batch` all
LESS = ("--jobs", "2", "--threads", "1", "--stages", "contract,skeleton")  #: `run` has all the others
POINTS = 250  #: of each cloud: a run is mostly start, files and pictures, where kills do most harm
ENDS = 30.0  #: seconds that workers get to notice that their batch is gone; a loaded machine is slow
OF_ITSELF = {"timings.json", "report.html", "manifest.jsonl", "summary.csv", "failed.txt"}  #: hold times or dates
#: What a process that a signal ends may return: the signal where Python had not started yet, 0 where it was done.
ENDINGS = {
    signal.SIGKILL: {-signal.SIGKILL, 0},
    signal.SIGTERM: {-signal.SIGTERM, 143, 0},
    signal.SIGINT: {-signal.SIGINT, 130, 0},
}


@dataclass
class Scene:
    """A command, where it writes, what an undisturbed run of it writes, and how long that takes."""

    words: list[str]
    folder: Path
    output: str
    files: dict[str, bytes] = field(default_factory=dict)
    seconds: float = 0.0

    @property
    def out(self) -> Path:
        """The folder of its output."""
        return self.folder / self.output


def scenes(folder: Path) -> dict[str, Scene]:
    """Make the clouds, and run both commands undisturbed."""
    (folder / "scans").mkdir()
    for name in SHAPES:
        words = ["shape", name, "-n", str(POINTS), "-o", f"scans/{name}.ply"]
        subprocess.run([PROGRAM, *words], cwd=folder, check=True, capture_output=True)
    made = {
        "run": Scene(["run", f"scans/{SHAPES[0]}.ply", "-o", "one", "-q"], folder, "one"),
        "batch": Scene(["batch", "scans", "-o", "many", "-q", *LESS], folder, "many"),
    }
    for scene in made.values():
        begun = time.monotonic()
        assert run(scene).returncode == 0
        scene.seconds = time.monotonic() - begun
        scene.files = written(scene)
        clear(scene)
    return made


def run(scene: Scene) -> "subprocess.CompletedProcess[bytes]":
    """Let a command come to its end."""
    return subprocess.run([PROGRAM, *scene.words], cwd=scene.folder, capture_output=True, check=False)


def written(scene: Scene) -> dict[str, bytes]:
    """Return all files of an output by their path in it, those that are being written and the batch's own too."""
    paths = (path for path in scene.out.rglob("*") if path.is_file())
    return {path.relative_to(scene.out).as_posix(): path.read_bytes() for path in paths}


def clear(scene: Scene) -> None:
    """Remove an output."""
    for path in sorted(scene.out.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    if scene.out.is_dir():
        scene.out.rmdir()


def kill(scene: Scene, number: signal.Signals, after: float) -> tuple[int | None, list[str]]:
    """Start a command, send a signal to its first process after so many seconds; return its end and the faults.

    The end is None where the command was done by then.
    """
    with subprocess.Popen(
        [PROGRAM, *scene.words],
        cwd=scene.folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    ) as process:
        sent = False
        try:
            _, said = process.communicate(timeout=after)
        except subprocess.TimeoutExpired:
            process.send_signal(number)
            sent = True
            _, said = process.communicate()
    faults = [] if process.returncode in ENDINGS[number] else [f"exit code {process.returncode}: {said[-300:]!r}"]
    if number != signal.SIGINT and b"Traceback" in said:  # Ctrl-C may come before there is a program to take it
        faults.append(f"a traceback: {said[-300:]!r}")
    if left := orphans(process.pid):
        faults.append(f"processes live on: {left}")
    return process.returncode if sent else None, faults + damaged(scene)


def orphans(session: int) -> list[int]:
    """Return the processes of a session that are still there once they had the time to end."""
    deadline = time.monotonic() + ENDS
    while (left := [pid for pid in _session(session) if started(pid)]) and time.monotonic() < deadline:
        time.sleep(0.05)
    return left


def _session(session: int) -> list[int]:
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if os.getsid(int(entry.name)) == session:
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


def damaged(scene: Scene) -> list[str]:
    """Return the files that are neither whole nor marked as being written."""
    return [name for name, data in written(scene).items() if not _whole(scene, name, data)]


def _whole(scene: Scene, name: str, data: bytes) -> bool:
    last = name.rpartition("/")[2]
    if last.startswith(BESIDE) or name.startswith(".batch/"):
        return True
    if last == "timings.json":
        return bool(json.loads(data))
    if last == "report.html":
        return data.rstrip().endswith(b"</html>")
    if last == "manifest.jsonl":  # the last line may be cut; the batch that goes on mends it
        return all(json.loads(line) for line in data.decode().split("\n")[:-1])
    return last in OF_ITSELF or data == scene.files.get(name)


def goes_on(scene: Scene) -> list[str]:
    """Let a command come to its end where a killed one left off, an hour later; return the faults."""
    for path in scene.out.rglob(f"{BESIDE}*"):
        os.utime(path, (time.time() - 2 * STALE,) * 2)
    begun = time.monotonic()
    done = run(scene)
    scene.seconds = min(scene.seconds, time.monotonic() - begun)  # a machine that was loaded at first may be no more
    faults = [] if done.returncode == 0 else [f"the next one ends with {done.returncode}: {done.stderr[-300:]!r}"]
    found = written(scene)
    faults += [f"{name} is {'left' if name in found else 'missing'}" for name in found.keys() ^ scene.files.keys()]
    return faults + [f"{name} differs" for name in damaged(scene)]


def killed(scene: Scene, tries: range, seed: int) -> tuple[Counter[str], list[str]]:
    """Try to kill a command so many times, into the same output, then let it come to its end; return ends and faults.

    The moments are uniform over the time of an undisturbed run; a try of the same number and seed is the same signal,
    at the same share of that time. Ends are counted by signal and exit code, "done" where the command was faster; a
    fault says which try it was.
    """
    ends: Counter[str] = Counter()
    faults: list[str] = []
    for at in tries:
        chance = random.Random(f"{seed} {at}")
        number, after = chance.choice(SIGNALS), chance.uniform(0, scene.seconds)
        code, found = kill(scene, number, after)
        ends["done" if code is None else f"{number.name} {code}"] += 1
        if at == tries[-1]:
            found += goes_on(scene)
            clear(scene)
        faults += [f"try {at}, {number.name} after {after:.2f} s: {fault}" for fault in found]
    return ends, faults
