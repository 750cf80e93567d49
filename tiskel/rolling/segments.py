"""Twists over time in pieces whose shapes have a few free numbers: Newton's method sets them so that a ball arrives."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tiskel.arrays import TINY, Numbers, Stack, Table
from tiskel.rolling.ambient import Ground
from tiskel.rolling.courses import bump
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.loops import ROWS, missed
from tiskel.rolling.many import Poses, roll_many

TAIL = 30.0  # radians at the end of a way that are corrected; what is before is rolled once
SHORTEST = 0.05  # radians: a piece that turns less takes as long as one that turns as much
STEPS, MOST = 8, 0.5  # of Newton's method: steps, and radians of one
NUDGE, SMALL = 0.01, 1e-5  # radians for differences, and what is none


@dataclass(frozen=True, eq=False)
class Segment:
    """A piece of a plan.

    Attributes
    ----------
    omega : (k + 1, 3) float64
        Twist of the object in the carried frame, without slip.
    step : float
        Seconds between rows.
    shapes : (n, k + 1, 3) float64
        What may be added to it, each turning by one radian in all.
    """

    omega: Table
    step: float
    shapes: Stack

    def changed(self, by: Table) -> Stack:
        """Return twists (k + 1, m, 3) with the shapes added, so much of each (m, n)."""
        return np.asarray(self.omega[:, None] + np.einsum("mn,nkc->kmc", by, self.shapes))

    def timed(self, speed: float) -> tuple[Numbers, Table]:
        """Return times from 0 and twists of a sphere that turns at so many radians per second at most."""
        turns = np.linalg.norm(self.omega, axis=1)
        stretch = max(float(turns.max()), SHORTEST / (self.step * (len(turns) - 1))) / speed
        return np.asarray(np.arange(len(self.omega)) * (self.step * stretch)), np.asarray(self.omega / stretch)


def of_way(omega: Table, step: float) -> list[Segment]:
    """Return the segments of a way: all of it but the tail, then that, which may be bent in two halves."""
    if not omega.any():
        return []
    tail = max(len(omega) - 1 - int(TAIL / step), 0)
    tail = 0 if tail < 2 else tail
    shapes = np.zeros((4, len(omega) - tail, 3))
    half = (len(omega) - tail - 1) // 2
    for number in range(4):
        first = (number // 2) * half
        shapes[number, first : first + half + 1, number % 2] = bump(half) / (half * step)
    head = [Segment(omega[: tail + 1], step, np.zeros((0, tail + 1, 3)))] if tail else []
    return [*head, Segment(omega[tail:], step, shapes)]


def of_moves(moves: Table, spin: bool) -> list[Segment]:
    """Return the segments of a loop, whose moves may be turned and lengthened."""
    shapes = np.array([np.outer(bump(ROWS), axis) for axis in np.eye(3)[: 3 if spin else 2]])
    return [Segment(np.outer(bump(ROWS), move), 1 / ROWS, shapes) for move in moves]


def joined(segments: Sequence[Segment], speed: float) -> Inputs:
    """Return the inputs of segments one after the other, at a speed in radians per second."""
    times, values = [np.zeros(1)], [np.zeros((1, 3))]
    for segment in segments:
        t, omega = segment.timed(speed)
        values[-1][-1] = omega[0]
        times.append(times[-1][-1] + t[1:])
        values.append(omega[1:].copy())
    omega = np.concatenate(values)
    return Inputs(np.concatenate(times), np.column_stack([omega, np.zeros_like(omega)]))


class Shooting:
    """Segments from a pose to a place, and perhaps to an attitude."""

    def __init__(
        self, ground: Ground, pose: Poses, segments: Sequence[Segment], place: Numbers, attitude: Numbers | None
    ) -> None:
        self.ground, self.place, self.attitude = ground, place, attitude
        first = next((number for number, one in enumerate(segments) if len(one.shapes)), len(segments))
        self.head, self.tail = list(segments[:first]), list(segments[first:])
        for segment in self.head:
            pose = roll_many(ground, pose, segment.omega[:, None], segment.step).poses
        self.pose = pose

    def off(self, by: Table) -> Table:
        """Return what is missed (m, 2 or 5) with so much of every shape (m, n)."""
        pose, used = self.pose.of(0, len(by)), 0
        for segment in self.tail:
            some = by[:, used : used + len(segment.shapes)]
            pose, used = roll_many(self.ground, pose, segment.changed(some), segment.step).poses, used + some.shape[1]
        return missed(self.ground, pose, self.place, self.attitude)

    @property
    def size(self) -> int:
        """How many shapes there are."""
        return sum(len(segment.shapes) for segment in self.tail)

    def step(self, by: Numbers, off: Numbers) -> Numbers:
        """Return how much more of every shape (n,) makes good what is missed; nothing where that is not known.

        Differences are wide, since fixed steps jump a little where curvature does, as at the caps of a capsule.
        """
        nudges = NUDGE * np.eye(self.size)
        sides = self.off(np.concatenate([by + nudges, by - nudges]))
        slopes = (sides[: self.size] - sides[self.size :]).T / (2 * NUDGE)
        if not np.isfinite(slopes).all():
            return np.zeros(self.size)
        step: Numbers = -np.linalg.pinv(slopes, rcond=1e-4) @ off
        return step * min(1.0, MOST / max(float(np.abs(step).max()), TINY))

    def solved(self, by: Numbers) -> Numbers:
        """Return so much of every shape (n,) that nothing is missed, by the fixed steps."""
        now = self.off(by[None])[0]
        for _ in range(STEPS):
            if not np.linalg.norm(now) > SMALL:
                break
            step = self.step(by, now)
            for _ in range(5):
                after = self.off((by + step)[None])[0]
                if np.linalg.norm(after) < np.linalg.norm(now):
                    break
                step = step / 3
            else:
                break
            by, now = by + step, after
        return by

    def with_shapes(self, by: Numbers) -> list[Segment]:
        """Return the segments with so much of every shape (n,) added."""
        out, used = list(self.head), 0
        for segment in self.tail:
            some = by[used : used + len(segment.shapes)]
            out.append(replace(segment, omega=segment.changed(some[None])[:, 0]))
            used += len(some)
        return out
