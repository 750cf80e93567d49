"""Smoothness of skeletal points and of curves."""

import numpy as np

from tiskel.arrays import Indices, Lists, Numbers, Points
from tiskel.geometry.curve import turns, two_sided
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.params import MetricParams

HAIRPIN = 0.5  # D_n below which a curve turns back: less than a right angle between its edges


def nearest_others(points: Points, count: int) -> Lists:
    """Return (m, count) int32, the rows of the nearest other points of each of points (m, 3), nearest first.

    Fewer columns where there are not so many. Where many points coincide, any of
    them but the point itself may stand for the nearest.
    """
    near = nearest_neighbours(points, min(count + 1, len(points)))[0]
    itself = near == np.arange(len(points))[:, None]
    itself[~itself.any(axis=1), -1] = True  # more duplicates than neighbours: the last makes room
    return np.asarray(near[~itself].reshape(len(points), -1))


def tangents(points: Points, others: Lists) -> Points:
    """Return (m, 3) the unit tangent at each of points (m, 3), from the rows of its neighbours, others (m, k).

    It is the leading eigenvector of their scatter about the point; NaN where all of them are at its place.
    """
    d = points[others] - points[:, None]
    scatter = np.einsum("nki,nkj->nij", d, d)
    leading = np.linalg.eigh(scatter)[1][:, :, 2]
    return np.where(scatter.any(axis=(1, 2))[:, None], leading, np.nan)


def point_smoothness(points: Points, params: MetricParams) -> Numbers:
    """Return the smoothness s of skeletal points.

    s is the minimum over the nearest others of |1 - 2 D_n|, with
    D_n = arccos(t . t') / pi for the tangents t and t'.

    Parameters
    ----------
    points : (m, 3) float64
        Skeletal points, in any unit.
    params : MetricParams
        ``tangent_neighbours`` and ``smooth_neighbours`` count.

    Returns
    -------
    (m,) float64
        s from 0 to 1; NaN where a tangent is undefined: for a point alone, and where all of its neighbours are at
        its place.
    """
    if len(points) < 2:
        return np.full(len(points), np.nan)
    others = nearest_others(points, params.tangent_neighbours)
    t = tangents(points, others)
    cosine = np.einsum("ni,nki->nk", t, t[others[:, : params.smooth_neighbours]])
    return np.asarray(np.abs(1 - 2 * np.arccos(np.clip(cosine, -1, 1)) / np.pi).min(axis=1))


def vertex_smoothness(curve: CurveGraph) -> tuple[Indices, Numbers]:
    """Return the vertices (d,) with two neighbours and their s = |1 - 2 D_n|; NaN beside an edge without length.

    By this formula a hairpin scores 1, like a straight line, and a right angle
    0; see :func:`hairpins`.
    """
    vertices, before, after = two_sided(curve)
    return vertices, np.abs(1 - 2 * turns(before, after))


def curve_smoothness(curve: CurveGraph) -> float | None:
    """Return the overall smoothness of a curve, 1 - sum w_i (1 - s_i) / W; None for a curve without length.

    w_i is half the length of a vertex's two edges, W the total length.
    """
    total = curve.length
    if total == 0:
        return None
    _, before, after = two_sided(curve)
    weight = (np.linalg.norm(before, axis=1) + np.linalg.norm(after, axis=1)) / 2
    _, s = vertex_smoothness(curve)
    return float(1 - np.nansum(weight * (1 - s)) / total)


def hairpins(curve: CurveGraph) -> int:
    """Return the number of vertices where a curve turns back by more than a right angle."""
    _, before, after = two_sided(curve)
    return int((turns(before, after) < HAIRPIN).sum())
