"""Tips and joints of two curves, matched one to one.

The largest number of pairs that can be made at once counts; which of several
such sets of pairs makes no difference to it, nor does the order of the nodes.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import maximum_bipartite_matching
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry.graph import CurveGraph


@dataclass(frozen=True)
class Matched:
    """Tips or joints, found and true, matched one to one."""

    true: int  #: those asked for
    found: int  #: those found, without the ones that a stub accounts for
    matched: int  #: pairs of the two

    @property
    def recall(self) -> float | None:
        """The share of the true ones that were found; None where there is none."""
        return self.matched / self.true if self.true else None

    @property
    def precision(self) -> float | None:
        """The share of the found ones that are true; None where none was found."""
        return self.matched / self.found if self.found else None


def matched_tips(found: CurveGraph, truth: CurveGraph, tolerance: float, margin: float = 0.0) -> Matched:
    """Match the ends of a found curve to those of the true one.

    Parameters
    ----------
    found : CurveGraph
        The found curve.
    truth : CurveGraph
        The true one, with radii, in the same unit.
    tolerance : float
        How far a pair may be apart, in that unit, where the local radius of the truth is not larger. Branches of the
        truth that end within that distance of their joint are stubs, neither asked for nor counted against.
    margin : float
        By how much more a branch has to stand out of its joint to be no stub, in that unit.

    Returns
    -------
    Matched

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.metrics.matching import matched_tips
    >>> matched_tips(shape_graph("y"), shape_graph("y"), 0.01)
    Matched(true=3, found=3, matched=3)
    """
    stubs = stub_ends(truth, tolerance, margin)
    every = np.flatnonzero(truth.degrees == 1).astype(np.int32)
    return _matched(found.nodes[found.degrees == 1], truth, np.setdiff1d(every, stubs), every, tolerance)


def matched_joints(found: CurveGraph, truth: CurveGraph, tolerance: float, margin: float = 0.0) -> Matched:
    """Match the joints of a found curve to those of the true one, a joint of d branches counting d - 2 times.

    Parameters and result are those of :func:`matched_tips`; joints that only stubs make are neither asked for nor
    counted against.

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.metrics.matching import matched_joints
    >>> matched_joints(shape_graph("y"), shape_graph("y"), 0.01)
    Matched(true=1, found=1, matched=1)
    """
    stubs = stub_ends(truth, tolerance, margin)
    left = truth.degrees.copy()
    for end in stubs:
        left[_way_to_joint(truth, int(end))[-1]] -= 1
    places = found.nodes[np.repeat(np.arange(len(found.nodes)), np.maximum(found.degrees - 2, 0))]
    real, every = (np.repeat(np.arange(len(left), dtype=np.int32), np.maximum(d - 2, 0)) for d in (left, truth.degrees))
    return _matched(places, truth, real, every, tolerance)


def _matched(places: Points, truth: CurveGraph, real: Indices, every: Indices, tolerance: float) -> Matched:
    """Match places (p, 3) to nodes of the truth; those that only the nodes that are not real account for are ignored.

    A largest matching with the real nodes can be extended to one with all of them
    that covers the same places and more; the more are those that are ignored.
    """
    pairs = [_largest(places, truth.nodes[rows], _reach(truth, rows, tolerance)) for rows in (real, every)]
    return Matched(len(real), len(places) - (pairs[1] - pairs[0]), pairs[0])


def _reach(truth: CurveGraph, rows: Indices, tolerance: float) -> Numbers:
    return np.maximum(tolerance, np.nan_to_num(truth.radii[rows]))


def _largest(places: Points, targets: Points, reach: Numbers) -> int:
    """Return how many pairs of a place and a target (t, 3) within its reach (t,) can be made at once."""
    if len(places) == 0 or len(targets) == 0:
        return 0
    near = cKDTree(places).query_ball_point(targets, reach * (1 + 1e-9), return_sorted=True)  # rounding aside
    starts = np.concatenate([[0], np.cumsum([len(rows) for rows in near])])
    columns = np.concatenate([np.asarray(rows, np.int32) for rows in near])
    graph = sparse.csr_array((np.ones(len(columns)), columns, starts), shape=(len(targets), len(places)))
    return int((maximum_bipartite_matching(graph, perm_type="column") >= 0).sum())


def stub_ends(curve: CurveGraph, tolerance: float, margin: float = 0.0) -> Indices:
    """Return the ends of a curve's stubs, ascending.

    A stub is a way from an end to a joint that is no longer than the tolerance or
    the radius at the joint, and the margin. At a joint the shortest goes first; a joint that is
    left with two branches is none any more.

    Parameters
    ----------
    curve : CurveGraph
        With radii; NaN counts as 0.
    tolerance : float
        In the unit of the curve.
    margin : float
        In that unit, too.

    Returns
    -------
    (s,) int32
        Nodes.
    """
    ways = [_way_to_joint(curve, int(end)) for end in np.flatnonzero(curve.degrees == 1)]
    left, found = curve.degrees.copy(), []
    reach = _reach(curve, np.arange(len(curve.nodes), dtype=np.int32), tolerance)
    steps = [(float(np.linalg.norm(np.diff(curve.nodes[way], axis=0), axis=1).sum()), way) for way in ways]
    for length, way in sorted(steps, key=lambda step: (step[0], *curve.nodes[step[1][0]])):
        joint = way[-1]
        if left[joint] > 2 and length <= reach[joint] + margin:
            left[joint] -= 1
            found.append(way[0])
    return np.sort(np.array(found, np.int32))


def _way_to_joint(curve: CurveGraph, end: int) -> list[int]:
    """Return the nodes from an end to the first node that has more or fewer neighbours than two."""
    way, before = [end], -1
    while len(way) == 1 or len(curve.neighbours[way[-1]]) == 2:
        following = next(other for other in curve.neighbours[way[-1]] if other != before)
        before = way[-1]
        way.append(following)
    return way
