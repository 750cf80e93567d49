"""Local point reduction: the stage function, the matching of points to merge, and the renaming of rings."""

from .engine import ti
from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)


@ti.kernel
def _stage_function(
    origin: Points,  # (n,) p_i(0)
    points: Points,  # (n,) p_i(k), just contracted
    delta: Points,  # (n,) Laplacian coordinates of the cloud before the solve
    rings: Table,  # (n, w)
    counts: Indices,  # (n,)
    first_sizes: Numbers,  # (n,) s_i(0)
    sizes: Numbers,  # (n,) s_i(k)
    shrinkage: ti.f64,  # psi' = epsilon psi
    contraction_weight: ti.f64,  # s_L^(k+2) w_l(0)
    attraction_weight: ti.f64,  # w_h(0)
    guard: ti.f64,  # stands in for eta s_i(0) where that is not positive
    out: Numbers,
):
    """The stage function F = V1 - V2 + 3 U of Wen et al. 2024 (GLSkeleton), which says where points may merge.

    V1 is what contraction still pulls at a point, V2 what attraction holds
    against it, and U how much its Laplacian coordinate differs from the mean
    of its ring.
    """
    for i in points:
        remainder = sizes[i] - shrinkage * first_sizes[i]
        if remainder <= 0.0:
            remainder = guard
        eta = remainder / first_sizes[i]
        v1 = contraction_weight**2 * (eta * delta[i]).norm_sqr()
        v2 = 0.0
        if first_sizes[i] != sizes[i]:
            ratio = shrinkage * first_sizes[i] / (first_sizes[i] - sizes[i])
            v2 = (attraction_weight / eta) ** 2 * (ratio * (points[i] - origin[i])).norm_sqr()
        mean = ti.Vector([0.0, 0.0, 0.0])
        for s in range(counts[i]):
            mean += delta[rings[i, s]]
        u = 0.0
        if counts[i] > 0:
            u = (delta[i] - mean / counts[i]).norm_sqr()
        out[i] = v1 - v2 + 3.0 * u


@ti.kernel
def _nearest_members(points: Points, rings: Table, counts: Indices, marked: Indices, out: Indices):
    """The nearest ring member of each marked point, the first among equals; -1 elsewhere."""
    for i in points:
        best, nearest = -1, ti.math.inf
        if marked[i] == 1:
            for s in range(counts[i]):
                square = (points[rings[i, s]] - points[i]).norm_sqr()
                if square < nearest:
                    best, nearest = rings[i, s], square
        out[i] = best


@ti.kernel
def _greedy_matching(partner: Indices, taken: Indices, merged_into: Indices):
    """Go through the pairs in order and accept those with both points free; in one thread, a few steps a point."""
    ti.loop_config(serialize=True)
    for i in partner:
        other = partner[i]
        free = other >= 0
        if free:
            free = taken[i] == 0 and taken[other] == 0
        if free:
            merged_into[other] = i
            taken[i] = 1
            taken[other] = 1


@ti.kernel
def _rename(rings: Table, counts: Indices, renamed: Indices, out: Table, out_counts: Indices):
    """Give every ring member its new name; a repeat or the point itself is dropped, the first is kept."""
    for i in counts:
        kept = 0
        for s in range(counts[i]):
            name = renamed[rings[i, s]]
            fresh = name != i
            for t in range(kept):
                fresh = fresh and out[i, t] != name
            if fresh:
                out[i, kept] = name
                kept += 1
        for s in range(kept, out.shape[1]):
            out[i, s] = -1
        out_counts[i] = kept


stage_function = started(_stage_function)
nearest_members = started(_nearest_members)
greedy_matching = started(_greedy_matching)
rename = started(_rename)
