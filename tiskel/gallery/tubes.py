"""Tubes whose sections are no circles, and strands that nearly touch: sweeps along smooth curves."""

from collections.abc import Sequence

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Body, joined
from tiskel.gallery.sweep import Sweep, spline, steady

ALONG = 64  # nodes of a true curve, a few for each of its radii


def swept(sweeps: Sequence[Sweep], count: int = ALONG) -> Body:
    """Return the body of some sweeps, each with so many nodes on its curve."""
    axes = [sweep.axis(count) for sweep in sweeps]
    thickness = min(sweep.thickness for sweep in sweeps)
    return joined([line for line, _ in axes], [r for _, r in axes], [sweep.part() for sweep in sweeps], thickness)


def _wave(length: float, height: float) -> Points:
    """Return one wave along x, up and down along y."""
    x = np.linspace(-length / 2, length / 2, 33)
    return np.stack([x, height * np.sin(2 * np.pi * x / length), 0 * x], axis=1)


def _bow(radius: float, reach: float) -> Points:
    """Return an arc about the origin in the xy plane that reaches so far, in radians, to both sides."""
    turn = np.linspace(-reach, reach, 65)
    return radius * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)


def flat_tube() -> Body:
    """A hose pressed flat, 3:1, that waves."""
    return swept([Sweep(spline(_wave(2.4, 0.3)), steady(0.24, 0.08))])


def strap() -> Body:
    """A bent strap, 8:1, with round edges."""
    return swept([Sweep(spline(_bow(1.0, 1.2)), steady(0.24, 0.03), power=4.0)])


def square_bar() -> Body:
    """A bent bar with a square section."""
    return swept([Sweep(spline(_bow(1.2, 0.9)), steady(0.15, 0.15), power=10.0)])


def twisted_bar() -> Body:
    """A flat bar that turns half about itself."""
    return swept([Sweep(spline([(0, 0, z) for z in np.linspace(-1, 1, 9)]), steady(0.22, 0.07), (1.0, 0, 0), 4.0, 0.5)])


def horn() -> Body:
    """A spiral that tapers from a wide oval to a narrow one."""
    turn = np.linspace(0, 1.6 * np.pi, 65)
    size = 0.9 - 0.09 * turn
    line = np.stack([size * np.cos(turn), size * np.sin(turn), 0.12 * turn], axis=1)

    def axes(t: Numbers) -> tuple[Numbers, Numbers]:
        return np.asarray(0.26 - 0.2 * t), np.asarray(0.17 - 0.13 * t)

    return swept([Sweep(spline(line), axes, power=3.0)])


def band() -> Body:
    """A closed ring with a flat section: one loop."""
    turn = 2 * np.pi * np.arange(65) / 64
    line = np.stack([0.8 * np.cos(turn), 0.8 * np.sin(turn), 0 * turn], axis=1)
    return swept([Sweep(spline(line, closed=True), steady(0.21, 0.07), power=4.0, closed=True)])


def half_torus() -> Body:
    """Half a ring with flat ends."""
    return swept([Sweep(spline(_bow(0.8, np.pi / 2)), steady(0.2))])


def _strand(place: tuple[float, float], turns: float) -> Points:
    """Return a strand along z that winds about the axis."""
    z = np.linspace(-1, 1, 33)
    turn = 2 * np.pi * turns * z / 2
    x, y = place
    return np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z], axis=1)


def bundle() -> Body:
    """Seven strands, wound a quarter of a turn, a third of a radius apart: seven components."""
    turn = 2 * np.pi * np.arange(6) / 6
    places = [(0.0, 0.0), *zip((0.235 * np.cos(turn)).tolist(), (0.235 * np.sin(turn)).tolist(), strict=True)]
    return swept([Sweep(spline(_strand(place, 0.25)), steady(0.1), (1.0, 0, 0)) for place in places], 33)


def twins() -> Body:
    """Two bars that bend towards each other until half a radius is between them: two components."""
    z = np.linspace(-1, 1, 33)
    x = 0.15 + 0.25 * z**2
    lines = [np.stack([sign * x, 0 * z, z], axis=1) for sign in (-1, 1)]
    return swept([Sweep(spline(line), steady(0.12), (0, 1.0, 0)) for line in lines])
