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
    components : int
        Components found minus true ones.
    loops : int
        Loops found minus true ones.
    true_ends : int
        Number of true ends.
    ends : int
        True ends that have a found end of their own within one local radius.
    spurious_ends : int
        Found ends that belong to no true end.
    to_truth : float or None
        Mean distance from the found curve to the true one; None where nothing was found.
    to_truth_95 : float or None
        95th percentile of the same.
    from_truth : float or None
        Mean distance from the true curve to the found one; None where nothing was found.
    from_truth_95 : float or None
        95th percentile of the same.
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
        """Whether components and loops are as many as they should be."""
        return self.components == 0 and self.loops == 0

    def as_dict(self) -> dict[str, float | None]:
        """Return the fields as plain JSON values."""
        return asdict(self)


def agreement(curve: CurveGraph, truth: ConeGraph) -> Agreement:
    """Compare a found curve with the graph of a shape.

    Parameters
    ----------
    curve : CurveGraph
        The found curve, in the units of the shape.
    truth : ConeGraph
        The shape, whose graph is the true curve.

    Returns
    -------
    Agreement

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.metrics.truth import agreement
    >>> shape = shape_graph("y")
    >>> found = agreement(shape, shape)
    >>> found.topology_right, found.ends, found.spurious_ends
    (True, 3, 0)
    """
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
    """Match found ends to true ones, one to one, within one local radius.

    Parameters
    ----------
    curve : CurveGraph
        The found curve, in the units of the shape.
    truth : ConeGraph
        The shape.

    Returns
    -------
    matched : int
        True ends that have a found end of their own.
    true : int
        Number of true ends.
    found : int
        Number of found ends.
    """
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
