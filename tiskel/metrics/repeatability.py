"""Two curves of one body: is it the same graph, and how far are they apart?

The same body sampled twice, scanned in two poses, or skeletonised by two methods
should have one curve. Counts need nothing in common; distances and tips take the
two to be in one frame, so turn poses into each other first.
"""

from dataclasses import asdict, dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import maximum_bipartite_matching
from scipy.spatial.distance import cdist

from tiskel.arrays import Numbers, diagonal
from tiskel.geometry.feet import between, feet_on, parts_of
from tiskel.geometry.graph import CurveGraph

NEAR = 0.01  # of the diagonal: tips no farther apart are one, and where they are thicker, within a radius
PARTS = 0.001  # of the diagonal: how long the parts are that distances are taken from
TAIL = 0.95  # share of the length that is no farther apart than is said


@dataclass(frozen=True)
class Repeatability:
    """How alike two curves of one body are.

    Attributes
    ----------
    components : int
        Components of the second minus those of the first.
    loops : int
        Loops, likewise.
    ends : int
        Ends, likewise.
    joints : int
        Joints, likewise.
    tips : int
        Ends of the two that belong together, one to one: within 1 % of the diagonal, or a radius of one of them.
    tips_share : float or None
        These over the ends of the one that has more; None where neither has any.
    radii_95 : float or None
        Distance in local radii, the mean of both curves' there, that 95 % of the length is within: from the first to
        the second or back, whichever is larger. None where one has no length or no radii.
    diagonals_95 : float or None
        The same in diagonals of both together; None where one has no length.
    """

    components: int
    loops: int
    ends: int
    joints: int
    tips: int
    tips_share: float | None
    radii_95: float | None
    diagonals_95: float | None

    @property
    def same_graph(self) -> bool:
        """Whether components, loops, ends and joints are as many."""
        return self.components == self.loops == self.ends == self.joints == 0

    def as_dict(self) -> dict[str, float | bool | None]:
        """Return plain JSON values."""
        return {"same_graph": self.same_graph, **asdict(self)}


def repeatability(a: CurveGraph, b: CurveGraph) -> Repeatability:
    """Compare two curves of one body.

    Parameters
    ----------
    a : CurveGraph
        One curve.
    b : CurveGraph
        Another, in the same frame and unit.

    Returns
    -------
    Repeatability
        The same for b and a, but for the signs of the differences.

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.metrics.repeatability import repeatability
    >>> alike = repeatability(shape_graph("y"), shape_graph("y"))
    >>> alike.same_graph, alike.tips_share, round(alike.radii_95, 6)
    (True, 1.0, 0.0)
    """
    return alike(a, b, ways_between(a, b))


@dataclass(frozen=True, eq=False)
class Way:
    """How far the parts of one curve are from another.

    Attributes
    ----------
    in_radii : (p,) float64
        In local radii, the mean of both curves' there; NaN where none is known.
    distances : (p,) float64
        In their unit.
    lengths : (p,) float64
        Of the parts.
    """

    in_radii: Numbers
    distances: Numbers
    lengths: Numbers


def ways_between(a: CurveGraph, b: CurveGraph) -> tuple[Way, ...]:
    """Return the way from the first to the second and that back; none where one of them has no length."""
    step = PARTS * _side(a, b)
    return tuple(_way(*pair, step) for pair in ((a, b), (b, a))) if a.length > 0 and b.length > 0 else ()


def _side(a: CurveGraph, b: CurveGraph) -> float:
    return diagonal(np.concatenate([a.nodes, b.nodes])) if len(a.nodes) + len(b.nodes) else 0.0


def alike(a: CurveGraph, b: CurveGraph, ways: tuple[Way, ...]) -> Repeatability:
    """Return how alike two curves are that are so far apart."""
    side = _side(a, b)
    tips, most = _tips(a, b, NEAR * side), max(a.ends, b.ends)
    in_radii = [far for way in ways if (far := tail(way.in_radii, way.lengths)) is not None]
    in_units = [far for way in ways if (far := tail(way.distances, way.lengths)) is not None]
    return Repeatability(
        components=b.components - a.components,
        loops=b.loops - a.loops,
        ends=b.ends - a.ends,
        joints=b.junctions - a.junctions,
        tips=tips,
        tips_share=tips / most if most else None,
        radii_95=max(in_radii, default=None),
        diagonals_95=max(in_units) / side if in_units else None,
    )


def _tips(a: CurveGraph, b: CurveGraph, tolerance: float) -> int:
    """Return how many pairs of ends of the two can be made at once."""
    rows, columns = np.flatnonzero(a.degrees == 1), np.flatnonzero(b.degrees == 1)
    if len(rows) == 0 or len(columns) == 0:
        return 0
    reach = [np.maximum(tolerance, np.nan_to_num(c.radii[ends])) for c, ends in ((a, rows), (b, columns))]
    near = cdist(a.nodes[rows], b.nodes[columns]) <= np.maximum.outer(*reach)
    return int((maximum_bipartite_matching(sparse.csr_array(near), perm_type="column") >= 0).sum())


def _way(a: CurveGraph, b: CurveGraph, step: float) -> Way:
    parts = parts_of(a, step)
    feet = feet_on(b, parts.points, step)
    radii = between(a.radii, a, parts.edges, parts.shares), between(b.radii, b, feet.edges, feet.shares)
    mean = (radii[0] + radii[1]) / 2
    ratio = np.divide(feet.distances, mean, out=np.full(len(mean), np.nan), where=mean > 0)
    return Way(ratio, feet.distances, parts.lengths)


def tail(values: Numbers, lengths: Numbers, share: float = TAIL) -> float | None:
    """Return what a share of the length that has a value is within; None where none has."""
    known = ~np.isnan(values)
    if not known.any():
        return None
    values, lengths = values[known], lengths[known]
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(lengths[order])
    return float(values[order][np.searchsorted(reached, share * reached[-1])])
