"""The nearest point with another label, on a complete binary tree of boxes.

What a round of Boruvka's minimum spanning tree asks for. The tree is laid out as a heap: node k has the children
2 k and 2 k + 1, the last level are leaves of LEAF points each. A box all of whose points have the label of the query
is passed over; so is one that is not nearer than what is known.
"""

from .engine import ti
from .neighbours import square_of, square_to_box
from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)

LEAF = 8  # points; of 4 to 16 the fastest, by trial


@ti.func
def box_square(low: ti.template(), high: ti.template(), shared: ti.template(), node, label, p) -> ti.f64:
    """Return the squared distance of a box, infinite where all its points have the label."""
    square = ti.math.inf
    if shared[node] != label:
        square = square_to_box(p, low[node], high[node])
    return square


@ti.kernel
def _nearest_outside(
    points: Points,  # (n,) in the order of the leaves
    labels: Indices,  # (n,)
    low: Points,  # (2 leaves,) corners of the boxes; infinitely far where a node is empty
    high: Points,
    shared: Indices,  # (2 leaves,) the label of all points of a node, -1 where they differ
    queries: Indices,  # (m,) rows of points
    bounds: Numbers,  # (m,) squared; only what is nearer counts
    # outputs
    nearest: Indices,  # (m,) row of the nearest point with another label, -1 where none is within the bound
    squares: Numbers,  # (m,) its squared distance, the bound where there is none
):
    leaves = low.shape[0] // 2
    for q in queries:
        p = points[queries[q]]
        label = labels[queries[q]]
        best = bounds[q]
        found = -1
        node = 1
        waiting = 0  # a bit for every level above: whether the sibling there is still to be looked at
        searching = True
        while searching:
            deeper = False
            if node >= leaves:
                first = (node - leaves) * LEAF
                for j in range(first, ti.min(first + LEAF, points.shape[0])):
                    square = square_of(points[j] - p)
                    if labels[j] != label and square < best:
                        best = square
                        found = j
            else:
                one = box_square(low, high, shared, 2 * node, label, p)
                other = box_square(low, high, shared, 2 * node + 1, label, p)
                deeper = ti.min(one, other) < best
                if deeper:
                    waiting = 2 * waiting + ti.cast(ti.max(one, other) < best, ti.i32)
                    node = 2 * node + ti.cast(other < one, ti.i32)
            while searching and not deeper:  # up, to the next sibling that is worth it
                if node == 1:
                    searching = False
                else:
                    if waiting % 2 == 1:
                        deeper = box_square(low, high, shared, node ^ 1, label, p) < best
                    if deeper:
                        node = node ^ 1
                        waiting -= 1
                    else:
                        node //= 2
                        waiting //= 2
        nearest[q] = found
        squares[q] = best


nearest_outside = started(_nearest_outside)
