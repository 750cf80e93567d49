"""Leaves and plants: folded sheets without thickness, whose skeleton is the midrib, on stems."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Body, Part, joined
from tiskel.gallery.sweep import Sweep, spline, steady

RIBS = 48  # nodes of a midrib
LEAST = 1 / 3  # of half the greatest width: radii of the midrib towards its tips, where the width is zero
UNIT = 0.25  # of half the greatest width: what noise on a sheet is a share of


@dataclass(frozen=True, eq=False)
class Leaf:
    """A sheet along a midrib, pointed at both ends, folded along it.

    Attributes
    ----------
    midrib : (m, 3) float64
        Places that a smooth curve is laid through.
    width : float
        Half the greatest width, along the blade.
    fold : float
        How far each half is raised, in radians; 0 is flat.
    up : (3,) float
        Where the halves are raised to, as far as it is across the midrib.
    """

    midrib: Points
    width: float
    fold: float = 0.5
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def _rail(self) -> Sweep:
        return Sweep(spline(self.midrib), steady(self.width), self.up)

    def _half_width(self, t: Numbers) -> Numbers:
        return np.asarray(self.width * (4 * t * (1 - t)) ** 0.6)

    def part(self) -> Part:
        """Return the leaf as a part without an inside."""
        rail, cosine, sine = self._rail(), np.cos(self.fold), np.sin(self.fold)

        def place(u: Numbers, v: Numbers) -> Points:
            _, raised, sideways = rail.frame(u)
            out = (2 * v - 1) * self._half_width(u)
            return np.asarray(
                rail.curve(u) + (out * cosine)[:, None] * sideways + (np.abs(out) * sine)[:, None] * raised
            )

        def level(points: Points) -> Numbers:
            t = rail.feet(points)
            _, raised, sideways = rail.frame(t)
            gap = points - rail.curve(t)
            high, wide = (gap * raised).sum(axis=1), np.abs((gap * sideways).sum(axis=1))
            out, off = wide * cosine + high * sine, np.abs(high * cosine - wide * sine)
            ahead = np.abs((gap * rail.frame(t)[0]).sum(axis=1))  # zero but beyond the ends
            return np.asarray(np.max([off, out - self._half_width(t), ahead], axis=0))

        return Part((place,), level, solid=False)

    def axis(self) -> tuple[Points, Numbers]:
        """Return places (RIBS, 3) along the midrib, and half the width there, at least a third of the greatest."""
        t = np.linspace(0, 1, RIBS)
        return np.asarray(self._rail().curve(t)), np.maximum(self._half_width(t), LEAST * self.width)


def leaf() -> Body:
    """One folded leaf, twelve times as long as half its width."""
    x = np.linspace(-0.7, 0.7, 15)
    one = Leaf(np.stack([x, 0 * x, 0.25 * np.cos(1.6 * x)], axis=1), 0.12)
    line, radii = one.axis()
    return joined([line], [radii], [one.part()], UNIT * one.width)


def maize() -> Body:
    """A stem with five leaves that arch: seven ends."""
    return plant(leaves=5, length=0.8, width=0.07, droop=0.55)


def seedling() -> Body:
    """A short stem with three upright leaves: five ends."""
    return plant(leaves=3, length=0.5, width=0.09, droop=0.1)


def plant(leaves: int, length: float, width: float, droop: float) -> Body:
    """Return a stem along z with leaves at even heights, in two rows as maize has them.

    Parameters
    ----------
    leaves : int
        How many.
    length : float
        How far each reaches out.
    width : float
        Half the width of each.
    droop : float
        How far tips are below where straight leaves would end.

    Returns
    -------
    Body
        Its skeleton is the middle of the stem and the midribs.
    """
    height = 0.3 * (leaves + 1)
    joints = np.linspace(0.3, height - 0.15, leaves)
    thick = 0.045, 0.02  # radii of the stem at its foot and its top
    stem = Sweep(
        spline([(0, 0, z) for z in np.linspace(0, height, 9)]),
        lambda t: (thick[0] + (thick[1] - thick[0]) * t, thick[0] + (thick[1] - thick[0]) * t),
        (1.0, 0, 0),
    )
    heights = np.unique(np.concatenate([np.linspace(thick[0], height - thick[1], 33), joints]))
    blades = [Leaf(_arch(z, number, length, droop), width) for number, z in enumerate(joints)]
    axes = [blade.axis() for blade in blades]
    lines = [np.stack([0 * heights, 0 * heights, heights], axis=1), *(line for line, _ in axes)]
    radii = [thick[0] + (thick[1] - thick[0]) * heights / height, *(r for _, r in axes)]
    return joined(lines, radii, [stem.part(), *(blade.part() for blade in blades)], min(thick[1], UNIT * width))


def _arch(height: float, number: int, length: float, droop: float) -> Points:
    """Return the midrib of a leaf that leaves the stem at a height, rises and bends down."""
    turn = np.radians(180 * number + 20 * (number % 3))  # two rows, not quite in one plane
    out = np.linspace(0, 1, 13)
    rise = 0.7 * length * out - (droop + 0.35 * length) * out**2
    return np.stack([length * out * np.cos(turn), length * out * np.sin(turn), height + rise], axis=1)
