"""The style of every picture: colours that colour-blind readers can tell apart, sizes of letters and dots.

Okabe and Ito, Color Universal Design, 2008, for what has names; viridis (Smith and van der Walt, 2015) for values.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

BACKGROUND, INK, QUIET, CLOUD = "#ffffff", "#1f3a5f", "#5b6773", "#8c98a4"
CURVE, POINTS = "#c0392b", "#2471a3"
CATEGORIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#7f7f7f")
ROLES = {
    "cloud": CLOUD, "points": POINTS, "curve": CURVE, "tube": "#d9822b", "surface": "#8fb3cf", "slices": POINTS,
    "warning": "#b3261e", "note": "#8a5a00", "path": CURVE, "ball": "#e9b48c", "end": "#e69f00", "joint": INK,
}  # fmt: skip
SCALE = "viridis"  # of values from 0 to 1: dark is bad, bright is good
SIZES = {
    "title": 10.0,
    "head": 9.0,
    "text": 8.0,
    "ticks": 7.0,
    "dots": 3.0,
    "places": 6.0,
    "knots": 20.0,
}  # points; marks in points^2
FADE = 0.62  # how much of the background is mixed into what is farthest away: the depth cue


def colour_of(role: str) -> str:
    """Return the colour of a thing: cloud, curve, surface, warning and so on."""
    return ROLES[role]


def faded(colours: npt.NDArray[Any], depth: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Return colours (n, 3) mixed with the background the more the farther away: depth (n,) is 1 near and 0 far."""
    from matplotlib.colors import to_rgb

    far = FADE * (1 - np.asarray(depth, float))[..., None]
    return np.asarray(np.clip((1 - far) * colours + far * np.array(to_rgb(BACKGROUND)), 0, 1))
