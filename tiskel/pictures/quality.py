"""The measures of skeletons: heat maps, barcodes and histograms, three rows for each."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points, finite_rows
from tiskel.geometry.strays import body_of
from tiskel.metrics.result import Quality
from tiskel.params import LookParams
from tiskel.pictures.canvas import Sight, cloud_panel, heat, new_figure, rendered, sight_of
from tiskel.pictures.style import CURVE, INK, POINTS, SCALE

COLUMNS, WIDTH, HEIGHT = 4, 14.0, 2.9  # inches; of a row of histograms
COLUMN, HEAD, LOWEST = 2.7, 0.7, 2.2  # inches: width of a panel, what its title and axis take, least height of a row
BINS = np.linspace(0, 1, 26)
MEASURES = ("boundedness", "centredness", "smoothness")


def quality_picture(
    qualities: Sequence[tuple[str, Points, Quality]], kind: str = "png", look: LookParams | None = None
) -> bytes:
    """Return a picture of skeletons: barcodes, heat maps of points and curve, histograms.

    Parameters
    ----------
    qualities : sequence of (str, (n, 3) float64, Quality)
        The name, the cloud and the measures of each.
    kind : "png", "svg" or "pdf"
        The format.
    look : LookParams, optional
        Which axis points up, and the unit of length.

    Returns
    -------
    bytes
    """
    sights = [sight_of(body_of(given[finite_rows(given)]), look) for _, given, _ in qualities]
    tall = [height for sight in sights for height in _heights(sight)]
    figure = new_figure(WIDTH, sum(tall))
    panels = figure.subplots(3 * len(qualities), COLUMNS, squeeze=False, height_ratios=tall)
    for number, (name, _, quality) in enumerate(qualities):
        sight = sights[number]
        rows = panels[3 * number : 3 * number + 3]
        _curve(rows[0][0], name, quality, sight)
        _barcode(rows[1][0], quality)
        _loops(rows[2][0], quality)
        places = None if quality.points is None else quality.points.points
        values = values_of_points(quality), values_of_curve(quality)
        for column, measure in enumerate(MEASURES, 1):
            _heat(rows[0][column], sight, places, values[0], measure, "skeletal points")
            _heat(rows[1][column], sight, _curve_places(quality, measure), values[1], measure, "curve")
            _histogram(rows[2][column], [v.get(measure) for v in values], measure)
        _scale(figure, rows[:2].ravel().tolist())
    return rendered(figure, kind)


def _heights(sight: Sight) -> tuple[float, float, float]:
    """Return the heights of the three rows, in inches."""
    body = COLUMN * sight.ratio + HEAD
    return body, max(body, LOWEST), HEIGHT


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


def _heat(panel: Any, sight: Sight, places: Points | None, values: Values, measure: str, of: str) -> None:
    cloud_panel(panel, sight, small=True)
    panel.set_title(f"{measure} of {of}", fontsize=9)
    if places is not None:
        heat(panel, places, values[measure], sight, size=3 if of != "curve" else 8)


def _scale(figure: Any, panels: list[Any]) -> None:
    """Draw the one colour bar of all measures."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    bar = figure.colorbar(ScalarMappable(Normalize(0, 1), SCALE), ax=panels, shrink=0.7, pad=0.01, aspect=25)
    bar.set_label("0 worst, 1 best; crosses: no value", fontsize=8)
    bar.ax.tick_params(labelsize=7)


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


def _curve(panel: Any, name: str, quality: Quality, sight: Sight) -> None:
    cloud_panel(panel, sight, small=True)
    panel.set_title(name, fontsize=10, fontweight="bold")
    c = quality.curve
    if c is not None:
        for a, b in c.edges:
            panel.plot(*sight.flat(c.nodes[[a, b]]).T, color=CURVE, linewidth=1.4)
