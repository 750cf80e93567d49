"""Which points of a cloud lie in which slab, all slabs at once."""

from .engine import ti
from .runtime import started
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Offsets = ti.types.ndarray(dtype=ti.i64, ndim=1)


@ti.func
def in_slab(point, centre, direction, half: ti.f64) -> bool:
    """Tell whether a point is no further than half from the plane through a centre across a unit direction."""
    return ti.abs((point - centre).dot(direction)) <= half


@ti.kernel
def _slab_counts(points: Points, centres: Points, directions: Points, half: ti.f64, out: Indices):
    """Number of points no further than half from the plane through each centre across each direction."""
    bits = spread(centres.shape[0])
    for number in range(centres.shape[0] << bits):
        if is_piece(number, bits):
            s = number >> bits
            count = 0
            for j in range(points.shape[0]):
                if in_slab(points[j], centres[s], directions[s], half):
                    count += 1
            out[s] = count


@ti.kernel
def _slab_members(points: Points, centres: Points, directions: Points, half: ti.f64, offsets: Offsets, out: Indices):
    """Rows of these points, ascending, those of slab s from offsets[s] on."""
    bits = spread(centres.shape[0])
    for number in range(centres.shape[0] << bits):
        if is_piece(number, bits):
            s = number >> bits
            at = offsets[s]
            for j in range(points.shape[0]):
                if in_slab(points[j], centres[s], directions[s], half):
                    out[at] = j
                    at += ti.i64(1)


slab_counts = started(_slab_counts)
slab_members = started(_slab_members)
