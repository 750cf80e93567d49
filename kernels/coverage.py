"""How much of the sphere around a place a cloud covers, on a grid of cells of the cube map.

What a block of points can add is known from its box: where all
cells that it can fall into are settled already, it is passed over as a whole, and nothing else changes by that.
"""

from .engine import ti
from .runtime import started
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)

SIDE = 8  # cells along each edge of the cube's faces
FACE = SIDE * SIDE  # cells of a face, as many as a long integer has bits
CELLS = 6 * FACE
BLOCK, BLOCKS = 32, 32  # points of a block, and blocks of a large one
LARGE = BLOCK * BLOCKS
DISC = 1.5  # spacings that a box reaches beyond its points: the corners of their discs are 1.42 from them


@ti.func
def square_of(d, side: ti.i32):
    """Return where a direction meets the cube: the face of its largest coordinate, row and column of a square there."""
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
    column = ti.min(side - 1, ti.cast((u + 1.0) * 0.5 * side, ti.i32))
    row = ti.min(side - 1, ti.cast((v + 1.0) * 0.5 * side, ti.i32))
    return face, row, column


@ti.func
def cell_of(d) -> ti.i32:
    """Return the cell of a direction."""
    face, row, column = square_of(d, SIDE)
    return (face * SIDE + row) * SIDE + column


@ti.func
def bit(k: ti.i32) -> ti.u64:
    """Return the k-th bit of a long integer."""
    return ti.u64(1) << ti.cast(k, ti.u64)


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
def cells_of_box(low, high):
    """Return a face and the bits of its cells that directions into a box can have; none where it may be several faces.

    Rounded quotients are monotone, so that no direction into the box has another cell.
    """
    a = ti.abs(low + high)
    axis = 0
    if a[1] > a[0]:
        axis = 1
    if a[2] > a[axis]:
        axis = 2
    face, near, far = 2 * axis, low[axis], high[axis]
    if low[axis] + high[axis] < 0.0:
        face, near, far = face + 1, -high[axis], -low[axis]
    bits = ti.u64(0)
    if near > 0.0:
        first, last = ti.Vector([0.0, 0.0]), ti.Vector([0.0, 0.0])
        for k in ti.static(range(2)):
            smallest, largest = low[(axis + 1 + k) % 3], high[(axis + 1 + k) % 3]
            first[k] = smallest / (near if smallest < 0.0 else far)
            last[k] = largest / (near if largest > 0.0 else far)
        if first.min() > -1.0 and last.max() < 1.0:
            start = ti.cast((first + 1.0) * 0.5 * SIDE, ti.i32)
            end = ti.min(SIDE - 1, ti.cast((last + 1.0) * 0.5 * SIDE, ti.i32))
            columns = (bit(end[0] - start[0] + 1) - ti.u64(1)) << ti.cast(start[0], ti.u64)
            for row in range(start[1], end[1] + 1):
                bits |= columns << ti.cast(SIDE * row, ti.u64)
    return face, bits


@ti.func
def settled(low: ti.template(), high: ti.template(), box: ti.i32, place, bits) -> bool:
    """Tell whether all cells that directions into a box can have are among the bits, a long integer for each face."""
    face, own = cells_of_box(low[box] - place, high[box] - place)
    return own != 0 and (own & ~bits[face]) == 0


@ti.func
def points_to_pass(
    low: ti.template(), high: ti.template(), count: ti.i32, j: ti.i32, step: ti.i32, place, bits
) -> ti.i32:
    """Return how many points from the j-th of so many on add nothing, going up or down, as far as boxes know."""
    passed = 0
    edge = j if step > 0 else j + 1  # where a block would begin
    if edge % BLOCK == 0:
        blocks = (count + BLOCK - 1) // BLOCK
        if edge % LARGE == 0:
            if settled(low, high, blocks + j // LARGE, place, bits):
                passed = LARGE
        if passed == 0:
            if settled(low, high, j // BLOCK, place, bits):
                passed = BLOCK
    return passed


@ti.func
def mark(seen: ti.template(), bits: ti.template(), areas: ti.template(), row: ti.i32, d, point: ti.i32) -> ti.f64:
    """Give the cell of a direction to a point; return its share of the sphere where it was nobody's before."""
    cell = cell_of(d)
    new = 0.0
    if seen[row, cell] < 0:
        seen[row, cell] = point
        bits[cell // FACE] |= bit(cell % FACE)
        new = areas[cell]
    return new


@ti.kernel
def _coverage(
    queries: Points,  # (m,)
    starts: Indices,  # (m,) rows of points to begin at, near the query
    points: Points,  # (n,), neighbours in space next to each other
    spacing: Numbers,  # (n,) radii of the discs that the points stand for
    low: Points,  # (b,) corners of the boxes of blocks of points, then of large blocks, their discs included
    high: Points,  # (b,)
    areas: Numbers,  # (CELLS,) shares of the sphere
    enough: ti.f64,  # share at which to stop looking
    # outputs
    seen: Table,  # (m, CELLS) row of the point first seen in each cell, -1 where there is none
    covered: Numbers,  # (m,) share of the sphere that is seen
    coincident: Indices,  # (m,) points found at the query itself
):
    """Look at the points outward from a start along their order, until enough of the sphere is covered.

    Those before and behind take turns, whatever is passed over.
    """
    count = points.shape[0]
    pieces = spread(queries.shape[0])
    for number in range(queries.shape[0] << pieces):
        if is_piece(number, pieces):
            i = number >> pieces
            for c in range(CELLS):
                seen[i, c] = -1
            bits = ti.Vector([ti.u64(0)] * 6)
            share = 0.0
            same = 0
            below, above = starts[i] - 1, starts[i]
            turn = -1  # the last of those before that was looked at, so many rows away
            looking = True
            while looking:
                down = below >= 0 and (above >= count or starts[i] - 1 - below <= above - starts[i])
                j = below if down else above
                looking = 0 <= j < count
                if looking and (down or turn != above - starts[i]):  # two at a time: the second is not asked
                    looking = share < enough
                if looking:
                    step = -1 if down else 1
                    passed = points_to_pass(low, high, count, j, step, queries[i], bits)
                    if passed == 0:
                        passed = 1
                        if down:
                            turn = starts[i] - 1 - below
                        d = points[j] - queries[i]
                        if d.norm_sqr() > 0.0:
                            share += mark(seen, bits, areas, i, d, j)
                            if spacing[j] * spacing[j] * SIDE * SIDE > d.norm_sqr():  # the disc meets several cells
                                u, v = across(d)
                                for k in range(9):
                                    aside = (k % 3 - 1.0) * u + (k // 3 - 1.0) * v
                                    share += mark(seen, bits, areas, i, d + spacing[j] * aside, j)
                        else:
                            same += 1
                    if down:
                        below -= passed
                    else:
                        above += passed
            covered[i] = share
            coincident[i] = same


cells = started(_cells)
coverage = started(_coverage)
