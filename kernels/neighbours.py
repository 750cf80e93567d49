"""k nearest neighbours of all points in a balanced k-d tree of boxes.

The cloud is halved at the median of its widest side until at most BUCKET points
are left. Halves are equal, so a node is a number: its children are 2 i and
2 i + 1, its points a run of the order, and neither is stored. A search begins
at the leaf of the point itself and climbs: below each node on its way, the
other half is gone through wherever boxes are no farther than the k-th found.
So the list is good from the start, the near end of each half comes first, and
no stack is needed. The points of a leaf follow each other: what one has read,
the next finds in the cache. Density does not matter, as it would to a grid.

The distance to a box is summed like those to points, and rounding is monotonic:
what is left out is farther to the last bit.
"""

from .engine import ti
from .runtime import started
from .spreading import is_piece, spread

BUCKET = 16  # most points of a leaf: with 8, searches cost the same and the tree a tenth more
LISTED = 32  # most neighbours found at once; Taichi unrolls longer lists, and is slow to compile them
LAST = 2**31 - 1  # the row that stands for no point: behind all others, were they infinitely far

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=2)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)


@ti.func
def first_of(part: ti.i32, n: ti.i32, level: ti.i32) -> ti.i32:
    """Return where the part of so many begins, of 2^level equal parts of n."""
    return ti.cast((ti.cast(part, ti.i64) * n) >> ti.cast(level, ti.i64), ti.i32)


@ti.func
def swap(points: ti.template(), rows: ti.template(), i: ti.i32, j: ti.i32):
    """Exchange two points."""
    for axis in ti.static(range(3)):
        x = points[i, axis]
        points[i, axis] = points[j, axis]
        points[j, axis] = x
    row = rows[i]
    rows[i] = rows[j]
    rows[j] = row


@ti.func
def select(points: ti.template(), rows: ti.template(), first: ti.i32, last: ti.i32, rank: ti.i32, axis: ti.i32):
    """Order a run so that what is before a rank is nowhere above what is behind it (Hoare's Find)."""
    low, high = first, last
    while low < high:
        a, b, c = points[low, axis], points[(low + high) // 2, axis], points[high, axis]
        pivot = ti.max(ti.min(a, b), ti.min(ti.max(a, b), c))  # the middle one
        i, j = low, high
        while i <= j:
            while points[i, axis] < pivot:
                i += 1
            while points[j, axis] > pivot:
                j -= 1
            if i <= j:
                swap(points, rows, i, j)
                i += 1
                j -= 1
        if rank <= j:
            high = j
        elif rank >= i:
            low = i
        else:
            high = low


@ti.func
def bounds(points: ti.template(), first: ti.i32, stop: ti.i32):
    """Return the lowest and highest coordinates of a run."""
    low = ti.Vector([points[first, 0], points[first, 1], points[first, 2]])
    high = low
    for i in range(first + 1, stop):
        for axis in ti.static(range(3)):
            x = points[i, axis]
            low[axis] = ti.select(x < low[axis], x, low[axis])
            high[axis] = ti.select(x > high[axis], x, high[axis])
    return low, high


@ti.func
def widest(sides) -> ti.i32:
    """Return the first of the axes whose side is longest."""
    axis = 0
    if sides[1] > sides[0]:
        axis = 1
    if sides[2] > ti.max(sides[0], sides[1]):
        axis = 2
    return axis


@ti.kernel
def _halve(
    top: ti.i32,  # level whose nodes are shared out among threads
    bottom: ti.i32,  # the last level to be done
    depth: ti.i32,  # level of the leaves, which get boxes and stay whole
    # in and out
    points: Numbers,  # (n, 3), put in the order of the nodes
    rows: Indices,  # (n,) likewise
    # outputs
    low: Numbers,  # (2^(depth + 1), 3) corners of the boxes, node 2^level + i being part i of its level
    high: Numbers,
):
    n = points.shape[0]
    bits = spread(1 << top)
    for number in range((1 << top) << bits):
        if is_piece(number, bits):
            for level in range(top, bottom + 1):
                below = level - top
                for node in range((number >> bits) << below, ((number >> bits) + 1) << below):
                    first, stop = first_of(node, n, level), first_of(node + 1, n, level)
                    lowest, highest = bounds(points, first, stop)
                    for axis in ti.static(range(3)):
                        low[(1 << level) + node, axis] = lowest[axis]
                        high[(1 << level) + node, axis] = highest[axis]
                    if level < depth:
                        half = first_of(2 * node + 1, n, level + 1)
                        select(points, rows, first, stop - 1, half, widest(highest - lowest))


@ti.func
def square_of(d) -> ti.f64:
    """Return the squared length, its terms summed in the order of the axes."""
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2]


