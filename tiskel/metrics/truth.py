"""A curve against the true one: components, loops, ends, and distances both ways."""

from dataclasses import asdict, dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers, Points
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.round_cones import ConeGraph

SAMPLES = 2000  # places on each curve
FAR = 1e9  # radii; stands for no partner


@dataclass(frozen=True)
class Agreement:
    """How a found curve agrees with the true one; distances in local radii.

    Attributes
    ----------
    components, loops : found minus true.
    ends : of the true ends, how many have a found end of their own within one local radius; true_ends : how many
        there are; spurious_ends : found ends that are nobody's.
    to_truth, to_truth_95 : mean and 95th percentile of the distance from the found curve to the true one.
    from_truth, from_truth_95 : the same the other way. None where nothing was found.
    """

    components: int
    loops: int
    true_ends: int
    ends: int
    spurious_ends: int
    to_truth: float | None
    to_truth_95: float | None
    from_truth: float | None
    from_truth_95: float | None

    @property
    def topology_right(self) -> bool:
        return self.components == 0 and self.loops == 0

    def as_dict(self) -> dict[str, float | None]:
        return asdict(self)


def agreement(curve: CurveGraph, truth: ConeGraph) -> Agreement:
    """Compare a found curve with the graph of a shape, in the shape's units."""
    matched, true_ends, found_ends = matched_ends(curve, truth)
    forth, back = _distances(curve, truth)
    return Agreement(
        components=curve.components - truth.components,
        loops=curve.loops - truth.loops,
        true_ends=true_ends,
        ends=matched,
        spurious_ends=found_ends - matched,
        to_truth=_mean(forth),
        to_truth_95=_tail(forth),
        from_truth=_mean(back),
        from_truth_95=_tail(back),
    )


def matched_ends(curve: CurveGraph, truth: ConeGraph) -> tuple[int, int, int]:
    """Return how many true ends have a found end of their own within one radius, and how many of either there are."""
    true, found = np.flatnonzero(truth.degrees == 1), np.flatnonzero(curve.degrees == 1)
    if len(true) == 0 or len(found) == 0:
        return 0, len(true), len(found)
    apart = np.linalg.norm(truth.nodes[true][:, None] - curve.nodes[found], axis=2) / truth.radii[true][:, None]
    cost = np.where(apart <= 1, apart, FAR)
    rows, columns = linear_sum_assignment(cost)
    return int((cost[rows, columns] <= 1).sum()), len(true), len(found)


def _distances(curve: CurveGraph, truth: ConeGraph) -> tuple[Numbers, Numbers]:
    """Return distances from places on the found curve to the true one, and back, in radii of the true one there."""
    if len(curve.nodes) == 0:
        return np.zeros(0), np.zeros(0)
    found = np.concatenate([curve.nodes, curve_samples(curve, SAMPLES).points])
    true, radii = true_places(truth)
    forth, nearest = cKDTree(true).query(found)
    back = cKDTree(found).query(true)[0]
    return forth / radii[nearest], back / radii


def true_places(truth: ConeGraph) -> tuple[Points, Numbers]:
    """Return places (p, 3) along the axes of a shape, and the radii (p,) there."""
    samples = curve_samples(truth, SAMPLES)
    first, last = truth.edges[samples.edges].T
    length = np.linalg.norm(truth.nodes[last] - truth.nodes[first], axis=1)
    share = np.linalg.norm(samples.points - truth.nodes[first], axis=1) / length
    between = truth.radii[first] * (1 - share) + truth.radii[last] * share
    return np.concatenate([truth.nodes, samples.points]), np.concatenate([truth.radii, between])


def _mean(values: Numbers) -> float | None:
    return float(values.mean()) if len(values) else None


def _tail(values: Numbers) -> float | None:
    return float(np.percentile(values, 95)) if len(values) else None
