"""How fast the measures are, as ratios to a yardstick taken in the same process, alternating.

    python benchmarks/metrics.py [reference folder]

The yardstick is ripser(points, maxdim=0) on the dense matrix of 4096 points of the same kind. Everything is measured:
skeletal points and curve, loops included. The shares per measure stand beside those of the published toolbox, which
takes 34 s for 4096 points (MATLAB, i5-13500H), 76 % of them for topology and 23 % for boundedness.
"""

import statistics
import sys
import time
from pathlib import Path

from ripser import ripser

from tiskel import (
    Contraction,
    ContractionParams,
    ShapeParams,
    Skeleton,
    contract,
    evaluate,
    extract_skeleton,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Points

ROUNDS = 5
YARDSTICK = 4096
REFERENCE = Path(__file__).parents[1] / ".." / "shared" / "reference"
PUBLISHED = {"topology": 0.76, "boundedness": 0.23}


def subject(points: Points, method: str) -> tuple[Contraction, Skeleton]:
    c = contract(points, ContractionParams(method=method))  # type: ignore[arg-type]
    return c, extract_skeleton(c)


def timed(c: Contraction, s: Skeleton) -> tuple[float, dict[str, float]]:
    start = time.perf_counter()
    quality = evaluate(c.cloud, c.points, s.nodes, s.edges, origin=c.origin)
    return time.perf_counter() - start, quality.seconds


def dense(points: Points) -> float:
    start = time.perf_counter()
    ripser(points[:YARDSTICK], maxdim=0)
    return time.perf_counter() - start


def compare(name: str, points: Points, yardstick: Points, method: str) -> None:
    c, s = subject(points, method)
    timed(c, s)
    rounds = [(timed(c, s), dense(yardstick)) for _ in range(ROUNDS)]
    ours, theirs = (statistics.median(column) for column in ([r[0][0] for r in rounds], [r[1] for r in rounds]))
    parts = {part: statistics.median(r[0][1][part] for r in rounds) for part in rounds[0][0][1]}
    shares = ", ".join(
        f"{part} {seconds / sum(parts.values()):.0%}"
        + (f" (published {PUBLISHED[part]:.0%})" if part in PUBLISHED else "")
        for part, seconds in parts.items()
    )
    print(f"{name}, {method}, {len(points)} points: {ours:.3f} s; dense ripser of {YARDSTICK}: {theirs:.3f} s; "
          f"ratio {ours / theirs:.3f}\n    {shares}")  # fmt: skip


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else REFERENCE
    hammer = load_cloud(folder / "clouds" / "hammer.ply").points
    for method in ("lbc", "gls"):
        compare("hammer", hammer, hammer, method)
    for name in ("hammer", "quadruped"):
        small, large = (make_shape(shape_graph(name), ShapeParams(count=count))[0] for count in (YARDSTICK, 16384))
        for method in ("lbc", "gls"):
            compare(f"shape {name}", small, small, method)
            compare(f"shape {name}", large, small, method)


if __name__ == "__main__":
    main()
