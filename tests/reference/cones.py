"""Round cones, plainly: every point against every edge."""

import numpy as np

from tiskel.arrays import Edges, Numbers, Points, Table

ROUNDS = 120  # of ternary search, each leaves two thirds


def cone_residuals(
    points: Points, nodes: Points, radii: Numbers, edges: Edges
) -> tuple[Table, Table]:  # fmt: skip
    """Return (p, e) the share along each edge of a point's foot, and its signed distance to the cone's surface.

    A round cone is the union of the balls along its axis, so the distance is the
    least of those to the balls: a convex function of the share, whose least value
    ternary search finds.
    """
    share, distance = np.zeros((2, len(points), len(edges)))
    for j, (first, last) in enumerate(edges):

        def to_ball(s: Numbers, a: int = first, b: int = last) -> Numbers:
            centres = nodes[a] + s[:, None] * (nodes[b] - nodes[a])
            return np.asarray(np.linalg.norm(points - centres, axis=1) - (1 - s) * radii[a] - s * radii[b])

        low, high = np.zeros(len(points)), np.ones(len(points))
        for _ in range(ROUNDS):
            one, other = low + (high - low) / 3, high - (high - low) / 3
            left = to_ball(one) <= to_ball(other)
            low, high = np.where(left, low, one), np.where(left, other, high)
        candidates = np.stack([np.zeros(len(points)), low, np.ones(len(points))])
        values = np.stack([to_ball(s) for s in candidates])
        best = values.argmin(axis=0)
        share[:, j] = candidates[best, np.arange(len(points))]
        distance[:, j] = values[best, np.arange(len(points))]
    return share, distance
