"""Round cones, plainly: every point against every edge."""

import numpy as np

from tiskel.arrays import Indices, Numbers, Points


def cone_residuals(
    points: Points, nodes: Points, radii: Numbers, edges: Indices
) -> tuple[Numbers, Numbers]:  # fmt: skip
    """Return (p, e) the share along each edge where a point's foot is, and the distance to the surface there."""
    share, distance = np.zeros((2, len(points), len(edges)))
    for j, (first, last) in enumerate(edges):
        along = nodes[last] - nodes[first]
        square = along @ along
        for i, point in enumerate(points):
            s = min(max((point - nodes[first]) @ along / square, 0.0), 1.0) if square > 0 else 0.0
            foot = nodes[first] + s * along
            share[i, j] = s
            distance[i, j] = np.linalg.norm(point - foot) - (1 - s) * radii[first] - s * radii[last]
    return share, distance
