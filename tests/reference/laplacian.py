"""Ring sizes and the cotangent Laplacian, one triangle at a time.

Written in scalars, in the order of the textbook formula: the systems built from
these numbers amplify the last bit by ten orders of magnitude, so a comparison
of whole contractions needs every rounding to be the same.
"""

import math

import numpy as np
from scipy import sparse

from reference.rings import Ring


def _minus(a: np.ndarray, b: np.ndarray) -> tuple[float, float, float]:
    return float(a[0]) - float(b[0]), float(a[1]) - float(b[1]), float(a[2]) - float(b[2])


def _dot(u: tuple[float, float, float], v: tuple[float, float, float]) -> float:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cotangent(u: tuple[float, float, float], v: tuple[float, float, float]) -> float:
    across = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    area = math.sqrt(_dot(across, across))
    return _dot(u, v) / area if area > 0 else 0.0


def distance(a: np.ndarray, b: np.ndarray) -> float:
    difference = _minus(a, b)
    return math.sqrt(_dot(difference, difference))


def sizes(points: np.ndarray, rings: list[Ring]) -> np.ndarray:
    """Return the smallest distance from each point to its ring, 0 for an empty ring."""
    return np.array([min((distance(points[j], points[i]) for j in r), default=0.0) for i, (r, _) in enumerate(rings)])


def mean_length(points: np.ndarray, rings: list[Ring]) -> float:
    """Return the mean over the points of the mean distance to their ring."""
    means = [sum(distance(points[j], points[i]) for j in r) / max(len(r), 1) for i, (r, _) in enumerate(rings)]
    return float(np.mean(means))


def weights(points: np.ndarray, rings: list[Ring], cap: float = 1e4) -> list[list[float]]:
    """Return w_ij beside the members of every ring (CONTRACTION, section 2)."""
    out = []
    for i, (ring, closed) in enumerate(rings):
        row = [0.0] * len(ring)
        for s in range(len(ring) - 1 + closed):
            t = (s + 1) % len(ring)
            p, a, b = points[i], points[ring[s]], points[ring[t]]
            row[s] += cotangent(_minus(p, b), _minus(a, b))
            row[t] += cotangent(_minus(p, a), _minus(b, a))
        total = 0.0
        for w in row:
            total += w
        out.append([w * (cap / abs(total)) for w in row] if abs(total) > cap else row)
    return out


def cotangent_laplacian(points: np.ndarray, rings: list[Ring], cap: float = 1e4) -> sparse.csr_array:
    """Return L with L_ij = w_ij and L_ii = -sum_j w_ij."""
    n = len(points)
    rows, columns, values = [], [], []
    for i, ((ring, _), row) in enumerate(zip(rings, weights(points, rings, cap), strict=True)):
        rows += [i] * len(ring) + [i]
        columns += [*ring, i]
        diagonal = 0.0
        for w in row:
            diagonal -= w
        values += [*row, diagonal]
    return sparse.csr_array(sparse.coo_array((values, (rows, columns)), shape=(n, n)))
