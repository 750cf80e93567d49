"""Measures of places: of every skeletal point, and of samples and vertices of a curve."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Edges, Indices, Mask, Numbers, Points
from tiskel.geometry.curve import CurveSamples
from tiskel.metrics.boundedness import Boundedness
from tiskel.metrics.centredness import Sections
from tiskel.metrics.shares import share


@dataclass(frozen=True, eq=False)
class PointQuality:
    """Measures of skeletal points, one row each; coordinates in the input's units.

    Attributes
    ----------
    points : (m, 3) float64
        The skeletal points.
    originals : (m, 3) float64
        The points of the cloud that they stand for.
    boundedness : Boundedness
        How each is surrounded by the cloud.
    inside : (m,) bool or None
        Whether each is inside the surface; None where the normals cannot be oriented.
    centredness : (m,) float64
        c from 0 to 1; 0 where unbounded.
    raw_centredness : (m,) float64
        c wherever the point is.
    smoothness : (m,) float64
        s from 0 to 1; NaN where a tangent is undefined.
    """

    points: Points
    originals: Points
    boundedness: Boundedness
    inside: Mask | None
    centredness: Numbers
    raw_centredness: Numbers
    smoothness: Numbers


@dataclass(frozen=True, eq=False)
class CurveQuality:
    """Measures of a curve at samples and at its vertices; coordinates in the input's units.

    Attributes
    ----------
    nodes : (v, 3) float64
        Where the nodes are.
    edges : (e, 2) int32
        The two nodes of every edge.
    samples : CurveSamples
        The q places on the curve that are measured.
    boundedness : Boundedness
        How each sample is surrounded by the cloud.
    inside : (q,) bool or None
        Whether each sample is inside the surface; None where the normals cannot be oriented.
    medialness : (q,) float64 or None
        Clearance over the best clearance across the curve, 0 outside, NaN inside where the curve has no direction and
        where a sample of a curve of many edges was passed over; None where the normals cannot be oriented.
    in_air : (q,) bool
        Whether each sample is neither at the points of the cloud nor between them.
    air_share : float or None
        The share of the length that is; None for a curve without length.
    air_where : (k, 3) float64
        A few of these places.
    sections : Sections
        The section of the cloud across each sample.
    centredness : (q,) float64
        c from 0 to 1; 0 where unbounded, NaN where the section is invalid.
    vertices : (d,) int32
        The nodes with two neighbours.
    smoothness : (d,) float64
        s from 0 to 1 at each of these.
    overall_smoothness : float or None
        Mean of s weighted by length; None for a curve without length.
    hairpins : int
        Vertices where the curve turns back.
    """

    nodes: Points
    edges: Edges
    samples: CurveSamples
    boundedness: Boundedness
    inside: Mask | None
    medialness: Numbers | None
    in_air: Mask
    air_share: float | None
    air_where: Points
    sections: Sections
    centredness: Numbers
    vertices: Indices
    smoothness: Numbers
    overall_smoothness: float | None
    hairpins: int


def bounded_share(measured: PointQuality | CurveQuality | None) -> float | None:
    """Return the share of places that are bounded."""
    return None if measured is None else share(measured.boundedness.bounded)


def inside_share(measured: PointQuality | CurveQuality | None) -> float | None:
    """Return the share of places that are inside, None where that is not known."""
    return None if measured is None else share(measured.inside)


def mean_medialness(measured: CurveQuality | None) -> float | None:
    """Return the mean medialness of the places that have one, None where it is not known."""
    if measured is None or measured.medialness is None:
        return None
    known = measured.medialness[~np.isnan(measured.medialness)]
    return float(known.mean()) if len(known) else None
