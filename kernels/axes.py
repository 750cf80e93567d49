"""Principal axes of neighbourhoods."""

import taichi as ti

from .runtime import started

Points = ti.types.ndarray(dtype=ti.types.vector(3, ti.f64), ndim=1)
Table = ti.types.ndarray(dtype=ti.i32, ndim=2)
Axes = ti.types.ndarray(dtype=ti.types.matrix(3, 3, ti.f64), ndim=1)

SWEEPS = 8  # cyclic Jacobi on a 3 x 3 matrix converges quadratically; five sweeps reach machine precision


@ti.func
def rotate(a, v, p: ti.template(), q: ti.template()):
    """Apply the Jacobi rotation that zeroes a[p, q]; the columns of v collect the rotations."""
    if ti.abs(a[p, q]) > 1e-300:
        theta = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
        t = 1.0 / (ti.abs(theta) + ti.sqrt(theta * theta + 1.0))
        if theta < 0.0:
            t = -t
        c = 1.0 / ti.sqrt(t * t + 1.0)
        s = t * c
        g = ti.Matrix.identity(ti.f64, 3)
        g[p, p], g[q, q], g[p, q], g[q, p] = c, c, s, -s
        a = g.transpose() @ a @ g
        v = v @ g
    return a, v


@ti.func
def eigenvectors(covariance):
    """Return eigenvalues, descending, and the matrix whose rows are their eigenvectors."""
    a = covariance
    v = ti.Matrix.identity(ti.f64, 3)
    for _ in range(SWEEPS):
        a, v = rotate(a, v, 0, 1)
        a, v = rotate(a, v, 0, 2)
        a, v = rotate(a, v, 1, 2)
    rows = v.transpose()
    values = ti.Vector([a[0, 0], a[1, 1], a[2, 2]])
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
