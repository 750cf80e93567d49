"""Clouds measured as published: lbc, its raw curve, the measures of the toolbox."""

from pathlib import Path
from typing import Any

import numpy as np
from keys import KEYS
from scipy.spatial import Delaunay

from tiskel import (
    ConditioningParams,
    LbcParams,
    Quality,
    StabilityParams,
    assess_stability,
    condition,
    contract,
    evaluate,
    extract_skeleton,
    load_cloud,
)
from tiskel.arrays import Points, normalisation
from tiskel.metrics.betas import betas

Json = dict[str, Any]
ENDS, RIM = (-0.8, 0.8), 0.04  # where the cave is cut along y, and how far from there its outline is taken
HALVINGS = 40  # of a spacing
THRESHOLD = 0.75  # of beta and of centredness [T]


def cloud_of(path: Path, voxel: float | None, sample: int | None, closed: int | None, noise: float,
             seed: int) -> Points:  # fmt: skip
    """Return a cloud as the published experiments have it: thinned, closed at both ends, noise on raw coordinates."""
    points = condition(load_cloud(path).points, ConditioningParams(voxel=voxel, sample=sample, seed=seed))[0]
    if closed:
        points = closed_cave(points, closed)
    return points + noise * np.random.default_rng(seed).normal(size=points.shape) * points


def closed_cave(points: Points, count: int) -> Points:
    """Return the cave with both its ends, planes across y, filled evenly, so that it has so many points in all.

    The toolbox does it by a function it does not hold, close_cave(points, -0.8, 0.8, 0.04, 0.05), before noise.
    Here square grids fill the convex outlines of what is within 0.04 of the planes, as dense as the count asks for.
    """
    low, high = 0.005, 0.2
    for _ in range(HALVINGS):
        spacing = (low + high) / 2
        added = np.concatenate([lid(points, end, spacing) for end in ENDS])
        low, high = (spacing, high) if len(points) + len(added) > count else (low, spacing)
    return np.concatenate([points, added])


def lid(points: Points, end: float, spacing: float) -> Points:
    rim = points[np.abs(points[:, 1] - end) < RIM][:, [0, 2]]
    x, z = (np.arange(low, high, spacing) for low, high in zip(rim.min(axis=0), rim.max(axis=0), strict=True))
    grid = np.stack(np.meshgrid(x, z), axis=-1).reshape(-1, 2)
    grid = grid[Delaunay(rim).find_simplex(grid) >= 0]
    return np.stack([grid[:, 0], np.full(len(grid), end), grid[:, 1]], axis=1)


def measured(path: Path, voxel: float | None = None, sample: int | None = None, closed: int | None = None,
             noise: float = 0.0, seed: int = 0, order: int = 0, every: int = 1,
             curve_alone: bool = False) -> Json:  # fmt: skip
    """Return the measures of a cloud's lbc curve as published.

    order: of the cloud's rows, by chance where it is not 0; every: so many skeletal points share one beta, by the
    toolbox's rule, which takes its time; 0: the default rule.
    """
    points = cloud_of(path, voxel, sample, closed, noise, seed)
    if order:
        points = points[np.random.default_rng(order).permutation(len(points))]
    c = contract(points, LbcParams(raw=True))
    s = extract_skeleton(c)
    skeletal = {} if curve_alone else {"points": c.points, "origin": c.origin}
    quality = evaluate(c.cloud, nodes=s.nodes, edges=s.edges, **skeletal)
    document = quality.as_dict()
    found = {key: (document[a] or {}).get(b) for key, (a, b) in KEYS.items()}
    found |= {"count": len(points), "seconds": quality.seconds, "steps": len(c.steps)}
    if quality.points is not None:
        found["raw centred"] = document["centredness"]["points_raw"]
    return found | (by_toolbox(quality, c.cloud, every) if every else {})


def by_toolbox(quality: Quality, cloud: Points, every: int) -> Json:
    """Return boundedness by the toolbox's rule, and centredness, which is 0 where a place is not bounded."""
    frame, found, curve = normalisation(cloud), {}, quality.curve
    if curve is not None:
        around = betas(frame.apply(curve.samples.points), frame.apply(cloud), "toolbox") > THRESHOLD
        centred = np.where(around, curve.sections.centredness, 0.0)
        centred = centred[~np.isnan(centred)]
        found |= {"bounded curve": float(around.mean()), "centred curve": float((centred > THRESHOLD).mean())}
    if quality.points is not None:
        some = betas(frame.apply(quality.points.points[::every]), frame.apply(cloud), "toolbox") > THRESHOLD
        both = some & (quality.points.raw_centredness[::every] > THRESHOLD)
        found |= {
            "bounded points": float(some.mean()),
            "centred points": float(both.mean()),
            "bounded": some.astype(int).tolist(),
        }
    return found


def printed_betas(path: Path, every: int) -> Json:
    """Return which skeletal points of the apple tree are bounded by print's rule, one of every so many."""
    cloud = cloud_of(path, 0.02, None, None, 0.0, 0)
    frame, points = normalisation(cloud), contract(cloud, LbcParams(raw=True)).points[::every]
    return {"bounded": (betas(frame.apply(points), frame.apply(cloud), "print") > THRESHOLD).astype(int).tolist()}


def normals_over_steps(path: Path) -> Json:
    """Return angles of normals under the three rules, step by step."""
    c = contract(load_cloud(path).points, LbcParams())
    result = {}
    for rule in ("origin", "outward", "random"):
        steps = assess_stability(c, StabilityParams(normals=rule)).steps
        result[rule] = {
            "histograms": [np.histogram(s.angles, 40, (0, 1))[0].tolist() for s in steps],
            "mean": [float(s.angles.mean()) for s in steps],
            "skewness": [float(((s.angles - s.angles.mean()) ** 3).mean() / s.angles.std() ** 3) for s in steps],
            "peaks": [{"origin": s.origin, "outward": s.angle, "random": s.control}[rule].peaks for s in steps],
        }  # fmt: skip
    return result
