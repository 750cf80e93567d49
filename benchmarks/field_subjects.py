"""What benchmarks/field.py scores: clouds of families, one-sided views, generated trees, and real clouds.

Front is along the axis in which the bounding box is smallest, so that the broadest side is seen; three-quarter is from
beside and above that.
"""

import os
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from tiskel import CurveGraph, ShapeParams, load_cloud, make_shape
from tiskel.gallery.families import BODIES
from tiskel.geometry.round_cones import ConeGraph
from tiskel.geometry.spacing import spacing_of
from tiskel.metrics.matching import stub_ends

HERE = Path(__file__).parent
SHARED = HERE / ".." / ".." / "shared"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", SHARED / "reference"))
CASES = Path(os.environ.get("TISKEL_CASES", SHARED / "cases"))
SCORED = "TISKEL_SCORED_COMMIT"

COUNTS = 4096, 16384
FAMILIES: dict[str, ShapeParams] = {
    f"{count} points{', noise 10 %' if noise else ''}": ShapeParams(count=count, noise=noise)
    for count in COUNTS
    for noise in (0.0, 0.1)
}
FRONT, THREE_QUARTER = (1.0, 0.0, 0.0), (1.0, 0.7, 0.5)  # along the least, middle and greatest extent
NOISE = 0.1  # along the rays, in smallest radii
VIEWS: dict[str, tuple[tuple[tuple[float, float, float], ...], float]] = {
    "front": ((FRONT,), 0.0),
    "three-quarter": ((THREE_QUARTER,), 0.0),
    "three-quarter, sensor noise 10 %": ((THREE_QUARTER,), NOISE),
    "two sides": ((THREE_QUARTER, (-1.0, -0.7, 0.5)), 0.0),
}
AGAIN = "sampled twice"  # families once more, with another seed

SEEDS = 40
TIPS, POINTS, NU = (100, 600), (4000, 12000), (0.1, 5.0)  # of generated trees: least and greatest
# Median twigs are so many radii long, or there are fewer tips, down to 50, and then more points: what is thicker is a
# lump. At nu 5 the shortest-path tree has F 0.27 to 0.65 where they are 6 radii long, 0.87 to 1.00 where they are 20.
SLENDER, FEWER, FEWEST, MORE = 15.0, 0.8, 50, 1.25
THIN, EVEN_NU = 0.3, 1.0  # bounds of the classes of thickness
TREES: dict[str, dict[str, float]] = {
    "trees clean": {},
    "trees noisy": {"noise": 1.0},  # of a spacing at most, a quarter at least
    "trees missing 20 %": {"missing": 0.2},
    "trees density 10:1": {"uneven": 10.0},
}
REAL, FILES = "reference clouds", "cases"
EVERY = (*FAMILIES, AGAIN, *VIEWS, *TREES, REAL, FILES)

Counts = tuple[int | None, int | None, int | tuple[int, ...] | None]  # components, loops, ends; None where any will do

# What is right, where it is known: cases by their README, reference clouds by what they are.
RIGHT: dict[str, Counts] = {
    "twigs": (1, 0, None), "crash_54points": (1, 0, None), "leaf_fold": (1, 0, 2), "maize": (1, 0, 6),
    "person_front": (1, 0, 5), "pipe_on_table": (1, 0, 2), "block_3holes": (1, 3, 0), "tree_stray": (1, 0, None),
    "tree_origin": (1, 0, None), "tree": (1, 0, None), "stent": (1, 13, 0), "aneurysm": (1, 0, (2, 3)),
    "beam": (1, 0, 2), "five_cylinders": (5, 0, 10),
    "hammer": (1, 0, 3), "horse": (1, 0, None), "joint": (1, 0, None), "fertility": (1, 4, None), "cave": (1, 0, None),
    "cave_dense": (1, 0, None), "bunny": (1, 0, None), "apple_tree": (1, 0, None), "tree_scan": (1, 0, None),
    "neuron": (1, None, None),
}  # fmt: skip


@dataclass(frozen=True)
class Subject:
    """A cloud, and what is known of it.

    Attributes
    ----------
    name : str
        Of the shape, the tree or the file.
    cloud : (n, 3) float64
    right : Counts
        Components, loops and ends.
    truth : CurveGraph or None
        The true skeleton; a ConeGraph or a Body has an exact surface as well.
    kind : str
        "whole", "view" or "tree"; only of the first are ends and loops counted against all of the truth.
    group : str
        The class that a tree belongs to.
    again : (m, 3) float64 or None
        Another cloud of the same body, whose curve should be the same.
    """

    name: str
    cloud: np.ndarray
    right: Counts
    truth: CurveGraph | None = None
    kind: str = "whole"
    group: str = ""
    again: np.ndarray | None = None


Make = Callable[[], Subject]  # makes the cloud where it is wanted; names are known before


def commit() -> str:
    """Return the hash of the commit that is scored: what HEAD was when the run began."""
    if SCORED not in os.environ:
        words = ["git", "rev-parse", "HEAD"]
        os.environ[SCORED] = subprocess.run(words, cwd=HERE, capture_output=True, text=True, check=True).stdout.strip()
    return os.environ[SCORED]


