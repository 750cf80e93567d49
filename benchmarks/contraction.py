"""How fast contraction is, as ratios to a yardstick taken in the same process, alternating.

    python benchmarks/contraction.py [reference cloud of a hammer]
    python benchmarks/contraction.py --sizes 4096 16384 65536 [--solver cholmod] [--write]

1. A whole gls contraction of the hammer, neighbours and rings included, against three
   scipy.sparse.linalg.spsolve(A_csc, one_column) calls with default settings on the first step's normal matrix.
2. gls against lbc, contraction alone (rings excluded): the hammer, and two shapes with 16384 points.
3. robust against gls with the raw curve, contraction and graph together: the hammer, and shapes with 4096 points.
4. Neighbours of a very uneven cloud against an even one of the same size.

With --sizes: 1. and, at these sizes of the shape quadruped, what lbc and gls take, part by part, apart from rings;
--write puts both into benchmarks/speed/laplacian-SOLVER.csv and .md. Held at most: three spsolve 0.6 times (0.35
with CHOLMOD); at least: lbc over gls 1.4, 1.7 and 2 at 4096, 16384 and 65536 points.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve
from tables import Row, shown, written

from tiskel import (
    ContractionParams,
    GlsParams,
    LbcParams,
    ShapeParams,
    SkeletonParams,
    contract,
    extract_skeleton,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Points, normalisation
from tiskel.geometry.neighbours import cloud_rings, nearest_neighbours
from tiskel.geometry.rings import cotangent_laplacian, mean_ring_length
from tiskel.params import Solver, published_neighbours

ROUNDS, LARGE = 5, 40_000  # of each work; points from which on one round has to do
HAMMER = Path(__file__).parents[1] / ".." / "shared" / "reference" / "clouds" / "hammer.ply"


def alternating(*works: Callable[[], float]) -> list[float]:
    """Return the median of each work's own figure over rounds of all of them, after one round to warm up."""
    figures = [[work() for work in works] for _ in range(ROUNDS + 1)][1:]
    return [statistics.median(column) for column in zip(*figures, strict=True)]


def seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def first_normal_matrix(points: Points) -> tuple[sparse.csc_array, Points]:
    cloud = normalisation(points).apply(points)
    rings = cloud_rings(cloud, published_neighbours(len(cloud)))
    laplacian = cotangent_laplacian(cloud, rings, GlsParams().cotangent_cap)
    weight = 1 / (5 * mean_ring_length(cloud, rings, count_first_twice=False))
    return sparse.csc_array(weight**2 * (laplacian.T @ laplacian) + sparse.eye_array(len(cloud))), cloud


def against_spsolve(points: Points, solver: Solver = "scipy") -> tuple[float, float]:
    matrix, right = first_normal_matrix(points)
    ours, three = alternating(
        lambda: seconds(lambda: contract(points, GlsParams(solver=solver))),
        lambda: seconds(lambda: [spsolve(matrix, right[:, axis]) for axis in range(3)]),
    )
    print(f"whole gls contraction: {ours:.3f} s; three spsolve: {three:.3f} s; ratio {ours / three:.2f}")
    return ours, three


def against_lbc(name: str, points: Points) -> None:
    """The whole contraction less its neighbours and rings: the discarded last step counts."""

    def alone(method: str) -> float:
        start = time.perf_counter()
        c = contract(points, ContractionParams(method=method))  # type: ignore[arg-type]
        return time.perf_counter() - start - c.ring_seconds

    gls, lbc = alternating(lambda: alone("gls"), lambda: alone("lbc"))
    left = contract(points, ContractionParams(method="gls"))
    print(
        f"{name}, {len(points)} points: gls {gls:.3f} s ({len(left.steps)} steps, {left.status.value}, "
        f"{len(left.points) / len(points):.1%} left), lbc {lbc:.3f} s; lbc / gls {lbc / gls:.2f}"
    )


