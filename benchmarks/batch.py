"""Many clouds: killed and resumed, broken ones among them, in shards, by two processes, on a cluster, and how fast.

    python benchmarks/batch.py                      # all parts, 216 clouds
    python benchmarks/batch.py --count 24 --parts resume,throughput
    python benchmarks/batch.py --write              # into benchmarks/scale/batch.md, throughput into benchmarks/speed

Every part says what it saw, and ends the script where that is not what should
be. Clouds are of random shapes, 400 to 1000 points, clean and noisy, by seed;
kills come at random moments, by the same seed. Throughput is that of a batch
under way, of clouds that cost the same (hands of 1000 points): those after the
first of every process, over the time since; the ways of using the machine take
turns. It wants a machine that does nothing else.
"""

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from batch_rates import throughput
from tables import shown, surroundings, written

from tiskel import ShapeParams, make_shape, named_shape
from tiskel.batch.owner import started
from tiskel.gallery.families import GROUPS
from tiskel.io.clouds import dump_cloud

PROGRAM = f"import sys; sys.path[:] = {sys.path!r}; sys.argv[0] = 'tiskel'; from tiskel.cli.app import main; main()"
STAGES = "contract,skeleton,metrics"
OWN = {"manifest.jsonl", "summary.csv", "failed.txt"}
KILLS = 3
LONGEST = 3600.0  # seconds that a batch may take here
SAID = Path(__file__).parent / "scale" / "batch.md"
BAD = {
    "empty.ply": b"",
    "words.xyz": b"this is\nno cloud\n",
    "cut.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nend_header\n1",
    "head.ply": b"ply\nformat ascii 1.0\n",
    "few.xyz": b"0 0 0\n1 1 1\n",
    "nan.xyz": b"nan nan nan\n" * 100,
    "same.xyz": b"1 2 3\n" * 100,
    "zipped.ply.gz": b"\x1f\x8b nothing",
    "array.npy": b"\x93NUMPY\x01\x00nothing",
    "mesh.stl": b"solid nothing\nfacet",
}


def make_clouds(folder: Path, count: int, seed: int = 0) -> None:
    """Write so many clouds of random shapes."""
    random_numbers = np.random.default_rng(seed)
    names = [name for group in GROUPS.values() for name in group]
    folder.mkdir()
    for i in range(count):
        name = names[random_numbers.integers(len(names))]
        params = ShapeParams(
            count=int(random_numbers.integers(400, 1000)), noise=float(random_numbers.choice([0.0, 0.05, 0.1])),
            seed=int(random_numbers.integers(1000)),
        )  # fmt: skip
        (folder / f"{i:04}-{name}.ply").write_bytes(dump_cloud(make_shape(named_shape(name), params)[0], "a.ply"))


def tiskel(*words: object) -> "subprocess.Popen[bytes]":
    """Start the program."""
    command = [sys.executable, "-c", PROGRAM, *map(str, words)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True)


def batch(scans: Path, output: Path, *words: object, code: int = 0) -> dict[str, int]:
    """Run a batch to its end; return its counts."""
    process = tiskel("batch", scans, "-o", output, "--stages", STAGES, "--json", "--quiet", *words)
    told = process.communicate(timeout=LONGEST)[0]
    assert process.returncode == code, process.returncode
    return json.loads(told)


def tree(output: Path) -> dict[str, bytes]:
    """Return all results, by path."""
    files = [path for path in sorted(output.rglob("*")) if path.is_file() and path.name not in OWN]
    return {path.relative_to(output).as_posix(): path.read_bytes() for path in files}


def records(output: Path) -> list[dict[str, Any]]:
    """Return the lines of the manifest about clouds; every line must be sound."""
    text = (output / "manifest.jsonl").read_text() if (output / "manifest.jsonl").exists() else ""
    return [record for line in text.splitlines() if "name" in (record := json.loads(line))]


def done(output: Path) -> Counter[str]:
    """Return how often each cloud was done."""
    return Counter(record["name"] for record in records(output) if record["status"] == "done")


