"""One-rings of a cloud, and what a contraction step takes from them."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from tiskel.arrays import Indices, Lists, Masks, Numbers, Points
from tiskel.geometry import numpy_kernels


@dataclass(frozen=True, eq=False)
class Rings:
    """The ring of every point: its neighbours in order around it.

    Attributes
    ----------
    members : (n, w) int32, rows padded with -1.
    sizes : (n,) int32, members per row.
    closed : (n,) int32, 1 where the last member connects to the first.
    """

    members: Lists
    sizes: Indices
    closed: Indices

    def __len__(self) -> int:
        return len(self.sizes)

    def mask(self) -> Masks:
        """Return which entries of members are filled."""
        return np.arange(self.members.shape[1]) < self.sizes[:, None]

    def of(self, point: int) -> Indices:
        """Return the ring of one point, without padding."""
        return self.members[point, : self.sizes[point]]

    def take(self, rows: Indices) -> "Rings":
        """Return the rings of some points only; their members keep their names."""
        return Rings(np.ascontiguousarray(self.members[rows]), self.sizes[rows], self.closed[rows])


def smallest_distances(points: Points, rings: Rings) -> Numbers:
    """Return S_i, the smallest distance from each point to its ring (print: the mean distance).

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    rings : Rings
        Of all points.

    Returns
    -------
    (n,) float64
        In the unit of the points; 0 for an empty ring.
    """
    if numpy_kernels.instead(len(points)):
        return numpy_kernels.smallest_distances(points, rings.members, rings.sizes)
    from tiskel.kernels import laplacian as kernel

    out = np.empty(len(points))
    kernel.smallest_distances(points, rings.members, rings.sizes, out)
    return out


def mean_ring_length(points: Points, rings: Rings, *, count_first_twice: bool) -> float:
    """Return the mean over all points of the mean distance to their ring.

    The toolbox repeats the first member of a closed ring at its end and counts
    it twice; that sets the first contraction weight, so lbc follows it.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    rings : Rings
        Of all points.
    count_first_twice : bool
        Whether to do as the toolbox.

    Returns
    -------
    float
        In the unit of the points; an empty ring counts as 0.
    """
    from tiskel.kernels import laplacian as kernel

    out = np.empty(len(points))
    twice = rings.closed if count_first_twice else np.zeros_like(rings.closed)
    kernel.mean_distances(points, rings.members, rings.sizes, twice, out)
    return float(out.mean())


def cotangent_laplacian(points: Points, rings: Rings, cap: float) -> sparse.csr_array:
    """Return L with L_ij = w_ij = cot a_ij + cot b_ij and L_ii = -sum_j w_ij (Au et al. 2008, equation 1).

    The angles are those opposite edge (i, j) in the triangles of the ring of i,
    so L is not symmetric. A row whose absolute sum passes the cap is scaled
    down to it; a ring without a triangle has a zero row.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    rings : Rings
        Of all points.
    cap : float
        The largest absolute sum of a row, without unit.

    Returns
    -------
    (n, n) sparse array, float64
    """
    from tiskel.kernels import laplacian as kernel

    weights, diagonal = np.empty(rings.members.shape), np.empty(len(points))
    kernel.cotangent_weights(points, rings.members, rings.sizes, rings.closed, cap, weights, diagonal)
    n, filled = len(points), rings.mask()
    rows = np.repeat(np.arange(n, dtype=np.int32), rings.sizes)
    everyone = np.arange(n, dtype=np.int32)
    values = np.concatenate([weights[filled], diagonal])
    where = np.concatenate([rows, everyone]), np.concatenate([rings.members[filled], everyone])
    return sparse.csr_array(sparse.coo_array((values, where), shape=(n, n)))
