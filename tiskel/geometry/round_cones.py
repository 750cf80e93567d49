"""Round cones: the hull of two balls, sampled and measured.

A shape is a graph whose nodes carry radii; every edge is a round cone. The
graph is the shape's curve skeleton, and the union's surface is what a scanner
would see of it.
"""

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points
from tiskel.geometry.frames import across
from tiskel.geometry.graph import CurveGraph

BATCH = 200_000  # candidates per round: bounds the memory, not the result


@dataclass(frozen=True, eq=False, repr=False)
class ConeGraph(CurveGraph):
    """A union of round cones: every edge is one.

    Attributes
    ----------
    open_ends : tuple of int
        Nodes whose ball leaves no surface, so that the tube is open there.
    """

    open_ends: tuple[int, ...] = field(default=(), kw_only=True)


def signed_distance(points: Points, shape: ConeGraph, edge: int) -> Numbers:
    """Return the exact distance of points to the surface of one round cone, negative inside.

    Behind the end planes of the cone part a ball is nearest; between them the
    distance is measured along the normal of the slanted side.

    Parameters
    ----------
    points : (n, 3) float64
        Places in the unit of the shape.
    shape : ConeGraph
    edge : int
        Which of its edges.

    Returns
    -------
    (n,) float64
        In the same unit.
    """
    (a, b), (ra, rb) = shape.nodes[shape.edges[edge]], shape.radii[shape.edges[edge]]
    axis, length = b - a, float(np.linalg.norm(b - a))
    if length <= abs(ra - rb):
        ball, radius = (a, ra) if ra > rb else (b, rb)
        return np.asarray(np.linalg.norm(points - ball, axis=1) - radius)
    sine = (ra - rb) / length
    cosine = np.sqrt(1 - sine**2)
    along = (points - a) @ (axis / length)
    across = np.sqrt(np.maximum(((points - a) ** 2).sum(axis=1) - along**2, 0))
    foot = along - across * sine / cosine  # where the slanted normal through the point meets the axis
    on_side = across * cosine + along * sine - ra
    at_a, at_b = np.hypot(along, across) - ra, np.hypot(along - length, across) - rb
    return np.asarray(np.where(foot < 0, at_a, np.where(foot > length, at_b, on_side)))


def union_distance(points: Points, shape: ConeGraph) -> Numbers:
    """Return the smallest signed distance to any part; inside it is no more than a bound on the depth.

    Parameters
    ----------
    points : (n, 3) float64
        Places in the unit of the shape.
    shape : ConeGraph

    Returns
    -------
    (n,) float64
        In the same unit, negative inside; exact outside.
    """
    return np.asarray(np.min([signed_distance(points, shape, e) for e in range(len(shape.edges))], axis=0))


def sample_union(shape: ConeGraph, count: int, generator: np.random.Generator) -> Points:
    """Return points on the surface of a union, uniform by area; points inside another part are not on it.

    Parameters
    ----------
    shape : ConeGraph
    count : int
        How many points.
    generator : numpy.random.Generator
        Drawn from; the same state gives the same points.

    Returns
    -------
    (count, 3) float64
        In the unit of the shape.
    """
    areas = cone_areas(shape)
    around = touching(shape)
    found: list[Points] = []
    have = 0
    while have < count:
        shares = generator.multinomial(min(BATCH, 2 * (count - have) + 1000), areas / areas.sum())
        batch = np.concatenate([visible(shape, e, int(m), around[e], generator) for e, m in enumerate(shares)])
        found.append(generator.permutation(batch))
        have += len(batch)
    return np.concatenate(found)[:count]


def bounding_balls(nodes: Points, radii: Numbers, edges: Edges) -> tuple[Points, Numbers]:
    """Return the middles (e, 3) of edges (e, 2) between nodes (v, 3), and the radii of balls that hold their cones."""
    ends = nodes[edges]
    half = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2
    return np.ascontiguousarray(ends.mean(axis=1)), half + radii[edges].max(axis=1)


def touching(shape: ConeGraph) -> list[Indices]:
    """Return for each part (k,) int32 the others whose bounding balls meet its own."""
    middle, reach = bounding_balls(shape.nodes, shape.radii, shape.edges)
    lists = cKDTree(middle).query_ball_point(middle, 1.01 * (reach + reach.max()), return_sorted=True)
    found = []
    for e, near in enumerate(lists):
        others: Indices = np.array(near, np.int32)
        meet = np.linalg.norm(middle[others] - middle[e], axis=1) <= 1.01 * (reach[others] + reach[e])
        found.append(others[meet & (others != e)])
    return found


