"""The steps of a contraction: histograms, and the contracted cloud under each."""

from typing import Any

import numpy as np

from tiskel.contraction import Contraction
from tiskel.metrics.distributions import SPAN
from tiskel.metrics.stability import Stability, StepStability
from tiskel.pictures.canvas import CURVE, INK, POINTS, broad_view, cloud_panel, new_figure, rendered

WIDTH, HEIGHT, TITLE = 3.2, 2.9, 0.4  # inches per panel


def stability_picture(contraction: Contraction, stability: Stability, title: str, kind: str = "png") -> bytes:
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

    Returns
    -------
    bytes
    """
    count = len(stability.steps)
    figure = new_figure(max(2, count) * WIDTH, 3 * HEIGHT + TITLE)
    panels = figure.subplots(3, count, squeeze=False)
    cloud = contraction.cloud[~contraction.strays]
    view = broad_view(cloud)
    for number, (step, positions) in enumerate(zip(stability.steps, contraction.history, strict=True)):
        _angles(panels[0][number], step, number + 1)
        _curvatures(panels[1][number], step)
        cloud_panel(panels[2][number], cloud, view)
        panels[2][number].scatter(*(positions @ view.T).T, s=1.5, c=CURVE, linewidths=0)
    figure.suptitle(f"{title}: {'stable' if stability.stable else 'not stable'}: {stability.reason}", fontsize=9)
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
