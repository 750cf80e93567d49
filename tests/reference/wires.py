"""Points along wires and tubes, as tests of wires take them."""

from collections.abc import Sequence

import numpy as np

from tiskel.arrays import Numbers, Points

STEP = 0.05  # between points along a wire
GOLDEN = (5**0.5 - 1) / 2


def wire(start: Sequence[float], stop: Sequence[float], step: float = STEP) -> Points:
    """Return points a step apart on a straight way, both ends included."""
    count = round(float(np.linalg.norm(np.subtract(stop, start))) / step) + 1
    return np.linspace(start, stop, count)


def jittered(points: Points, share: float = 0.1) -> Points:
    """Return points moved by a share of a step: exact lines and planes are no body to other stages."""
    return points + np.random.default_rng(0).normal(0, share * STEP, points.shape)


def tube(radius: Numbers | float, length: float, count: int) -> Points:
    """Return points spread evenly over a tube along z, whose radius may change from point to point."""
    number = np.arange(count)
    angle = 2 * np.pi * GOLDEN * number
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), length * (number + 0.5) / count], axis=1)


def circle(count: int) -> Points:
    angle = 2 * np.pi * np.arange(count) / count
    return jittered(np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1))
