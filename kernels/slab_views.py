"""What is seen from places in the plane across a direction: the nearest point of a slab, and where points stand about.

Angles are kept as the lowest and the highest of each of BINS sectors, so that the widest gap between them is exact
where it is wider than a sector.
"""

from .engine import ti
from .runtime import started
from .slabs import in_slab
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Table = ti.types.ndarray(dtype=ti.f64, ndim=2)

BINS = 72  # sectors of five degrees


@ti.kernel
def _nearest_in_slab(
    points: Points,  # (n,)
    centres: Points,  # (m,)
    x: Points,  # (m,) unit normals of the planes
    half: Numbers,  # (m,) half the thickness of each slab
    # output
    nearest: Numbers,  # (m,) distance in the plane, infinite where the slab is empty
):
    """Distance in its plane of the nearest point of each slab."""
    bits = spread(centres.shape[0])
    for number in range(centres.shape[0] << bits):
        if is_piece(number, bits):
            s = number >> bits
            best = ti.math.inf
            for j in range(points.shape[0]):
                if in_slab(points[j], centres[s], x[s], half[s]):
                    offset = points[j] - centres[s]
                    best = ti.min(best, (offset - offset.dot(x[s]) * x[s]).norm())
            nearest[s] = best


@ti.kernel
def _seen_around(
    points: Points,  # (n,)
    centres: Points,  # (m,)
    x: Points,  # (m,) unit normals of the planes
    y: Points,  # (m,) unit directions in the planes
    z: Points,  # (m,)
    half: Numbers,  # (m,)
    reach: Numbers,  # (m,) how far in the plane points count
    # outputs
    lowest: Table,  # (m, BINS) lowest angle in each sector, infinite where there is none
    highest: Table,  # (m, BINS) the highest, infinite below zero where there is none
):
    """Angles, from -pi to pi, at which points of each slab stand about its centre."""
    bits = spread(centres.shape[0])
    for number in range(centres.shape[0] << bits):
        if is_piece(number, bits):
            s = number >> bits
            for b in range(BINS):
                lowest[s, b] = ti.math.inf
                highest[s, b] = -ti.math.inf
            for j in range(points.shape[0]):
                if in_slab(points[j], centres[s], x[s], half[s]):
                    offset = points[j] - centres[s]
                    across, up = offset.dot(y[s]), offset.dot(z[s])
                    if across * across + up * up <= reach[s] * reach[s]:
                        angle = ti.atan2(up, across)
                        b = ti.min(BINS - 1, ti.cast((angle / ti.math.pi + 1.0) * 0.5 * BINS, ti.i32))
                        lowest[s, b] = ti.min(lowest[s, b], angle)
                        highest[s, b] = ti.max(highest[s, b], angle)


nearest_in_slab = started(_nearest_in_slab)
seen_around = started(_seen_around)
