"""What all pictures share: figures without a screen, bytes without dates, and panels in the input's own axes."""

import contextlib
import io
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.extras import extra
from tiskel.geometry.views import View, broad_view
from tiskel.params import LookParams
from tiskel.pictures.style import CLOUD, INK, SCALE, SIZES, faded
from tiskel.wording import printable

SHOWN_POINTS = 20_000  # more only blacken the picture
FORMATS = ("png", "svg", "pdf")
DPI = 110
PALETTE = 256  # colours, as many as PNG numbers; chosen to cover all that occur, none is off by more than a tenth
MARGIN = 0.05  # of the longer side, around what a panel frames
SMALL = 0.25  # of the area of dots, in small panels
FLATTEST, TALLEST = 0.35, 1.4  # height of a panel over its width, whatever the body's


def new_figure(width: float, height: float) -> Any:
    """Return an empty matplotlib figure, in inches; without pyplot it needs no backend, and leaves the user's alone."""
    _load()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _load() -> None:
    """Import matplotlib, also where MPLBACKEND names a backend that there is not: none is needed here."""
    asked = None if "matplotlib" in sys.modules else os.environ.pop("MPLBACKEND", None)
    matplotlib = extra("matplotlib", "a picture")
    if asked is not None:
        os.environ["MPLBACKEND"] = asked
        with contextlib.suppress(ValueError):
            matplotlib.rcParams["backend"] = asked


def rendered(figure: Any, kind: str = "png", dpi: int = DPI) -> bytes:
    """Return the bytes of a figure: the same bytes for the same figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        What is drawn.
    kind : "png", "svg" or "pdf"
        The format.
    dpi : int
        Pixels to an inch, of PNG and of what is an image in the others.

    Raises
    ------
    TiskelError
        For another kind.
    """
    import matplotlib
    from matplotlib.backend_bases import get_registered_canvas_class

    if kind not in FORMATS:
        raise TiskelError(f"a picture cannot be written as {kind!r}; choose one of {', '.join(FORMATS)}")
    metadata = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    titles = [title for title in (figure._suptitle, *(panel.title for panel in figure.axes)) if title is not None]
    for title in titles:  # names of files and branches may hold dollars and worse
        title.set_parse_math(False)
        title.set_text("\n".join(map(printable, title.get_text().split("\n"))))
    figure.set_dpi(dpi)
    canvas, out = get_registered_canvas_class(kind)(figure), io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "tiskel"}):  # figure.savefig would lay out and draw all twice
        getattr(canvas, f"print_{kind}")(out, metadata=metadata)
    return out.getvalue()


def with_palette(data: bytes) -> bytes:
    """Return a PNG with 256 colours in the place of all, a third as large, as it stands inside a page."""
    from PIL import Image

    out = io.BytesIO()
    picture = Image.open(io.BytesIO(data)).convert("RGB")
    picture.quantize(PALETTE, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
        out, format="PNG", optimize=True
    )
    return out.getvalue()


def picture_kind(target: str) -> str:
    """Return the format that the suffix of a target asks for; PNG without one."""
    suffix = target.rpartition(".")[2].lower() if "." in target else ""
    return suffix or "png"


@dataclass(frozen=True, eq=False)
class Sight:
    """How a cloud is looked at, the same in every picture of it.

    Attributes
    ----------
    cloud : (n, 3) float64
        The cloud without its stray points (:func:`tiskel.geometry.strays.body_of`), which would set the scale.
    view : View
        The direction.
    unit : str
        Of length; empty where unknown.
    """

    cloud: Points
    view: View
    unit: str = ""

    def flat(self, places: Points) -> Points:
        """Return (n, 2) where places (n, 3) are in a panel: the input's own coordinates."""
        return self.view.flat(places)

    @property
    def ratio(self) -> float:
        """Height over width of a panel that the body fills, within bounds."""
        width, height = self.view.extent(self.cloud)
        return float(np.clip(height / width if width > 0 else 1.0, FLATTEST, TALLEST))


def sight_of(cloud: Points, look: LookParams | None = None) -> Sight:
    """Return how a cloud without stray points is looked at: along its own axis that shows most of it."""
    chosen = look or LookParams()
    return Sight(cloud, broad_view(cloud, chosen.up), chosen.unit)


def with_unit(name: str, unit: str) -> str:
    """Return a name with the unit of its values where it is known: "x, mm"."""
    return f"{name}, {unit}" if unit else name


