"""Generalised winding numbers of oriented points."""

import taichi as ti

from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)

BLOCK = 32  # points that are summed up as one where they are far away
REACH = 2.0  # far: further away than so many radii of the block


@ti.func
def flux(d, dipole, softening: ti.f64) -> ti.f64:
    """Return d . n a / |d|^3, the solid angle of a small patch, softened below the size of the patch."""
    square = d.norm_sqr() + softening
    result = 0.0
    if square > 0.0:
        result = d.dot(dipole) / (square * ti.sqrt(square))
    return result


@ti.kernel
def _winding_numbers(
    queries: Points,  # (m,)
    points: Points,  # (n,), neighbours in space next to each other
    dipoles: Points,  # (n,), outward normals times areas
    softening: Numbers,  # (n,), squared lengths
    centres: Points,  # (b,) of blocks of BLOCK points
    moments: Points,  # (b,) sums of their dipoles
    radii: Numbers,  # (b,)
    # outputs
    out: Numbers,  # (m,)
):
    for i in queries:
        total = 0.0
        for b in range(centres.shape[0]):
            d = centres[b] - queries[i]
            if d.norm_sqr() > REACH * REACH * radii[b] * radii[b]:
                total += flux(d, moments[b], 0.0)
            else:
                for j in range(b * BLOCK, ti.min((b + 1) * BLOCK, points.shape[0])):
                    total += flux(points[j] - queries[i], dipoles[j], softening[j])
        out[i] = total / (4.0 * ti.math.pi)


winding_numbers = started(_winding_numbers)
