"""The stage ``slice``: a skeleton and its cloud in, a Fourier surface for every branch out."""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Mask, Numbers, Points, as_points, diagonal
from tiskel.errors import TiskelError
from tiskel.geometry.bspline import BSplineCurve
from tiskel.geometry.frames import step_lengths
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.spacing import spacing_of
from tiskel.geometry.strays import body_rows
from tiskel.params import SurfaceParams
from tiskel.progress import Report, Span
from tiskel.skeleton import Skeleton
from tiskel.slicing.axis import evened, fit_axis
from tiskel.slicing.field import fit_field
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.slicing.mesh import mesh_report
from tiskel.slicing.paths import LEAST_NODES, Path, dense, paths_of
from tiskel.slicing.rings import Ring, around, cut, frames_along
from tiskel.slicing.sections import Case, Section, fit_section
from tiskel.slicing.series import chosen_order, fit_sections, joined_series, without_unlike
from tiskel.surfaces.tube import V_STOP, Tube

TINY = 1e-300  # for quotients that may be of nothing
LEAST_SLICES = 4  # fewer do not determine how a surface changes along its curve
SLAB = 0.75  # spacings that a slab is thick to each side, at least
LINKED, LINKED_RADII = 2.0, 0.3  # spacings, or radii, between neighbours of one ring
REACH = 3.0  # radii of the curve's nearest points: how far a section looks where points have no nodes
INTERVALS = 4, 200  # of the splines; one for every two slices
RECENTRINGS, CENTRE_ORDER = 2, 2  # rounds, and the order of the series whose first terms say where the middle is
BRIDGED = 0.1  # weight of the old place of the curve where a section says nothing, and at its ends
FARTHEST = 0.5  # radii that the curve moves in a round
MISSING, OFF = 0.3, 0.1  # share of rejected slices, and misfit, that are worth a warning


class _Rejected(Exception):
    """A branch without a surface, and why."""


def fit_surface(
    skeleton: CurveGraph, params: SurfaceParams | None = None, cloud: Points | None = None, *,
    progress: Report | None = None,
) -> Surfaces:  # fmt: skip
    """Fit a Fourier surface around every branch of a skeleton (Wen et al. 2025; see :mod:`tiskel.surfaces.tube`).

    Of a tiskel skeleton every slice sees the points of its branch only; of a
    curve from elsewhere, what is around it.

    Parameters
    ----------
    skeleton : Skeleton or CurveGraph
        The curve, in any unit.
    params : SurfaceParams, optional
        The settings.
    cloud : (n, 3) float64, optional
        The cloud around a curve from elsewhere, in its unit; a skeleton brings its own.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the fit.

    Returns
    -------
    Surfaces
        One surface per branch, and the reason for every branch without.

    Raises
    ------
    TiskelError
        Where a curve comes without its cloud, or no branch has a surface; the message gives the reason of each.

    Examples
    --------
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("banana"), ShapeParams(count=1000))
    >>> surfaces = fit_surface(true, SurfaceParams(interval=0.05))
    >>> len(surfaces), surfaces[0].order, surfaces[0].error < 0.01
    (1, 3, True)
    """
    params, span = params or SurfaceParams(), Span(progress, "slice")
    span.at(0, "cloud")
    if isinstance(skeleton, Skeleton):
        every, owner = skeleton.cloud if cloud is None else as_points(cloud), skeleton.node_of_point
        owned = len(owner) == len(every)
    elif cloud is None:
        raise TiskelError("a curve needs the cloud that it runs through; give it, or a skeleton of tiskel")
    else:
        every, owned = as_points(cloud), False
    body, surfaces, rejected = body_rows(every), [], {}
    for number, path in enumerate(paths := paths_of(skeleton, params.branch)):
        span.at(number / len(paths), f"branch {path.name}")
        near = body & np.isin(owner, path.nodes) if owned else body
        try:
            surfaces.append(_fitted(path, skeleton.nodes, every, near, owned, params, diagonal(every[body])))
        except _Rejected as reason:
            rejected[path.name] = str(reason)
    if not surfaces:
        reasons = "; ".join(f"branch {name}: {reason}" for name, reason in rejected.items())
        raise TiskelError(f"no branch can be sliced: {reasons}")
    span.at(1)
    return Surfaces(tuple(surfaces), rejected, every)


