"""Where points stand on a curve of round cones."""

from .engine import ti
from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)

BELOW = 1 - 1e-9  # of a squared distance: what rounding might take off it


@ti.func
def beside_cone(point, start, end, first: ti.f64, last: ti.f64):
    """Return the share along the axis of the foot of the perpendicular, and how far out of the radius there."""
    axis = end - start
    offset = point - start
    square = axis.norm_sqr()
    share = 0.0
    if square > 0.0:
        share = ti.min(ti.max(offset.dot(axis) / square, 0.0), 1.0)
    return share, (offset - share * axis).norm() - (1.0 - share) * first - share * last


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


@ti.func
def foot(point, start, end, first: ti.f64, last: ti.f64, radial: ti.i32):
    """Return where the foot is and how far out the point is, perpendicular to the axis or to the surface."""
    share, out = 0.0, 0.0
    if radial == 1:
        share, out = beside_cone(point, start, end, first, last)
    else:
        share, out = on_cone(point, start, end, first, last)
    return share, out


@ti.kernel
def _cone_feet(
    points: Points,  # (n,)
    rows: Indices,  # (p,) points to place
    lists: Indices,  # (p,) which list of edges each of them may stand on
    candidates: Table,  # (l, w) these lists, ascending, padded with -1
    nodes: Points,  # (v,)
    radii: Numbers,  # (v,)
    edges: Table,  # (e, 2)
    middles: Points,  # (e,) of the edges
    reaches: Numbers,  # (e,) of balls about them that hold the cones
    signed: ti.i32,  # whether the least distance counts, or the least in size
    radial: ti.i32,  # whether perpendicular to the axis, or to the surface
    # outputs
    edge: Indices,  # (p,) the edge that counts, -1 where the list is empty
    share: Numbers,  # (p,) of the way along it
    residual: Numbers,  # (p,) distance to its surface, negative inside
):
    """Place each point on the candidate whose surface is nearest; the first of equals.

    The edge with the nearest middle is tried first: what is farther than it, by the ball that holds the cone, is passed
    over.
    """
    for i in rows:
        point, mine = points[rows[i]], lists[i]
        edge[i] = -1
        nearest, at = ti.math.inf, -1
        for k in range(candidates.shape[1]):
            c = candidates[mine, k]
            if c >= 0:
                square = (point - middles[c]).norm_sqr()
                if square < nearest or at < 0:
                    nearest, at = square, c
        best = ti.math.inf
        if at >= 0:
            a, b = edges[at, 0], edges[at, 1]
            s, d = foot(point, nodes[a], nodes[b], radii[a], radii[b], radial)
            best = d if signed == 1 else ti.abs(d)
            edge[i], share[i], residual[i] = at, s, d
        for k in range(candidates.shape[1]):
            c = candidates[mine, k]
            if c >= 0 and c != at:
                limit = best + reaches[c]
                if limit > 0.0 and (point - middles[c]).norm_sqr() * BELOW <= limit * limit:
                    a, b = edges[c, 0], edges[c, 1]
                    s, d = foot(point, nodes[a], nodes[b], radii[a], radii[b], radial)
                    size = d if signed == 1 else ti.abs(d)
                    if size < best or (size == best and c < edge[i]):
                        best = size
                        edge[i], share[i], residual[i] = c, s, d


cone_feet = started(_cone_feet)
