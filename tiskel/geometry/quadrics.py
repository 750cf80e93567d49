"""Quadrics through neighbourhoods of oriented points.

q(x) = c + g.d + d^T H d / 2 with d = x - centre is fitted so that it vanishes at
the points and has their normals as its gradients: near them it is the signed
distance. Spheres, cylinders and pairs of parallel planes are quadrics exactly, so
that a neighbourhood may reach around a thin part. On noisy samples of ellipsoids
and tori curvatures are half as far off as those of height fields over the tangent
plane, of second or third degree (Guennebaud and Gross, Algebraic point set
surfaces, SIGGRAPH 2007, show the same of spheres).
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Lists, Numbers, Points, Stack, Table

TERMS = 10  # of a quadric: 1, x, y, z, xx/2, yy/2, zz/2, xy, xz, yz
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # xx, yy, zz, xy, xz, yz
HELD = 0.3  # weight of gradients, in radii; 0.1 doubles errors of curvature where there is noise, 1 where there is none
RIDGE = 1e-7  # of the sum of weights: for what no point determines, as on a line of points
HELD_ALIKE = np.array([1.0] * 7 + [2.0] * 3)  # mixed terms stand twice in a Hessian: so it is held in all axes alike
LEAST_LEFT = 0.2  # of a point's own residual: what it is off the others is at most five times that
BATCH = 2048  # neighbourhoods at a time, which bounds the memory


class Quadrics(NamedTuple):
    """Quadrics about m centres, in the unit of length of the points.

    Attributes
    ----------
    value : (m,) float64
        c, a length.
    gradient : (m, 3) float64
        g, without unit.
    hessian : (m, 6) float64
        xx, yy, zz, xy, xz and yz of H, in 1 / length.
    error : (m,) float64
        How far points are off the quadric through the others, root of the weighted mean square.
    """

    value: Numbers
    gradient: Points
    hessian: Table
    error: Numbers

    def at(self, rows: npt.NDArray[np.integer[Any]]) -> "Quadrics":
        """Return those of some rows."""
        return Quadrics(*(column[rows] for column in self))

    def moved(self, by: Points) -> "Quadrics":
        """Return the same functions about centres moved by (m, 3)."""
        bent = np.einsum("mij,mj->mi", matrices(self.hessian), by)
        value = self.value + (self.gradient * by).sum(axis=1) + (bent * by).sum(axis=1) / 2
        return self._replace(value=value, gradient=self.gradient + bent)


def matrices(hessian: Table) -> Stack:
    """Return symmetric matrices (m, 3, 3) from xx, yy, zz, xy, xz and yz (m, 6)."""
    out = np.empty((len(hessian), 3, 3))
    for (a, b), column in zip(PAIRS, hessian.T, strict=True):
        out[:, a, b] = out[:, b, a] = column
    return out


def fit_quadrics(
    centres: Points, points: Points, normals: Points, lists: Lists, weights: Table, radii: Numbers
) -> Quadrics:
    """Return the quadrics that are nearest to neighbourhoods, in the mean of weighted squares.

    Parameters
    ----------
    centres : (m, 3) float64
        In any unit.
    points : (n, 3) float64
        In the same unit.
    normals : (n, 3) float64
        Unit vectors, out of the body.
    lists : (m, k) int32
        Rows of the points about each centre.
    weights : (m, k) float64
        How much each counts, 0 for none.
    radii : (m,) float64
        How far the neighbourhoods reach.

    Returns
    -------
    Quadrics

    Examples
    --------
    Of points on a sphere of radius 2: (|x|^2 - 4) / 4.

    >>> import numpy as np
    >>> from tiskel.geometry.quadrics import fit_quadrics
    >>> normals = np.random.default_rng(4).normal(size=(40, 3))
    >>> normals /= np.linalg.norm(normals, axis=1)[:, None]
    >>> everyone = np.arange(40, dtype=np.int32)[None]
    >>> found = fit_quadrics(np.zeros((1, 3)), 2 * normals, normals, everyone, np.ones((1, 40)), np.array([2.0]))
    >>> round(float(found.value[0]), 4), (np.abs(found.hessian[0]).round(4) + 0.0).tolist()
    (-1.0, [0.5, 0.5, 0.5, 0.0, 0.0, 0.0])
    """
    parts = [
        _fitted(centres[some], points[lists[some]], normals[lists[some]], weights[some], radii[some])
        for some in (slice(first, first + BATCH) for first in range(0, max(len(centres), 1), BATCH))
    ]
    return Quadrics(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _fitted(centres: Points, points: Stack, normals: Stack, weights: Table, radii: Numbers) -> Quadrics:
    d = (points - centres[:, None]) / radii[:, None, None]
    rows = terms(d)
    weighted = rows * weights[:, :, None]
    matrix = np.matmul(weighted.transpose(0, 2, 1), rows)
    right = np.matmul(weighted[:, :, :4].transpose(0, 2, 1), normals)  # sums of w n and of w d n^T
    matrix, target = matrix + HELD**2 * _of_slopes(matrix), HELD**2 * _of_normals(right)
    diagonal = np.arange(TERMS)
    matrix[:, diagonal, diagonal] += RIDGE * matrix[:, :1, 0] * HELD_ALIKE + 1e-300
    inverse = np.linalg.inv(matrix)
    found = np.matmul(inverse, target[:, :, None])[:, :, 0]
    off = np.matmul(rows, found[:, :, None])[:, :, 0]
    own = weights * (np.matmul(rows, inverse) * rows).sum(axis=2)
    left_out = off / np.maximum(1 - own, LEAST_LEFT)
    mean = (weights * left_out**2).sum(axis=1) / np.maximum(weights.sum(axis=1), 1e-300)
    return Quadrics(found[:, 0] * radii, found[:, 1:4], found[:, 4:] / radii[:, None], np.sqrt(mean) * radii)


def terms(d: Stack) -> Stack:
    """Return the terms of quadrics (m, k, 10) at offsets (m, k, 3)."""
    x, y, z = (d[:, :, axis] for axis in range(3))
    return np.stack([np.ones_like(x), x, y, z, x * x / 2, y * y / 2, z * z / 2, x * y, x * z, y * z], axis=2)


def _of_slopes(m: Stack) -> Stack:
    """Return the sums (m, 10, 10) of weighted products of gradients of the terms, from those of the terms themselves.

    The gradients of the terms are 0, constants, and offsets: what is summed is in
    the first four rows already.
    """
    out = np.zeros_like(m)
    slopes: list[dict[int, int]] = [{1 + a: 0} for a in range(3)]  # of each axis: term -> the term that it becomes
    for term, (a, b) in enumerate(PAIRS, 4):
        slopes[a][term] = 1 + b
        slopes[b][term] = 1 + a
    for slope in slopes:
        for i, u in slope.items():
            for j, v in slope.items():
                out[:, i, j] += m[:, u, v]
    return out


def _of_normals(sums: Stack) -> Table:
    """Return the sums (m, 10) of weighted products of gradients and normals, from those of 1 and d with normals."""
    out = np.zeros((len(sums), TERMS))
    out[:, 1:4] = sums[:, 0]
    for term, (a, b) in enumerate(PAIRS, 4):
        out[:, term] = sums[:, 1 + b, a] + (sums[:, 1 + a, b] if a != b else 0)
    return out
