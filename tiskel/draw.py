"""Pictures: a cloud and its curve."""

import io
from typing import Any

import numpy as np

from tiskel.arrays import Points
from tiskel.skeleton import Skeleton

SHOWN_POINTS = 20_000  # more only blacken the picture
VIEWS = ((2, "along axis 3"), (1, "along axis 2"), (0, "along axis 1"))


def skeleton_picture(skeleton: Skeleton, title: str) -> bytes:
    """Return a PNG with three views along the principal axes of the cloud: the cloud in grey, the curve on top."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    centre = skeleton.cloud.mean(axis=0)
    axes = np.linalg.svd(skeleton.cloud - centre, full_matrices=False)[2]
    cloud, nodes = (skeleton.cloud - centre) @ axes.T, (skeleton.nodes - centre) @ axes.T
    stride = max(1, len(cloud) // SHOWN_POINTS)
    figure = Figure(figsize=(13, 5), layout="constrained")
    for panel, (across, name) in zip(figure.subplots(1, 3), VIEWS, strict=True):
        shown = [axis for axis in range(3) if axis != across]
        panel.scatter(*cloud[::stride, shown].T, s=2, c="#b9c2cc", linewidths=0)
        _curve(panel, nodes[:, shown], skeleton)
        panel.set_aspect("equal")
        panel.set_title(name, fontsize=9)
        panel.tick_params(labelsize=7)
    figure.suptitle(f"{title}: {_counts(skeleton)}", fontsize=11)
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=110, metadata={"Software": None})
    return out.getvalue()


def _curve(panel: Any, flat: Points, skeleton: Skeleton) -> None:
    """Draw the branches, their joints and their ends."""
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
        (s.joints, "joint"),
    )
    return ", ".join(f"{count} {word}{'' if count == 1 else 's'}" for count, word in words)
