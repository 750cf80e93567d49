"""The Fourier series of one section, and why a section has none."""

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from tiskel.arrays import MAD, Indices, Numbers, Table
from tiskel.params import SurfaceParams
from tiskel.slicing.gaps import largest_gap, roughness_in_gaps, runs_away, waves_of
from tiskel.slicing.rings import Ring

RIDGE = 1e-7  # weight of the squares of coefficients, times the fourth power of their order: for what a gap leaves open
HELD = (
    1e-4,
    1e-3,
    1e-2,
    1e-1,
)  # weights of roughness in gaps, per point; the first that keeps the series near points
UNSEEN = np.pi / 4  # angle without a point that is an unseen side, in radians
HUBER, ROUNDS = 2.5, 4  # deviations beyond which points count less; rounds of weighting
OFF_SHARE = 0.1  # of the points that may be further off than a star-shaped section allows
SECTORS = 36  # directions in which the points of a star-shaped section are all about as far away
FILLED, RIM = 0.6, 0.85  # of the farthest point in its direction: nearer ones fill a face, farther ones are its rim
SLOPES = 3  # columns for how the section changes along the curve: its mean and its first harmonics


class Case(str, Enum):
    """What became of a slice."""

    FITTED = "fitted"
    FEW = "too few points"
    GAP = "gap in angle too large"
    NOT_STAR = "not star-shaped about the skeleton"
    ROUGH = "no smooth outline near its points"


@dataclass(frozen=True, eq=False)
class Section:
    """One slice.

    Attributes
    ----------
    v : float
        Its place on the curve, from 0 to pi.
    case : Case
        What became of it.
    series : (2 N + 1,) float64
        a0, then a_i and b_i in pairs, in the input's unit; empty unless fitted.
    points : int
        How many the ring has.
    gap : float
        The largest angle without a point, in radians.
    error : float
        RMS of the misfit over the mean radius; NaN unless fitted.
    gap_at : float
        Where the middle of that angle is, in radians; NaN in files of older versions.
    """

    v: float
    case: Case
    series: Numbers
    points: int
    gap: float
    error: float
    gap_at: float = np.nan

    @property
    def unseen(self) -> float:
        """The angle of the side of which there are no points, in radians; 0 where all sides are seen."""
        return self.gap if self.gap > UNSEEN else 0.0


def fit_section(v: float, ring: Ring, order: int, params: SurfaceParams) -> Section:
    """Return the series through a ring, or the reason why there is none.

    Parameters
    ----------
    v : float
        The place of the slice, from 0 to pi.
    ring : Ring
        Its points.
    order : int
        The order N of the series.
    params : SurfaceParams
        ``least_points``, ``gap`` and ``uneven`` count.

    Returns
    -------
    Section
    """
    gap, gap_at = largest_gap(ring.u)
    none = Section(v, Case.FEW, np.zeros(0), len(ring.u), gap, np.nan, gap_at)
    if len(ring.u) < max(params.least_points, 2 * order + 1 + SLOPES + 1):
        return none
    if gap > params.gap:
        return replace(none, case=Case.GAP)
    found = _with_series(none, ring, order, params, robust=True)
    if found.case is not Case.FITTED and one_valued(ring, params.uneven):  # all of its points count: corners, too
        return _with_series(none, ring, order, params, robust=False)
    return replace(found, case=Case.NOT_STAR) if found.case is Case.ROUGH else found


def _with_series(none: Section, ring: Ring, order: int, params: SurfaceParams, *, robust: bool) -> Section:
    """Return a section with the series through its ring, else with the reason why that is none."""
    fit = held_series(ring, none.v, order, robust)
    if fit is None:
        return replace(none, case=Case.GAP)
    basis, weights, solution = fit
    misfit = np.abs(ring.r - basis @ solution)
    if solution[0] <= 0 or (misfit > params.uneven * solution[0]).mean() > OFF_SHARE:
        return replace(none, case=Case.ROUGH)
    error = float(np.sqrt(np.average(misfit**2, weights=weights)) / solution[0])
    return replace(none, case=Case.FITTED, series=solution[: 2 * order + 1], error=error)


def held_series(ring: Ring, v: float, order: int, robust: bool) -> tuple[Table, Numbers, Numbers] | None:
    """Return columns, weights and coefficients of a fit, held in gaps as little as keeps it near its points.

    None where it leaves them in a gap however it is held.
    """
    basis, rough = basis_of(ring, v, order), roughness_in_gaps(ring.u, order)
    for weight in HELD if rough.any() else HELD[:1]:
        weights = robust_weights(ring, basis, weight * rough) if robust else np.ones(len(ring.r))
        solution = solved(basis, ring.r, weights, weight * rough)
        if not runs_away(solution, ring.u, np.concatenate([ring.r, basis @ solution]), order):
            return basis, weights, solution
    return None


