"""Sums of the normal equations of a fit of round cones, edge by edge."""

from .engine import ti
from .runtime import started
from .spreading import is_piece, spread

Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Table = ti.types.ndarray(dtype=ti.f64, ndim=2)
Stack = ti.types.ndarray(dtype=ti.f64, ndim=3)


@ti.kernel
def _summed_products(
    slopes: Table,  # (p, w) of the residuals
    weights: Numbers,  # (p,)
    residuals: Numbers,  # (p,)
    order: Indices,  # (p,) rows by edge
    starts: Indices,  # (e + 1,) where those of each edge begin
    # outputs
    blocks: Stack,  # (e, w, w) sums of weight * slope * slope, zero at first
    sides: Table,  # (e, w) sums of weight * slope * residual, zero at first
):
    edges = starts.shape[0] - 1
    bits = spread(edges)
    for number in range(edges << bits):
        if is_piece(number, bits):
            e = number >> bits
            for place in range(starts[e], starts[e + 1]):
                row = order[place]
                for a in range(slopes.shape[1]):
                    weighted = weights[row] * slopes[row, a]
                    sides[e, a] += weighted * residuals[row]
                    for b in range(a, slopes.shape[1]):
                        blocks[e, a, b] += weighted * slopes[row, b]
            for a in range(slopes.shape[1]):
                for b in range(a):
                    blocks[e, a, b] = blocks[e, b, a]


summed_products = started(_summed_products)
