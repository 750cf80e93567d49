"""Random and degenerate clouds through method robust: each gives a sound curve, or a TiskelError.

    python benchmarks/fuzz.py                       # seeds 0 to 19 of every kind
    python benchmarks/fuzz.py 0 1000 --kinds tree   # the seeds 0 to 999 of one kind
    python benchmarks/fuzz.py 0 5 --evaluate        # and the measures of each curve
    python benchmarks/fuzz.py 0 5 --moved           # and the same cloud shuffled, turned, shifted and scaled
    python benchmarks/fuzz.py 0 5 --digests         # one line for each curve, to compare between numbers of threads

A kind and a seed are a cloud, and the settings (regime, topology) go round with the
seed. Warnings of NumPy and SciPy count as crashes. A failing seed is printed with
the last line of its traceback that is in the package; a run that takes longer than
--patience seconds is a failure, too. At the end: how many went through, errors by
message, and how many connected clouds have a curve in several pieces. The exit code
is 1 where any failed. A crash of the interpreter itself names its seed with --loud.
"""

import argparse
import faulthandler
import hashlib
import json
import re
import signal
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

import tiskel
from tiskel import RobustParams, Skeleton, TiskelError, contract, evaluate, extract_skeleton
from tiskel.arrays import Points

PACKAGE = str(Path(tiskel.__file__).resolve().parent)
REGIMES = ("auto", "wire", "tube")
TOPOLOGIES = ("auto", "loops")
SAME = 0.02  # of the diagonal, how far the curves of a moved cloud may be apart
Random = np.random.Generator


def tree(rng: Random) -> Points:
    """Return 20 to 2000 points on forking polylines, exactly on them or with jitter, evenly spaced or not."""
    count = int(np.exp(rng.uniform(np.log(20), np.log(2000))))
    wander, forking, even = rng.uniform(0, 0.5), rng.uniform(0.02, 0.25), rng.random() < 0.5
    places, headings = [np.zeros(3)], [_unit(rng)]
    growing = [0]
    while len(places) < count:
        at = growing.pop(int(rng.integers(len(growing))) if rng.random() < 0.3 else -1)
        heading = _turned(rng, headings[at], wander)
        step = 1.0 if even else rng.exponential()
        places.append(places[at] + step * heading)
        headings.append(heading)
        growing.append(len(places) - 1)
        if rng.random() < forking:
            growing.append(at)
    points = np.array(places)
    return points + rng.choice([0.0, 0.0, 1e-6, 0.05, 0.3, 1.0]) * rng.normal(size=points.shape)


def thin_tree(rng: Random) -> Points:
    """Return points about the polylines of a tree, on limbs that are thinner towards the tips."""
    from tiskel import ShapeParams, make_shape
    from tiskel.gallery.trees import HABITS, thickened, tree

    count = int(rng.integers(200, 2000))
    shape = tree(str(rng.choice(list(HABITS))), tips=int(rng.integers(3, 40)), seed=int(rng.integers(1 << 30)))
    thick = thickened(shape, count, float(np.exp(rng.uniform(np.log(0.1), np.log(5)))))
    return make_shape(thick, ShapeParams(count=count, seed=int(rng.integers(1 << 30))))[0]


def line(rng: Random) -> Points:
    """Return points on a line: exactly, or nearly so that rounding decides."""
    along = np.sort(rng.uniform(0, 10, int(rng.integers(10, 300))))
    return along[:, None] * _unit(rng) + rng.choice([0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3]) * _noise(rng, len(along))


def polyline(rng: Random) -> Points:
    """Return points on a few straight pieces one after the other, in a plane or not."""
    corners = np.cumsum(rng.normal(size=(int(rng.integers(3, 7)), 3)), axis=0)
    if rng.random() < 0.3:
        corners[:, 2] = 0
    count = int(rng.integers(5, 80))
    pieces = [a + np.linspace(0, 1, count)[:, None] * (b - a) for a, b in zip(corners, corners[1:], strict=False)]
    return np.concatenate(pieces)


def ring(rng: Random) -> Points:
    """Return points on a circle, with the noise that keeps them off a plane; or on two linked ones."""
    count = int(rng.integers(12, 400))
    angle = 2 * np.pi * np.arange(count) / count
    points = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    if rng.random() < 0.3:
        points = np.concatenate([points, points[:, [0, 2, 1]] + [1.0, 0, 0]])
    return points + rng.choice([0.0, 1e-9, 1e-5, 1e-3, 0.02]) * _noise(rng, len(points))


