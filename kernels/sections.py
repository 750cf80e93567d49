"""Cross-sections of a cloud: which points lie in which slab, and where in its plane, all slabs at once."""

from .engine import ti
from .runtime import started
from .spreading import is_piece, spread

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)
Indices = ti.types.ndarray(dtype=ti.i32, ndim=1)
Offsets = ti.types.ndarray(dtype=ti.i64, ndim=1)


@ti.func
def in_section(offset, direction, half: ti.f64, reach: ti.f64) -> bool:
    """Tell whether an offset from a centre is within half along a unit direction and within reach across it."""
    along = offset.dot(direction)
    return ti.abs(along) <= half and offset.norm_sqr() - along * along <= reach * reach


@ti.kernel
def _section_counts(points: Points, centres: Points, x: Points, half: ti.f64, reach: Numbers, out: Indices):
    """Number of points no further than half from each plane and reach from its centre in it."""
    bits = spread(centres.shape[0])
    for number in range(centres.shape[0] << bits):
        if is_piece(number, bits):
            s = number >> bits
            count = 0
            for j in range(points.shape[0]):
                if in_section(points[j] - centres[s], x[s], half, reach[s]):
                    count += 1
            out[s] = count


@ti.kernel
def _section_points(
    points: Points,  # (n,)
    centres: Points,  # (s,)
    x: Points,  # (s,) unit normals of the planes
    y: Points,  # (s,) unit directions in the planes
    z: Points,  # (s,)
    half: ti.f64,
    reach: Numbers,  # (s,)
    offsets: Offsets,  # (s,) where the points of each section begin
    # outputs, as long as all counts together
    rows: Indices,
    across: Numbers,  # along y
    up: Numbers,  # along z
    ahead: Numbers,  # along x
):
    """Rows of these points, ascending in every section, and where they are in its frame."""
    bits = spread(centres.shape[0])
    for number in range(centres.shape[0] << bits):
        if is_piece(number, bits):
            s = number >> bits
            at = offsets[s]
            for j in range(points.shape[0]):
                offset = points[j] - centres[s]
                if in_section(offset, x[s], half, reach[s]):
                    rows[at] = j
                    across[at] = offset.dot(y[s])
                    up[at] = offset.dot(z[s])
                    ahead[at] = offset.dot(x[s])
                    at += ti.i64(1)


section_counts = started(_section_counts)
section_points = started(_section_points)
