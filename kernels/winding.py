"""Generalised winding numbers of oriented points."""

from .engine import ti
from .runtime import started
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)

BLOCK = 32  # points that are summed up as one where they are far away
REACH = 2.0  # far: further away than so many radii of the block
LANES = 8  # queries at a time, as many doubles as the widest registers hold: four times as fast as one by one

Lanes = ti.types.vector(LANES, ti.f64)
Vector = ti.types.vector(3, ti.f64)


@ti.func
def squares(place: Vector, x: Lanes, y: Lanes, z: Lanes) -> Lanes:
    """Return the squared distances of a place from all queries."""
    dx, dy, dz = place[0] - x, place[1] - y, place[2] - z
    return dx * dx + dy * dy + dz * dz


@ti.func
def fluxes(place: Vector, dipole: Vector, square: Lanes, x: Lanes, y: Lanes, z: Lanes) -> Lanes:
    """Return d . n a / |d|^3, the solid angle of a small patch, from all queries; 0 where the squared length is."""
    along = (place[0] - x) * dipole[0] + (place[1] - y) * dipole[1] + (place[2] - z) * dipole[2]
    return ti.select(square > 0.0, along / (square * ti.sqrt(square)), 0.0)


@ti.kernel
def _winding_numbers(
    queries: Points,  # (m,), m a multiple of LANES, neighbours in space next to each other
    points: Points,  # (n,), neighbours in space next to each other
    dipoles: Points,  # (n,), outward normals times areas
    softening: Numbers,  # (n,), squared lengths
    centres: Points,  # (b,) of blocks of BLOCK points
    moments: Points,  # (b,) sums of their dipoles
    radii: Numbers,  # (b,)
    # outputs
    out: Numbers,  # (m,)
):
    groups = queries.shape[0] // LANES
    bits = spread(groups)
    for number in range(groups << bits):
        if is_piece(number, bits):
            group = number >> bits
            x, y, z, total = Lanes(0.0), Lanes(0.0), Lanes(0.0), Lanes(0.0)
            for i in ti.static(range(LANES)):
                query = queries[group * LANES + i]
                x[i], y[i], z[i] = query[0], query[1], query[2]
            for b in range(centres.shape[0]):
                square = squares(centres[b], x, y, z)
                far = square > REACH * REACH * radii[b] * radii[b]
                total += ti.select(far, fluxes(centres[b], moments[b], square, x, y, z), 0.0)
                if not far.all():  # softened below the size of the patch
                    for j in range(b * BLOCK, ti.min((b + 1) * BLOCK, points.shape[0])):
                        near = fluxes(points[j], dipoles[j], squares(points[j], x, y, z) + softening[j], x, y, z)
                        total += ti.select(far, 0.0, near)
            for i in ti.static(range(LANES)):
                out[group * LANES + i] = total[i] / (4.0 * ti.math.pi)


winding_numbers = started(_winding_numbers)
