"""How time and memory grow with the number of points, of every method and of the measures, and of peers.

    python benchmarks/speed.py --sizes 1024 4096             # print
    python benchmarks/speed.py --sizes 1024 4096 --write     # into benchmarks/speed, beside the rows that are there
    python benchmarks/speed.py --shapes wire --works robust  # a part of it; --page draws the pages anew from the rows

Shapes are a body (quadruped), a tree, a thin plate with a hole, and a wire: a helix whose radius is 0.3 times what its
points are apart, whatever their number. Works are contraction and graph by robust, lbc and gls, all measures of
robust's skeleton, and peers: the shortest-path tree of tests/reference, and PyGEL's local separators and pc-skeletor
where they are installed. The yardstick is SciPy's tree, build and query of k = 14 by two workers, of the same cloud.

Every work on every cloud has a process of its own. After a run on 1024 points (base MB: what is held then, of
interpreter, libraries, kernels and the cloud, which comes from a file) it runs once (peak MB: the most that is held
meanwhile, base included), and then in turn with the yardstick, as often as a minute allows, five times at most; `over
tree` is the median of the rounds' ratios, seconds and processor seconds are medians. Where the first run took longer
than a minute it counts and is the only one. A run of more than --limit seconds (600) is ended, and what would take as
long if it only grew in proportion is not begun.
Kernels, parts of lbc and gls, solvers, start-up and files have tables of their own in benchmarks/speed.
"""

import argparse
import contextlib
import csv
import datetime
import json
import os
import pickle
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from field_methods import OWN, PATH, PYGEL, curve_of, missing
from memory import held_from_now, peak
from scipy.spatial import cKDTree
from speed_page import page
from tables import FOLDER, Row, shown

from tiskel import ContractionParams, Skeleton, contract, evaluate, extract_skeleton, make_shape, named_shape
from tiskel.arrays import Points
from tiskel.gallery.body import Shape
from tiskel.gallery.sweep import Sweep, spline, steady
from tiskel.gallery.tubes import swept
from tiskel.gallery.wires import THINNESS
from tiskel.geometry.frames import step_lengths
from tiskel.params import ShapeParams

SIZES = (1024, 4096, 16_384, 65_536, 262_144, 1_000_000)
SHAPES = ("quadruped", "tree", "washer-plate", "wire")
ROBUST, MEASURES, SKELETOR = "robust", "measures", "pc-skeletor"
WORKS = (*OWN, MEASURES, PATH, PYGEL, SKELETOR)
SMALL = 1024  # points of the cloud that every process starts with
K, WORKERS = 14, 2  # of the yardstick
LIMIT = 600  # seconds of a run, unless --limit says otherwise
ROUNDS, PATIENCE = 5, 60  # runs that are timed at most, and the seconds that they may take together
TURNS = 8  # of the wire
FIGURES = ("seconds", "processor s", "tree s", "over tree", "peak MB", "base MB", "rounds")


def wire(count: int) -> Shape:
    """Return a helix so thin that so many points of it lie on a line: see tiskel.gallery.wires."""
    turn = np.linspace(0, 2 * np.pi * TURNS, 32 * TURNS + 1)
    line = np.stack([0.5 * np.cos(turn), 0.5 * np.sin(turn), turn / 16], axis=1)
    return swept([Sweep(spline(line), steady(THINNESS * float(step_lengths(line).sum()) / count))], len(line))


def cloud(shape: str, count: int) -> Points:
    return make_shape(wire(count) if shape == "wire" else named_shape(shape), ShapeParams(count=count))[0]


def skeleton(points: Points, method: str = ROBUST) -> Skeleton:
    return extract_skeleton(contract(points, ContractionParams(method=method)))  # type: ignore[arg-type]


def pc_skeletor(points: Points) -> object:
    """Meyer et al., JOSS 2023: Laplacian-based contraction with the defaults, which take every point."""
    import open3d
    from pc_skeletor import LBC

    found = LBC(point_cloud=open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points)))
    found.extract_skeleton()
    return found.extract_topology()


RUNS: dict[str, Callable[..., object]] = {
    **{method: partial(skeleton, method=method) for method in OWN},
    MEASURES: evaluate,
    PATH: partial(curve_of, method=PATH),
    PYGEL: partial(curve_of, method=PYGEL),
    SKELETOR: pc_skeletor,
}


def not_there(work: str) -> str | None:
    """Return why a work cannot be done here, None where it can."""
    if work == SKELETOR and not (find_spec("pc_skeletor") and find_spec("open3d")):
        return "pc-skeletor or Open3D is not installed"
    return missing(work)


def timed(run: Callable[[], object]) -> tuple[float, float, object]:
    """Return wall and processor seconds, and what came of it."""
    wall, processor = time.perf_counter(), time.process_time()
    made = run()
    return time.perf_counter() - wall, time.process_time() - processor, made


