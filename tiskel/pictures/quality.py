"""The measures of skeletons: heat maps, barcodes and histograms, three rows for each."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points, finite_rows
from tiskel.geometry.strays import body_of
from tiskel.metrics.result import Quality
from tiskel.pictures.canvas import CURVE, INK, POINTS, broad_view, cloud_panel, heat, new_figure, rendered

COLUMNS, WIDTH, HEIGHT = 4, 14.0, 3.1  # inches; of one row
BINS = np.linspace(0, 1, 26)
MEASURES = ("boundedness", "centredness", "smoothness")


def quality_picture(qualities: Sequence[tuple[str, Points, Quality]], kind: str = "png") -> bytes:
    """Return a picture of skeletons: barcodes, heat maps of points and curve, histograms.

    Parameters
    ----------
    qualities : sequence of (str, (n, 3) float64, Quality)
        The name, the cloud and the measures of each.
    kind : "png", "svg" or "pdf"
        The format.

    Returns
    -------
    bytes
    """
    figure = new_figure(WIDTH, 3 * HEIGHT * len(qualities))
    panels = figure.subplots(3 * len(qualities), COLUMNS, squeeze=False)
    for number, (name, given, quality) in enumerate(qualities):
        cloud = body_of(given[finite_rows(given)])
        rows = panels[3 * number : 3 * number + 3]
        view = broad_view(cloud)
        _curve(rows[0][0], name, cloud, quality, view)
        _barcode(rows[1][0], quality)
        _loops(rows[2][0], quality)
        places = None if quality.points is None else quality.points.points
        values = values_of_points(quality), values_of_curve(quality)
        for column, measure in enumerate(MEASURES, 1):
            _heat(figure, rows[0][column], cloud, places, values[0], measure, "skeletal points", view)
            _heat(figure, rows[1][column], cloud, _curve_places(quality, measure), values[1], measure, "curve", view)
            _histogram(rows[2][column], [v.get(measure) for v in values], measure)
    return rendered(figure, kind)


Values = dict[str, Numbers]


def values_of_points(quality: Quality) -> Values:
    """Return the values (m,) from 0 to 1 of every skeletal point by measure; none without points."""
    p = quality.points
    if p is None:
        return {}
    return dict(zip(MEASURES, (p.boundedness.beta, p.centredness, p.smoothness), strict=True))


def values_of_curve(quality: Quality) -> Values:
    """Return the values from 0 to 1 of every sample, or vertex for smoothness, by measure; none without a curve."""
    c = quality.curve
    if c is None:
        return {}
    return dict(zip(MEASURES, (c.boundedness.beta, c.centredness, c.smoothness), strict=True))


def _curve_places(quality: Quality, measure: str) -> Points | None:
    c = quality.curve
    if c is None:
        return None
    return c.nodes[c.vertices] if measure == "smoothness" else c.samples.points


def _heat(
    figure: Any, panel: Any, cloud: Points, places: Points | None, values: Values, measure: str, of: str, view: Points
) -> None:
    cloud_panel(panel, cloud, view)
    panel.set_title(f"{measure} of {of}", fontsize=9)
    if places is not None:
        drawn = heat(panel, places, values[measure], view, size=5 if of != "curve" else 14)
        figure.colorbar(drawn, ax=panel, shrink=0.8)


def _histogram(panel: Any, values: Sequence[Numbers | None], measure: str) -> None:
    for of, colour, one in zip(("skeletal points", "curve"), (POINTS, CURVE), values, strict=True):
        known = np.zeros(0) if one is None else one[~np.isnan(one)]
        if len(known):
            panel.hist(known, BINS, weights=np.full(len(known), 1 / len(known)), color=colour, alpha=0.6, label=of)
    panel.set_title(f"{measure}, shares", fontsize=9)
    panel.set_xlim(0, 1)
    panel.tick_params(labelsize=7)
    if panel.get_legend_handles_labels()[0]:
        panel.legend(fontsize=7)


def _barcode(panel: Any, quality: Quality) -> None:
    """Draw the bars of H0 that are compared, longest below, those of the original beside those of the skeleton."""
    t = quality.topology
    panel.set_title("H0 bars: original blue, skeleton red", fontsize=9)
    panel.tick_params(labelsize=7)
    panel.locator_params(axis="x", nbins=5)
    if t is None:
        return
    for bars, colour in ((t.original, POINTS), (t.skeletal, CURVE)):
        panel.fill_betweenx(np.arange(len(bars)), 0, bars, color=colour, alpha=0.5, step="mid", linewidth=0)
    if t.bottleneck is not None:
        panel.set_xlabel(f"d_B {t.bottleneck:.4f}, d_W {t.wasserstein:.4f}, {t.bars} bars", fontsize=8)


def _loops(panel: Any, quality: Quality) -> None:
    """Draw births and deaths of the surface's loops, and the line above which they count."""
    bars, ratio = quality.loops.bars, quality.params.loop_ratio
    panel.set_title("H1 of the surface: births and deaths", fontsize=9)
    panel.tick_params(labelsize=7)
    top = float(bars.max(initial=1e-9)) * 1.05
    panel.plot([0, top], [0, top], color=INK, linewidth=0.6)
    panel.plot([0, top / ratio], [0, top], color=CURVE, linewidth=0.8, linestyle="--")
    panel.scatter(*bars.T, s=8, color=POINTS, linewidths=0)
    n = quality.loops
    said = ("?" if value is None else value for value in (n.surface, n.solid, n.graph))
    panel.set_xlabel("loops: surface {}, solid {}, curve {}".format(*said), fontsize=8)


def _curve(panel: Any, name: str, cloud: Points, quality: Quality, view: Points) -> None:
    cloud_panel(panel, cloud, view)
    panel.set_title(name, fontsize=10, fontweight="bold")
    c = quality.curve
    if c is not None:
        for a, b in c.edges:
            panel.plot(*(c.nodes[[a, b]] @ view.T).T, color=CURVE, linewidth=1.4)
