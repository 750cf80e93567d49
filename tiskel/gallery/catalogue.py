"""The named shapes, as graphs of round cones; lengths are of the order of one."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Points
from tiskel.gallery import bodies
from tiskel.gallery.strands import Strand, from_strands
from tiskel.geometry.round_cones import ConeGraph


def _circle(count: int, radius: float, centre: npt.ArrayLike = (0, 0, 0)) -> Points:
    """Return a closed circle in the xy plane, its first point repeated at the end."""
    turn = 2 * np.pi * np.arange(count + 1) / count
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * radius + np.asarray(centre, dtype=float)
    circle[-1] = circle[0]
    return np.asarray(circle)


def _arc(count: int, radius: float, start: float, stop: float) -> Points:
    turn = np.linspace(start, stop, count)
    return np.asarray(np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * radius)


def capsule() -> ConeGraph:
    """A straight rod with round ends."""
    return from_strands([([(0, 0, -0.7), (0, 0, 0.7)], 0.2)])


def banana() -> ConeGraph:
    """A bent rod, thin at both ends."""
    share = np.linspace(-1, 1, 33)
    return from_strands([(_arc(33, 1.0, -0.9, 0.9), 0.22 - 0.14 * share**2)])


def carrot() -> ConeGraph:
    """A straight taper, 5:1."""
    return from_strands([([(0, 0, 0), (0, 0, 1.6)], (0.3, 0.06))])


def egg() -> ConeGraph:
    """Two balls of unequal size and what spans them: hardly elongated."""
    return from_strands([([(0, 0, -0.25), (0, 0, 0.35)], (0.5, 0.36))])


def dumbbell() -> ConeGraph:
    """Two weights on a bar."""
    along = np.array([-0.8, -0.6, -0.45, 0.45, 0.6, 0.8])
    return from_strands([(along[:, None] * [0, 0, 1], (0.3, 0.3, 0.1, 0.1, 0.3, 0.3))])


def hammer() -> ConeGraph:
    """A handle and a head across it."""
    handle, head = [(0, 0, -1), (0, 0, 0.35), (0, 0, 0.5)], [(-0.35, 0, 0.5), (0, 0, 0.5), (0.35, 0, 0.5)]
    return from_strands([(handle, (0.08, 0.08, 0.15)), (head, 0.15)])


def y_shape() -> ConeGraph:
    """Three arms from one junction."""
    arms = [(0, 0, -0.9), (0.65, 0, 0.65), (-0.65, 0, 0.65)]
    return from_strands([([(0, 0, 0), arm], 0.14) for arm in arms])


def cross() -> ConeGraph:
    """Four arms from one junction."""
    arms = [(0.8, 0, 0), (-0.8, 0, 0), (0, 0, 0.8), (0, 0, -0.8)]
    return from_strands([([(0, 0, 0), arm], 0.13) for arm in arms])


def hand() -> ConeGraph:
    """A wrist, a palm and five fingers."""
    palm = (0.0, 0.0, 0.0)
    knuckles = [(-0.32, 0.0, 0.1), (-0.2, 0.0, 0.4), (0.0, 0.0, 0.45), (0.18, 0.0, 0.42), (0.34, 0.0, 0.34)]
    tips = [(-0.75, 0.0, 0.35), (-0.35, 0.0, 1.05), (0.0, 0.0, 1.2), (0.3, 0.0, 1.1), (0.6, 0.0, 0.85)]
    fingers: list[Strand] = [([palm, k, t], (0.2, 0.09, 0.07)) for k, t in zip(knuckles, tips, strict=True)]
    return from_strands([([(0, 0, -0.8), palm], (0.15, 0.2)), *fingers])


def quadruped() -> ConeGraph:
    """A body with four legs, a neck and a head, and no tail."""
    hips, chest = (-0.5, 0.0, 0.0), (0.5, 0.0, 0.0)
    legs: list[Strand] = [
        ([(x, 0, 0), (x, y, -0.25), (x, y, -0.9)], (0.22, 0.12, 0.07)) for x in (-0.5, 0.5) for y in (-0.22, 0.22)
    ]
    return from_strands([([hips, chest], 0.22), *legs, ([chest, (0.8, 0, 0.45), (1.1, 0, 0.4)], (0.2, 0.12, 0.1))])


def table() -> ConeGraph:
    """Two beams with a leg at each end, joined by a third beam."""
    beams: list[Strand] = [([(x, -0.5, 0), (x, 0, 0), (x, 0.5, 0)], 0.1) for x in (-0.7, 0.7)]
    legs: list[Strand] = [([(x, y, 0), (x, y, -0.8)], 0.07) for x in (-0.7, 0.7) for y in (-0.5, 0.5)]
    return from_strands([*beams, ([(-0.7, 0, 0), (0.7, 0, 0)], 0.1), *legs])


def torus() -> ConeGraph:
    """A ring: one loop, no end."""
    return from_strands([(_circle(64, 0.7), 0.2)])


def two_holed_torus() -> ConeGraph:
    """Two rings that share a point: two loops, one junction."""
    left, right = _circle(48, 0.5, (-0.5, 0, 0)), _circle(48, 0.5, (0.5, 0, 0))
    right[:, 0] = -left[:, 0]
    return from_strands([(left, 0.14), (right, 0.14)])


def mug() -> ConeGraph:
    """A thick body with a handle: one loop, two ends."""
    body = [(0, 0, -0.5), (0, 0, -0.3), (0, 0, 0.3), (0, 0, 0.5)]
    turn = np.linspace(np.pi / 2, -np.pi / 2, 17)
    bow = np.stack([0.3 + 0.45 * np.cos(turn), 0 * turn, 0.3 * np.sin(turn)], axis=1)
    return from_strands([(body, 0.3), (np.vstack([(0, 0, 0.3), bow, (0, 0, -0.3)]), 0.08)])


def helix() -> ConeGraph:
    """Two turns of a screw."""
    turn = np.linspace(0, 4 * np.pi, 97)
    return from_strands([(np.stack([0.6 * np.cos(turn), 0.6 * np.sin(turn), turn / 8], axis=1), 0.12)])


def tunnel() -> ConeGraph:
    """A bent tube, open at both ends."""
    return from_strands([(_arc(33, 1.2, -0.7, 0.7), 0.25)], open_ends=True)


SHAPES: dict[str, Callable[[], ConeGraph]] = {
    make.__name__.replace("_shape", "").replace("_", "-"): make
    for make in (
        capsule, banana, carrot, egg, dumbbell, hammer, y_shape, cross, hand, quadruped,
        table, torus, two_holed_torus, mug, helix, tunnel,
        bodies.duck, bodies.dog, bodies.starfish, bodies.tree, bodies.ladder, bodies.chair, bodies.knot,
        bodies.links, bodies.fork,
    )
}  # fmt: skip
