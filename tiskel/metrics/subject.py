"""What is measured: a cloud, skeletal points with their originals, a curve; checked, cleaned and normalised."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import (
    Edges,
    Frame,
    Mask,
    Points,
    PointsLike,
    as_points,
    check_solid,
    finite_rows,
    first_of_duplicates,
    normalisation,
)
from tiskel.errors import TiskelError
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.given import given_cloud
from tiskel.geometry.graph import CurveGraph, tidy_edges
from tiskel.geometry.strays import stray_points
from tiskel.params import Normalisation
from tiskel.skeleton import Skeleton

TARGET_SAMPLES = 1000  # places on a curve that a cloud may contract to
NO_POINTS: Points = np.zeros((0, 3))


@dataclass(frozen=True, eq=False)
class Subject:
    """A cloud and the skeleton that is measured against it, in normalised coordinates.

    Attributes
    ----------
    cloud : (n, 3) float64
        The cloud, finite and distinct, without stray points (:mod:`tiskel.geometry.strays`).
    points : (m, 3) float64
        Skeletal points; no row where none are given.
    originals : (m, 3) float64
        The points of the cloud that they stand for.
    correspondence : str
        "given", "rows" (as many points as the cloud has, row by row), "nearest", or "none" without skeletal points.
    curve : CurveGraph
        The curve; without nodes where none is given.
    curve_given : bool
        Whether a curve is given, be it empty.
    frame : Frame
        The way back to the input's units.
    warnings : tuple of str
        What was left out on the way in.
    """

    cloud: Points
    points: Points
    originals: Points
    correspondence: str
    curve: CurveGraph
    curve_given: bool
    frame: Frame
    warnings: tuple[str, ...]

    @cached_property
    def targets(self) -> Points:
        """(n, 3), the place that each point of the cloud contracts to, as far as that is known.

        That of the nearest original; without skeletal points the nearest place
        on the curve; without either the middle of the cloud.
        """
        if len(self.points):
            return np.asarray(self.points[cKDTree(self.originals).query(self.cloud)[1]])
        nodes, along = self.curve.nodes, curve_samples(self.curve, TARGET_SAMPLES).points
        places = np.concatenate([nodes, along]) if len(nodes) else self.cloud.mean(axis=0)[None]
        return np.asarray(places[cKDTree(places).query(self.cloud)[1]])


def arrays_of(
    cloud: PointsLike | CurveGraph, points: PointsLike | CurveGraph | None, nodes: npt.ArrayLike | None,
    edges: npt.ArrayLike | None, origin: npt.ArrayLike | None,
) -> tuple[Points, PointsLike | None, npt.ArrayLike | None, npt.ArrayLike | None, npt.ArrayLike | None]:  # fmt: skip
    """Return cloud, points, nodes, edges and origin, as far as they are there, out of the skeleton that holds them.

    Raises
    ------
    TiskelError
        Where a skeleton comes with arrays beside it, or a curve without a cloud.
    """
    if isinstance(cloud, CurveGraph):
        given, curve = points, cloud
        cloud = curve.cloud if isinstance(curve, Skeleton) else NO_POINTS
        if len(cloud) == 0:
            raise TiskelError("the curve comes without its cloud; give that first: evaluate(cloud, curve)")
    elif isinstance(points, CurveGraph):
        given, curve = None, points
    else:
        return given_cloud(cloud)[0], points, nodes, edges, origin
    if not given is nodes is edges is origin is None:
        raise TiskelError("a skeleton brings points, nodes, edges and origin along; leave them out, or give arrays")
    some = isinstance(curve, Skeleton) and len(curve.contracted) > 0
    points, origin = (curve.contracted, curve.origin) if some else (None, None)  # type: ignore[attr-defined]
    return given_cloud(cloud)[0], points, curve.nodes, curve.edges, origin


def make_subject(
    cloud: npt.ArrayLike,
    points: PointsLike | None,
    nodes: npt.ArrayLike | None,
    edges: npt.ArrayLike | None,
    origin: npt.ArrayLike | None,
    kind: Normalisation,
) -> Subject:
    """Check, clean and normalise what is to be measured.

    Parameters
    ----------
    cloud : (n, 3) array_like
        In any unit.
    points : (m, 3) array_like or None
        Skeletal points, in the unit of the cloud.
    nodes : (v, 3) array_like or None
        Nodes of the curve, in the unit of the cloud.
    edges : (e, 2) array_like of int or None
        The two nodes of every edge, counted from 0.
    origin : (m, 3) array_like or None
        Where the skeletal points came from.
    kind : "side" or "diagonal"
        The length of the cloud that is scaled to 1.6.

    Returns
    -------
    Subject

    Raises
    ------
    TiskelError
        For a cloud without a body, numbers of rows that do not match, nodes that are not finite, edges to nodes that
        are not there.
    """
    given = as_points(cloud)
    whole = given[finite_rows(given)]
    first = first_of_duplicates(whole) if len(whole) else np.zeros(0, np.int32)
    stray = stray_points(whole, first)
    distinct = np.ascontiguousarray(whole[(first == np.arange(len(first))) & ~stray])  # duplicates are stray together
    check_solid(distinct)
    frame = normalisation(distinct, kind)
    warnings = [f"{len(given) - len(whole)} rows of the cloud with NaN or Inf were dropped"] * (len(given) > len(whole))
    if stray.any():
        warnings.append(f"{stray.sum()} stray points of the cloud were left out")
    kept = finite_rows(given)
    kept[kept] = ~stray
    skeletal, originals, correspondence = _points(points, origin, given, kept, distinct, warnings)
    vertices, links = _curve(nodes, edges, warnings)
    return Subject(
        cloud=frame.apply(distinct),
        points=frame.apply(skeletal),
        originals=frame.apply(originals),
        correspondence=correspondence,
        curve=CurveGraph(frame.apply(vertices), links),
        curve_given=nodes is not None,
        frame=frame,
        warnings=tuple(warnings),
    )


def _points(
    points: PointsLike | None, origin: npt.ArrayLike | None, given: Points, kept: Mask, distinct: Points,
    warnings: list[str],
) -> tuple[Points, Points, str]:  # fmt: skip
    """Return skeletal points, their originals, and how these were found; kept says which rows of the cloud count."""
    if points is None:
        return NO_POINTS, NO_POINTS, "none"
    skeletal = as_points(points) if np.size(points) else NO_POINTS  # type: ignore[arg-type]
    originals, how = (as_points(origin), "given") if origin is not None else (given, "rows")
    if origin is not None and len(originals) != len(skeletal):
        raise TiskelError(f"origin must have a row for each of the {len(skeletal)} points, got {len(originals)}")
    if len(originals) != len(skeletal):
        originals, how = skeletal, "nearest"
    finite = finite_rows(skeletal) & finite_rows(originals)
    if not finite.all():
        warnings.append(f"{(~finite).sum()} rows of the skeletal points with NaN or Inf were dropped")
    counted = finite & kept if how == "rows" else finite
    skeletal, originals = skeletal[counted], originals[counted]
    if how == "nearest":
        originals = distinct[cKDTree(distinct).query(skeletal)[1]]
    return skeletal, originals, how


def _curve(nodes: npt.ArrayLike | None, edges: npt.ArrayLike | None, warnings: list[str]) -> tuple[Points, Edges]:
    """Return nodes and edges, each edge once, lower node first, none from a node to itself."""
    vertices = NO_POINTS if nodes is None or np.size(nodes) == 0 else as_points(nodes)
    bad = np.flatnonzero(~finite_rows(vertices))
    if len(bad):
        raise TiskelError(f"node {bad[0]} of the curve is not finite: {vertices[bad[0]].tolist()}; repair the curve")
    given = np.zeros((0, 2), np.int32) if edges is None else np.asarray(edges, np.int64).reshape(-1, 2)
    if len(given) and (given.min() < 0 or given.max() >= len(vertices)):
        raise TiskelError(f"an edge names node {given.max()}, the curve has {len(vertices)}; count nodes from 0")
    links = tidy_edges(given.astype(np.int32))
    if len(links) < len(given):
        warnings.append(f"{len(given) - len(links)} edges of the curve were repeats or led nowhere and are left out")
    return vertices, links
