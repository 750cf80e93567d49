"""Wires, thinner than the points of a cloud of 4096 are apart: coils, crossings, lattices, stents.

A wire of length L and radius r has points on a line, not on a tube, where r is below
L / n for n points; they are then L / n apart. Gaps here are given in these spacings, of
clouds of 4096 points.
"""

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Body, joined
from tiskel.gallery.sweep import Sweep, spline, steady
from tiskel.gallery.tubes import swept
from tiskel.geometry.frames import step_lengths

POINTS = 4096  # points that spacings are those of
THINNESS = 0.3  # radius of a wire in spacings
STENT_RINGS, STENT_WAVES, STENT_BRIDGES = 4, 8, 4  # rings, zigzags of each, bridges from each to the next
STENT_PITCH = 0.45  # from ring to ring
PER_WAVE = 32  # nodes of a zigzag, whose chords must stay inside the wire


def _spacing(*lines: Points) -> float:
    return sum(float(step_lengths(line).sum()) for line in lines) / POINTS


def coil(gap: float = 2.0) -> Body:
    """A close coil: 24 turns that are two spacings apart."""
    turns = 24
    turn = np.linspace(0, 2 * np.pi * turns, 32 * turns + 1)
    pitch = gap * 2 * np.pi * 0.5 * turns / POINTS
    line = np.stack([0.5 * np.cos(turn), 0.5 * np.sin(turn), pitch * turn / (2 * np.pi)], axis=1)
    return swept([Sweep(spline(line), steady(THINNESS * _spacing(line)))], len(line))


def crossing(gap: float = 2.0) -> Body:
    """Two wires that cross two spacings apart: two components."""
    x = np.linspace(-1, 1, 17)
    flat, bowed = np.stack([x, 0 * x, 0 * x], axis=1), np.stack([0 * x, x, 0.3 * x**2], axis=1)
    spacing = _spacing(flat, bowed)
    lines = flat, bowed + [0, 0, gap * spacing]
    return swept([Sweep(spline(line), steady(THINNESS * spacing)) for line in lines])


def lattice() -> Body:
    """Three wires across three others, joined where they meet: four loops, twelve ends."""
    places = np.linspace(-0.5, 0.5, 3)
    along = np.linspace(-1, 1, 21)  # every place where wires meet is one of them
    flat = [np.stack([along, 0 * along + y, 0.1 * np.cos(along) * np.cos(0 * along + y)], axis=1) for y in places]
    lines = [*flat, *(line[:, [1, 0, 2]] for line in flat)]
    radius = THINNESS * _spacing(*lines)
    parts = [Sweep(spline(_longer(line, radius)), steady(radius)).part() for line in lines]
    return joined(lines, [np.full(len(line), radius) for line in lines], parts, radius)


def _longer(line: Points, by: float) -> Points:
    """Return a line that goes on by so much at both ends, so that the ends are inside the wire along it."""
    first, last = line[0] - line[1], line[-1] - line[-2]
    ends = line[0] + by * first / np.linalg.norm(first), line[-1] + by * last / np.linalg.norm(last)
    return np.concatenate([ends[:1], line, ends[1:]])


def stent() -> Body:
    """Four zigzag rings and twelve bridges: thirteen loops and no end."""
    turn = 2 * np.pi * np.arange(STENT_WAVES * PER_WAVE + 1) / (STENT_WAVES * PER_WAVE)
    rings = [_zigzag(turn, STENT_PITCH * number) for number in range(STENT_RINGS)]
    places = np.arange(STENT_BRIDGES) * (STENT_WAVES * PER_WAVE // STENT_BRIDGES)
    share = np.linspace(0, 1, 9)[:, None]
    bridges = [
        low[at] * (1 - share) + high[at] * share
        for low, high in zip(rings[:-1], rings[1:], strict=True)
        for at in places
    ]
    radius = THINNESS * _spacing(*rings, *bridges)
    sweeps = [Sweep(spline(ring, closed=True), steady(radius), closed=True) for ring in rings]
    sweeps += [Sweep(spline(bridge), steady(radius), (1.0, 0, 0)) for bridge in bridges]
    lines = [*rings, *bridges]
    return joined(lines, [np.full(len(line), radius) for line in lines], [sweep.part() for sweep in sweeps], radius)


def _zigzag(turn: Numbers, height: float) -> Points:
    """Return a ring about z that goes up and down, its last place the first again."""
    ring = np.stack([0.5 * np.cos(turn), 0.5 * np.sin(turn), height + 0.15 * np.sin(STENT_WAVES * turn)], axis=1)
    ring[-1] = ring[0]
    return np.asarray(ring)
