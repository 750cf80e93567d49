"""Clouds of named shapes, clean or degraded the way scans are."""

from collections.abc import Iterable

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.gallery.body import Body, Shape, is_inside, least_thickness
from tiskel.gallery.catalogue import SHAPES
from tiskel.gallery.families import GROUPS
from tiskel.gallery.views import Scene, scan
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.round_cones import ConeGraph, sample_union
from tiskel.params import ShapeParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import ShapeSettings
from tiskel.skeleton import Skeleton
from tiskel.wording import meant

PATCHES = 8  # holes that --missing is spread over


def shape_graph(name: str) -> ConeGraph:
    """Return the round cones of a named shape, with lengths of the order of one.

    Parameters
    ----------
    name : str
        One of the names in :data:`tiskel.gallery.catalogue.SHAPES`, such as "y", "torus" or "hand"; for the other
        shapes see :func:`tiskel.named_shape`.

    Returns
    -------
    ConeGraph
        The curve skeleton of the shape, with radii.

    Raises
    ------
    TiskelError
        For another name; the message has the one that is most like it, and lists them all.

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> torus = shape_graph("torus")
    >>> torus.loops, torus.ends
    (1, 0)
    """
    if name not in SHAPES:
        raise _unknown(name, SHAPES)
    return SHAPES[name]()


def named_shape(name: str) -> Shape:
    """Return a named shape: a union of round cones, or a body of another kind.

    Parameters
    ----------
    name : str
        One of the names that `tiskel shape` lists, such as "y", "flat-tube", "maize", "block-3" or "stent".

    Returns
    -------
    ConeGraph or Body
        The curve skeleton of the shape, with radii, and its surface; lengths are of the order of one.

    Raises
    ------
    TiskelError
        For another name; the message lists them all.

    Examples
    --------
    >>> from tiskel import named_shape
    >>> stent = named_shape("stent")
    >>> stent.components, stent.loops, stent.ends
    (1, 13, 0)
    """
    every = {name: make for group in GROUPS.values() for name, make in group.items()}
    if name not in every:
        raise _unknown(name, every)
    return every[name]()


def _unknown(name: str, known: Iterable[str]) -> TiskelError:
    """Return the error for a name that no shape has."""
    return TiskelError(f"no shape is called {name!r};{meant(name, known).lower()} choose one of {', '.join(known)}")


def make_shape(
    shape: Shape | str, params: ShapeParams | int | None = None, **settings: Unpack[ShapeSettings]
) -> tuple[Points, Skeleton]:
    """Return a cloud of a shape and its true skeleton.

    The surface is sampled uniformly by area, thinned towards one end of its
    longest axis, seen from some sides, cut by patches and blurred, as the
    settings say; the same seed gives the same bytes.

    Parameters
    ----------
    shape : str, ConeGraph or Body
        The name of a shape, as :func:`tiskel.named_shape` knows it; or what it and :func:`tiskel.shape_graph` return.
    params : ShapeParams or int, optional
        The settings; a number is ``count``, of points.
    **settings
        Those of :class:`tiskel.ShapeParams` by name; over those of params.

    Returns
    -------
    cloud : (n, 3) float64
        Points on the surface, in the units of the shape.
    skeleton : Skeleton
        The graph of the shape as the skeleton of this cloud; all of it, seen or not.

    Raises
    ------
    TiskelError
        For an unknown name, and where a sensor is so near that it sees too little.

    Examples
    --------
    >>> from tiskel import make_shape
    >>> cloud, true = make_shape("hand", 2000, missing=0.1)
    >>> cloud.shape, true.ends
    ((2000, 3), 6)
    """
    if isinstance(params, (int, np.integer)):
        chosen = settled(ShapeParams, None, {"count": int(params), **settings})
    else:
        chosen = settled(ShapeParams, params, settings)
    shape = named_shape(shape) if isinstance(shape, str) else shape
    generator = np.random.default_rng(chosen.seed)
    unit = least_thickness(shape)
    before_cut = int(np.ceil(chosen.count / (1 - chosen.missing)))
    points = _scanned(shape, before_cut, chosen, generator)
    points = _cut(points, len(points) - chosen.count, generator)
    points = points + generator.normal(size=points.shape) * chosen.noise * unit
    return points, analytic_skeleton(shape, points)


def _scanned(shape: Shape, count: int, params: ShapeParams, generator: np.random.Generator) -> Points:
    """Return points of the whole surface, or those that sensors see, with noise along their rays."""
    if not params.views and not params.table:
        return _uneven(shape, count, params.uneven, generator)
    scene = Scene(
        sample=lambda more: _uneven(shape, more, params.uneven, generator),
        inside=lambda places: is_inside(places, shape),
        distance=params.sensor_distance,
        noise=params.sensor_noise * least_thickness(shape),
        table=params.table,
    )
    return scan(scene, count, params.views, generator)


def _sampled(shape: Shape, count: int, generator: np.random.Generator) -> Points:
    return shape.sample(count, generator) if isinstance(shape, Body) else sample_union(shape, count, generator)


def _uneven(shape: Shape, count: int, ratio: float, generator: np.random.Generator) -> Points:
    """Sample more than needed and keep each point with a probability that falls exponentially along the axis."""
    if ratio == 1:
        return _sampled(shape, count, generator)
    kept: list[Points] = []
    while sum(map(len, kept)) < count:
        points = _sampled(shape, 2 * count, generator)
        centred = shape.nodes - shape.nodes.mean(axis=0)
        axis = np.linalg.svd(centred, full_matrices=False)[2][0]
        low, high = (shape.nodes @ axis).min(), (shape.nodes @ axis).max()
        share = np.clip((points @ axis - low) / (high - low), 0, 1)
        kept.append(points[generator.random(len(points)) < ratio**-share])
    return np.concatenate(kept)[:count]


def _cut(points: Points, surplus: int, generator: np.random.Generator) -> Points:
    """Remove so many points in round patches about random points."""
    for patch in range(PATCHES):
        size = surplus * (patch + 1) // PATCHES - surplus * patch // PATCHES
        if size:
            centre = points[generator.integers(len(points))]
            points = np.delete(points, cKDTree(points).query(centre, k=[*range(1, size + 1)])[1], axis=0)
    return points


def analytic_skeleton(shape: CurveGraph, cloud: Points) -> Skeleton:
    """Return the graph of a shape as a skeleton of a cloud (n, 3), each point with its nearest node."""
    everyone = np.arange(len(cloud), dtype=np.int32)
    none = np.empty((0, 3))
    return Skeleton(
        nodes=shape.nodes,
        edges=shape.edges,
        radii=shape.radii,
        radius_sources=np.full(len(shape.nodes), RadiusSource.MEASURED, np.uint8),
        node_of_point=cKDTree(shape.nodes).query(cloud)[1].astype(np.int32),
        cloud=cloud,
        input_rows=everyone,
        contracted=none,
        origin=none,
        rows=everyone[:0],
    )