def child(work: str, folder: Path, limit: int) -> dict[str, float]:
    """Return the figures of a work on the cloud of a folder; the signal ends the process, in foreign code too."""
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")  # where memory runs out, this process is the one that ends
    points, small, curve = np.load(folder / "cloud.npy"), np.load(folder / "small.npy"), folder / "skeleton.pickle"
    RUNS[work](skeleton(small) if work == MEASURES else small)

    def run() -> tuple[float, float, object]:
        subject = pickle.loads(curve.read_bytes()) if work == MEASURES else points  # nothing kept from the last run
        return timed(lambda: RUNS[work](subject))

    def tree() -> float:
        return timed(lambda: cKDTree(points).query(points, K, workers=WORKERS))[0]

    base = held_from_now()
    signal.alarm(limit)
    *first, made = run()
    signal.alarm(0)
    most = peak()
    if work == ROBUST:
        curve.write_bytes(pickle.dumps(made))
    del made
    tree()
    long = first[0] > PATIENCE
    count = 1 if long else min(ROUNDS, max(1, int(PATIENCE / first[0])))
    rounds = [(*(first if long else run()[:2]), tree()) for _ in range(count)]
    wall, processor, trees = zip(*rounds, strict=True)
    ratio = statistics.median(ours / other for ours, other in zip(wall, trees, strict=True))
    medians = map(statistics.median, (wall, processor, trees))
    return dict(zip(FIGURES, (*medians, ratio, most, base, count), strict=True))


def measured(work: str, folder: Path, limit: int) -> tuple[dict[str, float], str]:
    """Return the figures of a work in a process of its own, or none and why there are none."""
    if work == MEASURES and not (folder / "skeleton.pickle").exists():
        return {}, "no skeleton by robust"
    command = [sys.executable, __file__, "--child", work, str(folder), "--limit", str(limit)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return json.loads(done.stdout.splitlines()[-1]), ""
    ends = {-signal.SIGALRM: f"over {limit} s", -signal.SIGKILL: "killed: out of memory"}
    return {}, ends.get(done.returncode, (done.stderr.strip().splitlines() or [f"ended by {done.returncode}"])[-1])


def hopeless(before: Sequence[Row], count: int, limit: int) -> str:
    """Return why a work on so many points is not begun, after its rows with fewer; empty where it is."""
    if not before:
        return ""
    last = max(before, key=lambda row: int(row["points"]))
    if not last["seconds"]:
        return f"not begun: {last['points']} points were too many"
    expected = float(last["seconds"]) * count / int(last["points"])
    return f"not begun: {expected:.0f} s or more" if expected > limit else ""


def row(shape: str, count: int, work: str, found: dict[str, float], said: str) -> Row:
    """Return a row of the table, with date and load at its end."""
    digits = {"peak MB": 0, "base MB": 0, "rounds": 0, "over tree": 2}
    cells = {name: f"{found[name]:.{digits.get(name, 4)}f}" if found else "" for name in FIGURES}
    now = {"load": f"{os.getloadavg()[0]:.1f}", "date": str(datetime.date.today())}
    return {"shape": shape, "points": str(count), "work": work, **cells, **now, "said": said}


def add(rows: list[Row], new: Row) -> None:
    """Put a row in its place, over the one that is there."""

    def place(row: Row) -> tuple[int, int, int]:
        return SHAPES.index(row["shape"]), WORKS.index(row["work"]), int(row["points"])

    rows[:] = sorted([*(old for old in rows if place(old) != place(new)), new], key=place)


def measure(rows: list[Row], shape: str, count: int, works: Sequence[str], limit: int) -> Iterator[None]:
    """Add the rows of a cloud, one after the other."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        np.save(folder / "cloud.npy", cloud(shape, count))
        np.save(folder / "small.npy", cloud(shape, SMALL))
        for work in works:
            before = [r for r in rows if (r["shape"], r["work"]) == (shape, work) and int(r["points"]) < count]
            said = hopeless(before, count, limit)
            new = row(shape, count, work, *(({}, said) if said else measured(work, folder, limit)))
            print(", ".join(f"{key} {cell}" for key, cell in new.items() if cell), flush=True)
            add(rows, new)
            yield


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=list(SIZES))
    parser.add_argument("--shapes", nargs="+", choices=SHAPES, default=list(SHAPES))
    parser.add_argument("--works", nargs="+", choices=WORKS, default=list(WORKS))
    parser.add_argument("--limit", type=int, default=LIMIT)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--child", nargs=2, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child:
        print(json.dumps(child(given.child[0], Path(given.child[1]), given.limit)))
        return
    wanted = {*given.works, *([ROBUST] if MEASURES in given.works else [])}  # whose skeleton is measured
    skipped = {work: why for work in WORKS if work in wanted and (why := not_there(work))}
    for work, why in skipped.items():
        print(f"{work} is left out: {why}")
    works = [work for work in WORKS if work in wanted and work not in skipped]
    table, keep = FOLDER / "speed.csv", given.write or given.page
    rows: list[Row] = list(csv.DictReader(table.open(newline=""))) if keep and table.exists() else []
    for count in () if given.page else sorted(given.sizes):
        for shape in given.shapes:
            for _ in measure(rows, shape, count, works, given.limit):
                if keep:
                    page(rows, skipped)
    if given.page:
        page(rows, skipped)
    print(shown(rows))


if __name__ == "__main__":
    main()
