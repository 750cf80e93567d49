"""Homotopic thinning: cubes of a grid taken away one by one, in a given order, without a change of topology."""

from .engine import ti
from .runtime import started

Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)

AROUND = 27  # cubes of a neighbourhood, the one in its middle included
MIDDLE = 13  # its number there


@ti.func
def bits_around(state: ti.template(), cube: ti.i32, steps: ti.template()) -> ti.i32:
    """Return which cubes about one are there, a bit for each; never its own."""
    bits = 0
    for k in range(AROUND):
        if k != MIDDLE and state[cube + steps[k]] > 0:
            bits |= 1 << k
    return bits


@ti.func
def piece_of(seed: ti.i32, bits: ti.i32, adjacent: ti.template()) -> ti.i32:
    """Return the bits that hang together with those of the seed."""
    piece, todo = seed, seed
    while todo != 0:
        reached = 0
        for k in range(AROUND):
            if (todo >> k) & 1 == 1:
                reached |= adjacent[k]
        todo = reached & bits & ~piece
        piece |= todo
    return piece


@ti.func
def is_simple(bits: ti.i32, masks: ti.template(), touching: ti.template(), beside: ti.template()) -> ti.i32:
    """Tell whether topology stays as it is without a cube (Bertrand and Malandain, A new characterization, 1994).

    Its neighbours hang together by corners, and what is empty about it, within
    edges of it, and has a face in common with it, hangs together by faces.
    """
    simple = 0
    empty = ~bits & masks[0]  # within edges
    open_faces = empty & masks[1]
    if bits != 0 and open_faces != 0:
        lowest = bits & -bits
        face = open_faces & -open_faces
        one = piece_of(lowest, bits, touching) == bits
        if one and (open_faces & ~piece_of(face, empty, beside)) == 0:
            simple = 1
    return simple


@ti.func
def push(heap: ti.template(), size: ti.i32, rank: ti.i32):
    """Put a rank into a heap of so many."""
    at = size
    while at > 0 and heap[(at - 1) // 2] > rank:
        heap[at] = heap[(at - 1) // 2]
        at = (at - 1) // 2
    heap[at] = rank


@ti.func
def pop(heap: ti.template(), size: ti.i32) -> ti.i32:
    """Take the lowest rank out of a heap of so many."""
    lowest, last = heap[0], heap[size - 1]
    at, below = 0, 1
    while below < size - 1:
        if below + 1 < size - 1 and heap[below + 1] < heap[below]:
            below += 1
        if heap[below] < last:
            heap[at] = heap[below]
            at = below
            below = 2 * at + 1
        else:
            below = size
    heap[at] = last
    return lowest


@ti.kernel
def _thin(
    cubes: Indices,  # (m,) cells of the grid, in the order in which they may go
    rank: Indices,  # (c,) place of each cell in that order, -1 where there is no cube
    steps: Indices,  # (27,) from a cell to the cells about it
    touching: Indices,  # (27,) bits of the cells about a cell that touch each of them
    beside: Indices,  # (27,) the same of those that have a face in common
    masks: Indices,  # (2,) bits of the cells that have an edge, and a face, in common with the middle
    # outputs
    state: Indices,  # (c,) 1 where there is a cube, 2 where it stays, 0 elsewhere; a rim of zeros
    heap: Indices,  # (m,)
    waiting: Indices,  # (m,) which ranks are in the heap: zeros
):
    for _ in range(1):  # one after the other
        size = 0
        for i in range(cubes.shape[0]):
            push(heap, size, i)
            waiting[i] = 1
            size += 1
        while size > 0:
            here = pop(heap, size)
            size -= 1
            waiting[here] = 0
            cube = cubes[here]
            if state[cube] == 1 and is_simple(bits_around(state, cube, steps), masks, touching, beside) == 1:
                state[cube] = 0
                for k in range(AROUND):
                    other = rank[cube + steps[k]]
                    if other >= 0 and state[cube + steps[k]] == 1 and waiting[other] == 0:
                        push(heap, size, other)
                        waiting[other] = 1
                        size += 1


thin = started(_thin)