@ti.func
def square_to_box(p, low, high) -> ti.f64:
    """Return the squared distance to a box, no more than that to any point in it, to the last bit."""
    below, above = low - p, p - high
    outside = ti.select(below > above, below, above)
    return square_of(ti.select(outside > 0.0, outside, 0.0))


@ti.func
def closer(square: ti.f64, row: ti.i32, other: ti.f64, other_row: ti.i32) -> bool:
    """Order by distance, then by row, so that ties have one answer."""
    return square < other or (square == other and row < other_row)


@ti.func
def offer(squares: ti.template(), rows: ti.template(), slot: ti.i32, last: ti.i32, square: ti.f64, row: ti.i32):
    """Put a point into a sorted list, at the slot or above, where it is closer than the last; return the next slot."""
    at, next_slot = slot, slot
    wanted = closer(square, row, squares[last], rows[last])
    if wanted:
        next_slot = ti.min(slot + 1, last)
    sinking = wanted and at > 0
    while sinking:
        sinking = closer(square, row, squares[at - 1], rows[at - 1])
        if sinking:
            squares[at] = squares[at - 1]
            rows[at] = rows[at - 1]
            at -= 1
            sinking = at > 0
    if wanted:
        squares[at] = square
        rows[at] = row
    return next_slot


@ti.func
def behind(node: ti.i32, top: ti.i32, near: ti.i32) -> ti.i32:
    """Return where to go from a node that is done: the near children come first, and the top in the end."""
    at = node
    while at != top and (at & 1) != near:
        at >>= 1
    if at != top:
        at ^= 1
    return at


@ti.func
def other_half(top: ti.i32, leaf: ti.i32) -> ti.i32:
    """Return the node beside the next one on the way from a leaf to the root, 0 at its end."""
    on_the_way = top
    if top != leaf:
        on_the_way = top >> 1
    beside = 0
    if on_the_way > 1:
        beside = on_the_way ^ 1
    return beside


@ti.kernel
def _nearest(
    points: Points,  # (n,) as they were halved
    rows: Indices,  # (n,) where they stand in the cloud
    depth: ti.i32,  # level of the leaves
    low: Points,  # (2^(depth + 1),)
    high: Points,
    first: ti.i32,  # columns to fill, at most LISTED; those before them are filled
    stop: ti.i32,
    # outputs, by row of the cloud
    nearest: Table,  # (n, k)
    squares: Numbers,  # (n, k)
):
    n = points.shape[0]
    leaves = 1 << depth
    last = stop - first - 1
    bits = spread(leaves)
    for number in range(leaves << bits):
        leaf = number >> bits
        if is_piece(number, bits):
            for s in range(first_of(leaf, n, depth), first_of(leaf + 1, n, depth)):
                p, row = points[s], rows[s]
                before, row_before = ti.f64(-1.0), -1  # only what is farther counts
                if first > 0:
                    before, row_before = squares[row, first - 1], nearest[row, first - 1]
                list_squares = ti.Vector([ti.math.inf for _ in range(LISTED)], ti.f64)
                list_rows = ti.Vector([LAST for _ in range(LISTED)], ti.i32)
                slot = 0
                node = leaves + leaf
                top = node
                near = 0
                while top > 0:
                    hit = square_to_box(p, low[node], high[node]) <= list_squares[last]
                    if hit and node < leaves:
                        node = 2 * node + near
                    else:
                        if hit:
                            for j in range(first_of(node - leaves, n, depth), first_of(node - leaves + 1, n, depth)):
                                square = square_of(points[j] - p)
                                if square <= list_squares[last] and closer(before, row_before, square, rows[j]):
                                    slot = offer(list_squares, list_rows, slot, last, square, rows[j])
                        node = behind(node, top, near)
                        if node == top:
                            top = other_half(top, leaves + leaf)
                            node = top
                            near = 1 - (top & 1)
                for c in range(first, stop):
                    nearest[row, c] = list_rows[c - first]
                    squares[row, c] = list_squares[c - first]


halve = started(_halve)
nearest = started(_nearest)
