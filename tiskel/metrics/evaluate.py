"""Measure a skeleton."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Mask, Numbers, Points, PointsLike
from tiskel.extras import there
from tiskel.geometry.air import in_the_air
from tiskel.geometry.clearance import CloudBody
from tiskel.geometry.curve import CurveSamples, curve_samples
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.oriented import OrientedCloud, oriented_cloud, places_inside
from tiskel.geometry.representatives import few_places
from tiskel.metrics import smoothness
from tiskel.metrics.barcode import Barcode, barcode
from tiskel.metrics.boundedness import Boundedness, boundedness_by
from tiskel.metrics.centredness import curve_centredness, point_centredness
from tiskel.metrics.loop_points import loop_rows
from tiskel.metrics.loops import Loops, count_loops
from tiskel.metrics.medialness import medialness_at
from tiskel.metrics.places import CurveQuality, PointQuality
from tiskel.metrics.result import Quality
from tiskel.metrics.subject import Subject, arrays_of, make_subject
from tiskel.metrics.topology import Topology, compare_topology
from tiskel.params import MetricParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import MetricSettings
from tiskel.progress import Report, Span
from tiskel.timing import Stopwatch

PARTS = 11  # that a skeleton with points and a curve is measured in; for who waits only


def evaluate(
    cloud: PointsLike | CurveGraph,
    points: PointsLike | CurveGraph | None = None,
    nodes: npt.ArrayLike | None = None,
    edges: npt.ArrayLike | None = None,
    *,
    origin: npt.ArrayLike | None = None,
    params: MetricParams | None = None,
    progress: Report | None = None,
    **settings: Unpack[MetricSettings],
) -> Quality:
    """Measure skeletal points and a curve against the cloud they stand for.

    The measures are those of the skeleton evaluation toolbox; where print and
    toolbox differ, the toolbox, which made the published tables, is followed,
    and :class:`tiskel.MetricParams` names the alternatives. Beyond it: a true
    inside test, medialness (:mod:`tiskel.metrics.medialness`), curve in the air
    (:mod:`tiskel.geometry.air`), loops of surface, solid and curve, and reasons
    where there is no value.

    Parameters
    ----------
    cloud : (n, 3) array_like, Cloud, object of Open3D or trimesh, or Skeleton
        In any unit; rows that are not finite are dropped, duplicates counted once. A skeleton brings its cloud,
        contracted points and curve along.
    points : (m, 3) array_like, or CurveGraph, optional
        Skeletal (contracted) points, in the unit of the cloud; or a curve or skeleton in the place of points, nodes
        and edges.
    nodes : (v, 3) array_like, optional
        Nodes of the curve skeleton, in the unit of the cloud.
    edges : (e, 2) array_like of int, optional
        The two nodes of every edge of the curve, counted from 0.
    origin : (m, 3) array_like, optional
        Where the skeletal points came from. Without it they belong to the rows of the cloud where there are as
        many, else to the nearest point of the cloud; the result says which.
    params : MetricParams, optional
        The settings.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the measuring.
    **settings
        Those of :class:`tiskel.MetricParams` by name; over those of params.

    Returns
    -------
    Quality
        Values of every place, and the overall values by :meth:`Quality.as_dict`.

    Raises
    ------
    TiskelError
        For a cloud without a body (few points, a line, a plane), numbers of rows that do not match, edges to nodes
        that are not there.

    Examples
    --------
    >>> from tiskel import ShapeParams, evaluate, make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("torus"), ShapeParams(count=1000))
    >>> quality = evaluate(true)
    >>> quality.loops.solid, quality.loops.graph
    (1, 1)
    >>> round(quality.as_dict()["inside"]["curve"], 2)
    1.0
    """
    params = settled(MetricParams, params, settings)
    subject = make_subject(*arrays_of(cloud, points, nodes, edges, origin), params.normalise)
    watch = Stopwatch(began=(span := Span(progress, "metrics")).parts(PARTS))
    with watch.measure("inside"):
        surface = oriented_cloud(subject.cloud, subject.targets, params.seed)
    topology, loops = _topology_and_loops(subject, surface, params, watch)
    of_points, of_curve = _measures(subject, surface, params, watch)
    span.at(1)
    return Quality(
        topology=topology,
        loops=loops,
        points=of_points,
        curve=of_curve,
        graph=_graph_counts(subject),
        cloud_points=len(subject.cloud),
        correspondence=subject.correspondence,
        oriented_by=surface.oriented_by,
        orientation=surface.consistency,
        unoriented="" if surface.trusted else f"the normals agree at {surface.consistency:.0%} of the points only",
        params=params,
        warnings=subject.warnings,
        seconds=watch.seconds,
    )


def _topology_and_loops(
    subject: Subject, surface: OrientedCloud, params: MetricParams, watch: Stopwatch
) -> tuple[Topology | None, Loops]:
    """Return both, from one barcode where the skeletal points stand for the whole cloud."""
    with watch.measure("loops"):
        part = _loop_part(subject, surface, params)
        told = there("ripser")
        bars = barcode(part.points, loops=told)
        loops = count_loops(bars.cycles if told else None, part, subject, params)
    with watch.measure("topology"):
        topology = _topology(subject, part.points, bars, params)
    return topology, loops


def _loop_part(subject: Subject, surface: OrientedCloud, params: MetricParams) -> OrientedCloud:
    """Return the surface, or that of a random subset of a large cloud, or of even points on wires."""
    rows = loop_rows(subject.cloud, params)
    if len(rows) == len(subject.cloud):
        return surface
    return oriented_cloud(np.ascontiguousarray(subject.cloud[rows]), subject.targets[rows], params.seed)


def _topology(subject: Subject, known: Points, bars: Barcode, params: MetricParams) -> Topology | None:
    if len(subject.points) == 0:
        return None
    original = subject.cloud if subject.correspondence == "nearest" else subject.originals
    before = bars if np.array_equal(original, known) else barcode(original)
    return compare_topology(original, before.deaths, barcode(subject.points).deaths, params)


def _measures(
    subject: Subject, surface: OrientedCloud, params: MetricParams, watch: Stopwatch
) -> tuple[PointQuality | None, CurveQuality | None]:
    """Return the measures of points and of the curve; how places are surrounded is asked for all of them at once."""
    samples = curve_samples(subject.curve, params.curve_samples)
    places = np.concatenate([subject.points, samples.points])
    with watch.measure("boundedness"):
        bounded = boundedness_by(places, subject.cloud, params.beta, params.bounded)
    with watch.measure("inside"):
        inside = places_inside(surface, places)
    of_points, of_curve = slice(0, len(subject.points)), slice(len(subject.points), len(places))
    surrounded = [(bounded.take(rows), None if inside is None else inside[rows]) for rows in (of_points, of_curve)]
    return (
        _point_quality(subject, surrounded[0], params, watch) if len(subject.points) else None,
        _curve_quality(subject, samples, surface, surrounded[1], params, watch) if len(subject.curve.edges) else None,
    )


Surrounded = tuple[Boundedness, Mask | None]


def _point_quality(subject: Subject, surrounded: Surrounded, params: MetricParams, watch: Stopwatch) -> PointQuality:
    points, originals, frame = subject.points, subject.originals, subject.frame
    bounded, inside = surrounded
    with watch.measure("centredness"):
        centred = point_centredness(points, originals)
    with watch.measure("smoothness"):
        smooth = smoothness.point_smoothness(points, params)
    return PointQuality(
        points=frame.undo(points),
        originals=frame.undo(originals),
        boundedness=bounded,
        inside=inside,
        centredness=np.where(bounded.bounded, centred, 0.0),
        raw_centredness=centred,
        smoothness=smooth,
    )


def _curve_quality(
    subject: Subject, samples: CurveSamples, surface: OrientedCloud, surrounded: Surrounded,
    params: MetricParams, watch: Stopwatch,
) -> CurveQuality:  # fmt: skip
    curve, frame = subject.curve, subject.frame
    bounded, inside = surrounded
    with watch.measure("medialness"):
        medial = _medialness(samples, surface, params) if surface.trusted else None
    with watch.measure("air"):
        air = in_the_air(curve, samples, subject.cloud)
    with watch.measure("centredness"):
        sections = curve_centredness(samples, subject.cloud, params)
    with watch.measure("smoothness"):
        vertices, smooth = smoothness.vertex_smoothness(curve)
        overall = smoothness.curve_smoothness(curve)
    return CurveQuality(
        nodes=frame.undo(curve.nodes),
        edges=curve.edges,
        samples=replace(samples, points=frame.undo(samples.points)),
        boundedness=bounded,
        inside=inside,
        medialness=medial,
        in_air=air.places,
        air_share=air.share,
        air_where=frame.undo(few_places(samples.points[air.places], air.distance[air.places])),
        sections=sections,
        centredness=np.where(bounded.bounded, sections.centredness, 0.0),
        vertices=vertices,
        smoothness=smooth,
        overall_smoothness=overall,
        hairpins=smoothness.hairpins(curve),
    )


def _medialness(samples: CurveSamples, surface: OrientedCloud, params: MetricParams) -> Numbers:
    """Return (q,) medialness; NaN at most samples of a curve of many short edges, since climbing takes its time."""
    some = slice(None, None, 1 + len(samples.points) // (2 * params.curve_samples))
    values = np.full(len(samples.points), np.nan)
    values[some] = medialness_at(samples.points[some], samples.directions[some], CloudBody(surface)).values
    return values


def _graph_counts(subject: Subject) -> dict[str, float] | None:
    """Return what the curve is made of; its length in the input's units."""
    curve = subject.curve
    return CurveGraph(subject.frame.undo(curve.nodes), curve.edges).counts() if subject.curve_given else None
