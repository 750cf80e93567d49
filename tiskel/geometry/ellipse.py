"""Ellipses through points of a section."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Numbers, Table

LEAST = 5  # points that determine a conic
FLAT = 1e-8  # relative: a scatter matrix worse conditioned says nothing


@dataclass(frozen=True, eq=False)
class Ellipse:
    """An ellipse in a plane.

    Attributes
    ----------
    centre : (2,) float64
        In the unit of the points.
    axes : (2,) float64
        The semi-axes, the longer first, in the same unit.
    """

    centre: Numbers
    axes: Numbers


def fit_ellipse(points: Table) -> Ellipse | None:
    """Return the ellipse of least algebraic distance to points of a plane.

    Fitzgibbon, Pilu and Fisher (PAMI 1999), in the numerically stable form of
    Halir and Flusser (WSCG 1998): minimise |D a|^2 under 4 a c - b^2 = 1.

    Parameters
    ----------
    points : (n, 2) float64
        In any unit.

    Returns
    -------
    Ellipse or None
        None for fewer than five points, for points on a line, and where no solution is an ellipse.
    """
    if len(points) < LEAST:
        return None
    mean = points.mean(axis=0)
    scale = np.abs(points - mean).max()
    conic = _conic((points - mean) / scale) if scale > 0 else None
    found = None if conic is None else _centre_and_axes(conic)
    return None if found is None else Ellipse(found[0] * scale + mean, found[1] * scale)


def _conic(p: Table) -> Numbers | None:
    """Return a, b, c, d, e, f of a x^2 + b x y + c y^2 + d x + e y + f = 0."""
    x, y = p.T
    quadratic, linear = np.stack([x * x, x * y, y * y], axis=1), np.stack([x, y, np.ones_like(x)], axis=1)
    s1, s2, s3 = quadratic.T @ quadratic, quadratic.T @ linear, linear.T @ linear
    if np.linalg.cond(s3) > 1 / FLAT:
        return None
    reduce = -np.linalg.solve(s3, s2.T)
    m = s1 + s2 @ reduce
    _, vectors = np.linalg.eig(np.stack([m[2] / 2, -m[1], m[0] / 2]))
    real = np.real(vectors.T)
    ellipses = real[4 * real[:, 0] * real[:, 2] - real[:, 1] ** 2 > 0]
    return np.concatenate([ellipses[0], reduce @ ellipses[0]]) if len(ellipses) else None


def _centre_and_axes(conic: Numbers) -> tuple[Numbers, Numbers] | None:
    a, b, c, d, e, f = conic
    matrix = np.array([[a, b / 2], [b / 2, c]])
    centre = np.linalg.solve(2 * matrix, [-d, -e])
    value = f + (d * centre[0] + e * centre[1]) / 2
    squares = -value / np.linalg.eigvalsh(matrix)
    return (centre, np.sqrt(np.sort(squares)[::-1])) if (squares > 0).all() and np.isfinite(squares).all() else None
