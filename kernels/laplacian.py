"""Ring sizes and cotangent weights."""

from .engine import ti
from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Weights = ti.types.ndarray(dtype=ti.f64, ndim=2)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)


@ti.func
def cotangent(u, v) -> ti.f64:
    """Return the cotangent of the angle between u and v; a degenerate triangle contributes nothing."""
    area = u.cross(v).norm()
    result = 0.0
    if area > 0.0:
        result = u.dot(v) / area
    return result


@ti.kernel
def _smallest_distances(points: Points, rings: Table, counts: Indices, out: Numbers):
    """S_i, the smallest distance from a point to its ring; an empty ring has size 0."""
    for i in points:
        smallest = ti.math.inf
        for s in range(counts[i]):
            smallest = ti.min(smallest, (points[rings[i, s]] - points[i]).norm())
        if counts[i] == 0:
            smallest = 0.0
        out[i] = smallest


@ti.kernel
def _mean_distances(points: Points, rings: Table, counts: Indices, first_again: Indices, out: Numbers):
    """Mean distance from a point to its ring, added in ring order; the first member counts twice where asked."""
    for i in points:
        total = 0.0
        for s in range(counts[i]):
            total += (points[rings[i, s]] - points[i]).norm()
        count = counts[i]
        if count > 0 and first_again[i] == 1:
            total += (points[rings[i, 0]] - points[i]).norm()
            count += 1
        out[i] = total / ti.max(count, 1)


@ti.kernel
def _cotangent_weights(
    points: Points,  # (n,)
    rings: Table,  # (n, w)
    counts: Indices,  # (n,)
    closed: Indices,  # (n,)
    cap: ti.f64,  # of the absolute sum of a row
    # outputs
    weights: Weights,  # (n, w), beside the rings
    diagonal: Numbers,  # (n,), minus the sum of each row, added in ring order
):
    """w_ij = cot a_ij + cot b_ij, the angles opposite edge (i, j) in the triangles of the ring of i."""
    for i in points:
        count = counts[i]
        for s in range(rings.shape[1]):
            weights[i, s] = 0.0
        total = 0.0
        for s in range(count - 1 + closed[i]):
            following = (s + 1) % count
            p, a, b = points[i], points[rings[i, s]], points[rings[i, following]]
            weights[i, s] += cotangent(p - b, a - b)
            weights[i, following] += cotangent(p - a, b - a)
        for s in range(count):
            total += weights[i, s]
        if ti.abs(total) > cap:
            for s in range(count):
                weights[i, s] *= cap / ti.abs(total)
        diagonal[i] = 0.0
        for s in range(count):
            diagonal[i] -= weights[i, s]


smallest_distances = started(_smallest_distances)
mean_distances = started(_mean_distances)
cotangent_weights = started(_cotangent_weights)
