"""Where points stand on a curve of round cones."""

import taichi as ti

from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)


@ti.func
def on_cone(point, start, end, first: ti.f64, last: ti.f64):
    """Return the share of the way along the axis where the foot is, and the signed distance to the surface.

    The cone is the union of the balls along its axis, so that the distance is the
    least of |p - c(s)| - r(s). That is convex in s; it is least where the slanted
    normal of the side through the point meets the axis, or at an end.
    """
    axis = end - start
    offset = point - start
    square = axis.norm_sqr()
    taper = first - last
    share = 0.0
    if square > taper * taper:
        length = ti.sqrt(square)
        along = offset.dot(axis) / length
        across = ti.sqrt(ti.max(offset.norm_sqr() - along * along, 0.0))
        foot = along - across * taper / ti.sqrt(square - taper * taper)
        share = ti.min(ti.max(foot / length, 0.0), 1.0)
    elif last > first:  # the ball at the end holds all others
        share = 1.0
    return share, (offset - share * axis).norm() - (1.0 - share) * first - share * last


@ti.kernel
def _cone_feet(
    points: Points,  # (n,)
    rows: Indices,  # (p,) points to place
    lists: Indices,  # (p,) which list of edges each of them may stand on
    candidates: Table,  # (l, w) these lists, ascending, padded with -1
    nodes: Points,  # (v,)
    radii: Numbers,  # (v,)
    edges: Table,  # (e, 2)
    signed: ti.i32,  # whether the least distance counts, or the least in size
    # outputs
    edge: Indices,  # (p,) the edge that counts, -1 where the list is empty
    share: Numbers,  # (p,) of the way along it
    residual: Numbers,  # (p,) distance to its surface, negative inside
):
    """Place each point on the candidate whose surface is nearest; the first of equals."""
    for i in rows:
        best = ti.math.inf
        edge[i] = -1
        for k in range(candidates.shape[1]):
            c = candidates[lists[i], k]
            if c >= 0:
                a, b = edges[c, 0], edges[c, 1]
                s, d = on_cone(points[rows[i]], nodes[a], nodes[b], radii[a], radii[b])
                size = d
                if signed == 0:
                    size = ti.abs(d)
                if size < best:
                    best = size
                    edge[i] = c
                    share[i] = s
                    residual[i] = d


cone_feet = started(_cone_feet)