def cloud_panel(panel: Any, sight: Sight, frame: Points | None = None, *, small: bool = False) -> None:
    """Draw a cloud at one scale, what is far paler, in named axes of the input.

    Parameters
    ----------
    panel : matplotlib.axes.Axes
        Where to.
    sight : Sight
        The cloud and how it is looked at; of more than 20 000 points some are left out.
    frame : (k, 3) float64, optional
        What the panel shows; the whole cloud without it.
    small : bool
        Whether the panel is small: then the dots are, too.
    """
    shown = sight.cloud[:: -(-len(sight.cloud) // SHOWN_POINTS) or 1]
    dots(panel, sight.flat(shown), sight.view.depth(shown), SMALL if small else 1.0)
    with_axes(panel, sight)
    framed(panel, sight, sight.cloud if frame is None else frame)


def with_axes(panel: Any, sight: Sight) -> None:
    """Give a panel one scale and the names of the input's axes, with the unit of length."""
    panel.set_aspect("equal", adjustable="box")
    panel.tick_params(labelsize=SIZES["ticks"])
    across, up = sight.view.labels
    panel.set_xlabel(with_unit(across, sight.unit), fontsize=SIZES["ticks"], labelpad=1)
    panel.set_ylabel(with_unit(up, sight.unit), fontsize=SIZES["ticks"], labelpad=1)


def dots(panel: Any, flat: Points, depth: Numbers, scale: float = 1.0) -> None:
    """Draw the points of a cloud, far ones first and paler; as an image in SVG and PDF, which it would choke."""
    from matplotlib.colors import to_rgb

    if len(flat) == 0:
        return
    order = np.argsort(depth, kind="stable")
    near = (depth - depth.min()) / (np.ptp(depth) or 1.0)
    size = scale * SIZES["dots"] * min(1.0, (4000 / len(flat)) ** 0.5)
    colours = faded(np.tile(to_rgb(CLOUD), (len(flat), 1)), near)[order]
    panel.scatter(*flat[order].T, s=size, c=colours, linewidths=0, rasterized=True)


def framed(panel: Any, sight: Sight, places: Points) -> None:
    """Set the limits of a panel to places (k, 3), the way the view's axes run."""
    if len(places) == 0:
        return
    flat = sight.flat(places)
    low, high = flat.min(axis=0), flat.max(axis=0)
    margin = MARGIN * float((high - low).max() or 1.0)
    limits = [
        (low[i] - margin, high[i] + margin)[:: sight.view.signs[i]] for i in range(2)
    ]  # fmt: skip
    panel.set_xlim(*limits[0])
    panel.set_ylim(*limits[1])


def named(figure: Any, entries: Sequence[tuple[str, str, str]]) -> None:
    """Draw a legend below all panels, of (what, colour, how); how is "-", "--" or ":" for a line, or a marker."""
    from matplotlib.lines import Line2D

    handles = []
    for what, colour, how in entries:
        dot = {"marker": how, "linestyle": "none", "markersize": 5, "markeredgewidth": 0}
        style = {"linestyle": how} if how in {"-", "--", ":"} else dot
        handles.append(Line2D([], [], color=colour, label=what, linewidth=1.6, **style))
    figure.legend(
        handles=handles, fontsize=SIZES["text"], loc="outside lower center", ncols=len(handles), frameon=False
    )


def heat(panel: Any, places: Points, values: Numbers, sight: Sight, size: float = 5) -> Any:
    """Draw places by their values, those without a value as crosses.

    Parameters
    ----------
    panel : matplotlib.axes.Axes
        Where to.
    places : (n, 3) float64
        The places.
    values : (n,) float64
        From 0 to 1; NaN for none.
    sight : Sight
        How they are looked at.
    size : float
        Area of a marker, in square points.

    Returns
    -------
    matplotlib.collections.PathCollection
        What a colour bar needs.
    """
    flat, known = sight.flat(places), ~np.isnan(values)
    raster = len(flat) > SHOWN_POINTS / 10
    panel.scatter(*flat[~known].T, s=2 * size, c=INK, marker="x", linewidths=0.6)
    return panel.scatter(
        *flat[known].T, s=size, c=values[known], cmap=SCALE, vmin=0, vmax=1, linewidths=0, rasterized=raster
    )
