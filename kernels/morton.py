"""Codes along the Morton curve, where neighbours in the order are mostly neighbours in space."""

from .engine import ti
from .runtime import started

LEVELS = 20  # bits per axis: a code and the end of the coarsest cell both fit 63 bits
Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Codes = ti.types.ndarray(dtype=ti.i64, ndim=1)


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


@ti.kernel
def _morton_codes(points: Points, origin: ti.types.vector(3, ti.f64), inverse_cell: ti.f64, codes: Codes):
    last = ti.i64((1 << LEVELS) - 1)
    for i in points:
        cell = ti.cast(ti.floor((points[i] - origin) * inverse_cell), ti.i64)
        codes[i] = morton(ti.max(ti.min(cell, last), ti.i64(0)))


morton_codes = started(_morton_codes)