def family(pid: int) -> list[int]:
    """Return the processes that a process has started."""
    return [int(word) for word in Path(f"/proc/{pid}/task").glob("*/children") for word in word.read_text().split()]


def resume(scans: Path, whole: Path, folder: Path) -> str:
    """Kill a batch three times, at random, and once by Ctrl-C; resume it."""
    output, chance, total = folder / "killed", random.Random(0), len(list(scans.iterdir()))
    moments, orphans = sorted(chance.sample(range(total // 10, total - total // 10), KILLS + 1)), 0
    for moment, how in zip(moments, [signal.SIGKILL] * KILLS + [signal.SIGINT], strict=True):
        process = tiskel("batch", scans, "-o", output, "--stages", STAGES, "--quiet", "--jobs", 2)
        while len(records(output)) < moment:
            assert process.poll() is None
            time.sleep(0.02)
        time.sleep(chance.random())
        children = family(process.pid)
        process.send_signal(how)
        assert process.wait(60) == (130 if how == signal.SIGINT else -signal.SIGKILL)
        time.sleep(1.0)
        orphans += sum(map(bool, map(started, children)))
    last = batch(scans, output, "--jobs", 2)
    again = [name for name, times in done(output).items() if times > 1]
    assert not again, again
    assert not orphans
    assert not (output / ".batch").exists()
    assert tree(output) == tree(whole)
    return (
        f"killed with {', '.join(map(str, moments[:-1]))} and stopped with {moments[-1]} of {total} done; resumed "
        f"({last['kept']} kept, {last['done']} done): all {len(tree(whole))} files as uninterrupted, nothing done "
        "twice, no orphans, nothing left over"
    )


def broken(scans: Path, whole: Path, folder: Path) -> str:
    """Mix in files of ten kinds that are no clouds, one that eats memory, and one that takes forever."""
    mixed = folder / "mixed"
    mixed.mkdir()
    for path in scans.iterdir():
        (mixed / path.name).hardlink_to(path)
    for name, data in BAD.items():
        (mixed / name).write_bytes(data)
    points = np.random.default_rng(0).random((1_500_000, 3))
    (mixed / "glutton.npy").write_bytes(dump_cloud(points, "a.npy"))  # uniform noise: no body, no end
    os.mkfifo(mixed / "forever.xyz")  # nobody ever writes into it
    output = folder / "survived"
    counts = batch(mixed, output, "--jobs", 2, "--timeout", 120, "--memory", 0.7, code=1)
    failed = {record["name"]: f"{record['kind']}: {record['message']}" for record in records(output)
              if record["status"] == "failed"}  # fmt: skip
    assert tree(output) == tree(whole)
    assert counts["failed"] == len(BAD) + 2, failed
    assert failed["glutton"].startswith("memory"), failed["glutton"]
    assert failed["forever"].startswith("timeout"), failed["forever"]
    for name, reason in failed.items():
        print(f"    {name}: {reason}")
    return f"{counts['done']} good clouds done, {counts['failed']} bad ones failed, each with its reason"


def shards(scans: Path, whole: Path, folder: Path) -> str:
    """Do the list in four shards, two at a time; together they are the whole."""
    for pair in ((1, 2), (3, 4)):
        running = [
            tiskel("batch", scans, "-o", folder / "shards", "--stages", STAGES, "-q", "--jobs", 1, "--shard", f"{i}/4")
            for i in pair
        ]  # fmt: skip
        assert [process.wait(LONGEST) for process in running] == [0, 0]
    assert tree(folder / "shards") == tree(whole)
    assert set(done(folder / "shards").values()) == {1}
    return "1/4 to 4/4, two at a time, into one folder: the same files, each cloud once"


def leases(scans: Path, whole: Path, folder: Path) -> str:
    """Have two processes share the list, and kill one of them."""
    output, total = folder / "leases", len(list(scans.iterdir()))
    running = [
        tiskel("batch", scans, "-o", output, "--stages", STAGES, "--quiet", "--jobs", 1, "--lease", 10)
        for _ in range(2)
    ]
    while len(records(output)) < total // 3:
        time.sleep(0.05)
    running[0].kill()
    assert running[1].wait(LONGEST) == 0
    pids = Counter(record["pid"] for record in records(output))
    assert tree(output) == tree(whole)
    assert set(done(output).values()) == {1}
    assert not (output / ".batch").exists()
    return f"two processes did {_shares(pids)}, the first killed; each cloud once, the same files"


def cluster(scans: Path, whole: Path, folder: Path) -> str:
    """Hand the list to a Dask scheduler with two workers, and kill one of them."""
    file, output = folder / "scheduler.json", folder / "cluster"
    with ExitStack() as stack:
        here = ("--host", "127.0.0.1", "--no-dashboard")
        _dask(stack, "dask_scheduler", *here, "--port", "0", "--scheduler-file", str(file))
        while not (file.exists() and file.read_text()):
            time.sleep(0.1)
        address = json.loads(file.read_text())["address"]
        words = ("--no-nanny", "--nthreads", "1", "--local-directory", str(folder))
        workers = [_dask(stack, "dask_worker", address, *here, *words) for _ in range(2)]
        _wait_for_workers(address, len(workers))
        process = tiskel("batch", scans, "-o", output, "--stages", STAGES, "--quiet", "--scheduler", address)
        while len(records(output)) < len(list(scans.iterdir())) // 2:
            assert process.poll() is None
            time.sleep(0.05)
        workers[0].kill()
        assert process.wait(LONGEST) == 0
    pids = Counter(record["pid"] for record in records(output))
    assert tree(output) == tree(whole)
    assert set(done(output).values()) == {1}
    assert not (output / ".batch").exists()
    return f"two workers did {_shares(pids)}, the first killed midway; each cloud once, the same files"


def _shares(pids: "Counter[int]") -> str:
    return " and ".join(map(str, pids.values()))


def _dask(stack: ExitStack, program: str, *words: str) -> "subprocess.Popen[bytes]":
    code = f"import sys; sys.path[:] = {sys.path!r}; from distributed.cli.{program} import main; main()"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen([sys.executable, "-c", code, *words], env=environment, stderr=subprocess.DEVNULL)
    stack.callback(process.wait)
    stack.callback(process.kill)
    return process


def _wait_for_workers(address: str, count: int) -> None:
    from distributed import Client

    with Client(address) as client:
        client.wait_for_workers(count, timeout=120)


PARTS: dict[str, Callable[[Path, Path, Path], str]] = {
    "resume": resume, "broken": broken, "shards": shards, "leases": leases, "cluster": cluster,
}  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=216)
    parser.add_argument("--parts", default=",".join((*PARTS, "throughput")))
    parser.add_argument("--rounds", type=int, default=5, help="of throughput")
    parser.add_argument("--few", type=int, default=24, help="clouds of a round of throughput")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    parts, said = given.parts.split(","), []
    with tempfile.TemporaryDirectory() as name:
        folder, scans = Path(name), Path(name, "scans")
        make_clouds(scans, given.count)
        whole = folder / "whole"
        rows = throughput(folder, given.rounds, given.few) if "throughput" in parts else []
        if set(parts) & set(PARTS):
            start = time.perf_counter()
            counts = batch(scans, whole, "--jobs", 2)
            said.append(f"whole: {counts['done']} clouds in {time.perf_counter() - start:.0f} s with --jobs 2")
            print(said[-1], flush=True)
        for part in (part for part in PARTS if part in parts):
            said.append(f"{part}: {PARTS[part](scans, whole, folder)}")
            print(said[-1], flush=True)
    if rows:
        print(shown(rows))
        if given.write:
            written("batch", rows, "Hands of 1000 points: `python benchmarks/batch.py --parts throughput`.")
    if said and given.write:
        lines = [
            f"`python benchmarks/batch.py --count {given.count}`",
            surroundings(),
            "\n".join(f"- {s}" for s in said),
        ]
        SAID.write_text("\n\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
