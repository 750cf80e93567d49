"""Random graphs of round cones: trees, and graphs with loops, whose parts keep apart.

What is asked of them keeps the question fair: edges are 3 to 10 radii long, radii
differ by a factor of 4 at most, parts that do not meet at a node are half a local
radius and three point spacings apart, and a square of the smallest radius holds at
least four points.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from tiskel.arrays import Stack, Table
from tiskel.errors import TiskelError
from tiskel.geometry.round_cones import ConeGraph

EDGES, LENGTH, RATIO = (3, 12), (3.0, 10.0), 4.0  # of edges; of their lengths in radii; of radii
GAP, SPACINGS = 0.5, 3.0  # between parts: of the local radius, and of the distance of points
PER_SQUARE = 4.0  # points in a square of the smallest radius
FEWEST = 4096  # points of a cloud
STRAIGHTEST = np.cos(np.radians(50))  # edges at one node open by at least so much
PROBES = np.linspace(0, 1, 33)  # places along an edge where gaps are measured
TRIES = 400  # of one part, and of a whole graph


@dataclass(frozen=True)
class RandomGraph:
    """A random shape and what is known of it.

    Attributes
    ----------
    shape : ConeGraph
        The round cones, with radii from 1 to 4.
    loops : int
        How many loops it has.
    count : int
        How many points make a fair cloud of it.
    """

    shape: ConeGraph
    loops: int
    count: int


def random_graph(seed: int, loops: int | None = None) -> RandomGraph:
    """Return a random connected graph of round cones; half of all seeds give trees.

    Parameters
    ----------
    seed : int
        The same seed gives the same graph.
    loops : int, optional
        Number of loops, from 0 to 4; without it the seed decides.

    Returns
    -------
    RandomGraph

    Raises
    ------
    TiskelError
        For a number of loops that 12 edges cannot hold, and where no graph was found.

    Examples
    --------
    >>> from tiskel.gallery.random_graphs import random_graph
    >>> random_graph(1, loops=2).shape.loops
    2
    """
    if loops is not None and not 0 <= loops <= EDGES[1] // 3:
        raise TiskelError(f"loops must be between 0 and {EDGES[1] // 3}, got {loops}")
    generator = np.random.default_rng(seed)
    wanted = loops if loops is not None else int(generator.integers(1, 5) if generator.random() < 0.5 else 0)
    for _ in range(TRIES):
        grown = _grow(generator, wanted, int(generator.integers(max(EDGES[0], 3 * wanted), EDGES[1] + 1)))
        if grown is not None and _apart(grown, _fair_count(grown)):
            return RandomGraph(grown, wanted, _fair_count(grown))
    raise TiskelError(f"no graph with {wanted} loops was found for seed {seed}; try another seed")


def _grow(generator: np.random.Generator, loops: int, edges: int) -> ConeGraph | None:
    """Add triangles, then single edges, each at a random node; None where there is no room."""
    shape = ConeGraph(np.zeros((1, 3)), np.zeros((0, 2), np.int32), generator.uniform(1, RATIO, 1))
    parts = [3] * loops + [1] * (edges - 3 * loops)
    for size in parts:
        tries = (_with_part(shape, size, generator) for _ in range(TRIES))
        found = next((made for made in tries if made is not None and _apart(made, FEWEST)), None)
        if found is None:
            return None
        shape = found
    return shape


def _with_part(shape: ConeGraph, size: int, generator: np.random.Generator) -> ConeGraph | None:
    """Return the shape with an edge, or with a triangle, at a random node of degree below four."""
    at = int(generator.choice(np.flatnonzero(shape.degrees < 5 - (size > 1))))
    radii = generator.uniform(1, RATIO, 2 if size > 1 else 1)
    mean = (shape.radii[at] + radii.mean()) / 2
    length = mean * generator.uniform(LENGTH[0] + 3 * (size > 1), LENGTH[1])
    u, v = np.linalg.qr(generator.normal(size=(3, 2)))[0].T
    first = len(shape.nodes)
    if size == 1:
        nodes, links = shape.nodes[at] + length * u[None], [(at, first)]
    else:
        turned = 0.5 * u + np.sqrt(0.75) * v
        nodes = shape.nodes[at] + length * np.stack([u, turned])
        links = [(at, first), (first, first + 1), (at, first + 1)]
    made = ConeGraph(
        np.concatenate([shape.nodes, nodes]),
        np.concatenate([shape.edges, np.array(links, np.int32)]),
        np.concatenate([shape.radii, radii]),
    )
    return made if _lengths_fit(made) else None


def _lengths_fit(shape: ConeGraph) -> bool:
    ratio = shape.lengths / shape.radii[shape.edges].mean(axis=1)
    return bool(((ratio >= LENGTH[0]) & (ratio <= LENGTH[1])).all())


def _fair_count(shape: ConeGraph) -> int:
    """Return the points that give a square of the smallest radius its share of the area of all sides."""
    return max(FEWEST, int(np.ceil(PER_SQUARE * _area(shape) / shape.radii.min() ** 2)))


def _area(shape: ConeGraph) -> float:
    return float((np.pi * shape.radii[shape.edges].sum(axis=1) * shape.lengths).sum())


def _apart(shape: ConeGraph, count: int) -> bool:
    """Return whether edges open wide at their nodes, and parts that do not meet keep their gap."""
    spacing = SPACINGS * np.sqrt(_area(shape) / count)
    along, radii = _probes(shape)
    for a, b in combinations(range(len(shape.edges)), 2):
        shared = np.intersect1d(shape.edges[a], shape.edges[b])
        if len(shared):
            if _cosine(shape, a, b, int(shared[0])) > STRAIGHTEST:
                return False
            continue
        gap = np.linalg.norm(along[a][:, None] - along[b], axis=2) - radii[a][:, None] - radii[b]
        if gap.min() < max(GAP * min(radii[a].min(), radii[b].min()), spacing):
            return False
    return True


def _probes(shape: ConeGraph) -> tuple[Stack, Table]:
    """Return places (e, p, 3) along the edges and radii (e, p) there."""
    ends, radii = shape.nodes[shape.edges], shape.radii[shape.edges]
    share = PROBES[None, :, None]
    places = ends[:, :1] * (1 - share) + ends[:, 1:] * share
    return np.asarray(places), np.asarray(radii[:, :1] * (1 - PROBES) + radii[:, 1:] * PROBES)


def _cosine(shape: ConeGraph, a: int, b: int, node: int) -> float:
    """Return the cosine of the angle between two edges at a node."""
    sides = [shape.nodes[shape.edges[e][shape.edges[e] != node][0]] - shape.nodes[node] for e in (a, b)]
    return float(sides[0] @ sides[1] / np.prod([np.linalg.norm(side) for side in sides]))
