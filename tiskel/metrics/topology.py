"""Topological similarity: H0 barcodes of the original and of the skeletal points."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers, Points
from tiskel.metrics.distances import bottleneck, wasserstein
from tiskel.params import MetricParams

PERCENTILE, SHARE = 99, 0.05  # of nearest-neighbour distances; least share of the bars that is kept [T]


@dataclass(frozen=True, eq=False)
class Topology:
    """How alike two H0 barcodes are; lengths in normalised units, as published.

    Attributes
    ----------
    bottleneck : float or None
        The bottleneck distance d_B; None with a reason.
    wasserstein : float or None
        The 1-Wasserstein distance divided by the number of bars, d_W; None with a reason.
    bars : int
        Number of bars kept of each barcode.
    similar : bool or None
        Whether both distances are below d*.
    original : (b,) float64
        The bars kept of the original points, longest first.
    skeletal : (b,) float64
        The bars kept of the skeletal points, longest first.
    reason : str
        Why there are no distances; empty where there are.
    """

    bottleneck: float | None
    wasserstein: float | None
    bars: int
    similar: bool | None
    original: Numbers
    skeletal: Numbers
    reason: str = ""


def compare_topology(original: Points, before: Numbers, after: Numbers, params: MetricParams) -> Topology:
    """Compare the H0 barcode of the original points with that of the skeletal points.

    Bars are chosen as :class:`tiskel.MetricParams` says; the infinite bar of
    each is left out.

    Parameters
    ----------
    original : (n, 3) float64
        The original points, in normalised units.
    before : (n - 1,) float64
        Their deaths, longest first.
    after : (m - 1,) float64
        The deaths of the skeletal points, longest first.
    params : MetricParams
        ``bars``, ``diagonal`` and ``similar`` count.

    Returns
    -------
    Topology
    """
    kept = bars_kept(original, before, params.bars)
    before, after = before[:kept], after[:kept]
    reason = _obstacle(kept, len(after), params)
    if reason:
        return Topology(None, None, kept, None, before, after, reason)
    distance = bottleneck(before, after, diagonal=params.diagonal)
    mean = wasserstein(before, after, diagonal=params.diagonal) / kept
    return Topology(distance, mean, kept, max(distance, mean) < params.similar, before, after)


def bars_kept(points: Points, deaths: Numbers, rule: str) -> int:
    """Return how many of the longest bars of the original points are compared.

    Parameters
    ----------
    points : (n, 3) float64
        The original points.
    deaths : (n - 1,) float64
        Their deaths, in the unit of the points.
    rule : "toolbox" or "max"
        "toolbox": bars longer than the 99th percentile of the nearest-neighbour distances, or 5 % of all where these
        are fewer. "max": bars longer than the largest nearest-neighbour distance, as the paper has it.
    """
    nearest = cKDTree(points).query(points, [min(2, len(points))])[0][:, 0]
    if rule == "max":
        return int((deaths > nearest.max()).sum())
    return max(int((deaths > np.percentile(nearest, PERCENTILE)).sum()), round(SHARE * len(deaths)))


def _obstacle(kept: int, skeletal: int, params: MetricParams) -> str:
    """Return why the distances cannot be computed, or nothing."""
    if params.bars == "max" and kept <= 1:
        return f"{kept} bars are longer than the largest nearest-neighbour distance; use the toolbox's rule"
    if kept == 0:
        return "too few points to keep a bar"
    if skeletal < kept and not params.diagonal:
        return f"{kept} bars are kept, the skeletal points have {skeletal}: no bijection without the diagonal"
    return ""
