"""k nearest neighbours on a hierarchy of uniform grids.

Points are sorted along the Morton curve, so that the cells of *every* grid
whose side is a power of two are contiguous runs, found by bisection. Each
query starts on the finest grid whose own cell is well filled and coarsens
until the k-th neighbour provably lies within the 3 x 3 x 3 block around it.
One fixed cell size would degrade on scans of uneven density; this does not.
"""

import taichi as ti

from .runtime import started

LEVELS = 20  # bits per axis: a code and the end of the coarsest cell both fit 63 bits
Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Codes = ti.types.ndarray(dtype=ti.i64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)
Distances = ti.types.ndarray(dtype=ti.f64, ndim=2)


@ti.func
def spread_bits(coordinate: ti.i64) -> ti.i64:
    """Insert two zero bits after each of the lowest 21 bits."""
    x = coordinate & ti.i64(0x1FFFFF)
    x = (x | (x << 32)) & ti.i64(0x1F00000000FFFF)
    x = (x | (x << 16)) & ti.i64(0x1F0000FF0000FF)
    x = (x | (x << 8)) & ti.i64(0x100F00F00F00F00F)
    x = (x | (x << 4)) & ti.i64(0x10C30C30C30C30C3)
    return (x | (x << 2)) & ti.i64(0x1249249249249249)


@ti.func
def morton(cell):
    """Interleave three cell coordinates into one code."""
    return spread_bits(cell[0]) | (spread_bits(cell[1]) << 1) | (spread_bits(cell[2]) << 2)


@ti.func
def first_at_least(codes: ti.template(), n: ti.i32, code: ti.i64) -> ti.i32:
    """Return the first row whose code is at least the given one, by bisection."""
    low, high = 0, n
    while low < high:
        middle = (low + high) // 2
        if codes[middle] < code:
            low = middle + 1
        else:
            high = middle
    return low


@ti.func
def closer(distance: ti.f64, index: ti.i32, other_distance: ti.f64, other_index: ti.i32) -> bool:
    """Order by distance, then by index, so that ties have one answer."""
    return distance < other_distance or (distance == other_distance and index < other_index)


@ti.func
def insert(nearest: ti.template(), distances: ti.template(), row, found, k, index, distance):
    """Insert a candidate into the sorted row of at most k nearest; return how many there are now."""
    count = found
    wanted = found < k
    if not wanted:
        wanted = closer(distance, index, distances[row, k - 1], nearest[row, k - 1])
    if wanted:
        slot = ti.min(found, k - 1)
        sinking = slot > 0
        while sinking:
            sinking = closer(distance, index, distances[row, slot - 1], nearest[row, slot - 1])
            if sinking:
                distances[row, slot] = distances[row, slot - 1]
                nearest[row, slot] = nearest[row, slot - 1]
                slot -= 1
                sinking = slot > 0
        distances[row, slot] = distance
        nearest[row, slot] = index
        count = ti.min(found + 1, k)
    return count


@ti.func
def start_level(codes: ti.template(), n, code, wanted) -> ti.i32:
    """Return the finest level at which the cell of the code holds the wanted number of points."""
    low, high = 0, LEVELS
    while low < high:
        level = (low + high + 1) // 2
        shift = ti.cast(3 * (LEVELS - level), ti.i64)  # shifts of one width: debug mode checks no other
        first = (code >> shift) << shift
        if first_at_least(codes, n, first + (ti.i64(1) << shift)) - first_at_least(codes, n, first) >= wanted:
            low = level
        else:
            high = level - 1
    return low


@ti.kernel
def _morton_codes(points: Points, origin: ti.types.vector(3, ti.f64), inverse_cell: ti.f64, codes: Codes):
    last = ti.i64((1 << LEVELS) - 1)
    for i in points:
        cell = ti.cast(ti.floor((points[i] - origin) * inverse_cell), ti.i64)
        codes[i] = morton(ti.max(ti.min(cell, last), ti.i64(0)))


@ti.kernel
def _nearest(
    points: Points,  # (n,) in Morton order
    ids: Indices,  # (n,) their original rows
    codes: Codes,  # (n,) ascending
    origin: ti.types.vector(3, ti.f64),
    inverse_cell: ti.f64,  # of the finest grid
    k: ti.i32,
    # outputs, by original row
    nearest: Table,  # (n, k)
    distances: Distances,  # (n, k), squared
):
    n = points.shape[0]
    for s in range(n):
        p = points[s]
        row = ids[s]
        level = start_level(codes, n, codes[s], ti.max(2, k // 4))  # of one point, the finest would do: its own
        searching = True
        while searching:
            shift = ti.cast(LEVELS - level, ti.i64)
            width = ti.cast(ti.i64(1) << shift, ti.f64) / inverse_cell
            cells = ti.i64(1) << ti.cast(level, ti.i64)
            finest = ti.cast(ti.floor((p - origin) * inverse_cell), ti.i64)
            own = ti.max(ti.min(finest, ti.i64((1 << LEVELS) - 1)), ti.i64(0)) >> shift
            found = 0
            for offset in range(27):
                step = ti.Vector([offset % 3 - 1, (offset // 3) % 3 - 1, offset // 9 - 1])
                cell = own + ti.cast(step, ti.i64)
                inside = cell.min() >= 0 and cell.max() < cells
                if inside:
                    first = morton(cell) << (3 * shift)
                    at = first_at_least(codes, n, first)
                    end = first + (ti.i64(1) << (3 * shift))
                    stop = first_at_least(codes, n, end)
                    while at < stop:
                        d = points[at] - p
                        square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
                        found = insert(nearest, distances, row, found, k, ids[at], square)
                        at += 1
            # The block reaches at least this far from p; the last factor covers the rounding of cell borders.
            corner = origin + ti.cast(own, ti.f64) * width
            reach = (width + ti.min((p - corner).min(), (corner + width - p).min())) * (1.0 - 1e-9)
            if found == k:
                searching = distances[row, k - 1] >= reach * reach
            if level == 0:
                searching = False
            level -= 1


morton_codes = started(_morton_codes)
nearest = started(_nearest)
