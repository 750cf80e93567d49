"""A function that is blended from quadrics of compact support, with its gradient and Hessian."""

from .engine import ti
from .runtime import started

Table = ti.types.ndarray(dtype=ti.f64, ndim=2)

BLOCK = 8  # patches that share a box
LARGE = 16  # boxes that share a large box
COLUMNS = 14  # of a patch: centre, square of the support, value, gradient, and xx, yy, zz, xy, xz, yz of the Hessian
FOUND = 11  # of the blend: value, gradient, Hessian likewise, and the number of the patch that counts most


@ti.func
def apart(p, boxes: ti.template(), b: ti.i32) -> bool:
    """Tell whether a place lies outside a box."""
    out = False
    for k in ti.static(range(3)):
        out = out or p[k] < boxes[b, k] or p[k] > boxes[b, 3 + k]
    return out


@ti.func
def triple(table: ti.template(), i: ti.i32, first: ti.i32):
    """Return three numbers of a row."""
    return ti.Vector([table[i, first], table[i, first + 1], table[i, first + 2]])


@ti.func
def times(h, d):
    """Return the product of a symmetric matrix, as xx, yy, zz, xy, xz, yz, and a vector."""
    return ti.Vector(
        [h[0] * d[0] + h[3] * d[1] + h[4] * d[2], h[3] * d[0] + h[1] * d[1] + h[5] * d[2],
         h[4] * d[0] + h[5] * d[1] + h[2] * d[2]]
    )  # fmt: skip


@ti.func
def crossed(a, b):
    """Return xx, yy, zz, xy, xz, yz of a b^T + b a^T."""
    return ti.Vector(
        [2.0 * a[0] * b[0], 2.0 * a[1] * b[1], 2.0 * a[2] * b[2],
         a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[2] * b[0], a[1] * b[2] + a[2] * b[1]]
    )  # fmt: skip


@ti.kernel
def _blend(
    places: Table,  # (m, 3)
    patches: Table,  # (p, COLUMNS), neighbours in space next to each other
    boxes: Table,  # (b, 6) least and largest coordinates of blocks of supports
    large: Table,  # (c, 6) of LARGE of these boxes
    # outputs
    found: Table,  # (m, FOUND); NaN, and -1 for the patch, where there is no support
):
    """f = sum w q / sum w with w = (1 - s)^4, s the squared distance over the squared support: three times smooth."""
    unit = ti.Vector([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    for m in range(places.shape[0]):
        p = triple(places, m, 0)
        w0, w1, w2 = 0.0, ti.Vector([0.0] * 3), ti.Vector([0.0] * 6)
        n0, n1, n2 = 0.0, ti.Vector([0.0] * 3), ti.Vector([0.0] * 6)
        heaviest, most = -1, 0.0
        b = 0
        while b < boxes.shape[0]:
            passed = 1
            if b % LARGE == 0 and apart(p, large, b // LARGE):
                passed = LARGE
            elif not apart(p, boxes, b):
                for i in range(b * BLOCK, ti.min((b + 1) * BLOCK, patches.shape[0])):
                    d = p - triple(patches, i, 0)
                    inverse = 1.0 / patches[i, 3]
                    left = 1.0 - d.norm_sqr() * inverse
                    if left > 0.0:
                        h = ti.Vector([patches[i, 8 + k] for k in range(6)])
                        g, hd = triple(patches, i, 5), times(h, d)
                        q, slope = patches[i, 4] + g.dot(d) + 0.5 * hd.dot(d), g + hd
                        w = left * left * left * left
                        dw = -8.0 * left * left * left * inverse * d
                        ddw = left * left * inverse * (24.0 * inverse * crossed(d, d) - 8.0 * left * unit)
                        w0, w1, w2 = w0 + w, w1 + dw, w2 + ddw
                        n0, n1 = n0 + w * q, n1 + w * slope + q * dw
                        n2 += w * h + q * ddw + crossed(dw, slope)
                        if w > most:
                            heaviest, most = i, w
            b += passed
        f = n0 / w0
        slope = (n1 - f * w1) / w0
        bend = (n2 - f * w2 - crossed(slope, w1)) / w0
        found[m, 0] = f
        for k in ti.static(range(3)):
            found[m, 1 + k] = slope[k]
        for k in ti.static(range(6)):
            found[m, 4 + k] = bend[k]
        found[m, 10] = heaviest


blend = started(_blend)
