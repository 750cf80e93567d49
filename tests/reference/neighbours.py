"""k nearest neighbours by SciPy's tree, with ties broken by index."""

import numpy as np
from scipy.spatial import cKDTree


def nearest(points: np.ndarray, k: int) -> np.ndarray:
    """Return (n, k) rows by squared distance, then index; every point tied with the k-th is considered."""
    tree = cKDTree(points)
    reach = tree.query(points, k=[k])[0][:, 0]
    out = np.empty((len(points), k), np.int32)
    for i, p in enumerate(points):
        # A little further than the k-th, so that rounding inside the tree cannot hide a tie.
        candidates = np.array(tree.query_ball_point(p, reach[i] * (1 + 1e-9) + 1e-300))
        d = points[candidates] - p
        squares = d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1] + d[:, 2] * d[:, 2]
        out[i] = candidates[np.lexsort([candidates, squares])][:k]
    return out
