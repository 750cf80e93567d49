"""A cloud and its curve."""

from typing import Any

import numpy as np

from tiskel.arrays import Points
from tiskel.geometry.strays import body_of
from tiskel.pictures.canvas import new_figure, rendered
from tiskel.skeleton import Skeleton

SHOWN_POINTS = 20_000  # more only blacken the picture
WIDTH, MARGIN = 11.0, 1.3  # inches
SLENDER = 0.12  # least share of the longest extent that a panel gets
PANELS = ((0, 0, (0, 1)), (1, 0, (0, 2)), (0, 1, (2, 1)))  # row, column, axes across and up: a third-angle drawing


def skeleton_picture(skeleton: Skeleton, title: str) -> bytes:
    """Return a PNG of three views along the principal axes of the cloud, at one scale: cloud grey, curve red."""
    body = body_of(skeleton.cloud)
    centre = body.mean(axis=0)
    axes = np.linalg.svd(body - centre, full_matrices=False)[2]
    cloud, nodes = (body - centre) @ axes.T, (skeleton.nodes - centre) @ axes.T
    extent = np.maximum(np.ptp(cloud, axis=0), SLENDER * np.ptp(cloud, axis=0).max())
    widths, heights = (extent[0], extent[2]), (extent[1], extent[2])
    height = (WIDTH - MARGIN) * sum(heights) / sum(widths) + MARGIN
    figure = new_figure(WIDTH, height)
    grid = figure.add_gridspec(2, 2, width_ratios=widths, height_ratios=heights)
    for row, column, shown in PANELS:
        panel = figure.add_subplot(grid[row, column])
        across, up = cloud[:: max(1, len(cloud) // SHOWN_POINTS), shown].T
        panel.scatter(across, up, s=2, c="#b9c2cc", linewidths=0)
        _curve(panel, nodes[:, shown], skeleton)
        panel.set_aspect("equal", adjustable="datalim")
        panel.tick_params(labelsize=7)
    figure.suptitle(f"{title}: {_counts(skeleton)}", fontsize=10)
    return rendered(figure)


def _curve(panel: Any, flat: Points, skeleton: Skeleton) -> None:
    """Draw the branches, their junctions and their ends."""
    for branch in skeleton.branches:
        panel.plot(*flat[branch].T, "-", color="#c0392b", linewidth=1.6, solid_capstyle="round")
    degrees = skeleton.degrees
    panel.scatter(*flat.T, s=6, c="#c0392b", zorder=3)
    panel.scatter(*flat[degrees > 2].T, s=26, c="#1f3a5f", zorder=4)
    panel.scatter(*flat[degrees == 1].T, s=26, c="#e8a33d", zorder=4)


def _counts(s: Skeleton) -> str:
    words = (
        (len(s.nodes), "node"),
        (s.components, "component"),
        (s.loops, "loop"),
        (s.ends, "end"),
        (s.junctions, "joint"),
    )
    return ", ".join(f"{count} {word}{'' if count == 1 else 's'}" for count, word in words)
