"""Sweeps: superellipses carried along a smooth curve, with the exact surface and the curve as its skeleton."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import gamma
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Part
from tiskel.geometry.frames import step_lengths, unit

Axes = Callable[[Numbers], tuple[Numbers, Numbers]]  #: from parameters (n,) to the two half axes (n,) there

STARTS = 4096  # places along a curve that feet are sought from
NEWTON = 30  # steps to a foot at most; each squares the error, and the start is within a 4096th of the curve
AT_END = 1e-6  # of the parameter: feet so near an end may be at it but for rounding
SETTLED = 1e-15  # of the parameter, which runs from 0 to 1: no step any more


def spline(points: npt.ArrayLike, *, closed: bool = False) -> Any:
    """Return the cubic spline through points, over 0 to 1.

    Parameters
    ----------
    points : (m, 3) array_like
        Where it runs through; of a closed one the last is the first again.
    closed : bool
        Whether it returns smoothly.

    Returns
    -------
    scipy.interpolate.CubicSpline
        From parameters (n,) to places (n, 3).
    """
    places = np.asarray(points, dtype=float)
    along = np.concatenate([[0], np.cumsum(step_lengths(places))])
    if closed:
        places[-1] = places[0]
    return CubicSpline(along / along[-1], places, bc_type="periodic" if closed else "not-a-knot")


def steady(first: float, second: float | None = None) -> Axes:
    """Return half axes that are the same everywhere; one alone is a radius."""
    other = first if second is None else second
    return lambda t: (np.full(len(t), first), np.full(len(t), other))


@dataclass(frozen=True, eq=False)
class Sweep:
    """A superellipse |x/a|^p + |y/b|^p = 1 carried across a curve, with flat ends.

    Attributes
    ----------
    curve : CubicSpline
        Over 0 to 1.
    axes : callable
        The half axes a and b along it.
    up : (3,) float
        What a points along, as far as it is across the curve; never along the curve.
    power : float
        The p: 2 is an ellipse, 4 to 10 a rectangle with rounder or sharper corners.
    turns : float
        How often a turns about the curve on the way.
    closed : bool
        Whether the curve returns.
    """

    curve: Any
    axes: Axes
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)
    power: float = 2.0
    turns: float = 0.0
    closed: bool = False

    def frame(self, t: Numbers) -> tuple[Points, Points, Points]:
        """Return the directions (n, 3) of the curve, of a and of b at parameters (n,)."""
        ahead = unit(self.curve(t, 1))
        raised = np.asarray(self.up) - (ahead @ np.asarray(self.up))[:, None] * ahead
        first = unit(raised)
        second = np.cross(ahead, first)
        turn = 2 * np.pi * self.turns * t[:, None]
        return ahead, np.cos(turn) * first + np.sin(turn) * second, np.cos(turn) * second - np.sin(turn) * first

    def side(self, u: Numbers, v: Numbers) -> Points:
        """Return places (n, 3) on the side, u along the curve and v around it, from 0 to 1."""
        return self._section(u, v, np.ones(len(u)))

    def _section(self, t: Numbers, around: Numbers, share: Numbers) -> Points:
        _, first, second = self.frame(t)
        a, b = self.axes(t)
        x, y = np.cos(2 * np.pi * around), np.sin(2 * np.pi * around)
        size = share / (np.abs(x) ** self.power + np.abs(y) ** self.power) ** (1 / self.power)
        return np.asarray(self.curve(t) + (size * a * x)[:, None] * first + (size * b * y)[:, None] * second)

    def feet(self, points: Points) -> Numbers:
        """Return the parameters (n,) of the nearest places on the curve to places (n, 3), by Newton's steps."""
        t = self._starts[1][self._starts[0].query(points)[1]]
        for _ in range(NEWTON):
            gap, speed, bend = points - self.curve(t), self.curve(t, 1), self.curve(t, 2)
            slope = np.maximum((speed**2).sum(axis=1) - (gap * bend).sum(axis=1), 0.1 * (speed**2).sum(axis=1))
            step = np.clip((gap * speed).sum(axis=1) / slope, -1 / STARTS, 1 / STARTS)
            moved = (t + step) % 1 if self.closed else np.clip(t + step, 0, 1)
            settled = np.abs(moved - t).max(initial=0) <= SETTLED
            t = moved
            if settled:
                break
        return np.asarray(t)

    @cached_property
    def _starts(self) -> tuple[cKDTree, Numbers]:
        t = np.linspace(0, 1, STARTS, endpoint=not self.closed)
        return cKDTree(self.curve(t)), t

    def level(self, points: Points) -> Numbers:
        """Return numbers (n,) that are zero on the surface and negative inside, of places (n, 3)."""
        t = self.feet(points)
        _, first, second = self.frame(t)
        gap = points - self.curve(t)
        a, b = self.axes(t)
        x, y = np.abs((gap * first).sum(axis=1)) / a, np.abs((gap * second).sum(axis=1)) / b
        across = ((x**self.power + y**self.power) ** (1 / self.power) - 1) * np.minimum(a, b)
        if self.closed:
            return np.asarray(across)
        beyond = np.full(len(t), -np.inf)
        for end, near, sign in ((0.0, t < AT_END, -1), (1.0, t > 1 - AT_END, 1)):
            lid = np.array([end])
            beyond[near] = sign * (points[near] - self.curve(lid)) @ self.frame(lid)[0][0]
        return np.asarray(np.maximum(across, beyond))

    def part(self) -> Part:
        """Return the sweep as a solid part of a body."""
        if self.closed:
            return Part((self.side,), self.level)
        lids = tuple(self._lid(end) for end in (0.0, 1.0))
        return Part((self.side, *lids), self.level)

    def _lid(self, end: float) -> Callable[[Numbers, Numbers], Points]:
        return lambda u, v: self._section(np.full(len(u), end), v, u)

    def axis(self, count: int) -> tuple[Points, Numbers]:
        """Return the true curve, and the radii there.

        A flat end is where the surface is; the curve ends before it by half the thickness,
        in the middle of the largest ball there, as that of a round end does.

        Parameters
        ----------
        count : int
            How many places.

        Returns
        -------
        places : (count, 3) float64
            Evenly along the curve; of a closed one the last is the first again.
        radii : (count,) float64
            Of circles with the area of the sections.
        """
        t = np.linspace(0, 1, STARTS)
        along = np.concatenate([[0], np.cumsum(step_lengths(self.curve(t)))])
        shortened = (0.0, 0.0) if self.closed else tuple(min(self.axes(np.array([end])))[0] for end in (0.0, 1.0))
        chosen = np.interp(np.linspace(shortened[0], along[-1] - shortened[1], count), along, t)
        places = np.asarray(self.curve(chosen))
        if self.closed:
            places[-1] = places[0]
        a, b = self.axes(chosen)
        share = 4 * gamma(1 + 1 / self.power) ** 2 / gamma(1 + 2 / self.power) / np.pi
        return places, np.asarray(np.sqrt(share * a * b))

    @property
    def thickness(self) -> float:
        """Half the least thickness."""
        return float(np.minimum(*self.axes(np.linspace(0, 1, STARTS))).min())
