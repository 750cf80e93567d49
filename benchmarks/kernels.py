"""Every kernel against its plain reference, and against the best library call that does the same.

    python benchmarks/kernels.py                         # one thread and two, to benchmarks/speed/
    python benchmarks/kernels.py --largest 65536 --out /tmp/speed

Ours and the library take turns in one process, after a round that warms both,
and a million points on two threads only. Given are the least time of ours an
item (a point, a query, a place), the median of its ratios to the library, below
one where ours is faster, and the ratio of the plain implementation of
tests/reference to it, an item, from the least times of both; what is plain are
loops, on as many items as they can bear. Neighbours are build and query of
k = 14 of a cloud in no order, against SciPy's tree with as many workers.
"""

import argparse
import csv
import itertools
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))  # plain implementations are those of the tests

from reference import air, cones, gls, laplacian, morton, neighbours, quality, rings, thinning
from tiskel.arrays import Points
from tiskel.geometry import neighbours as ours
from tiskel.geometry import rings as our_rings
from tiskel.geometry.air import widest_gaps
from tiskel.geometry.oriented import SOFTENING, OrientedCloud
from tiskel.geometry.thinning import thinned
from tiskel.kernels.morton import LEVELS, morton_codes
from tiskel.kernels.sections import section_counts, section_points
from tiskel.methods.laplacian import reduction
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.fit import foot_points
from tiskel.metrics import boundedness
from tiskel.metrics.centredness import slab_members

HERE = Path(__file__).parent / "speed"
SIZES = (4096, 16_384, 65_536, 262_144, 1_000_000)
K = 14  # neighbours, as robust asks for
MANY = 200_000  # items from which on three rounds do, without one to warm up
COUNT = 4096  # points of all kernels but the neighbours
HEAD = ("kernel", "what", "items", "threads", "least us an item", "library", "ours / library", "plain / ours")


@dataclass(frozen=True)
class Work:
    """One kernel on one input; the plain function takes so many of the items."""

    kernel: str
    what: str
    items: int
    run: Callable[[], object]
    plain: Callable[[], object] | None = None
    plain_items: int = COUNT
    library: str = ""
    other: Callable[[], object] | None = None

    def row(self, threads: int) -> tuple[str, ...]:
        """Return a row of the table."""
        for work in (self.run, self.other) if self.items < MANY else ():
            _ = work and work()
        mine, ratios = [], []
        for _ in range(101 if self.items < 10_000 else 31 if self.items < 50_000 else 7 if self.items < MANY else 3):
            mine.append(seconds(self.run))
            if self.other:
                ratios.append(mine[-1] / seconds(self.other))
        each = min(mine) / self.items
        plain = f"{min(map(seconds, [self.plain] * 3)) / self.plain_items / each:.0f}" if self.plain else ""
        ratio = f"{statistics.median(ratios):.2f}" if ratios else ""
        return self.kernel, self.what, str(self.items), str(threads), f"{each * 1e6:.3g}", self.library, ratio, plain


def seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def cloud(name: str, count: int) -> Points:
    """Return a cloud in no order: even, half of it in a thousandth of the volume, on a sheet, or along a curve."""
    generator = np.random.default_rng(count)
    points = generator.random((count, 3))
    if name == "uneven":
        points[::2] *= 0.1
    elif name == "sheet":
        points[:, 2] = 0.1 * np.sin(6 * points[:, 0])
    elif name == "curve":
        t = 20 * np.pi * points[:, 0]
        points = np.stack([np.cos(t), np.sin(t), 0.05 * t], axis=1) + generator.normal(size=(count, 3)) * 1e-3
    return np.ascontiguousarray(points)


def neighbour_work(largest: int, threads: int) -> Iterator[Work]:
    for count, name in itertools.product(SIZES, ("even", "uneven", "sheet", "curve")):
        if count <= largest:
            points = cloud(name, count)
            yield Work(
                "neighbours", name, count, lambda p=points: ours.nearest_neighbours(p, K),
                (lambda p=points: neighbours.nearest(p, K)) if count == SIZES[0] else None, count,
                "cKDTree", lambda p=points: cKDTree(p).query(p, K, workers=threads))  # fmt: skip


