"""Which points of a cloud its loops are taken from: so many that their Delaunay graph can be had.

On a surface a point has some twelve neighbours in the Delaunay graph, however many points there are. On a curve every
two of them may be neighbours: 2000 points have a million edges, and ripser takes minutes and gigabytes over them. A
cloud with wires in it is thinned evenly, until there are few edges.
"""

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Mask, Points
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.metrics.barcode import delaunay_edges
from tiskel.params import MetricParams

Rows = npt.NDArray[np.intp]

NEIGHBOURS = 9  # a point's own included, whose axes say whether it is on a wire
# Second axis over the first, below which a point is on a wire. With noise of a tenth of the spacing it is 0.045 and a
# point has 11 neighbours; of a hundredth 0.022 and 32; without noise 0.022 and as many as a quarter of all points.
THIN = 0.03
FEW = 512  # points on wires that need no thinning, and with which it begins
SIZES = (FEW, 2 * FEW, 4 * FEW, 8 * FEW)  # of the even subsets that are tried, before all points are
EDGES, EACH = 1 << 16, 16  # that a graph may have in all, or for each point; the first takes ripser a second


def loop_rows(cloud: Points, params: MetricParams) -> Rows:
    """Return the rows of a cloud that its loops are taken from.

    Parameters
    ----------
    cloud : (n, 3) float64
        Distinct points, in any unit.
    params : MetricParams
        ``loop_points`` is how many there are at most; the ``seed`` chooses them.

    Returns
    -------
    (k,) int
        Ascending: all, a random subset of a large cloud, or even points where there are wires.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import MetricParams
    >>> from tiskel.metrics.loop_points import loop_rows
    >>> turn = np.linspace(0, 20, 3000)
    >>> wire = np.stack([np.cos(turn), np.sin(turn), turn / 5], axis=1)
    >>> len(loop_rows(wire[:500], MetricParams())), len(loop_rows(wire, MetricParams()))
    (500, 512)
    """
    rows = np.arange(len(cloud))
    if len(cloud) > params.loop_points:
        rows = np.sort(np.random.default_rng(params.seed).choice(len(cloud), params.loop_points, replace=False))
    points = np.ascontiguousarray(cloud[rows])
    if len(points) <= FEW or int(on_wires(points).sum()) <= FEW:
        return rows
    return rows[_few_edges(points)]


def on_wires(points: Points) -> Mask:
    """Return (n,) which of points (n, 3) lie in line with their neighbours."""
    near = nearest_neighbours(points, min(NEIGHBOURS, len(points)))[0]
    values = principal_axes(points, near)[0]
    return np.asarray(values[:, 1] < THIN**2 * values[:, 0])


def _few_edges(points: Points) -> Rows:
    """Return as many even points as have few edges, twice as many each time; all where they have."""
    sizes = [size for size in SIZES if size < len(points)]
    order = _evenly(points, sizes[-1])
    found = np.sort(order[: sizes[0]])
    for size in [*sizes[1:], len(points)]:
        rows = np.sort(order[:size]) if size < len(points) else np.arange(len(points))
        if len(delaunay_edges(np.ascontiguousarray(points[rows]))) > max(EDGES, EACH * size):
            break
        found = rows
    return found


def _evenly(points: Points, count: int) -> Rows:
    """Return so many rows, each time that of the point farthest from those before (Gonzalez 1985)."""
    rows, away = np.zeros(count, np.intp), np.full(len(points), np.inf)
    for k in range(1, count):
        d = points - points[rows[k - 1]]
        away = np.minimum(away, d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1] + d[:, 2] * d[:, 2])
        rows[k] = away.argmax()
    return rows
