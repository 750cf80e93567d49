"""How much of the sphere around a place a cloud covers, on a grid of cells of the cube map."""

import taichi as ti

from .runtime import started
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)

SIDE = 8  # cells along each edge of the cube's faces
CELLS = 6 * SIDE * SIDE


@ti.func
def cell_of(d) -> ti.i32:
    """Return the cell of a direction: the face of its largest coordinate, then a square of that face."""
    a = ti.abs(d)
    axis = 0
    if a[1] > a[0]:
        axis = 1
    if a[2] > a[axis]:
        axis = 2
    face = 2 * axis
    if d[axis] < 0.0:
        face += 1
    u = d[(axis + 1) % 3] / a[axis]
    v = d[(axis + 2) % 3] / a[axis]
    column = ti.min(SIDE - 1, ti.cast((u + 1.0) * 0.5 * SIDE, ti.i32))
    row = ti.min(SIDE - 1, ti.cast((v + 1.0) * 0.5 * SIDE, ti.i32))
    return (face * SIDE + row) * SIDE + column


@ti.kernel
def _cells(queries: Points, points: Points, out: Indices):
    """Cell of every direction from one place, -1 where a point is at the place itself."""
    for j in points:
        d = points[j] - queries[0]
        cell = -1
        if d.norm_sqr() > 0.0:
            cell = cell_of(d)
        out[j] = cell


@ti.func
def across(d):
    """Return two directions of unit length across d."""
    a = ti.abs(d)
    helper = ti.Vector([1.0, 0.0, 0.0])
    if a[0] > a[1]:
        helper = ti.Vector([0.0, 1.0, 0.0])
    u = d.cross(helper).normalized()
    return u, d.normalized().cross(u)


@ti.func
def mark(seen: ti.template(), areas: ti.template(), row: ti.i32, d, point: ti.i32) -> ti.f64:
    """Give the cell of a direction to a point; return its share of the sphere where it was nobody's before."""
    cell = cell_of(d)
    new = 0.0
    if seen[row, cell] < 0:
        seen[row, cell] = point
        new = areas[cell]
    return new


@ti.kernel
def _coverage(
    queries: Points,  # (m,)
    starts: Indices,  # (m,) rows of points to begin at, near the query
    points: Points,  # (n,), neighbours in space next to each other
    spacing: Numbers,  # (n,) radii of the discs that the points stand for
    areas: Numbers,  # (CELLS,) shares of the sphere
    enough: ti.f64,  # share at which to stop looking
    # outputs
    seen: Table,  # (m, CELLS) row of the point first seen in each cell, -1 where there is none
    covered: Numbers,  # (m,) share of the sphere that is seen
    coincident: Indices,  # (m,) points found at the query itself
):
    """Look at the points outward from a start along their order, until enough of the sphere is covered."""
    bits = spread(queries.shape[0])
    for number in range(queries.shape[0] << bits):
        if is_piece(number, bits):
            i = number >> bits
            for c in range(CELLS):
                seen[i, c] = -1
            share = 0.0
            same = 0
            below, above = starts[i] - 1, starts[i]
            while share < enough and (below >= 0 or above < points.shape[0]):
                for side in range(2):
                    j = below + side * (above - below)
                    if j >= 0 and j < points.shape[0]:
                        d = points[j] - queries[i]
                        if d.norm_sqr() > 0.0:
                            share += mark(seen, areas, i, d, j)
                            if spacing[j] * spacing[j] * SIDE * SIDE > d.norm_sqr():  # the disc meets several cells
                                u, v = across(d)
                                for k in range(9):
                                    aside = (k % 3 - 1.0) * u + (k // 3 - 1.0) * v
                                    share += mark(seen, areas, i, d + spacing[j] * aside, j)
                        else:
                            same += 1
                below -= 1
                above += 1
            covered[i] = share
            coincident[i] = same


cells = started(_cells)
coverage = started(_coverage)
