"""What can be seen of a true curve in a cloud: each branch ends where the last point witnesses it.

A point witnesses one place of the truth: the one whose ball it is nearest to,
|p - x| - r(x) being the least, if it is within two spacings of that ball. So the
points on a trunk witness the trunk, and not the twigs that begin inside it.

From every end the truth is cut back to the first witnessed place. What lies
between witnessed places stays, seen or not: a curve has to bridge it. Loops stay
whole, and pieces that nothing witnesses vanish.
"""

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import Mask, Numbers, Points
from tiskel.geometry.feet import between, parts_of
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.spacing import spacing_of

SLACK = 2.0  # spacings that a witness may be off the surface: noise up to a spacing, two standard deviations
STEP = 0.5  # spacings: how finely the truth is cut, so that no branch is known more closely
MOST = 50_000  # pieces of the truth: bounds the time; of denser clouds the ends are known less closely than that
CLASS = np.sqrt(2)  # ratio of radii within which the nearest place is that of the nearest ball


def observable(truth: CurveGraph, cloud: Points) -> CurveGraph:
    """Return the part of a true curve that a cloud shows.

    Parameters
    ----------
    truth : CurveGraph
        With radii, 0 where they are not known, in the unit of the cloud.
    cloud : (n, 3) float64
        The points.

    Returns
    -------
    CurveGraph
        Its edges are cut finely, half a spacing long at most; every end is a witnessed place.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import shape_graph, make_shape
    >>> from tiskel.metrics.observable import observable
    >>> shape = shape_graph("y")
    >>> seen = observable(shape, make_shape(shape)[0])
    >>> seen.ends, seen.loops, round(seen.length / shape.length, 1)
    (3, 0, 1.0)
    """
    spacing = spacing_of(cloud)
    fine = _cut_finely(truth, max(STEP * spacing, truth.length / MOST))
    return _without_dangling(fine, _witnessed(fine, cloud, SLACK * spacing))


def _cut_finely(truth: CurveGraph, longest: float) -> CurveGraph:
    """Return the same curve with nodes in the middle of all its parts; radii are interpolated."""
    parts = parts_of(truth, longest)
    count, first = len(truth.nodes), np.flatnonzero(np.diff(parts.edges, prepend=-1))
    new = count + np.arange(len(parts.edges))
    last = np.append(first[1:], len(new)) - 1
    own = parts.edges[first]
    starts, stops = (np.stack([truth.edges[own, side], new[at]], axis=1) for side, at in ((0, first), (1, last)))
    inner = np.delete(np.stack([new[:-1], new[1:]], axis=1), first[1:] - 1, axis=0) if len(new) else np.zeros((0, 2))
    known = np.nan_to_num(truth.radii)
    return CurveGraph(
        np.concatenate([truth.nodes, parts.points]),
        np.concatenate([starts, inner, stops]).astype(np.int32),
        np.concatenate([known, between(known, truth, parts.edges, parts.shares)]),
    )


def _witnessed(fine: CurveGraph, cloud: Points, slack: float) -> Mask:
    """Return which nodes a point witnesses: of each class of radii the nearest node, of these the nearest ball."""
    out, best = np.full(len(cloud), np.inf), np.zeros(len(cloud), np.int64)
    for rows in _classes(fine.radii):
        apart, near = cKDTree(fine.nodes[rows]).query(cloud)
        gap = apart - fine.radii[rows[near]]
        best = np.where(gap < out, rows[near], best)
        out = np.minimum(gap, out)
    seen = np.zeros(len(fine.nodes), np.bool_)
    seen[best[out <= slack]] = True
    return seen


def _classes(radii: Numbers) -> list[npt.NDArray[np.intp]]:
    """Return the rows of nodes about as thick as each other."""
    known = radii > 0
    kind = np.full(len(radii), -1, np.int64)
    if known.any():
        kind[known] = np.floor(np.log(radii[known] / radii[known].min()) / np.log(CLASS))
    return [np.flatnonzero(kind == number) for number in np.unique(kind)]


def _without_dangling(curve: CurveGraph, held: Mask) -> CurveGraph:
    """Return the curve without ends that are not held, and without nodes on their own."""
    left, keep = curve.degrees.copy(), np.ones(len(curve.nodes), np.bool_)
    ends = np.flatnonzero((left <= 1) & ~held).tolist()
    while ends:
        end = ends.pop()
        keep[end] = False
        for other in curve.neighbours[end]:
            left[other] -= 1
            if keep[other] and left[other] == 1 and not held[other]:
                ends.append(other)
    edges = curve.edges[keep[curve.edges].all(axis=1)]
    rows, links = np.unique(edges, return_inverse=True)
    return CurveGraph(curve.nodes[rows], links.reshape(-1, 2).astype(np.int32), curve.radii[rows])
