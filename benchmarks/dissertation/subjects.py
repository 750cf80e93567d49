"""The clouds of the experiments: generated, whose true curve is known, or scans."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from tiskel import ConditioningParams, CurveGraph, ShapeParams, Skeleton, condition, load_cloud, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.gallery.catalogue import SHAPES
from tiskel.geometry.round_cones import ConeGraph
from tiskel.metrics.truth import agreement

STRETCH = (0.8, 1.25)  # of every axis, by chance
THICKEN = (0.8, 1.1)  # of all radii, by chance


@lru_cache(maxsize=4)
def generated(number: int, count: int) -> tuple[str, Points, ConeGraph]:
    """Return a cloud of a gallery shape with random proportions, and its true curve."""
    names = list(SHAPES)
    name, generator = names[number % len(names)], np.random.default_rng(number)
    shape = shape_graph(name)
    turn = Rotation.random(random_state=number).as_matrix()
    nodes = shape.nodes * generator.uniform(*STRETCH, 3) @ turn.T
    shape = replace(shape, nodes=nodes, radii=shape.radii * generator.uniform(*THICKEN))
    return name, make_shape(shape, ShapeParams(count=count, seed=number))[0], shape


def scan(path: Path, count: int) -> Points:
    """Return so many points of a scan, at random; all where it has fewer."""
    points = load_cloud(path).points
    return condition(points, ConditioningParams(sample=count))[0] if len(points) > count else points


def meaningful(curve: CurveGraph, truth: ConeGraph) -> bool:
    """The stated rule of a meaningful skeleton: components and loops are those of the body."""
    return agreement(curve, truth).topology_right


def distance(skeleton: Skeleton, truth: ConeGraph) -> float:
    """Return the mean distance of curve and truth, both ways, in local radii."""
    found = agreement(skeleton, truth)
    return (
        float("nan") if found.to_truth is None or found.from_truth is None else (found.to_truth + found.from_truth) / 2
    )
