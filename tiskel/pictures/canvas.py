"""What all pictures share: figures without a screen, bytes without dates, views, colours."""

import contextlib
import io
import os
import sys
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.wording import printable

SHOWN_POINTS = 20_000  # more only blacken the picture
CLOUD, CURVE, POINTS, INK = "#b9c2cc", "#c0392b", "#2471a3", "#1f3a5f"
FORMATS = ("png", "svg", "pdf")
SCALE = "viridis"  # of values from 0 to 1: dark is bad, bright is good
DPI = 110


def new_figure(width: float, height: float) -> Any:
    """Return an empty matplotlib figure, in inches; without pyplot it needs no backend, and leaves the user's alone."""
    _load()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _load() -> None:
    """Import matplotlib, also where MPLBACKEND names a backend that there is not: none is needed here."""
    asked = None if "matplotlib" in sys.modules else os.environ.pop("MPLBACKEND", None)
    import matplotlib

    if asked is not None:
        os.environ["MPLBACKEND"] = asked
        with contextlib.suppress(ValueError):
            matplotlib.rcParams["backend"] = asked


def rendered(figure: Any, kind: str = "png") -> bytes:
    """Return the bytes of a figure: the same bytes for the same figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        What is drawn.
    kind : "png", "svg" or "pdf"
        The format.

    Raises
    ------
    TiskelError
        For another kind.
    """
    import matplotlib

    if kind not in FORMATS:
        raise TiskelError(f"a picture cannot be written as {kind!r}; choose one of {', '.join(FORMATS)}")
    metadata = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    titles = [title for title in (figure._suptitle, *(panel.title for panel in figure.axes)) if title is not None]
    for title in titles:  # names of files and branches may hold dollars and worse
        title.set_parse_math(False)
        title.set_text("\n".join(map(printable, title.get_text().split("\n"))))
    out = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "tiskel"}):
        figure.savefig(out, format=kind, dpi=DPI, metadata=metadata)
    return out.getvalue()


def picture_kind(target: str) -> str:
    """Return the format that the suffix of a target asks for; PNG without one."""
    suffix = target.rpartition(".")[2].lower() if "." in target else ""
    return suffix or "png"


def broad_view(cloud: Points) -> Points:
    """Return two directions (2, 3) that show most of a cloud: its principal axes, each pointing up its longest part."""
    axes = np.linalg.svd(cloud - cloud.mean(axis=0), full_matrices=False)[2][:2]
    return np.asarray(axes * np.where(axes[np.arange(2), np.abs(axes).argmax(axis=1)] < 0, -1.0, 1.0)[:, None])


def cloud_panel(panel: Any, cloud: Points, view: Points) -> None:
    """Draw a cloud in grey, at one scale, without ticks.

    Parameters
    ----------
    panel : matplotlib.axes.Axes
        Where to.
    cloud : (n, 3) float64
        The cloud without its stray points (:func:`tiskel.geometry.strays.body_of`), which would set the scale; of more
        than 20 000 points some are left out.
    view : (2, 3) float64
        The directions that run across and up.
    """
    shown = cloud[:: max(1, len(cloud) // SHOWN_POINTS)] @ view.T
    panel.scatter(*shown.T, s=1.5, c=CLOUD, linewidths=0)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_xticks([])
    panel.set_yticks([])


def heat(panel: Any, places: Points, values: Numbers, view: Points, size: float = 5) -> Any:
    """Draw places by their values, those without a value as crosses.

    Parameters
    ----------
    panel : matplotlib.axes.Axes
        Where to.
    places : (n, 3) float64
        The places.
    values : (n,) float64
        From 0 to 1; NaN for none.
    view : (2, 3) float64
        The directions that run across and up.
    size : float
        Area of a marker, in square points.

    Returns
    -------
    matplotlib.collections.PathCollection
        What a colour bar needs.
    """
    flat, known = places @ view.T, ~np.isnan(values)
    panel.scatter(*flat[~known].T, s=2 * size, c=INK, marker="x", linewidths=0.6)
    return panel.scatter(*flat[known].T, s=size, c=values[known], cmap=SCALE, vmin=0, vmax=1, linewidths=0)
