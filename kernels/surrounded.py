"""The area of the convex hull of the directions in which places see a cloud, many places at once."""

from .coverage import CELLS, FACE, SIDE, bit, points_to_pass, square_of
from .engine import ti
from .hulls import FLAT, area_of, farthest, first_faces, grown, volume
from .runtime import started
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)
Squares = ti.types.ndarray(dtype=ti.u64, ndim=2)

FINE = 64  # squares along each edge of the cube's faces, 0.02 to 0.03 radians wide
SQUARES = 6 * FINE * FINE // 64  # long integers that have a bit for each


@ti.func
def counts(taken: ti.template(), bits: ti.template(), q: ti.i32, d, thin: ti.i32) -> bool:
    """Tell whether a direction is in no cell that is known, and the first in its square where these count."""
    face, row, column = square_of(d, FINE)
    cell = row // (FINE // SIDE) * SIDE + column // (FINE // SIDE)
    result = (bits[face] & bit(cell)) == 0
    if result and thin == 1:
        word, own = (face * FINE + row) * FINE // 64 + column // 64, bit(column % 64)
        result = (taken[q, word] & own) == 0
        taken[q, word] |= own
    return result


@ti.kernel
def _surrounded(
    queries: Points,  # (m,)
    seen: Table,  # (m, CELLS) row of a point in each cell, -1 where there is none
    inner: Table,  # (m, CELLS) 1 for the cells in which no more than that point counts
    points: Points,  # (n,), neighbours in space next to each other
    low_corners: Points,  # (b,) of the boxes of blocks of points, then of large blocks
    high_corners: Points,  # (b,)
    enough: ti.f64,  # area from which on the points that are seen first do
    slack: ti.f64,  # what the hull may miss of the other points
    thin: ti.i32,  # whether of these the first in each square of a fine grid does
    room: ti.i32,  # vectors that a hull may have
    # outputs
    taken: Squares,  # (m, SQUARES) bits
    vectors: Points,  # (m room,)
    faces: Table,  # (2 m room, 3) corners
    beside: Table,  # (2 m room, 3) faces across the edge opposite to each corner
    stack: Indices,  # (2 m room,)
    areas: Numbers,  # (m,) of the vectors that there is room for; -1 where they are too few or nearly in a plane
):
    pieces = spread(queries.shape[0])
    for number in range(queries.shape[0] << pieces):
        if is_piece(number, pieces):
            q = number >> pieces
            first, low = q * room, 2 * q * room
            place = queries[q]
            count = 0
            bits = ti.Vector([ti.u64(0)] * 6)
            for cell in range(CELLS):
                if inner[q, cell] == 1:
                    bits[cell // FACE] |= bit(cell % FACE)
                if seen[q, cell] >= 0:
                    vectors[first + count] = (points[seen[q, cell]] - place).normalized()
                    count += 1
            for k in range(SQUARES):
                taken[q, k] = 0
            areas[q] = -1.0
            corners = ti.Vector([first, first, first, first])
            for k in ti.static(range(1, 4)):
                corners[k] = farthest(vectors, first, first + count, corners, k)
            a, b, c, d = vectors[corners[0]], vectors[corners[1]], vectors[corners[2]], vectors[corners[3]]
            if count >= 4 and ti.abs(volume(a, b, c, d)) > FLAT:
                middle = 0.25 * (a + b + c + d)
                for i in range(first, first + count):
                    vectors[i] -= middle
                first_faces(vectors, faces, beside, low, corners)
                used, face = 4, low
                for i in range(first, first + count):
                    face, used = grown(vectors, faces, beside, stack, low, used, face, 0.0, i)
                areas[q] = area_of(vectors, faces, low, used)
                j = points.shape[0] if areas[q] >= enough else 0
                while j < points.shape[0]:
                    passed = points_to_pass(low_corners, high_corners, points.shape[0], j, 1, place, bits)
                    if passed == 0:
                        passed = 1
                        d = points[j] - place
                        wanted = d.norm_sqr() > 0.0
                        if wanted:
                            wanted = counts(taken, bits, q, d, thin)
                        if wanted:
                            vectors[first + count] = d.normalized() - middle
                            before = used
                            face, used = grown(vectors, faces, beside, stack, low, used, face, slack, first + count)
                            count += (used - before) // 2
                    j += passed
                    if count == room:
                        j = points.shape[0]
                if areas[q] < enough:
                    areas[q] = area_of(vectors, faces, low, used)


surrounded = started(_surrounded)
