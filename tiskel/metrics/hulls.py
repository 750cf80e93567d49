"""Convex hulls of the directions in which places see a cloud, and the hull of the cloud itself.

The area of a hull of directions is taken step by step, until it is known on which side of the threshold it is: of the
vector that is seen first in each cell of the cube map, whose hull can only be too small; of the vectors that stick out
of that by more than a slack, the first in each square of a fine grid; of all of these; of all. In cells that are
filled all round one vector does in any case, since the rest of them lie under the same faces, to 0.005.

All vectors within the slack s of a hull add no more than 2 s + s^2 to its share of the sphere: it is not larger than
the hull's parallel body, whose area grows by no more than that of a ball (Steiner).
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from tiskel.arrays import Lists, Mask, Numbers, Points, diagonal
from tiskel.geometry.frames import unit
from tiskel.geometry.neighbours import MortonCurve

BOUNDED = 0.75  # beta of a point on a flat, endless surface
TOUCHING = 0.36  # radians between the centres of touching cells; the largest is 0.25 wide
TOLERANCE = 1e-9  # of the diagonal, on which side of the convex hull a place is
# Slack, whether only the first in each square counts, and below the threshold the share that may be missing then: of
# caps, sheets and plants half a square's width along the rim is 0.005 at most.
STEPS = ((0.004, True, 0.02), (0.0005, False, 0.0011), (0.0, False, 0.0))
ROOM = 4096  # corners of a hull: of those that stick out by the slack a tenth of that
MOST_ROOM = 1 << 15  # corners of a hull of all vectors; where they are more, the step before decides
MEMORY = 500_000  # corners of hulls at a time, 80 bytes each


@dataclass(frozen=True, eq=False)
class View:
    """A cloud laid out for being looked at.

    Attributes
    ----------
    curve : MortonCurve
        Its points (n, 3), in any unit, along the Morton curve.
    spacing : (n,) float64
        Radius of the disc that each of these points stands for.
    """

    curve: MortonCurve
    spacing: Numbers

    @property
    def points(self) -> Points:
        """The points (n, 3) along the curve."""
        return self.curve.points

    @cached_property
    def boxes(self) -> tuple[Points, Points]:
        """The corners of the boxes of blocks of points, discs included, then of large blocks: (b, 3) each."""
        from tiskel.kernels import coverage as kernel

        reach = kernel.DISC * self.spacing[:, None]
        starts = [np.arange(0, len(self.points), size) for size in (kernel.BLOCK, kernel.LARGE)]
        low, high = (
            np.concatenate([extreme.reduceat(ends, first) for first in starts])
            for extreme, ends in ((np.minimum, self.points - reach), (np.maximum, self.points + reach))
        )
        return low, high


def outside_hull(places: Points, cloud: Points) -> Mask:
    """Return (m,) which places (m, 3) lie outside the convex hull of a cloud (n, 3)."""
    try:
        faces = ConvexHull(cloud).equations
    except QhullError:  # a flat cloud: its hull has no inside, and nothing is settled
        return np.zeros(len(places), bool)
    margin = TOLERANCE * diagonal(cloud)
    blocks = np.array_split(places, max(1, len(places) * len(faces) // 4_000_000))
    return np.concatenate([(block @ faces[:, :3].T + faces[:, 3] > margin).any(axis=1) for block in blocks])


def hull_shares(places: Points, seen: Lists, view: View) -> Numbers:
    """Return the areas of the hulls of the directions in which places see a cloud.

    Parameters
    ----------
    places : (m, 3) float64
        In the unit of the cloud.
    seen : (m, cells) int32
        Row of the point of the view that is seen first in each cell of the cube map, -1 where there is none.
    view : View
        The cloud.

    Returns
    -------
    (m,) float64
        Shares of the sphere, never too large: exact to 0.01 below 0.75, and on the right side of that.
    """
    shares, doubtful = np.zeros(len(places)), np.arange(len(places))
    for slack, thin, missing in STEPS:
        room = ROOM if slack > 0 else min(len(view.points) + seen.shape[1], MOST_ROOM)
        for rows in np.array_split(doubtful, -(-len(doubtful) * room // MEMORY) or 1):
            shares[rows] = np.maximum(shares[rows], _areas(places[rows], seen[rows], view, slack, thin, room))
        doubtful = doubtful[(shares[doubtful] < BOUNDED) & (shares[doubtful] >= BOUNDED - missing)]
    return shares


def _areas(places: Points, seen: Lists, view: View, slack: float, thin: bool, room: int) -> Numbers:
    """Return the shares of the sphere; of the vectors that are seen first where these do, of flat ones both sides."""
    from tiskel.kernels.surrounded import SQUARES, surrounded

    corners = len(places) * room
    areas, taken = np.empty(len(places)), np.empty((len(places), SQUARES), np.uint64)
    faces, beside, stack = (np.empty((2 * corners, *shape), np.int32) for shape in ((3,), (3,), ()))
    inner = _filled_all_round(places, seen, view.points)
    surrounded(
        np.ascontiguousarray(places), seen, inner, view.points, *view.boxes, 4 * np.pi * BOUNDED, slack, int(thin),
        room, taken, np.empty((corners, 3)), faces, beside, stack, areas,
    )  # fmt: skip
    for row in np.flatnonzero(areas < 0):
        d = view.points - places[row]
        areas[row] = hull_area(unit(d[d.any(axis=1)]))
    return areas / (4 * np.pi)


def _filled_all_round(places: Points, seen: Lists, points: Points) -> Lists:
    """Return (m, cells) 1 for the cells that touch none without a direction in it; discs reach into such ones, too."""
    from tiskel.kernels import coverage as kernel

    directions = (points[np.maximum(seen, 0)] - places[:, None]).reshape(-1, 3)
    cells = np.empty(len(directions), np.int32)
    kernel.cells(np.zeros((1, 3)), directions, cells)
    filled = (seen >= 0) & (cells.reshape(seen.shape) == np.arange(seen.shape[1]))
    touching = touching_cells()
    inner = filled[:, touching[:, 0]]
    for column in touching.T[1:]:
        inner &= filled[:, column]
    return np.asarray(inner, np.int32)


@cache
def touching_cells() -> Lists:
    """Return (6 side^2, w) the cells that touch each cell of the cube map, itself among them and again as padding."""
    from tiskel.kernels.coverage import SIDE

    centres = cell_centres(SIDE)
    found = cKDTree(centres).query_ball_point(centres, 2 * np.sin(TOUCHING / 2), return_sorted=True)
    table = np.repeat(np.arange(len(centres), dtype=np.int32)[:, None], max(map(len, found)), axis=1)
    for row, others in zip(table, found, strict=True):
        row[: len(others)] = others
    return table


def cell_centres(side: int) -> Points:
    """Return (6 side^2, 3) unit vectors to the centres of the cells of the cube map, in the kernel's order."""
    middle = (np.arange(side) + 0.5) * 2 / side - 1
    v, u = np.meshgrid(middle, middle, indexing="ij")
    centres = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            face = np.empty((side * side, 3))
            face[:, axis], face[:, (axis + 1) % 3], face[:, (axis + 2) % 3] = sign, u.ravel(), v.ravel()
            centres.append(face)
    return unit(np.concatenate(centres))


def hull_area(vectors: Points) -> float:
    """Return the surface area of the convex hull of unit vectors (n, 3); of a flat one both sides count."""
    try:
        return float(ConvexHull(vectors).area)
    except (QhullError, ValueError):
        return _flat_area(vectors)


def _flat_area(vectors: Points) -> float:
    """Return twice the area of the polygon around vectors (n, 3) in a plane; 0 where they are on a line."""
    if len(vectors) < 3:
        return 0.0
    centred = vectors - vectors.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2][:2]
    try:
        return 2 * float(ConvexHull(centred @ axes.T).volume)
    except QhullError:
        return 0.0
