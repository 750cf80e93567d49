"""Principal axes of neighbourhoods."""

from .engine import ti
from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)
Axes = ti.types.ndarray(dtype=ti.types.matrix(3, 3, ti.f64), ndim=1)

SWEEPS = 8  # cyclic Jacobi on a 3 x 3 matrix converges quadratically; five sweeps reach machine precision


@ti.func
def rotate(a_p, a_q, a_r, v_p, v_q, p: ti.template(), q: ti.template()):
    """Apply the Jacobi rotation that zeroes a[p, q].

    Of the matrix a its rows p, q and the third, of the product of all rotations its columns p and q, are taken and
    returned. Written out: as products of matrices, Taichi took four times as long to lay this out before it ran.
    """
    c, s = 1.0, 0.0
    if ti.abs(a_p[q]) > 1e-300:
        theta = (a_q[q] - a_p[p]) / (2.0 * a_p[q])
        t = 1.0 / (ti.abs(theta) + ti.sqrt(theta * theta + 1.0))
        if theta < 0.0:
            t = -t
        c = 1.0 / ti.sqrt(t * t + 1.0)
        s = t * c
    b_p, b_q, b_r = c * a_p - s * a_q, s * a_p + c * a_q, a_r
    x, y = ti.Vector([b_p[p], b_q[p], b_r[p]]), ti.Vector([b_p[q], b_q[q], b_r[q]])
    low, high = c * x - s * y, s * x + c * y
    b_p[p], b_q[p], b_r[p] = low[0], low[1], low[2]
    b_p[q], b_q[q], b_r[q] = high[0], high[1], high[2]
    return b_p, b_q, b_r, c * v_p - s * v_q, s * v_p + c * v_q


@ti.func
def eigenvectors(covariance):
    """Return eigenvalues, descending, and the matrix whose rows are their eigenvectors."""
    x, y, z = covariance[0, :], covariance[1, :], covariance[2, :]
    u, v, w = ti.Vector([1.0, 0.0, 0.0]), ti.Vector([0.0, 1.0, 0.0]), ti.Vector([0.0, 0.0, 1.0])
    for _ in range(SWEEPS):
        x, y, z, u, v = rotate(x, y, z, u, v, 0, 1)
        x, z, y, u, w = rotate(x, z, y, u, w, 0, 2)
        y, z, x, v, w = rotate(y, z, x, v, w, 1, 2)
    rows = ti.Matrix.rows([u, v, w])
    values = ti.Vector([x[0], y[1], z[2]])
    for pair in ti.static(((0, 1), (0, 2), (1, 2))):
        i, j = ti.static(pair[0]), ti.static(pair[1])
        if values[i] < values[j]:
            values[i], values[j] = values[j], values[i]
            for c in ti.static(range(3)):
                rows[i, c], rows[j, c] = rows[j, c], rows[i, c]
    return values, rows


@ti.kernel
def _principal_axes(
    points: Points,  # (n,)
    neighbours: Table,  # (n, k)
    # outputs
    values: Points,  # (n,) eigenvalues of the covariance, descending
    axes: Axes,  # (n,) eigenvectors as rows
):
    k = neighbours.shape[1]
    for i in values:
        mean = ti.Vector([0.0, 0.0, 0.0])
        for j in range(k):
            mean += points[neighbours[i, j]]
        mean /= k
        covariance = ti.Matrix.zero(ti.f64, 3, 3)
        for j in range(k):
            d = points[neighbours[i, j]] - mean
            covariance += d.outer_product(d)
        values[i], axes[i] = eigenvectors(covariance / k)


principal_axes = started(_principal_axes)
