"""Nodes of the curve: a front of sampling balls over the contracted cloud, as published."""

import heapq

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Numbers, Points

UNCLAIMED = -1


def front_samples(points: Points, radius: float) -> tuple[Indices, Indices]:
    """Sample a contracted cloud by a front of balls.

    Of the points already claimed, the one farthest from its sample looks into
    the ball around it. Where the ball holds an unclaimed point it becomes a
    sample and claims the points of its ball that are nearer to it than to their
    present sample. A new front starts at the next unclaimed point when the old
    one is exhausted (Cao et al. 2010, section 4, as in the toolbox).

    Parameters
    ----------
    points : (n, 3) float64
        The contracted cloud, in any unit.
    radius : float
        Of the balls, in the same unit.

    Returns
    -------
    samples : (v,) int32
        Rows of points, in the order they were taken.
    owner : (n,) int32
        For each point the sample that owns it.
    """
    tree = cKDTree(points)
    unclaimed = _Unclaimed(points, tree, radius)
    owner = unclaimed.owner
    distance = np.full(len(points), np.inf)
    settled = np.zeros(len(points), bool)
    samples: list[int] = []
    for start in range(len(points)):
        front = [(-np.inf, start)] if owner[start] == UNCLAIMED else []
        while front:
            priority, at = heapq.heappop(front)
            if settled[at] or (owner[at] != UNCLAIMED and -priority != distance[at]):
                continue
            settled[at] = True
            ball = np.empty(0, np.int32)
            if unclaimed.may_be_near(at):
                ball = np.array(sorted(tree.query_ball_point(points[at], radius)), dtype=np.int32)
            if (owner[ball] == UNCLAIMED).any():
                for row in _claim(points, ball, at, len(samples), owner, distance):
                    heapq.heappush(front, (-distance[row], int(row)))
                samples.append(at)
            else:
                distance[at] = 0.0  # looked around in vain: no later sample takes it over
    return np.array(samples, np.int32), owner


class _Unclaimed:
    """Tell cheaply that no unclaimed point is near, which is so for most points that look around.

    The tree holds the points that were unclaimed when it was built; it is built
    anew each time half of them have been claimed.
    """

    def __init__(self, points: Points, tree: cKDTree, radius: float) -> None:
        self.points, self.reach = points, radius * (1 + 1e-9)  # the query's bound is exclusive, the ball's is not
        self.owner = np.full(len(points), UNCLAIMED, np.int32)
        self.rows = np.arange(len(points))
        self.tree = tree
        self.looks = 0

    def may_be_near(self, at: int) -> bool:
        """Tell whether an unclaimed point may be in the ball about a point; never no where one is."""
        self.looks += 1
        if self.looks > len(self.rows) // 8:
            self._forget_claimed()
        return bool(np.isfinite(self.tree.query(self.points[at], distance_upper_bound=self.reach)[0]))

    def _forget_claimed(self) -> None:
        self.looks, left = 0, self.rows[self.owner[self.rows] == UNCLAIMED]
        if 2 * len(left) <= len(self.rows):
            self.rows, self.tree = left, cKDTree(self.points[left])


def _claim(points: Points, ball: Indices, at: int, sample: int, owner: Indices, distance: Numbers) -> Indices:
    """Give the points of a ball to a new sample where it is nearer than their present one; return them."""
    to_sample = np.linalg.norm(points[ball] - points[at], axis=1)
    nearer = to_sample < distance[ball]
    won = ball[nearer]
    owner[won], distance[won] = sample, to_sample[nearer]
    return np.asarray(won[won != at])