def star(rng: Random) -> Points:
    """Return points on arms from one centre."""
    arms = np.array([_unit(rng) for _ in range(int(rng.integers(3, 40)))])
    if rng.random() < 0.3:
        arms = np.concatenate([np.eye(3), -np.eye(3)])
    along = np.arange(int(rng.integers(0, 2)), int(rng.integers(3, 40)))
    return (along[:, None, None] * arms).reshape(-1, 3)


def lattice(rng: Random) -> Points:
    """Return a cubic lattice, with ties between all distances; sometimes with holes in it."""
    sides = rng.integers(2, 12, 3)
    points = np.stack(np.meshgrid(*map(np.arange, sides), indexing="ij"), axis=-1).reshape(-1, 3).astype(float)
    return points[rng.random(len(points)) < rng.choice([1.0, 1.0, 0.7, 0.3])]


def sheet(rng: Random) -> Points:
    """Return points on a sheet: on a lattice or at random, plain, folded, curved or rough."""
    count = int(rng.integers(4, 35))
    flat = np.stack(np.meshgrid(np.arange(count), np.arange(int(rng.integers(2, 35))), indexing="ij"), axis=-1)
    flat = flat.reshape(-1, 2) / count
    if rng.random() < 0.5:
        flat = rng.uniform(size=flat.shape)
    x = flat[:, 0]
    height = [np.zeros(len(flat)), np.abs(x - 0.5), x**2, 0.3 * np.sin(6 * x)][int(rng.integers(4))]
    return np.column_stack([flat, height]) + rng.choice([0.0, 1e-9, 1e-3, 0.02]) * _noise(rng, len(flat))


def blob(rng: Random) -> Points:
    """Return a filled ball, a sphere, a cluster with a tail, or points without any order."""
    count = int(rng.integers(10, 800))
    points = rng.normal(size=(count, 3))
    kind = int(rng.integers(4))
    if kind == 1:
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    if kind == 2:
        points = np.concatenate([points, np.linspace(0, 20, 40)[:, None] * [1.0, 0, 0]])
    return rng.uniform(size=(count, 3)) if kind == 3 else points


def tube(rng: Random) -> Points:
    """Return a tube whose rings lie exactly one above the other, open, closed by one point, or cone to a point."""
    rings, around = int(rng.integers(2, 30)), int(rng.integers(3, 20))
    angle, height = 2 * np.pi * np.arange(around) / around, np.arange(rings) * rng.choice([0.1, 0.5, 2.0])
    radius = [np.ones(rings), np.linspace(1, 0, rings), np.full(rings, 1e-9)][int(rng.integers(3))]
    points = np.stack(
        [np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)), np.outer(height, np.ones(around))], axis=-1
    ).reshape(-1, 3)
    return np.concatenate([points, [[0, 0, height[-1] + 1]]]) if rng.random() < 0.5 else points


def duplicates(rng: Random) -> Points:
    """Return a tree with many rows twice, exactly or nearly, and some rows that are not finite."""
    points = tree(rng)
    again = points[rng.integers(len(points), size=len(points))]
    points = np.concatenate([points, again + rng.choice([0.0, 1e-15, 1e-12, 1e-7]) * _noise(rng, len(again))])
    points[rng.random(len(points)) < 0.02] = np.nan
    return points


def apart(rng: Random) -> Points:
    """Return two or more small bodies far from each other, or a body and single points."""
    first, second = tree(rng)[:300], [tree, ring, blob, line][int(rng.integers(4))](rng)[:300]
    away = rng.choice([30.0, 1e3, 1e6]) * _unit(rng)
    alone = rng.normal(size=(int(rng.integers(0, 4)), 3)) * 100
    return np.concatenate([first, second + away, alone])


def extreme(rng: Random) -> Points:
    """Return another kind, tiny, huge, far from the origin, or thousandfold along one axis."""
    points = KINDS[str(rng.choice([name for name in KINDS if name != "extreme"]))](rng)
    points = points * rng.choice([1e-30, 1e-9, 1.0, 1e9, 1e30])
    if rng.random() < 0.3:
        points = points * np.array([1, 1, rng.choice([1e-6, 1e-3, 1e3])])
    return points + rng.choice([0.0, 0.0, 1e6, 1e12]) * np.nanmax(np.abs(points)) * _unit(rng)