@dataclass(frozen=True)
class _Cutter:
    """What all slices of a branch share: points, how thick slices are, what hangs together, how thick the body is."""

    points: Points
    owned: bool
    half: float
    link: float
    radius: float
    params: SurfaceParams

    def field(self, axis: BSplineCurve) -> tuple[BSplineCurve, str, str]:
        return fit_field(axis, self.params.m, self.radius, axis.intervals)

    def rings(self, axis: BSplineCurve, field: BSplineCurve, places: Numbers) -> list[Ring]:
        """Return the ring of every slice."""
        reach = np.full(len(places), np.inf)
        if not self.owned:
            reach = REACH * np.asarray(cKDTree(self.points).query(axis.along(places)[:, 0])[0]) + self.half
        found = cut(self.points, axis, field, places, self.half, reach, self.link)
        every, sizes = np.concatenate(found), [len(rows) for rows in found]
        all_at_once = around(self.points, every, axis, field, np.repeat(places, sizes))
        flat = every, all_at_once.u, all_at_once.v, all_at_once.r
        columns = (np.split(column, np.cumsum(sizes)[:-1]) for column in flat)
        return [Ring(*ring) for ring in zip(*columns, strict=True)]


def _fitted(
    path: Path, nodes: Points, cloud: Points, own: Mask, owned: bool, params: SurfaceParams, scale: float
) -> FittedSurface:
    near, interval = np.flatnonzero(own).astype(np.int32), params.interval * scale
    points, count = np.ascontiguousarray(cloud[near]), _slices(path, nodes, interval)
    if len(near) < params.least_points:
        raise _Rejected(f"{len(near)} points lie about it")
    radius = float(np.median(cKDTree(dense(nodes[path.nodes], interval)).query(points)[0])) if owned else interval
    coarse = min(max(len(path.nodes) // 2, INTERVALS[0]), max(count // 2, INTERVALS[0]))
    axis = fit_axis(nodes[path.nodes], np.ones(len(path.nodes)), radius, coarse, closed=path.closed)
    spacing = spacing_of(points)
    half, link = max(interval / 2, SLAB * spacing), max(LINKED * spacing, LINKED_RADII * radius)
    cutter = _Cutter(points, owned, half, link, radius, params)
    for _ in range(RECENTRINGS if params.recentre else 0):
        axis, cutter = _recentred(axis, cutter, count)
    trimmed: Counter[str] = Counter()
    order = None
    while True:
        intervals = int(np.clip(count // 2, *INTERVALS))
        axis = evened(axis, intervals) if axis.intervals != intervals else axis
        field, frame, note = cutter.field(axis)
        rings = cutter.rings(axis, field, places_of(count))
        pairs = list(zip(places_of(count).tolist(), rings, strict=True))
        order = order or chosen_order(pairs, params)
        sections = fit_sections(pairs, order, params)
        first, last = _span(sections)
        if path.closed or last - first == count:
            break
        trimmed += Counter(section.case.value for section in (*sections[:first], *sections[last:]))
        axis, count = evened(axis, intervals, first / count * V_STOP, last / count * V_STOP), last - first
    tube = Tube(axis, field, joined_series(sections, intervals, path.closed))
    rows, error = _misfit(tube, rings, sections)
    fitted = FittedSurface(
        tube, path.name, path.nodes, frame, sections, dict(trimmed), near[rows], error, {},
        float(np.median(tube.series.along(places_of(count))[:, 0, 0])), tube.length(), cloud, note, (),
    )  # fmt: skip
    return replace(fitted, distance=mesh_report(fitted), warnings=_doubts(fitted))


def places_of(count: int) -> Numbers:
    """Return (count,) v of the slices: the middles of as many even parts of the curve."""
    return np.asarray((np.arange(count) + 0.5) / count * V_STOP)


def _span(sections: tuple[Section, ...]) -> tuple[int, int]:
    """Return the first fitted slice and the one after the last: beyond them nothing says where the surface is."""
    fitted = np.flatnonzero([section.case is Case.FITTED for section in sections])
    if len(fitted) < LEAST_SLICES:
        raise _Rejected(_why(sections))
    return int(fitted[0]), int(fitted[-1]) + 1


def _slices(path: Path, nodes: Points, interval: float) -> int:
    if len(path.nodes) < LEAST_NODES:
        raise _Rejected(f"it has {len(path.nodes)} node{'s' * (len(path.nodes) > 1)}, a curve needs {LEAST_NODES}")
    length = float(step_lengths(nodes[path.nodes]).sum())
    count = round(length / interval)
    if count < LEAST_SLICES:
        raise _Rejected(f"it is {length:.4g} long, too short for {LEAST_SLICES} slices {interval:.4g} apart")
    return count


def _recentred(axis: BSplineCurve, cutter: _Cutter, count: int) -> tuple[BSplineCurve, _Cutter]:
    """Return the curve through the middles of the sections, and the cutter with their median radius."""
    field, places = cutter.field(axis)[0], places_of(count)
    loose = replace(cutter.params, uneven=np.inf)
    rings = cutter.rings(axis, field, places)
    sections = without_unlike(
        tuple(fit_section(v, ring, CENTRE_ORDER, loose) for v, ring in zip(places, rings, strict=True))
    )  # fmt: skip
    frame = frames_along(axis, field, places)
    fitted = np.array([len(section.series) > 0 for section in sections])
    if fitted.sum() < LEAST_SLICES:
        raise _Rejected(_why(sections))
    terms = np.array([section.series[:3] if len(section.series) else np.zeros(3) for section in sections])
    radius = float(np.median(terms[fitted, 0]))
    move = terms[:, 2] * np.array(frame.y) + terms[:, 1] * np.array(frame.z)
    move *= np.minimum(1, FARTHEST * radius / np.maximum(np.linalg.norm(move, axis=0), TINY))
    centres, weights, v = (np.array(frame.p) + move).T, np.where(fitted, 1.0, BRIDGED), places
    if not axis.periodic:  # the ends move with the slices next to them
        v = np.concatenate([[0.0], v, [V_STOP]])
        first, last = (axis.along(v[[end]])[:, 0] + move.T[[end]] for end in (0, -1))
        centres = np.concatenate([first, centres, last])
        weights = np.concatenate([[BRIDGED], weights, [BRIDGED]])
    intervals = int(np.clip(count // 2, *INTERVALS))
    return fit_axis(centres, weights, radius, intervals, closed=axis.periodic, v=v), replace(cutter, radius=radius)


def _why(sections: "list[Section] | tuple[Section, ...]") -> str:
    cases = Counter(section.case.value for section in sections if section.case is not Case.FITTED)
    told = ", ".join(f"{count} {case}" for case, count in cases.items())
    return f"fewer than {LEAST_SLICES} of its {len(sections)} slices can be fitted ({told})"


def _misfit(tube: Tube, rings: list[Ring], sections: tuple[Section, ...]) -> tuple[Indices, float]:
    """Return the rows of all fitted rings, and the RMS of what they are off the surface, over the mean radius."""
    good = [ring for ring, section in zip(rings, sections, strict=True) if section.case is Case.FITTED]
    rows, first = np.unique(np.concatenate([ring.rows for ring in good]), return_index=True)
    u, v, r = (np.concatenate([getattr(ring, name) for ring in good])[first] for name in ("u", "v", "r"))
    fitted = tube.at(u, v)[1].R
    return rows.astype(np.int32), float(np.sqrt(np.mean((r - fitted) ** 2)) / fitted.mean())


def _doubts(surface: FittedSurface) -> tuple[str, ...]:
    """Return warnings about a fitted surface."""
    sections = surface.sections
    lost = sum(section.case is not Case.FITTED for section in sections)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 36), np.linspace(0, V_STOP, 2 * len(sections)))
    crossing, thin = surface.tube.spread(u, v), surface.tube.at(u, v)[1].R
    told = {
        f"{lost} of {len(sections)} slices were bridged: {surface.cases()}": lost > MISSING * len(sections),
        f"the surface is off its points by {surface.error:.0%} of its radius": surface.error > OFF,
        "slices cross where the curve bends sharper than the body is thick; the surface folds there": crossing.min()
        <= 0,
        "the radius is not positive everywhere; the surface folds there": thin.min() <= 0,
    }
    return tuple(f"branch {surface.name}: {line}" for line, holds in told.items() if holds)
