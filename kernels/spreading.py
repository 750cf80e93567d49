"""Few and heavy pieces of work, spread among all threads.

Taichi 1.7 cuts the outermost loop of a kernel into one run a thread, of 512
iterations at least, whatever block_dim says: of 200 places, one thread does all
and the others nothing. So a loop over few pieces counts further, and does one
at every 2^bits-th number:

    bits = spread(pieces)
    for number in range(pieces << bits):
        if is_piece(number, bits):
            piece = number >> bits
"""

from .engine import ti

NUMBERS = 2**14  # 512 for each of 32 threads; to count them with nothing to do takes 10 microseconds


@ti.func
def spread(pieces: ti.i32) -> ti.i32:
    """Return the bits that make so many pieces enough numbers for all threads."""
    bits = 0
    while pieces > 0 and (pieces << bits) < NUMBERS:
        bits += 1
    return bits


@ti.func
def is_piece(number: ti.i32, bits: ti.i32) -> bool:
    """Tell whether there is something to do at a number."""
    return (number & ((1 << bits) - 1)) == 0
