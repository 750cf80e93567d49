"""Local point reduction of GLSkeleton: which points merge, and the rings they leave (Wen et al. 2024).

Departures from the toolbox, which departs from its paper (the paper is followed here):

- U compares every point's Laplacian coordinate with its own ring; the toolbox takes that of point 1 throughout.
- psi is the mean ring *shrinkage* in the first step too; the toolbox takes the remaining ratio there.
- Merges of one step are simultaneous: the matching is on the rings as the step found them, removed members take
  the name of the point they merged into, and only then are rings rebuilt. The toolbox renames as it goes.
- Renaming drops every repeat; the toolbox only those side by side, so that a ring can hold a member twice.
- An open merged ring needs three members like a closed one; the toolbox asks for four.
- A step without a merge does not turn reduction off.

With the toolbox's departures, :mod:`tiskel.methods.laplacian.toolbox_gls` leaves its points, one for one.
"""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Indices, Lists, Mask, Numbers, Points, Stack
from tiskel.geometry.frames import across, unit
from tiskel.geometry.neighbours import one_rings
from tiskel.geometry.rings import Rings

MIN_RING = 3  # members that a merged ring must keep


@dataclass(frozen=True, eq=False)
class Merge:
    """The result of one reduction, in the rows of the cloud before it.

    Attributes
    ----------
    merged_into : (n,) int32
        The row that each removed point was merged into; -1 for the others.
    rings : Rings
        Of all rows; those of removed points have no meaning.
    """

    merged_into: Indices
    rings: Rings

    def kept(self) -> Indices:
        """Return (m,) the rows that stay, ascending."""
        return np.flatnonzero(self.merged_into < 0).astype(np.int32)


def stage_function(
    origin: Points, points: Points, delta: Points, rings: Rings, first_sizes: Numbers, sizes: Numbers, *,
    shrinkage: float, contraction_weight: float, attraction_weight: float = 1.0, guard: float,
) -> Numbers:  # fmt: skip
    """Return F = V1 - V2 + 3 U of every point.

    Parameters
    ----------
    origin : (n, 3) float64
        The points before all contraction, in normalised coordinates.
    points : (n, 3) float64
        The points just contracted.
    delta : (n, 3) float64
        Laplacian coordinates L P, of the step's L and the cloud before its solve.
    rings : Rings
        Of the points, as the step found them.
    first_sizes : (n,) float64
        Ring sizes s_i(0).
    sizes : (n,) float64
        Ring sizes s_i(k).
    shrinkage : float
        psi' = epsilon psi.
    contraction_weight : float
        s_L^(k+2) w_l(0).
    attraction_weight : float
        w_h(0).
    guard : float
        Stands in for eta s_i(0) where that is not positive.

    Returns
    -------
    (n,) float64
    """
    from tiskel.kernels import reduction as kernel

    out = np.empty(len(points))
    kernel.stage_function(
        origin,
        points,
        delta,
        rings.members,
        rings.sizes,
        first_sizes,
        sizes,
        shrinkage,
        contraction_weight,
        attraction_weight,
        guard,
        out,
    )
    return out


def matching(points: Points, rings: Rings, marked: Mask) -> Indices:
    """Match points that may merge with ring members.

    Each marked point asks for its nearest ring member, in index order, and has it
    where both are still free.

    Parameters
    ----------
    points : (n, 3) float64
        The contracted points.
    rings : Rings
        Of all of them.
    marked : (n,) bool
        Which may merge.

    Returns
    -------
    (n,) int32
        For each point the row it merges into; -1 for those that stay.
    """
    from tiskel.kernels import reduction as kernel

    n = len(points)
    partner, merged_into = np.empty(n, np.int32), np.full(n, -1, np.int32)
    kernel.nearest_members(points, rings.members, rings.sizes, marked.astype(np.int32), partner)
    kernel.greedy_matching(partner, np.zeros(n, np.int32), merged_into)
    return merged_into


def merge(origin: Points, rings: Rings, merged_into: Indices, directions: Points) -> Merge:
    """Merge the matched points at once and rebuild the rings that change.

    Ring i becomes the one-ring of i among the members of both rings, on their
    original positions, projected along directions[i]; every other ring only
    renames. A merge whose ring would fall below three members does not happen.

    Parameters
    ----------
    origin : (n, 3) float64
        The points before all contraction.
    rings : Rings
        Of all points, as the step found them.
    merged_into : (n,) int32
        A matching: the row that each point merges into, -1 for those that stay.
    directions : (n, 3) float64
        What each merged ring is projected along, of any length but zero.

    Returns
    -------
    Merge
        With the merges that happened.
    """
    merged_into = merged_into.copy()
    while True:
        renamed = rename(rings, merged_into)
        removed = np.flatnonzero(merged_into >= 0).astype(np.int32)
        keepers = merged_into[removed]
        rebuilt = one_rings(origin, keepers, _unions(renamed, keepers, removed), projections(directions[keepers]))
        failed = removed[rebuilt.sizes < MIN_RING]
        if len(failed) == 0:
            return Merge(merged_into, _replaced(renamed, keepers, rebuilt))
        merged_into[failed] = -1


def rename(rings: Rings, merged_into: Indices) -> Rings:
    """Return all rings with removed members under their new names, repeats and the point itself dropped.

    Parameters
    ----------
    rings : Rings
        Of all n points.
    merged_into : (n,) int32
        The new name of every removed point; -1 for the others.

    Returns
    -------
    Rings
        As wide as before.
    """
    from tiskel.kernels import reduction as kernel

    names = np.where(merged_into >= 0, merged_into, np.arange(len(merged_into))).astype(np.int32)
    members, sizes = np.empty_like(rings.members), np.empty_like(rings.sizes)
    kernel.rename(rings.members, rings.sizes, names, members, sizes)
    return Rings(members, sizes, rings.closed)


def projections(directions: Points) -> Stack:
    """Return for each direction two orthonormal vectors across it.

    Parameters
    ----------
    directions : (m, 3) float64
        Of any length but zero.

    Returns
    -------
    (m, 2, 3) float64
        C-contiguous, as the kernel of the rings wants them.
    """
    return np.ascontiguousarray(across(unit(directions)))


def _unions(rings: Rings, keepers: Indices, removed: Indices) -> Lists:
    """Return both rings of each pair side by side, repeats blanked out."""
    both = np.concatenate([rings.members[keepers], rings.members[removed]], axis=1)
    order = np.argsort(both, axis=1, kind="stable")
    ascending = np.take_along_axis(both, order, axis=1)
    repeated = np.zeros(both.shape, bool)
    np.put_along_axis(repeated, order[:, 1:], ascending[:, 1:] == ascending[:, :-1], axis=1)
    return np.where(repeated, -1, both).astype(np.int32)


def _replaced(rings: Rings, rows: Indices, new: Rings) -> Rings:
    """Return the rings with some rows replaced, as wide as needed."""
    width = max(rings.members.shape[1], new.members.shape[1])
    members = np.full((len(rings), width), -1, np.int32)
    members[:, : rings.members.shape[1]] = rings.members
    members[rows] = -1
    members[rows, : new.members.shape[1]] = new.members
    sizes, closed = rings.sizes.copy(), rings.closed.copy()
    sizes[rows], closed[rows] = new.sizes, new.closed
    return Rings(members, sizes, closed)