def cone_areas(shape: ConeGraph) -> Numbers:
    """Return (e,) the area of every round cone of a shape, as if it were alone, in the squared unit of the shape."""
    return np.array([sum(_areas(*_cone(shape, e))) for e in range(len(shape.edges))])


def visible(
    shape: ConeGraph, edge: int, count: int, others: Indices, generator: np.random.Generator
) -> Points:  # fmt: skip
    """Return points (k, 3) of one cone, of so many those that do not lie inside another part or on an open end."""
    a, b, ra, rb = _cone(shape, edge)
    points, end = sample_cone(a, b, ra, rb, count, generator)
    opened = [np.isin(node, shape.open_ends) for node in shape.edges[edge]]
    keep: Mask = ~((end == 0) & opened[0] | (end == 1) & opened[1])
    depth = 1e-9 * max(ra, rb)  # a point on the common surface of two parts belongs to both
    for other in others.tolist():
        keep &= signed_distance(points, shape, other) > -depth
    return points[keep]


def _cone(shape: ConeGraph, edge: int) -> tuple[Numbers, Numbers, float, float]:
    (a, b), (ra, rb) = shape.nodes[shape.edges[edge]], shape.radii[shape.edges[edge]]
    return a, b, float(ra), float(rb)


def _areas(a: Numbers, b: Numbers, ra: float, rb: float) -> tuple[float, float, float]:
    """Return the areas of the cap at a, the slanted side, and the cap at b."""
    length = float(np.linalg.norm(b - a))
    if length <= abs(ra - rb):
        return (4 * np.pi * ra**2, 0.0, 0.0) if ra > rb else (0.0, 0.0, 4 * np.pi * rb**2)
    sine = (ra - rb) / length
    side = np.pi * (ra + rb) * length * (1 - sine**2)
    return 2 * np.pi * ra**2 * (1 + sine), side, 2 * np.pi * rb**2 * (1 - sine)


def sample_cone(
    a: Numbers, b: Numbers, ra: float, rb: float, count: int, generator: np.random.Generator
) -> tuple[Points, npt.NDArray[np.intp]]:
    """Return points on a round cone, uniform by area, and the part that each lies on.

    Parameters
    ----------
    a : (3,) float64
        The centre of one ball.
    b : (3,) float64
        The centre of the other, in the same unit.
    ra : float
        The radius at a.
    rb : float
        The radius at b.
    count : int
        How many points.
    generator : numpy.random.Generator
        Drawn from.

    Returns
    -------
    points : (count, 3) float64
        In the same unit.
    end : (count,) int
        0 on the ball at a, 1 on that at b, -1 on the side.
    """
    areas = np.array(_areas(a, b, ra, rb))
    part = np.repeat(np.arange(3), generator.multinomial(count, areas / areas.sum()))
    first, second = even_pairs(count, generator)
    length = float(np.linalg.norm(b - a))
    axis = (b - a) / length if length else np.array([0.0, 0.0, 1.0])
    sine = np.clip((ra - rb) / length, -1, 1) if length else 0.0
    # Archimedes: on a ball the axial coordinate is uniform; on a cone the radius is, weighted by itself.
    low, high = ra * (-1 + first * (1 + sine)), length + rb * (sine + first * (1 - sine))
    swept = np.sqrt(ra**2 + first * (rb**2 - ra**2))
    share = first if ra == rb else (swept - ra) / (rb - ra)
    side = ra * sine + share * (length + (rb - ra) * sine)
    along = np.choose(part, [low, side, high])
    cosine = np.sqrt(1 - sine**2)
    at_a, at_b = np.sqrt(np.maximum(ra**2 - low**2, 0)), np.sqrt(np.maximum(rb**2 - (high - length) ** 2, 0))
    away = np.choose(part, [at_a, swept * cosine, at_b])
    u, v = across(axis)
    turn = 2 * np.pi * second
    points = a + along[:, None] * axis + away[:, None] * (np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * v)
    return points, np.choose(part, [0, -1, 1])


def even_pairs(count: int, generator: np.random.Generator) -> tuple[Numbers, Numbers]:
    """Return pairs in the unit square, as even as the plastic-number sequence makes them, from a random start.

    Scanners and mesh samplers spread points more evenly than chance does.

    Parameters
    ----------
    count : int
        How many pairs.
    generator : numpy.random.Generator
        Drawn from for the start.

    Returns
    -------
    first, second : (count,) float64
        From 0 to 1.
    """
    plastic = 1.32471795724474602596
    steps = np.arange(count)[:, None] * np.array([1 / plastic, 1 / plastic**2]) + generator.random(2)
    first, second = (steps % 1).T
    return first, second
