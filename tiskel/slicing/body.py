"""The surface of the whole body, from a skeleton, its cloud and the tubes that were fitted to it."""

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Numbers, Points, PointsLike
from tiskel.errors import TiskelError
from tiskel.geometry.given import given_cloud
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.quadrics import Quadrics
from tiskel.geometry.strays import body_rows
from tiskel.params import BodyParams, SurfaceParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import BodySettings, SurfaceSettings
from tiskel.progress import Report, Span
from tiskel.skeleton import Skeleton
from tiskel.slicing.body_points import BodyPoints, body_points
from tiskel.slicing.body_tubes import on_tubes
from tiskel.slicing.fit import fit_surface
from tiskel.slicing.fitted import NoTubeError, Surfaces
from tiskel.surfaces.implicit import projected
from tiskel.surfaces.patches import BodySurface, Patches, Trust

FEW = 4  # neighbours; twice the distance to the last there is always another patch
LEAST_REACH = 2.0
ROUNDS, GRADE = 3, 0.7  # of grading supports, and how fast they grow
COVERED, LAID = 0.9, 0.1  # share of the points that are near, and of the surface over gaps, that are worth a warning
TUBE_WIDTH = 0.35  # local radii that a patch of a tube is wide
TURN = 0.4  # radians that a tube bends over the width of a patch at most


def fit_body(
    skeleton: CurveGraph, surfaces: Surfaces | None = None, params: BodyParams | None = None,
    cloud: PointsLike | None = None, *, progress: Report | None = None, **settings: Unpack[BodySettings],
) -> BodySurface:  # fmt: skip
    """Fit one closed surface to the whole body: joints and ends are places like others.

    Parameters
    ----------
    skeleton : Skeleton or CurveGraph
        The curve, in any unit; it tells which way is out, and how thick the body is.
    surfaces : Surfaces, optional
        Tubes fitted along its branches.
    params : BodyParams, optional
        The settings.
    cloud : (n, 3) array, Cloud, or object of Open3D or trimesh, optional
        The cloud around a curve from elsewhere, in its unit; a skeleton brings its own.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the fit.
    **settings
        Those of :class:`tiskel.BodyParams` by name; over those of params.

    Returns
    -------
    BodySurface

    Raises
    ------
    TiskelError
        Where a curve comes without its cloud.

    Examples
    --------
    >>> from tiskel import ShapeParams, fit_body, make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("capsule"), ShapeParams(count=1000))
    >>> body = fit_body(true)
    >>> body.summary["coverage"], body.summary["mean"] < 0.001
    (1.0, True)
    """
    params, span = settled(BodyParams, params, settings), Span(progress, "body")
    span.at(0, "points")
    if cloud is None and not isinstance(skeleton, Skeleton):
        raise TiskelError("a curve needs the cloud that it runs through; give it, or a skeleton of tiskel")
    every = given_cloud(skeleton.cloud if cloud is None else cloud)[0]  # type: ignore[attr-defined]
    body = body_points(skeleton, every, params)
    span.at(0.4, "patches")
    surface = BodySurface(
        _patches(body, surfaces, params).sorted(), every, np.zeros(0), float(np.median(body.radii[body.seen]))
    )
    span.at(0.7, "distances")
    distances = np.full(len(every), np.nan)
    whole = body_rows(every)
    distances[whole] = np.linalg.norm(projected(surface, every[whole]) - every[whole], axis=1)
    surface = replace(surface, distances=distances)
    span.at(1)
    return replace(surface, warnings=_doubts(surface, body.trusted))


def _doubts(surface: BodySurface, trusted: bool) -> tuple[str, ...]:
    """Return warnings about the surface of a body."""
    near, bridged = surface.summary["coverage"], surface.share(Trust.BRIDGED)
    told = {
        "its normals do not agree on which side is out; it may be inside out in places, and gaps are open": not trusted,
        f"only {near:.0%} of the points are within 5 % of the local radius of it": near < COVERED,
        f"{bridged:.0%} of it was laid over gaps": bridged > LAID,
    }
    return tuple(f"whole body: {line}" for line, holds in told.items() if holds)