def subjects(setting: str, seeds: int = SEEDS) -> Iterator[tuple[str, Make]]:
    """Yield the name of each subject of a setting, and what makes it."""
    if setting in FAMILIES:
        yield from ((name, lambda n=name: of_family(n, FAMILIES[setting])) for name in BODIES)
    elif setting == AGAIN:
        yield from ((name, lambda n=name: twice(n)) for name in BODIES)
    elif setting in VIEWS:
        yield from ((name, lambda n=name: of_view(n, setting)) for name in BODIES)
    elif setting in TREES and find_spec("tiskel.gallery.trees"):
        yield from ((f"tree {number}", lambda n=number: of_tree(n, setting)) for number in range(seeds))
    elif setting in (REAL, FILES):
        folder, endings = (REFERENCE / "clouds", (".ply", ".las")) if setting == REAL else (CASES, (".xyz", ".stl"))
        paths = sorted(p for p in folder.glob("*") if p.suffix in endings) if folder.is_dir() else []
        yield from ((path.stem, lambda p=path: of_file(p)) for path in paths)


def of_family(name: str, params: ShapeParams) -> Subject:
    shape = BODIES[name]()
    return Subject(name, make_shape(shape, params)[0], counts(shape), shape)


def twice(name: str) -> Subject:
    subject = of_family(name, ShapeParams())
    return replace(subject, again=make_shape(subject.truth, ShapeParams(seed=1))[0])  # type: ignore[arg-type]


def of_view(name: str, view: str) -> Subject:
    shape = BODIES[name]()
    order = np.argsort(np.ptp(make_shape(shape, ShapeParams(count=2000))[0], axis=0), kind="stable")
    ways, noise = VIEWS[view]
    turned = np.zeros((len(ways), 3))
    turned[:, order] = ways
    params = ShapeParams(views=tuple(map(tuple, turned.tolist())), sensor_noise=noise)
    return Subject(name, make_shape(shape, params)[0], (shape.components, None, None), shape, kind="view")


def of_tree(number: int, setting: str) -> Subject:
    """Return a generated tree: habits in turn, thickness rising with the number, the rest by the seed."""
    from tiskel.gallery.trees import HABITS

    seeds = np.random.SeedSequence(int(commit(), 16)).generate_state(SEEDS)
    seed = int(seeds[number % SEEDS])
    generator = np.random.default_rng(seed)
    tips, count = int(generator.integers(*TIPS, endpoint=True)), int(generator.integers(*POINTS, endpoint=True))
    levels = -(-SEEDS // len(HABITS))
    nu = NU[0] * (NU[1] / NU[0]) ** ((number // len(HABITS)) % levels / (levels - 1))
    shape, count = slender(list(HABITS)[number % len(HABITS)], tips, seed, count, nu)
    params = replace(ShapeParams(count=count, seed=seed % 2**31), **TREES[setting])
    if params.noise:
        spacing = spacing_of(make_shape(shape, replace(params, noise=0.0))[0])
        share = params.noise * (number % 4 + 1) / 4
        params = replace(params, noise=share * spacing / float(shape.radii.min()))
    group = f"nu below {THIN}" if nu < THIN else f"nu below {EVEN_NU}" if nu < EVEN_NU else f"nu {EVEN_NU} and above"
    right = (shape.components, shape.loops, None)
    return Subject(f"tree {number}", make_shape(shape, params)[0], right, shape, "tree", group)


def slender(habit: str, tips: int, seed: int, count: int, nu: float) -> tuple[ConeGraph, int]:
    """Return a tree whose median twig is a twig and no wart, with the most tips up to these, and how many points."""
    from tiskel.gallery.trees import thickened, tree

    while True:
        shape = thickened(tree(habit, tips=tips, seed=seed), count, nu)
        twigs = [b for b in shape.branches if 1 in (shape.degrees[b[0]], shape.degrees[b[-1]])]
        ratio = [np.linalg.norm(np.diff(shape.nodes[b], axis=0), axis=1).sum() / shape.radii[b].mean() for b in twigs]
        if np.median(ratio) >= SLENDER:
            return shape, count
        count = count if tips > FEWEST else int(MORE * count)
        tips = max(FEWEST, int(FEWER * tips))


def of_file(path: Path) -> Subject:
    """Return a file's cloud, as the program reads it; raise TiskelError where it cannot."""
    points = load_cloud(path).points
    truth = swc(path.parent / ".." / f"{path.stem}_truth.swc")
    right = RIGHT.get(path.stem, (None, None, None))
    return Subject(path.stem, points, right, truth, "tree" if truth else "whole")


def swc(path: Path) -> CurveGraph | None:
    """Return the curve of an SWC file with its radii, None where there is none."""
    if not path.is_file():
        return None
    table: Any = np.loadtxt(path, ndmin=2)
    row = {int(number): i for i, number in enumerate(table[:, 0])}
    edges = [sorted((row[int(up)], i)) for i, up in enumerate(table[:, 6]) if up >= 0]
    return CurveGraph(np.ascontiguousarray(table[:, 2:5]), np.array(edges, np.int32), table[:, 5].copy())


def counts(shape: CurveGraph) -> Counts:
    """Return the counts of a shape; stubs, no longer than the radius at their joint, may be missing, as in trees."""
    stubs = len(stub_ends(shape, 0.0))
    return shape.components, shape.loops, tuple(range(shape.ends - stubs, shape.ends + 1))