def few(rng: Random) -> Points:
    """Return 1 to 25 points, at random, on a lattice, or on a helix."""
    count = int(rng.integers(1, 26))
    at = np.arange(count)
    kinds = [rng.normal(size=(count, 3)), rng.integers(0, 3, (count, 3)).astype(float),
             np.column_stack([np.cos(at), np.sin(at), 0.2 * at])]  # fmt: skip
    return np.asarray(kinds[int(rng.integers(3))])


EVERY = (tree, thin_tree, line, polyline, ring, star, lattice, sheet, blob, tube, duplicates, apart, few, extreme)
KINDS: dict[str, Callable[[Random], Points]] = {kind.__name__: kind for kind in EVERY}
CONNECTED = ("tree", "thin_tree", "polyline")  # whose curve should be in one piece, unless tubes are asked for


def _unit(rng: Random) -> Points:
    direction = rng.normal(size=3)
    return np.asarray(direction / np.linalg.norm(direction))


def _noise(rng: Random, count: int) -> Points:
    return np.asarray(rng.normal(size=(count, 3)))


def _turned(rng: Random, heading: Points, wander: float) -> Points:
    direction = heading + wander * rng.normal(size=3)
    return np.asarray(direction / np.linalg.norm(direction))


def cloud_of(kind: str, seed: int) -> Points:
    """Return the cloud (n, 3) of a kind and a seed."""
    return KINDS[kind](np.random.default_rng([seed, *kind.encode()]))


def params_of(seed: int) -> RobustParams:
    """Return the settings of a seed: every other one is plain."""
    if seed % 2 == 0:
        return RobustParams()
    at = seed // 2
    return RobustParams(regime=REGIMES[at % 3], topology=TOPOLOGIES[at // 3 % 2])  # type: ignore[arg-type]


def curve_of(points: Points, params: RobustParams) -> Skeleton:
    """Return the curve of a cloud.

    Raises
    ------
    ValueError
        Where something of it is not finite, or points to what is not there.
    """
    found = extract_skeleton(contract(points, params))
    count = len(found.nodes)
    unsound = {
        "no nodes": count == 0,
        "nodes": not np.isfinite(found.nodes).all(),
        "radii": not (np.isfinite(found.radii) & (found.radii >= 0)).all(),
        "edges": bool(len(found.edges)) and not 0 <= found.edges.min() <= found.edges.max() < count,
        "an edge from a node to itself": bool((found.edges[:, 0] == found.edges[:, 1]).any()),
        "an edge twice": len(np.unique(np.sort(found.edges, axis=1), axis=0)) < len(found.edges),
        "lengths": not np.isfinite(found.lengths).all(),
        "points without a node": len(found.node_of_point) != len(found.cloud)
        or not 0 <= found.node_of_point.min() <= found.node_of_point.max() < count,
        "contracted points": not np.isfinite(found.contracted).all(),
        "columns": not len(found.radii) == len(found.regimes) == len(found.radius_sources) == count
        or len(found.bridged) != len(found.edges),
    }
    wrong = [name for name, is_wrong in unsound.items() if is_wrong]
    if wrong:
        raise ValueError(f"unsound: {', '.join(wrong)}")
    json.dumps(found.doubts(), allow_nan=False)
    return found


def moved(points: Points, seed: int) -> tuple[Points, Callable[[Points], Points]]:
    """Return a cloud shuffled, turned, shifted and scaled, and the way back."""
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    shift, scale = rng.normal(size=3) * np.ptp(points, axis=0).max(), rng.uniform(0.1, 10)
    return scale * points[rng.permutation(len(points))] @ turn + shift, lambda x: ((x - shift) / scale) @ turn.T


def differing(found: Skeleton, points: Points, params: RobustParams, seed: int) -> str:
    """Return how the curve of a moved cloud differs, "" where it does not."""
    cloud, back = moved(points, seed)
    other = curve_of(cloud, params)
    counts = [(curve.components, curve.loops, curve.ends) for curve in (found, other)]
    there, here = back(other.nodes), found.nodes
    apart = max(cKDTree(here).query(there)[0].max(), cKDTree(there).query(here)[0].max())
    apart /= float(np.linalg.norm(np.ptp(points, axis=0)))
    same = counts[0] == counts[1] and apart < SAME
    return "" if same else f"components, loops, ends {counts[0]} and {counts[1]}, {apart:.2g} of the diagonal apart"


def digest(found: Skeleton) -> str:
    """Return a hash of all arrays and warnings of a curve."""
    arrays = (found.nodes, found.edges, found.radii, found.node_of_point, found.contracted, found.regimes)
    code = hashlib.sha256(json.dumps(found.doubts()).encode())
    for array in arrays:
        code.update(np.ascontiguousarray(array).tobytes())
    return code.hexdigest()[:16]


@contextmanager
def at_most(seconds: int) -> Iterator[None]:
    """Raise TimeoutError in what takes longer."""

    def stop(number: int, frame: object) -> None:
        raise TimeoutError(f"more than {seconds} s")

    signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)


def where(error: BaseException) -> str:
    """Return an error, and the last place of the package that it passed."""
    places = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename.startswith(PACKAGE)]
    at = f"{Path(places[-1].filename).name}:{places[-1].lineno} in {places[-1].name}" if places else "fuzz"
    return f"{type(error).__name__}: {str(error)[:200]} ({at})"