def ring_work() -> Iterator[Work]:
    """What method lbc and gls do to the rings of a sheet."""
    points = cloud("sheet", COUNT)
    near = ours.nearest_neighbours(points, K)[0]
    axes = ours.principal_axes(points, near)[1]

    def by_lapack() -> object:
        some = points[near] - points[near].mean(axis=1, keepdims=True)
        return np.linalg.eigh(some.transpose(0, 2, 1) @ some / K)

    yield Work(
        "axes", "of 14 points", COUNT, lambda: ours.principal_axes(points, near),
        lambda: [np.linalg.eigh(np.cov(points[r].T)) for r in near[:500]], 500, "numpy eigh", by_lapack)  # fmt: skip
    planes, everyone = np.ascontiguousarray(axes[:, :2]), np.arange(COUNT, dtype=np.int32)
    flat = [(points[near[i, 1:]] - points[i]) @ planes[i].T for i in range(300)]
    yield Work(
        "rings", "of 13 candidates", COUNT, lambda: ours.one_rings(points, everyone, near, planes),
        lambda: [rings.one_ring(f) for f in flat], 300)  # fmt: skip
    found = ours.one_rings(points, everyone, near, planes)
    lists = [(found.of(i).tolist(), bool(found.closed[i])) for i in range(COUNT)]
    yield Work(
        "laplacian", "weights and matrix", COUNT, lambda: our_rings.cotangent_laplacian(points, found, 1e4),
        lambda: laplacian.cotangent_laplacian(points, lists))  # fmt: skip
    first = our_rings.smallest_distances(points, found)
    there, delta, now = points * 0.6, points[::-1].copy(), first * 0.5
    yield Work(
        "reduction", "stage function", COUNT,
        lambda: reduction.stage_function(
            points, there, delta, found, first, now, shrinkage=0.4, contraction_weight=150.0, guard=1e-4
        ),
        lambda: gls.stage_function(points, there, delta, lists, first, now, 0.4, 150.0))  # fmt: skip
    marked = np.random.default_rng(2).random(COUNT) < 0.5
    yield Work(
        "reduction", "matching", COUNT, lambda: reduction.matching(points, found, marked),
        lambda: gls.greedy_matching(points, lists, marked))  # fmt: skip
    merged = reduction.matching(points, found, marked)
    names = {i: int(merged[i]) for i in np.flatnonzero(merged >= 0).tolist()}
    yield Work(
        "reduction", "renaming", COUNT, lambda: reduction.rename(found, merged),
        lambda: [gls.renamed(ring, names, i) for i, (ring, _) in enumerate(lists)])  # fmt: skip


def place_work() -> Iterator[Work]:
    """Kernels that look from a few places at all points."""
    generator = np.random.default_rng(1)
    points, places = cloud("even", COUNT), generator.random((200, 3))
    x, y, z = (np.ascontiguousarray(a) for a in np.linalg.qr(generator.normal(size=(200, 3, 3)))[0].transpose(2, 0, 1))
    half, reach = 0.02, np.full(200, 0.3)
    yield Work(
        "slabs", "200 slabs", 200, lambda: slab_members(points, places, x, half),
        lambda: [np.flatnonzero(np.abs((points - places[i]) @ x[i]) <= half) for i in range(200)], 200)  # fmt: skip

    def sections() -> object:
        counts = np.empty(200, np.int32)
        section_counts(points, places, x, half, reach, counts)
        offsets = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        rows, (across, up, ahead) = np.empty(offsets[-1], np.int32), np.empty((3, offsets[-1]))
        section_points(points, places, x, y, z, half, reach, offsets[:-1], rows, across, up, ahead)
        return rows

    def plain_section(i: int) -> object:
        local = (points - places[i]) @ np.stack([x[i], y[i], z[i]], axis=1)
        return local[(np.abs(local[:, 0]) <= half) & (np.hypot(local[:, 1], local[:, 2]) <= reach[i])]

    yield Work("sections", "200 slices", 200, sections, lambda: [plain_section(i) for i in range(200)], 200)
    halves = np.full(200, half)
    yield Work(
        "slab_views", "200 places", 200, lambda: widest_gaps(places, x, halves, points),
        lambda: [air.widest_gap(p, d, half, points) for p, d in zip(places, x, strict=True)], 200)  # fmt: skip
    curve = ours.morton_curve(points)
    spacing = np.full(COUNT, 0.03)
    yield Work(
        "coverage", "200 places", 200, lambda: boundedness.coverage(places, curve, spacing),
        lambda: [quality.covered_cells(p, points, spacing, 8) for p in places[:1]], 1)  # fmt: skip
    normals = points - 0.5
    surface, soft = OrientedCloud(points, normals, np.full(COUNT, 1 / COUNT)), np.full(COUNT, SOFTENING / COUNT)
    yield Work(
        "winding", "200 places", 200, lambda: surface.winding_numbers(places),
        lambda: [quality.winding_number(p, points, normals, soft) for p in places[:5]], 5)  # fmt: skip


