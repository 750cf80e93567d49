"""Solids with exact surfaces: superellipsoids, and plates cut out of a plan with holes through them."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Part
from tiskel.gallery.patches import rectangle, wall

Box = tuple[float, float, float, float]  #: x from, y from, x to, y to
Hole = tuple[float, float, float]  #: x and y of the middle, radius


def superellipsoid(centre: npt.ArrayLike, half: npt.ArrayLike, power: float = 2.0) -> Part:
    """Return the solid |x/a|^p + |y/b|^p + |z/c|^p <= 1.

    Parameters
    ----------
    centre : (3,) array_like
        Its middle.
    half : (3,) array_like
        The half axes a, b, c along x, y, z.
    power : float
        The p: 2 is an ellipsoid, above it is boxier.

    Returns
    -------
    Part
    """
    middle, axes = np.asarray(centre, dtype=float), np.asarray(half, dtype=float)

    def level(points: Points) -> Numbers:
        share = np.abs((points - middle) / axes) ** power
        return np.asarray((share.sum(axis=1) ** (1 / power) - 1) * axes.min())

    def place(u: Numbers, v: Numbers) -> Points:
        polar, turn = np.pi * u, 2 * np.pi * v
        ways = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=1)
        size = (np.abs(ways) ** power).sum(axis=1) ** (1 / power)
        return np.asarray(middle + axes * ways / size[:, None])

    return Part((place,), level)


def plate(boxes: Sequence[Box], thickness: float, holes: Sequence[Hole] = ()) -> Part:
    """Return a plate about z = 0 whose plan is a union of rectangles with round holes.

    Parameters
    ----------
    boxes : sequence of (float, float, float, float)
        Rectangles of the plan, x and y of two corners. They overlap where they join.
    thickness : float
        Along z.
    holes : sequence of (float, float, float)
        x, y and radius of holes right through it, apart from each other and from the sides.

    Returns
    -------
    Part
    """
    half = thickness / 2
    sides = [partial(_side, box, which, half) for box in boxes for which in range(4)]
    x, y = [b[0] for b in boxes] + [b[2] for b in boxes], [b[1] for b in boxes] + [b[3] for b in boxes]
    wide, long = (max(x) - min(x), 0, 0), (0, max(y) - min(y), 0)
    faces = [rectangle((min(x), min(y), z), wide, long) for z in (-half, half)]
    walls = [wall((hx, hy, -half), radius, (0, 0, thickness)) for hx, hy, radius in holes]

    def level(points: Points) -> Numbers:
        plan = np.min([_beyond(points, box) for box in boxes], axis=0)
        for hx, hy, radius in holes:
            plan = np.maximum(plan, radius - np.hypot(points[:, 0] - hx, points[:, 1] - hy))
        return np.asarray(np.maximum(plan, np.abs(points[:, 2]) - half))

    return Part((*sides, *faces, *walls), level)


def _side(box: Box, which: int, half: float, u: Numbers, v: Numbers) -> Points:
    """Return places on one of the four upright sides of a box."""
    low, high = np.array(box[:2]), np.array(box[2:])
    along, across = which % 2, 1 - which % 2
    places = np.empty((len(u), 3))
    places[:, along] = low[along] + u * (high - low)[along]
    places[:, across] = (low, high)[which // 2][across]
    places[:, 2] = half * (2 * v - 1)
    return places


def _beyond(points: Points, box: Box) -> Numbers:
    """Return how far places are beyond the nearest side of a box in the plan, negative inside."""
    low, high = np.array(box[:2]), np.array(box[2:])
    return np.asarray(np.maximum(low - points[:, :2], points[:, :2] - high).max(axis=1))


def around_holes(length: float, width: float, holes: int, radius: float, count: int) -> list[tuple[Points, Numbers]]:
    """Return the medial axis of a rectangle with a row of holes, without its branches into the corners.

    What is as far from the hole at x = 0 as from a side at distance d in direction w is on a parabola,
    s = (d + r) / (1 + cos(turn - w)) from the middle of the hole; between two holes it is the line midway.

    Parameters
    ----------
    length : float
        Along x, shared out among the holes evenly.
    width : float
        Along y.
    holes : int
        How many.
    radius : float
        Of each hole.
    count : int
        Places on each piece.

    Returns
    -------
    list of (places (m, 3), room (m,))
        Polylines at z = 0, joined where they share an end, and the distance to the nearest side or hole.
    """
    pitch = length / holes
    tall, wide = width / 2 + radius, pitch / 2 + radius
    top = (tall**2 - pitch**2 / 4) / (2 * tall)  # y of where the line between two holes ends
    turned = np.arctan2(top, pitch / 2)
    lines: list[tuple[Points, Numbers]] = []
    for hole in range(holes):
        x = (hole - (holes - 1) / 2) * pitch
        ends = {0: hole == holes - 1, 1: hole == 0}  # whether there is a side, not a hole, towards +x and -x
        for turns in _between(ends, turned, count):
            towards = [tall / (1 + np.abs(np.sin(turns)))]
            towards += [
                wide / (1 + np.maximum(sign * np.cos(turns), 0)) for sign, end in ((1, ends[0]), (-1, ends[1])) if end
            ]
            out = np.min(towards, axis=0)
            places = np.stack([x + out * np.cos(turns), out * np.sin(turns), 0 * turns], axis=1)
            lines.append((places, out - radius))
        if hole:
            y = np.linspace(-top, top, count)
            places = np.stack([0 * y + x - pitch / 2, y, 0 * y], axis=1)
            lines.append((places, np.hypot(pitch / 2, y) - radius))
    return lines


def _between(ends: dict[int, bool], turned: float, count: int) -> list[Numbers]:
    """Return the directions from a hole in which no other hole is nearest, in pieces from end to end."""
    if all(ends.values()):
        return [np.linspace(0, 2 * np.pi, 2 * count)]
    if not any(ends.values()):
        return [np.linspace(turned, np.pi - turned, count), np.linspace(np.pi + turned, 2 * np.pi - turned, count)]
    if ends[0]:
        return [np.linspace(turned - np.pi, np.pi - turned, 2 * count)]
    return [np.linspace(turned, 2 * np.pi - turned, 2 * count)]
