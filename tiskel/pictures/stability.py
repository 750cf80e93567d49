"""The steps of a contraction: histograms, and the contracted cloud under each."""

from textwrap import fill
from typing import Any

import numpy as np

from tiskel.contraction import Contraction
from tiskel.metrics.distributions import SPAN
from tiskel.metrics.stability import Stability, StepStability
from tiskel.params import LookParams
from tiskel.pictures.canvas import cloud_panel, named, new_figure, rendered, sight_of
from tiskel.pictures.style import CLOUD, CURVE, INK, POINTS

WIDTH, ALONE, HEIGHT, HEAD, TITLE = 3.4, 6.4, 2.6, 0.3, 0.8  # inches per panel; of a single step; titles
LETTERS = 15  # of the title in an inch


def stability_picture(
    contraction: Contraction, stability: Stability, title: str, kind: str = "png", look: LookParams | None = None
) -> bytes:
    """Return a column per step: turns of the normals, changes of curvature, the contracted points in their cloud.

    Parameters
    ----------
    contraction : Contraction
        The contraction, with its history.
    stability : Stability
        Its steps as they were judged.
    title : str
        The name of the cloud.
    kind : "png", "svg" or "pdf"
        The format.
    look : LookParams, optional
        Which axis points up, and the unit of length.

    Returns
    -------
    bytes
    """
    count = len(stability.steps)
    sight = sight_of(contraction.cloud[~contraction.strays], look)
    wide = WIDTH if count > 1 else ALONE
    tall = (HEIGHT, HEIGHT, wide * sight.ratio + HEAD)
    figure = new_figure(count * wide, sum(tall) + TITLE)
    panels = figure.subplots(3, count, squeeze=False, height_ratios=tall)
    for number, (step, positions) in enumerate(zip(stability.steps, contraction.history, strict=True)):
        _angles(panels[0][number], step, number + 1)
        _curvatures(panels[1][number], step)
        cloud_panel(panels[2][number], sight, small=True)
        panels[2][number].scatter(*sight.flat(positions).T, s=1.5, c=CURVE, linewidths=0, rasterized=True)
    named(figure, (("cloud", CLOUD, "o"), ("contracted", CURVE, "o"), ("even over a curve", INK, "--")))
    verdict = f"{title}: {'stable' if stability.stable else 'not stable'}: {stability.reason}"
    figure.suptitle(fill(verdict, int(LETTERS * count * wide)), fontsize=9)
    return rendered(figure, kind)


def _angles(panel: Any, step: StepStability, number: int) -> None:
    """Draw the histogram of angles; a curve has the dashed level up to a right angle."""
    bins = np.linspace(0, 1, 51)
    panel.hist(step.angles, bins, weights=np.full(len(step.angles), 1 / len(step.angles)), color=POINTS)
    panel.plot([0, 0.5, 0.5], [0.04, 0.04, 0], color=INK, linewidth=0.9, linestyle="--")
    panel.set_title(f"step {number}: turn of normals / pi", fontsize=8)
    panel.set_xlabel(_numbers(step.angle.mean, step.angle.spread, step.angle.skewness), fontsize=7)
    panel.tick_params(labelsize=6)


def _curvatures(panel: Any, step: StepStability) -> None:
    low, high = SPAN["curvature"]
    shares = np.full(len(step.curvatures), 1 / len(step.curvatures))
    panel.hist(step.curvatures, np.linspace(low, high, 101), weights=shares, color=POINTS)
    panel.set_title("change of curvature", fontsize=8)
    c = step.curvature
    panel.set_xlabel(_numbers(c.mean, c.spread, c.skewness), fontsize=7)
    panel.tick_params(labelsize=6)


def _numbers(mean: float, spread: float, skewness: float) -> str:
    return f"mean {mean:.3f}, spread {spread:.3f}, skewness {skewness:.2f}"