class Tally:
    """What came of the clouds so far."""

    def __init__(self) -> None:
        self.ran, self.curves, self.pieces, self.differ = 0, 0, 0, 0
        self.refused: Counter[str] = Counter()
        self.failed: Counter[str] = Counter()
        self.slowest: tuple[float, str] = (0.0, "")

    def run(self, kind: str, seed: int, options: argparse.Namespace) -> None:
        """Run one cloud; print what is wrong with it."""
        start, name = time.perf_counter(), f"{kind} {seed}"
        self.ran += 1
        try:
            with at_most(options.patience):
                self._curve(kind, seed, options)
        except TiskelError as error:
            self.refused[re.sub(r"\d+(\.\d+)?", "N", str(error))] += 1
        except Exception as error:
            self.failed[where(error)] += 1
            print(f"FAILED {name}: {where(error)}", flush=True)
        self.slowest = max(self.slowest, (time.perf_counter() - start, name))

    def _curve(self, kind: str, seed: int, options: argparse.Namespace) -> None:
        points, params = cloud_of(kind, seed), params_of(seed)
        found = curve_of(points, params)
        self.curves += 1
        if kind in CONNECTED and params.regime != "tube" and found.components != 1:
            self.pieces += 1
            print(f"{kind} {seed}: {found.components} components, {len(points)} points, {params.regime}")
        if options.digests:
            print(f"{kind} {seed} {digest(found)}")
        if options.evaluate:
            json.dumps(evaluate(found).as_dict(), allow_nan=False)
        if options.moved and (different := differing(found, points, params, seed)):
            self.differ += 1
            print(f"{kind} {seed}: moved, {different}")

    def report(self) -> None:
        """Print the sums."""
        print(f"{self.ran} clouds: {self.curves} curves, {sum(self.refused.values())} refused, "
              f"{sum(self.failed.values())} failed; {self.pieces} connected in pieces, {self.differ} differ moved; "
              f"the slowest {self.slowest[1]}, {self.slowest[0]:.1f} s")  # fmt: skip
        for title, counts in (("refused", self.refused), ("failed", self.failed)):
            for message, count in counts.most_common():
                print(f"    {title} {count}: {message}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("first", type=int, nargs="?", default=0, help="the first seed")
    parser.add_argument("stop", type=int, nargs="?", default=20, help="the seed before which it ends")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--patience", type=int, default=60, help="seconds that a cloud may take")
    parser.add_argument("--minutes", type=float, default=np.inf, help="no new cloud is begun after so many")
    for name in ("evaluate", "moved", "digests", "loud"):
        parser.add_argument(f"--{name}", action="store_true")
    options = parser.parse_args()
    faulthandler.enable()
    for category in (RuntimeWarning, UserWarning):
        warnings.simplefilter("error", category)
    tally, end = Tally(), time.monotonic() + 60 * options.minutes
    for seed in range(options.first, options.stop):
        for kind in options.kinds:
            if time.monotonic() > end:
                break
            if options.loud:
                print(f"{kind} {seed}", file=sys.stderr, flush=True)
            tally.run(kind, seed, options)
    tally.report()
    sys.exit(bool(tally.failed))


if __name__ == "__main__":
    main()
