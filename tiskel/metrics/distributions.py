"""Distributions of angles and changes of curvature: shape, peaks, and the distance from what a curve has."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Numbers
from tiskel.params import StabilityParams

UNIFORM_UP_TO = 0.5  # of D on a curve: a right angle
SPAN = {"angle": (0.0, 1.0), "curvature": (-1 / 3, 1 / 3)}  # what values can be


@dataclass(frozen=True)
class Distribution:
    """The shape of a distribution; its values have no unit."""

    mean: float  #: arithmetic mean
    spread: float  #: standard deviation
    skewness: float  #: 0 where there is no spread
    peaks: int  #: number of peaks of the histogram


def distance_from_uniform(angles: Numbers) -> float:
    """Return the largest difference of the angles' cumulative distribution from the uniform one on [0, 1/2]."""
    uniform = np.clip(np.sort(angles) / UNIFORM_UP_TO, 0, 1)
    steps = np.arange(len(angles) + 1) / len(angles)
    return float(max((steps[1:] - uniform).max(), (uniform - steps[:-1]).max()))


def distribution(values: Numbers, kind: str, params: StabilityParams) -> Distribution:
    """Return mean, spread, skewness and peaks of values (m,); kind "angle" or "curvature" says what they can be."""
    mean, spread = float(values.mean()), float(values.std())
    skewness = float(((values - mean) ** 3).mean() / spread**3) if spread > 0 else 0.0
    return Distribution(mean, spread, skewness, peaks(values, SPAN[kind], params))


def peaks(values: Numbers, span: tuple[float, float], params: StabilityParams) -> int:
    """Return the number of peaks of the histogram of values (m,): it falls by the prominence on both sides of each."""
    shares = np.histogram(values, params.bins, span)[0] / len(values)
    return int((prominences(shares) >= params.prominence).sum())


def prominences(heights: Numbers) -> Numbers:
    """Return how far one has to go down from each peak before it goes up beyond it, or to the end, at zero.

    As scipy.signal has it, which takes a second to be imported; a plateau is one peak.
    """
    rim = np.concatenate([[0.0], heights, [0.0]])
    level = rim[np.concatenate([[True], np.diff(rim) != 0])]
    rising = np.diff(level) > 0
    found = []
    for peak in np.flatnonzero(rising[:-1] & ~rising[1:]) + 1:
        higher = np.flatnonzero(level > level[peak])
        before, after = higher[higher < peak], higher[higher > peak]
        left, right = before.max(initial=-1) + 1, after.min(initial=len(level))
        found.append(level[peak] - max(level[left:peak].min(), level[peak + 1 : right].min()))
    return np.array(found)
