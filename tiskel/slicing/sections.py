"""The Fourier series of one section, and why a section has none."""

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from tiskel.arrays import MAD, Numbers, Table
from tiskel.params import SurfaceParams
from tiskel.slicing.rings import Ring

RIDGE = 1e-7  # weight of the squares of coefficients, times the fourth power of their order: for what a gap leaves open
WIDE, PROBES, HELD = 0.35, 12, 1e-4  # gaps in radians; places in each; weight of roughness there, per point
AWAY = 1.5  # the longest of its points that a series may be, and one over the shortest
HUBER, ROUNDS = 2.5, 4  # deviations beyond which points count less; rounds of weighting
OFF_SHARE = 0.1  # of the points that may be further off than a star-shaped section allows
SLOPES = 3  # columns for how the section changes along the curve: its mean and its first harmonics


class Case(str, Enum):
    """What became of a slice."""

    FITTED = "fitted"
    FEW = "too few points"
    GAP = "gap in angle too large"
    NOT_STAR = "not star-shaped about the skeleton"


@dataclass(frozen=True)
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
    """

    v: float
    case: Case
    series: Numbers
    points: int
    gap: float
    error: float


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
    none = Section(v, Case.FEW, np.zeros(0), len(ring.u), largest_gap(ring.u), np.nan)
    if len(ring.u) < max(params.least_points, 2 * order + 1 + SLOPES + 1):
        return none
    if none.gap > params.gap:
        return replace(none, case=Case.GAP)
    basis = basis_of(ring, v, order)
    weights = robust_weights(ring, basis, order)
    held = held_in_gaps(ring.u, order)
    solution = solved(basis, ring.r, weights, held)
    misfit = np.abs(ring.r - basis @ solution)
    if runs_away(solution, ring.r, order):
        return replace(none, case=Case.GAP)
    if (misfit > params.uneven * solution[0]).mean() > OFF_SHARE or solution[0] <= 0:
        return replace(none, case=Case.NOT_STAR)
    error = float(np.sqrt(np.average(misfit**2, weights=weights)) / solution[0])
    return Section(v, Case.FITTED, solution[: 2 * order + 1], len(ring.u), none.gap, error)


def largest_gap(u: Numbers) -> float:
    """Return the largest angle between neighbours among angles u (k,), in radians; 2 pi for fewer than two."""
    if len(u) < 2:
        return 2 * np.pi
    return float(gaps_of(u)[1].max())


def gaps_of(u: Numbers) -> tuple[Numbers, Numbers]:
    """Return the angles u (k,) in order, and how far it is from each to the next around the circle, in radians."""
    ordered = np.sort(np.mod(u, 2 * np.pi))
    return ordered, np.diff(np.append(ordered, ordered[0] + 2 * np.pi))


def waves_of(u: Numbers, order: int) -> Table:
    """Return (k, 2 N) for angles u (k,): sin u, cos u, sin 2u, cos 2u ... up to order N."""
    i = np.arange(1, order + 1)
    return np.stack([np.sin(u[:, None] * i), np.cos(u[:, None] * i)], axis=2).reshape(len(u), -1)


def basis_of(ring: Ring, v: float, order: int) -> Table:
    """Return (k, 2 N + 4) the columns of the fit: 1, sin u, cos u, sin 2u ..., and three that grow along the curve."""
    series = np.concatenate([np.ones((len(ring.u), 1)), waves_of(ring.u, order)], axis=1)
    return np.concatenate([series, (ring.v - v)[:, None] * series[:, :SLOPES]], axis=1)


def held_in_gaps(u: Numbers, order: int) -> Table:
    """Return (2 N + 1, 2 N + 1) the roughness of a series in the gaps of angles u (k,): the mean square of R_uu there.

    Points say nothing of waves that fit into a gap between them; this does.
    """
    ordered, widths = gaps_of(u)
    open_ends = np.flatnonzero(widths > WIDE)
    places = [ordered[i] + widths[i] * np.linspace(0, 1, PROBES + 2)[1:-1] for i in open_ends]
    if not places:
        return np.zeros((2 * order + 1, 2 * order + 1))
    at = np.concatenate(places)
    turns = -np.repeat(np.arange(1, order + 1) ** 2, 2) * waves_of(at, order)
    bend = np.concatenate([np.zeros((len(at), 1)), turns], axis=1)
    return np.asarray(bend.T @ bend / len(at))


def runs_away(solution: Numbers, r: Numbers, order: int) -> bool:
    """Tell whether a series is far from all distances r (k,) that it was fitted to, as happens in a gap."""
    u = np.linspace(0, 2 * np.pi, 20 * order, endpoint=False)
    fitted = solution[0] + waves_of(u, order) @ solution[1 : 2 * order + 1]
    return bool(fitted.max() > AWAY * r.max() or fitted.min() < r.min() / AWAY)


def normal_matrix(basis: Table, weights: Numbers, held: Table) -> Table:
    """Return the matrix of weighted least squares, with what holds the coefficients that no point determines.

    Parameters
    ----------
    basis : (k, 2 N + 4) float64
        The columns of the fit.
    weights : (k,) float64
        How much each point counts.
    held : (2 N + 1, 2 N + 1) float64
        The roughness in gaps.

    Returns
    -------
    (2 N + 4, 2 N + 4) float64
    """
    order, count = len(held) // 2, len(held)
    ridge = np.concatenate([[0.0], np.repeat(np.arange(1.0, order + 1) ** 4, 2), np.zeros(SLOPES)])
    ridge[-SLOPES:] = 1e-6 * (basis[:, -SLOPES:] ** 2).sum(axis=0) + 1e-12
    matrix = basis.T @ (weights[:, None] * basis)
    matrix[np.diag_indices(len(ridge))] += RIDGE * len(basis) * ridge
    matrix[:count, :count] += HELD * len(basis) * held
    return np.asarray(matrix)


def solved(basis: Table, r: Numbers, weights: Numbers, held: Table) -> Numbers:
    """Return (2 N + 4,) the coefficients that fit distances r (k,); other arguments as in :func:`normal_matrix`."""
    return np.linalg.solve(normal_matrix(basis, weights, held), basis.T @ (weights * r))


def robust_weights(ring: Ring, basis: Table, order: int) -> Numbers:
    """Return (k,) the weights of the points of a ring: 1, or less for those that are far off the series.

    Parameters
    ----------
    ring : Ring
        The points.
    basis : (k, 2 N + 4) float64
        The columns of the fit.
    order : int
        The order N of the series.

    References
    ----------
    P. Huber: Robust estimation of a location parameter. Annals of Mathematical Statistics 35(1), 1964.
    """
    r, weights, held = ring.r, np.ones(len(ring.r)), held_in_gaps(ring.u, order)
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
    basis = basis_of(ring, v, order)
    weights = robust_weights(ring, basis, order)
    held = held_in_gaps(ring.u, order)
    solution = solved(basis, ring.r, weights, held)
    leverage = weights * (basis * np.linalg.solve(normal_matrix(basis, weights, held), basis.T).T).sum(axis=1)
    off = (ring.r - basis @ solution) / np.maximum(1 - leverage, 0.05)
    return float(np.average(off**2, weights=weights) / solution[0] ** 2)
