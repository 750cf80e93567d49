"""Scenes of many limbs, larger than the shapes of the gallery: for cutting into tiles."""

import numpy as np

from tiskel.gallery.body import Body
from tiskel.gallery.sweep import Sweep, spline, steady
from tiskel.gallery.trees import tree
from tiskel.gallery.tubes import swept
from tiskel.geometry.round_cones import ConeGraph


def long_tube(turns: float = 1.5, radius: float = 0.12) -> Body:
    """Return a tube that winds along x, ten long and more."""
    t = np.linspace(0, 1, 65)
    line = np.stack([10 * t, np.sin(2 * np.pi * turns * t), 0.7 * np.cos(13 * t)], axis=1)
    return swept([Sweep(spline(line), steady(radius))])


def network(sides: tuple[int, int, int], radius: float, seed: int = 0) -> ConeGraph:
    """Return pipes along a crooked lattice of so many joints to its sides, one apart, three pipes of ten left out."""
    generator = np.random.default_rng(seed)
    number = np.arange(np.prod(sides)).reshape(sides)
    nodes = np.stack(np.meshgrid(*map(np.arange, sides), indexing="ij"), -1).reshape(-1, 3)
    places = nodes + generator.uniform(-0.2, 0.2, nodes.shape)
    steps = [np.moveaxis(number, axis, 0) for axis in range(3)]
    edges = np.concatenate([np.stack([step[:-1].ravel(), step[1:].ravel()], axis=1) for step in steps])
    edges = edges[generator.random(len(edges)) < 0.7]
    used, numbered = np.unique(edges, return_inverse=True)
    edges = np.sort(numbered.reshape(-1, 2), axis=1).astype(np.int32)
    return ConeGraph(places[used], edges, radius * generator.uniform(0.6, 1.2, len(used)))


def forest(side: int, tips: int, seed: int = 0, apart: float = 9.0) -> ConeGraph:
    """Return trees with so many tips each, side by side in a square."""
    trees = [tree("spreading", tips=tips, seed=seed + number) for number in range(side**2)]
    starts = np.cumsum([0, *(len(one.nodes) for one in trees)])
    nodes = [one.nodes + apart * np.array([i % side, i // side, 0]) for i, one in enumerate(trees)]
    edges = [one.edges + start for one, start in zip(trees, starts[:-1], strict=True)]
    radii = 1.5 * np.concatenate([one.radii for one in trees])
    return ConeGraph(np.concatenate(nodes), np.concatenate(edges).astype(np.int32), radii)
