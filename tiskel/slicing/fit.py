"""The stage ``slice``: a skeleton and its cloud in, a Fourier surface for every branch out.

Departures from print (Wen et al. 2025), which has the skeleton curve as a Fourier series over one of the Cartesian
coordinates, and keeps it where the contraction left it:

- The curve is a smoothing spline over arc length (:mod:`tiskel.slicing.axis`): a U-shaped one has no coordinate to go
  over.
- It moves to the middles of its sections before the surface is fitted (``recentre``).
- A slab is at least 1.5 spacings of the points thick, whatever the interval between slices: thinner ones are empty.
- Slices at the ends that have no section are trimmed, and told; between fitted ones they are bridged.
- All sections share one order, raised only while the cross-validated error falls; print's rule is
  ``order_rule="published"``, each section its own until its RMS error is below 1e-3 in the unit of length.
- Coefficients are joined along the curve with continuous second derivatives, where print leaves that open.
"""

from collections import Counter
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Mask, Points, PointsLike, diagonal
from tiskel.errors import TiskelError
from tiskel.geometry.frames import step_lengths
from tiskel.geometry.given import given_cloud
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.spacing import spacing_of
from tiskel.geometry.strays import body_rows
from tiskel.params import SurfaceParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import SurfaceSettings
from tiskel.progress import Report, Span
from tiskel.skeleton import Skeleton
from tiskel.slicing.axis import evened, fit_axis
from tiskel.slicing.coverage import coverage_of
from tiskel.slicing.cutter import INTERVALS, LEAST_SLICES, Cutter, Rejected, places_of, recentred, why_not
from tiskel.slicing.doubts import doubts, misfit
from tiskel.slicing.fitted import FittedSurface, NoTubeError, Surfaces
from tiskel.slicing.mesh import mesh_report
from tiskel.slicing.paths import LEAST_NODES, Path, dense, paths_of
from tiskel.slicing.sections import Case, Section
from tiskel.slicing.series import chosen_order, fit_sections, joined_series
from tiskel.surfaces.tube import V_STOP, Tube

SLAB = 0.75  # spacings that a slab is thick to each side, at least
LINKED, LINKED_RADII = 2.0, 0.3  # spacings, or radii, between neighbours of one ring
RECENTRINGS = 2  # rounds


def fit_surface(
    skeleton: CurveGraph, params: SurfaceParams | None = None, cloud: PointsLike | None = None, *,
    progress: Report | None = None, **settings: Unpack[SurfaceSettings],
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
    cloud : (n, 3) array, Cloud, or object of Open3D or trimesh, optional
        The cloud around a curve from elsewhere, in its unit; a skeleton brings its own.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the fit.
    **settings
        Those of :class:`tiskel.SurfaceParams` by name; over those of params.

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
    params, span = settled(SurfaceParams, params, settings), Span(progress, "slice")
    span.at(0, "cloud")
    if isinstance(skeleton, Skeleton):
        every, owner = skeleton.cloud if cloud is None else given_cloud(cloud)[0], skeleton.node_of_point
        owned = len(owner) == len(every)
    elif cloud is None:
        raise TiskelError("a curve needs the cloud that it runs through; give it, or a skeleton of tiskel")
    else:
        every, owned = given_cloud(cloud)[0], False
    body, surfaces, rejected = body_rows(every), [], {}
    scale = diagonal(every[body])
    for number, path in enumerate(paths := paths_of(skeleton, params.branch)):
        span.at(number / len(paths), f"branch {path.name}")
        near = body & np.isin(owner, path.nodes) if owned else body
        try:
            surfaces.append(_fitted(path, skeleton.nodes, every, near, owned, params, scale))
        except Rejected as reason:
            rejected[path.name] = str(reason)
    if not surfaces:
        raise NoTubeError(rejected)
    span.at(1)
    whole = sum(_length(path, skeleton.nodes) for path in paths_of(skeleton, "all"))
    found = Surfaces(tuple(surfaces), rejected, every)
    return replace(found, coverage=coverage_of(found, body, skeleton.nodes, whole))


def _fitted(
    path: Path, nodes: Points, cloud: Points, own: Mask, owned: bool, params: SurfaceParams, scale: float
) -> FittedSurface:
    near, interval = np.flatnonzero(own).astype(np.int32), params.interval * scale
    points, count = np.ascontiguousarray(cloud[near]), _slices(path, nodes, interval)
    if len(near) < params.least_points:
        raise Rejected(f"{len(near)} points lie about it")
    radius = float(np.median(cKDTree(dense(nodes[path.nodes], interval)).query(points)[0])) if owned else interval
    coarse = min(max(len(path.nodes) // 2, INTERVALS[0]), max(count // 2, INTERVALS[0]))
    axis = fit_axis(nodes[path.nodes], np.ones(len(path.nodes)), radius, coarse, closed=path.closed)
    spacing = spacing_of(points)
    half, link = max(interval / 2, SLAB * spacing), max(LINKED * spacing, LINKED_RADII * radius)
    cutter = Cutter(points, owned, half, link, radius, params)
    for _ in range(RECENTRINGS if params.recentre else 0):
        axis, cutter = recentred(axis, cutter, count)
    trimmed: Counter[str] = Counter()
    order = None
    while True:
        intervals = int(np.clip(count // 2, *INTERVALS))
        axis = evened(axis, intervals) if axis.intervals != intervals else axis
        field, frame, note = cutter.field(axis)
        rings = cutter.rings(axis, field, places_of(count))
        pairs = list(zip(places_of(count).tolist(), rings, strict=True))
        order = order or chosen_order(pairs, params)
        sections = fit_sections(pairs, order, params, path.closed)
        first, last = _span(sections)
        if path.closed or last - first == count:
            break
        trimmed += Counter(section.case.value for section in (*sections[:first], *sections[last:]))
        axis, count = evened(axis, intervals, first / count * V_STOP, last / count * V_STOP), last - first
    tube = Tube(axis, field, joined_series(sections, intervals, path.closed))
    rows, error = misfit(tube, rings, sections)
    fitted = FittedSurface(
        tube, path.name, path.nodes, frame, sections, dict(trimmed), near[rows], error, {},
        float(np.median(tube.series.along(places_of(count))[:, 0, 0])), tube.length(), cloud, note, (),
    )  # fmt: skip
    return replace(fitted, distance=mesh_report(fitted), warnings=doubts(fitted))


def _span(sections: tuple[Section, ...]) -> tuple[int, int]:
    """Return the first fitted slice and the one after the last: beyond them nothing says where the surface is."""
    fitted = np.flatnonzero([section.case is Case.FITTED for section in sections])
    if len(fitted) < LEAST_SLICES:
        raise Rejected(why_not(sections))
    return int(fitted[0]), int(fitted[-1]) + 1


def _slices(path: Path, nodes: Points, interval: float) -> int:
    if len(path.nodes) < LEAST_NODES:
        raise Rejected(f"it has {len(path.nodes)} node{'s' * (len(path.nodes) > 1)}, a curve needs {LEAST_NODES}")
    length = _length(path, nodes)
    count = round(length / interval)
    if count < LEAST_SLICES:
        raise Rejected(f"it is {length:.4g} long, too short for {LEAST_SLICES} slices {interval:.4g} apart")
    return count


def _length(path: Path, nodes: Points) -> float:
    return float(step_lengths(nodes[path.nodes]).sum())