def other_work() -> Iterator[Work]:
    generator = np.random.default_rng(3)
    points = cloud("even", COUNT)
    codes, low = np.empty(COUNT, np.int64), points.min(axis=0)
    yield Work(
        "morton", "codes", COUNT, lambda: morton_codes(points, low, 1e6, codes),
        lambda: morton.codes(points[:300], low, 1e6, LEVELS), 300)  # fmt: skip
    nodes, edges = generator.random((41, 3)), np.stack([np.arange(40), np.arange(1, 41)], axis=1).astype(np.int32)
    radii, none = generator.uniform(0.05, 0.1, 41), np.zeros(0, np.int32)
    bones = ConeCurve(nodes, edges, radii, levels=none, node_of_section=none, section_sizes=np.zeros(0))
    rows, every = np.arange(COUNT, dtype=np.int32), np.arange(40, dtype=np.int32)[None]
    yield Work(
        "cones", "feet on 40 cones", COUNT, lambda: foot_points(bones, points, rows, 0 * rows, every),
        lambda: cones.cone_residuals(points[:200], nodes, radii, edges), 200)  # fmt: skip
    for side in (24, 96):
        sponge = ndimage.gaussian_filter(generator.normal(size=(side,) * 3), 2) > 0
        solid = sponge, ndimage.distance_transform_edt(sponge), np.zeros(sponge.shape, bool)
        yield Work(
            "thinning", f"sponge of {side}^3", int(sponge.sum()), lambda s=solid: thinned(*s),
            (lambda s=solid: thinning.thinned(*s)) if side == 24 else None, int(sponge.sum()))  # fmt: skip


def measure(threads: int, largest: int) -> None:
    """Write the rows of one number of threads on standard output, as they come."""
    out = csv.writer(sys.stdout)
    works = itertools.chain(ring_work(), place_work(), other_work(), neighbour_work(largest, threads))
    for work in works:
        out.writerow(work.row(threads))
        sys.stdout.flush()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="points of the largest cloud")
    parser.add_argument("--out", type=Path, default=HERE)
    parser.add_argument("--threads", type=int, help="measure here, with so many, and write on standard output")
    asked = parser.parse_args()
    if asked.threads:
        return measure(asked.threads, asked.largest)
    rows = []
    for threads in ("1", "2"):
        limits = dict.fromkeys(("TISKEL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), threads)
        largest = min(asked.largest, SIZES[-2]) if threads == "1" else asked.largest
        command = [sys.executable, __file__, "--threads", threads, "--largest", str(largest)]
        done = subprocess.run(command, env={**os.environ, **limits}, stdout=subprocess.PIPE, text=True, check=True)
        rows += list(csv.reader(done.stdout.splitlines()))
    rows.sort(key=lambda row: (row[0], row[1], int(row[2]), row[3]))
    asked.out.mkdir(parents=True, exist_ok=True)
    with (asked.out / "kernels.csv").open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEAD, *rows])
    lines = [f"| {' | '.join(row)} |" for row in (HEAD, ["---"] * 4 + ["---:"] + ["---"] + ["---:"] * 2, *rows)]
    (asked.out / "kernels.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
