"""How far the points of a cloud are apart: one definition for all rooms.

The spacing about a point is the side of the square that holds one point, for the
k-th nearest other at distance d: pi d^2 holds k points, so the side is
d sqrt(pi / k). On a random sample that is unbiased, where the distance to the
nearest other is half of it; on a square lattice it is 0.89 of the lattice's side.
"""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers, Points, Table

NEIGHBOURS = 4  # others that are counted: the four sides of a square lattice
SAMPLED = 8192  # points of a sample whose median spacing is within 2 % of that of all


def spacings_from(squares: Table) -> Numbers:
    """Return the spacing about each point.

    Parameters
    ----------
    squares : (n, k) float64
        Squared distances to the k nearest points, the point itself first.

    Returns
    -------
    (n,) float64
        In the root of that unit.

    Examples
    --------
    >>> import numpy as np
    >>> float(spacings_from(np.array([[0.0, 1, 1, 1, 1]]))[0].round(3))
    0.886
    """
    k = min(NEIGHBOURS, squares.shape[1] - 1)
    return np.asarray(np.sqrt(squares[:, k]) / np.sqrt(max(k, 1) / np.pi))


def spacing_of(points: Points, tree: cKDTree | None = None, most: int | None = None) -> float:
    """Return the median spacing of points.

    Parameters
    ----------
    points : (n, 3) float64
        In any unit.
    tree : cKDTree, optional
        Of the points, where there is one.
    most : int, optional
        How many points are looked at, evenly along the first axis; not given: all.

    Returns
    -------
    float
        In the unit of the points; 0 of fewer than two.
    """
    if len(points) < 2:
        return 0.0
    tree = cKDTree(points) if tree is None else tree
    if most is not None and len(points) > most:
        points = points[np.argsort(points[:, 0])[:: -(-len(points) // most)]]
    distances = tree.query(points, k=min(NEIGHBOURS + 1, tree.n))[0]
    return float(np.median(spacings_from(distances**2)))