def fit_whole(
    skeleton: CurveGraph, params: SurfaceParams | None = None, cloud: PointsLike | None = None, *,
    body: BodyParams | None = None, progress: Report | None = None, **settings: Unpack[SurfaceSettings],
) -> Surfaces:  # fmt: skip
    """Fit tubes along the branches of a skeleton, as far as there are any, and one surface to the whole body.

    Parameters
    ----------
    skeleton, params, cloud, progress, **settings
        See :func:`tiskel.fit_surface`.
    body : BodyParams, optional
        The settings of the whole surface.

    Returns
    -------
    Surfaces
        With ``body``; without tubes where no branch can have one.

    Raises
    ------
    TiskelError
        Where a curve comes without its cloud.

    Examples
    --------
    A ball has no branch to slice.

    >>> from tiskel import ShapeParams, SurfaceParams, fit_whole, make_shape, shape_graph
    >>> true = make_shape(shape_graph("egg"), ShapeParams(count=1000))[1]
    >>> found = fit_whole(true, SurfaceParams(interval=0.2))
    >>> len(found), found.body.summary["coverage"]
    (0, 1.0)
    """
    try:
        found = fit_surface(skeleton, params, cloud, progress=progress, **settings)
    except NoTubeError as none:
        every = skeleton.cloud if isinstance(skeleton, Skeleton) and cloud is None else given_cloud(cloud)[0]  # type: ignore[arg-type]
        found = Surfaces((), none.rejected, every)
    return replace(found, body=fit_body(skeleton, found, body, found.cloud, progress=progress))


def _patches(body: BodyPoints, surfaces: Surfaces | None, params: BodyParams) -> Patches:
    """Return the quadrics about some of the points, with supports that end before opposite walls.

    Of tubes where these explain the points, else through the points themselves.
    """
    tubes = on_tubes(body, surfaces, params)
    smooth = np.minimum(TUBE_WIDTH * body.radii, TURN / np.maximum(tubes.bends, TINY))
    widths = np.where(tubes.there, np.maximum(smooth, body.far[:, FEW]), body.widths)
    least = LEAST_REACH * body.far[:, FEW]
    supports = np.maximum(np.minimum(params.reach * widths, params.facing * body.opposite), least)
    supports = np.maximum(graded(supports, body), least)
    rows = spread(body.points, params.spread * np.minimum(supports, widths))
    there = tubes.there[rows]
    centres, found = (
        np.empty((len(rows), 3)),
        Quadrics(*(np.empty((len(rows), *size)) for size in ((), (3,), (6,), ()))),
    )
    free = rows[~there]
    if len(free):
        fitted = body.chosen(free)
        foot = -fitted.gradient * (fitted.value / (fitted.gradient**2).sum(axis=1))[:, None]
        centres[~there] = body.points[free] + foot
        for column, values in zip(found, fitted.moved(foot), strict=True):
            column[~there] = values
    owned = rows[there]
    centres[there] = tubes.places[owned]
    for column, values in zip(
        found[:3], (np.zeros(len(owned)), tubes.normals[owned], tubes.hessians[owned]), strict=True
    ):
        column[there] = values
    return Patches(centres, supports[rows], *found[:3], body.radii[rows], body.trust(rows), there)


def graded(supports: Numbers, body: BodyPoints) -> Numbers:
    """Return supports (n,) that do not grow faster than by a share of the way from point to point.

    Beyond an edge only patches of one face would count otherwise, as if it went on.
    """
    for _ in range(ROUNDS):
        supports = np.minimum(supports, (supports[body.near] + GRADE * body.far).min(axis=1))
    return supports


def spread(points: Points, apart: Numbers) -> Indices:
    """Return rows of points so that every point is nearer to one of them than that one's distance.

    Parameters
    ----------
    points : (n, 3) float64
        In any unit.
    apart : (n,) float64
        How far about each point no other is needed, in the same unit; where this is least comes first.

    Returns
    -------
    (m,) int32
        Ascending.

    Examples
    --------
    >>> import numpy as np
    >>> spread(np.outer(np.arange(5.0), [1, 0, 0]), np.full(5, 1.5)).tolist()
    [0, 2, 4]
    """
    lists = cKDTree(points).query_ball_point(points, apart)
    free, taken = np.ones(len(points), bool), []
    for row in np.argsort(apart, kind="stable").tolist():
        if free[row]:
            taken.append(row)
            free[lists[row]] = False
    return np.sort(np.array(taken, np.int32))
