"""One-rings without a triangulation.

The one-ring of p in the 2D Delaunay triangulation is the convex hull of the
neighbours' inversions q -> (q - p) / |q - p|^2: a circle through p becomes a
line, and the circle is empty when no other inversion lies beyond that line.
The ring is closed when the hull holds p in its interior; otherwise p is a hull
vertex of its projected neighbours and the chain stays open. Neighbours are
sorted by angle and scanned once (Graham), with the exact sign conditions of
the in-circle determinant, so no division takes place.
"""

from .engine import ti
from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Planes = ti.types.ndarray(dtype=ti.types.matrix(2, 3, ti.f64), ndim=1)
Plane = ti.types.ndarray(dtype=ti.types.vector(2, ti.f64), ndim=2)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)


@ti.func
def cross(a, b) -> ti.f64:
    """Return the cross product of two vectors in the plane, positive where b is to the left of a."""
    return a[0] * b[1] - a[1] * b[0]


@ti.func
def lower_half(a) -> bool:
    """Tell whether the angle of a from the positive first axis is half a turn or more."""
    return a[1] < 0.0 or (a[1] == 0.0 and a[0] < 0.0)


@ti.func
def comes_before(a, b) -> bool:
    """Order by angle from the positive first axis; in one direction the nearer point comes first."""
    before = not lower_half(a) and lower_half(b)
    if lower_half(a) == lower_half(b):
        turn = cross(a, b)
        before = turn > 0.0 or (turn == 0.0 and a.norm_sqr() < b.norm_sqr())
    return before


@ti.func
def same_direction(a, b) -> bool:
    """Tell whether a and b lie on one ray from the origin, exactly."""
    return cross(a, b) == 0.0 and a.dot(b) > 0.0


@ti.func
def convex(a, b, c) -> bool:
    """Tell whether the inversion of b is a strict hull vertex between those of a and c.

    This is the in-circle determinant of b against p, a, c, with p at the origin.
    """
    return a.norm_sqr() * cross(b, c) - b.norm_sqr() * cross(a, c) + c.norm_sqr() * cross(a, b) > 0.0


@ti.func
def sort_by_angle(flat: ti.template(), order: ti.template(), row, count):
    """Insertion sort of the order of a row; rows are a few dozen long."""
    for s in range(1, count):
        item = order[row, s]
        slot = s
        sinking = True  # Taichi evaluates both sides of an "and": guards stand alone
        while sinking:
            sinking = comes_before(flat[row, item], flat[row, order[row, slot - 1]])
            if sinking:
                order[row, slot] = order[row, slot - 1]
                slot -= 1
                sinking = slot > 0
        order[row, slot] = item


@ti.func
def drop_shadowed(flat: ti.template(), order: ti.template(), row, count):
    """Keep the nearest of the points that lie in one direction; the others are never Delaunay neighbours."""
    kept = 0
    for s in range(count):
        item = order[row, s]
        shadowed = False
        if kept > 0:
            shadowed = same_direction(flat[row, order[row, kept - 1]], flat[row, item])
        if not shadowed:
            order[row, kept] = item
            kept += 1
    return kept


@ti.func
def start_of_chain(flat: ti.template(), order: ti.template(), row, count):
    """Return where to start, and whether the ring is closed.

    A gap of half a turn or more makes p a hull vertex: the chain starts behind
    the gap. Otherwise it starts at the nearest point, surely a hull vertex.
    """
    start, closed = 0, count > 2
    nearest = ti.math.inf
    for s in range(count):
        following = (s + 1) % count
        if cross(flat[row, order[row, s]], flat[row, order[row, following]]) <= 0.0 and closed:
            start, closed = following, False
    if closed:
        for s in range(count):
            square = flat[row, order[row, s]].norm_sqr()
            if square < nearest:
                nearest, start = square, s
    if count == 2:
        if cross(flat[row, order[row, 0]], flat[row, order[row, 1]]) < 0.0:
            start = 1
    return start, closed


@ti.kernel
def _one_rings(
    points: Points,  # (n,)
    centres: Indices,  # (m,) whose ring each row is
    candidates: Table,  # (m, w) rows of points, -1 pads at the end; the centre itself is ignored
    planes: Planes,  # (m,) two orthonormal directions of the projection
    # scratch
    flat: Plane,  # (m, w)
    order: Table,  # (m, w)
    # outputs
    rings: Table,  # (m, w), counter-clockwise, -1 pads
    sizes: Indices,  # (m,)
    closed: Indices,  # (m,) 1 or 0
):
    for row in centres:
        centre = points[centres[row]]
        count = 0
        for s in range(candidates.shape[1]):
            rings[row, s] = -1
            candidate = candidates[row, s]
            if candidate >= 0 and candidate != centres[row]:
                q = planes[row] @ (points[candidate] - centre)
                flat[row, s] = q
                if q.norm_sqr() > 0.0:
                    order[row, count] = s
                    count += 1
        sort_by_angle(flat, order, row, count)
        count = drop_shadowed(flat, order, row, count)
        closed[row] = 0
        kept = 0
        if count > 0:
            start, is_closed = start_of_chain(flat, order, row, count)
            closed[row] = ti.cast(is_closed, ti.i32)
            # A closed ring is scanned back to its first member, which removes the last ones where needed.
            for step in range(count + closed[row]):
                item = order[row, (start + step) % count]
                scanning = kept >= 2
                while scanning:
                    a, b = flat[row, rings[row, kept - 2]], flat[row, rings[row, kept - 1]]
                    scanning = not convex(a, b, flat[row, item])
                    if scanning:
                        kept -= 1
                        rings[row, kept] = -1
                        scanning = kept >= 2
                if step < count:
                    rings[row, kept] = item
                    kept += 1
        for s in range(kept):
            rings[row, s] = candidates[row, rings[row, s]]
        sizes[row] = kept


one_rings = started(_one_rings)