def one_valued(ring: Ring, uneven: float) -> bool:
    """Tell whether the points of a ring are about as far away as others in their direction."""
    sector = sectors_of(ring.u)
    typical = np.array([np.median(ring.r[sector == k]) if (sector == k).any() else 0.0 for k in range(SECTORS)])
    return bool((np.abs(ring.r - typical[sector]) > uneven * np.median(ring.r)).mean() <= OFF_SHARE)


def sectors_of(u: Numbers) -> Indices:
    """Return (k,) the numbers of the sectors that angles u (k,) are in."""
    return (np.floor(np.mod(u, 2 * np.pi) / (2 * np.pi) * SECTORS) % SECTORS).astype(np.int32)


def rim_of(ring: Ring) -> Ring | None:
    """Return the rim of a face that a slice lies in, as at the flat end of a bar: its outermost points.

    None where the ring is no such face, filled up to the middle on most sides.
    """
    sector = sectors_of(ring.u)
    outermost, innermost = np.zeros(SECTORS), np.full(SECTORS, np.inf)
    np.maximum.at(outermost, sector, ring.r)
    np.minimum.at(innermost, sector, ring.r)
    if (innermost < FILLED * outermost).sum() < SECTORS / 2:
        return None
    return ring.part(ring.r >= RIM * outermost[sector])


def basis_of(ring: Ring, v: float, order: int) -> Table:
    """Return (k, 2 N + 4) the columns of the fit: 1, sin u, cos u, sin 2u ..., and three that grow along the curve."""
    series = np.concatenate([np.ones((len(ring.u), 1)), waves_of(ring.u, order)], axis=1)
    return np.concatenate([series, (ring.v - v)[:, None] * series[:, :SLOPES]], axis=1)


def normal_matrix(basis: Table, weights: Numbers, held: Table) -> Table:
    """Return the matrix of weighted least squares, with what holds the coefficients that no point determines.

    Parameters
    ----------
    basis : (k, 2 N + 4) float64
        The columns of the fit.
    weights : (k,) float64
        How much each point counts.
    held : (2 N + 1, 2 N + 1) float64
        The roughness in gaps, weighted.

    Returns
    -------
    (2 N + 4, 2 N + 4) float64
    """
    order, count = len(held) // 2, len(held)
    ridge = np.concatenate([[0.0], np.repeat(np.arange(1.0, order + 1) ** 4, 2), np.zeros(SLOPES)])
    ridge[-SLOPES:] = 1e-6 * (basis[:, -SLOPES:] ** 2).sum(axis=0) + 1e-12
    matrix = basis.T @ (weights[:, None] * basis)
    matrix[np.diag_indices(len(ridge))] += RIDGE * len(basis) * ridge
    matrix[:count, :count] += len(basis) * held
    return np.asarray(matrix)


def solved(basis: Table, r: Numbers, weights: Numbers, held: Table) -> Numbers:
    """Return (2 N + 4,) the coefficients that fit distances r (k,); other arguments as in :func:`normal_matrix`."""
    return np.linalg.solve(normal_matrix(basis, weights, held), basis.T @ (weights * r))


def robust_weights(ring: Ring, basis: Table, held: Table) -> Numbers:
    """Return (k,) the weights of the points of a ring: 1, or less for those that are far off the series.

    Parameters
    ----------
    ring : Ring
        The points.
    basis : (k, 2 N + 4) float64
        The columns of the fit.
    held : (2 N + 1, 2 N + 1) float64
        The roughness in gaps, weighted.

    References
    ----------
    P. Huber: Robust estimation of a location parameter. Annals of Mathematical Statistics 35(1), 1964.
    """
    r, weights = ring.r, np.ones(len(ring.r))
    for _ in range(ROUNDS):
        misfit = np.abs(r - basis @ solved(basis, r, weights, held))
        scale = max(HUBER * MAD * float(np.median(misfit)), 1e-12 * float(r.max()))
        weights = 1 / np.maximum(1, misfit / scale)
    return np.asarray(weights)


def left_out_error(v: float, ring: Ring, order: int) -> float:
    """Return the mean square distance of each point from the series through the others, in squared mean radii.

    Parameters
    ----------
    v : float
        The place of the slice, from 0 to pi.
    ring : Ring
        Its points.
    order : int
        The order of the series.
    """
    basis, held = basis_of(ring, v, order), HELD[0] * roughness_in_gaps(ring.u, order)
    weights = robust_weights(ring, basis, held)
    solution = solved(basis, ring.r, weights, held)
    leverage = weights * (basis * np.linalg.solve(normal_matrix(basis, weights, held), basis.T).T).sum(axis=1)
    off = (ring.r - basis @ solution) / np.maximum(1 - leverage, 0.05)
    return float(np.average(off**2, weights=weights) / solution[0] ** 2)