def robust_against_gls(name: str, points: Points) -> None:
    """From the cloud to the curve; robust with its doubts, gls as published."""
    robust, gls = alternating(
        lambda: seconds(lambda: extract_skeleton(contract(points))),
        lambda: seconds(
            lambda: extract_skeleton(contract(points, ContractionParams(method="gls")), SkeletonParams(raw=True))
        ),
    )
    print(f"{name}, {len(points)} points: robust {robust:.3f} s, gls raw {gls:.3f} s; robust / gls {robust / gls:.2f}")


def neighbours_of_uneven_clouds() -> None:
    generator = np.random.default_rng(0)
    even = generator.random((100_000, 3))
    uneven = generator.normal(size=(100_000, 3)) * np.geomspace(1e-6, 1, 100_000)[:, None]
    one, other = alternating(*(lambda p=p: seconds(lambda: nearest_neighbours(p, 30)) for p in (even, uneven)))
    print(f"neighbours of 100000 points: even {one:.3f} s, density 1e18:1 {other:.3f} s; ratio {other / one:.2f}")


def parts_of(points: Points, params: LbcParams | GlsParams) -> dict[str, float]:
    """Return the seconds of a contraction by part: rings, laplacian, solve, and everything."""
    start = time.perf_counter()
    c = contract(points, params)
    whole = time.perf_counter() - start
    steps = {part: sum(step.seconds.get(part, 0.0) for step in c.steps) for part in ("laplacian", "solve", "reduce")}
    return {"whole": whole, "rings": c.ring_seconds, **steps, "apart": whole - c.ring_seconds}


def at_sizes(sizes: list[int], solver: Solver) -> list[Row]:
    """Return a row for each size and method, of medians; the ratio is lbc over gls, apart from rings."""
    rows = []
    for size in sizes:
        points = make_shape(shape_graph("quadruped"), ShapeParams(count=size))[0]
        rounds = [(parts_of(points, LbcParams(solver=solver)), parts_of(points, GlsParams(solver=solver)))
                  for _ in range(ROUNDS if size <= LARGE else 1)]  # fmt: skip
        ratio = statistics.median(lbc["apart"] / gls["apart"] for lbc, gls in rounds)
        for method, found in zip(("lbc", "gls"), zip(*rounds, strict=True), strict=True):
            medians = {f"{part} s": f"{statistics.median(one[part] for one in found):.3f}" for part in found[0]}
            told = f"{ratio:.2f}" if method == "gls" else ""
            rows.append({"points": str(size), "method": method, "solver": solver, **medians, "lbc / gls": told})
    return rows


def by_size(hammer: Points, sizes: list[int], solver: Solver, *, write: bool) -> None:
    ours, three = against_spsolve(hammer, solver)
    rows = at_sizes(sizes, solver)
    print(shown(rows))
    if write:
        words = (
            f"lbc and gls on the shape quadruped; medians of {ROUNDS} rounds in turn, of one over {LARGE} points. "
            f"A whole gls contraction of the hammer takes {ours / three:.2f} times three spsolve of its first step."
        )
        written(f"laplacian-{solver}", rows, words)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cloud", nargs="?", default=HAMMER)
    parser.add_argument("--sizes", type=int, nargs="+")
    parser.add_argument("--solver", choices=["scipy", "cholmod"], default="scipy")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    hammer = load_cloud(given.cloud).points
    if given.sizes:
        by_size(hammer, given.sizes, given.solver, write=given.write)
        return
    against_spsolve(hammer)
    against_lbc("hammer", hammer)
    for name in ("hammer", "quadruped"):
        against_lbc(f"shape {name}", make_shape(shape_graph(name), ShapeParams(count=16384))[0])
    robust_against_gls("hammer", hammer)
    for name in ("capsule", "y", "dog", "mug", "knot", "fork", "starfish"):
        robust_against_gls(f"shape {name}", make_shape(shape_graph(name))[0])
    neighbours_of_uneven_clouds()


if __name__ == "__main__":
    main()
