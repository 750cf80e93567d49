"""Morton codes, bit by bit."""

import numpy as np


def code(cell: np.ndarray, bits: int) -> int:
    """Return the code of a cell (3,): bit b of its coordinate a is bit 3 b + a of the code."""
    return sum(((int(cell[a]) >> b) & 1) << (3 * b + a) for a in range(3) for b in range(bits))


def codes(points: np.ndarray, low: np.ndarray, per_length: float, bits: int) -> list[int]:
    """Return the codes of points (n, 3), from the cells they are in; those outside the grid are in its outermost."""
    return [code(np.clip(np.floor((p - low) * per_length), 0, 2**bits - 1), bits) for p in points]
