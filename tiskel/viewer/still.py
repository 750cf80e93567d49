"""A scene as a still picture, drawn without a screen: what stands in where there is no WebGL, and `view -o out.png`."""

from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.geometry.views import screen_axes
from tiskel.pictures.canvas import new_figure, rendered
from tiskel.pictures.style import BACKGROUND, CATEGORIES, INK, QUIET, SCALE, SIZES, colour_of, faded
from tiskel.viewer.packed import value_span
from tiskel.viewer.scene import Field, Layer, Scene

WIDTH, HEIGHT = 10.0, 7.0  # inches
DISTANCE = 3.7  # of the eye, in radii of the scene: an opening angle of 30 degrees, as the page has it
MOST_POINTS = 60_000  # of a cloud; more only blacken the picture
MARGIN = 0.06  # of the picture, around what it shows
BAR = 0.2  # most of the width that a scale bar takes
BYTE = 255.0  # of a colour at its brightest
LIGHT = np.array([-0.35, 0.55, 0.75])  # direction to the sun: right, up, towards the eye
SHADE = 0.45  # of the colour that is left where the light grazes


class _Eye:
    """Where the scene is seen from, in perspective."""

    def __init__(self, scene: Scene) -> None:
        body = scene.body
        low, high = body.min(axis=0), body.max(axis=0)
        self.centre, self.radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2 or 1.0
        self.axes = screen_axes(scene.eye, scene.up)
        depth = (body - self.centre) @ self.axes[2] / self.radius
        self.far, self.near = float(depth.min()), float(depth.max())

    def flat(self, places: Points) -> tuple[Points, Numbers]:
        """Return (n, 2) picture coordinates, in the scene's unit at its centre, and (n,) depths from 0, far, to 1."""
        turned = (places - self.centre) @ self.axes.T / self.radius
        shrunk = DISTANCE / np.maximum(DISTANCE - turned[..., 2], 0.1)
        return turned[..., :2] * shrunk[..., None] * self.radius, np.clip(
            (turned[..., 2] - self.far) / max(self.near - self.far, 1e-9), 0, 1
        )


def still(scene: Scene, kind: str = "png", most: int = MOST_POINTS) -> bytes:
    """Return a picture of the layers of a scene that are shown at first.

    Parameters
    ----------
    scene : Scene
        What it shows.
    kind : "png", "svg" or "pdf"
        The format.
    most : int
        Points of a cloud that are drawn at most.

    Returns
    -------
    bytes
        The same bytes for the same scene.
    """
    figure = new_figure(WIDTH, HEIGHT)
    panel = figure.add_subplot()
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_axis_off()
    eye = _Eye(scene)
    coloured = None
    for layer in scene.layers:
        if layer.shown and layer.kind in DRAW:
            field = next((one for one in layer.fields if scene.colour and one.name == scene.colour), None)
            coloured = coloured or field
            DRAW[layer.kind](panel, layer, eye, _colours(layer, field), most)
    panel.margins(MARGIN)
    panel.set_title(scene.title, fontsize=SIZES["title"], loc="left")
    _furniture(figure, panel, scene, eye, coloured)
    return rendered(figure, kind)


def _colours(layer: Layer, field: Field | None) -> npt.NDArray[np.float64]:
    """Return (n, 3) the colour of every place."""
    from matplotlib import colormaps
    from matplotlib.colors import to_rgb

    if field is None:
        return np.tile(to_rgb(colour_of(layer.role)), (len(layer.places), 1))
    if field.values.ndim == 2:
        return np.asarray(field.values, np.float64) / BYTE
    if field.labels:
        return np.asarray(np.array([to_rgb(colour) for colour in CATEGORIES])[field.values % len(CATEGORIES)])
    low, high = value_span(field)
    return np.asarray(colormaps[SCALE]((field.values - low) / ((high - low) or 1.0))[:, :3])


def _points(panel: Any, layer: Layer, eye: _Eye, colours: Numbers, most: int) -> None:
    rows = np.arange(len(layer.places))[:: -(-len(layer.places) // most)]
    flat, depth = eye.flat(layer.places[rows])
    order = np.argsort(depth)
    size = SIZES["dots"] * min(1.0, (10_000 / max(len(rows), 1)) ** 0.5) if layer.role == "cloud" else SIZES["places"]
    panel.scatter(
        *flat[order].T, s=size, c=faded(colours[rows[order]], depth[order]), linewidths=0, rasterized=True, zorder=1
    )


def _curve(panel: Any, layer: Layer, eye: _Eye, colours: Numbers, most: int) -> None:
    _segments(panel, layer.places, np.asarray(layer.more["edges"]), eye, colours, 2.2)
    for role, size in (("end", 22), ("joint", 22)):
        rows = np.unique(np.asarray(layer.more[role], int))
        panel.scatter(*eye.flat(layer.places[rows])[0].T, s=size, c=colour_of(role), linewidths=0, zorder=5)


def _lines(panel: Any, layer: Layer, eye: _Eye, colours: Numbers, most: int) -> None:
    stops = np.cumsum(layer.more["counts"])
    start = np.delete(np.arange(len(layer.places)), stops - 1)
    _segments(panel, layer.places, np.stack([start, start + 1], axis=1), eye, colours, 0.8)


def _segments(panel: Any, places: Points, pairs: npt.NDArray[Any], eye: _Eye, colours: Numbers, width: float) -> None:
    from matplotlib.collections import LineCollection

    flat, depth = eye.flat(places)
    order = np.argsort(depth[pairs].mean(axis=1))
    first = pairs[order][:, 0]
    lines = LineCollection(
        flat[pairs[order]], colors=faded(colours[first], depth[first]), linewidths=width, capstyle="round", zorder=4
    )
    panel.add_collection(lines)


def _mesh(panel: Any, layer: Layer, eye: _Eye, colours: Numbers, most: int) -> None:
    """Draw the faces from far to near, shaded by how they face the light."""
    from matplotlib.collections import PolyCollection

    faces = _faces(layer)
    flat, depth = eye.flat(layer.places)
    corners = layer.places[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) @ eye.axes.T
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    lit = SHADE + (1 - SHADE) * np.abs(normal @ LIGHT / np.linalg.norm(LIGHT))
    order = np.argsort(depth[faces].mean(axis=1))
    painted = faded(colours[faces[order, 0]] * lit[order][:, None], depth[faces[order, 0]])
    panel.add_collection(
        PolyCollection(list(flat[faces[order]]), facecolors=painted, edgecolors=painted, linewidths=0.2, zorder=1.5)
    )


def _faces(layer: Layer) -> npt.NDArray[np.int64]:
    """Return the triangles of a mesh, or the quadrilaterals of its grids."""
    if "triangles" in layer.more:
        return np.asarray(layer.more["triangles"], np.int64).reshape(-1, 3)
    made, start = [], 0
    for rows, around, closed in layer.more["grids"]:
        number = start + np.arange(rows * around).reshape(rows, around)
        after = np.roll(number, -1, axis=0) if closed else number[1:]
        here = number[: len(after)]
        made.append(np.stack([here, np.roll(here, -1, axis=1), np.roll(after, -1, axis=1), after], axis=-1))
        start += rows * around
    return np.concatenate([grid.reshape(-1, 4) for grid in made])


def _marks(panel: Any, layer: Layer, eye: _Eye, colours: Numbers, most: int) -> None:
    panel.scatter(*eye.flat(layer.places)[0].T, s=60, facecolors="none", edgecolors=colours, linewidths=2, zorder=6)


def _path(panel: Any, layer: Layer, eye: _Eye, colours: Numbers, most: int) -> None:
    """Draw the contact's way, and the sphere where it begins."""
    from matplotlib.patches import Circle

    way = eye.flat(layer.more["contact"])[0]
    panel.plot(*way.T, color=colour_of("path"), linewidth=1.8, zorder=4)
    centre, _ = eye.flat(layer.more["centre"][:1])
    ball = Circle(centre[0], layer.more["radius"], facecolor=colour_of("ball"), edgecolor=INK, linewidth=1, zorder=4.5)
    panel.add_patch(ball)


DRAW = {"points": _points, "curve": _curve, "lines": _lines, "mesh": _mesh, "marks": _marks, "path": _path}


def _furniture(figure: Any, panel: Any, scene: Scene, eye: _Eye, coloured: Field | None) -> None:
    """Draw axes, a scale bar that holds at the middle of the scene, and the colour bar."""
    corner = panel.inset_axes((0.0, 0.0, 0.11, 0.15))
    corner.set(xlim=(-1.4, 1.4), ylim=(-1.4, 1.4), aspect="equal")
    corner.set_axis_off()
    for axis, name in enumerate("xyz"):
        tip = eye.axes[:2, axis]
        corner.annotate("", tip, (0, 0), arrowprops={"arrowstyle": "-|>", "color": CATEGORIES[axis], "lw": 1.5})
        corner.text(*(1.3 * tip), name, ha="center", va="center", fontsize=SIZES["text"], color=INK)
    figure.draw_without_rendering()
    low, high = panel.get_xlim()
    length = round_length(BAR * (high - low))
    share = length / (high - low)
    panel.plot([0.14, 0.14 + share], [0.03, 0.03], color=INK, linewidth=1.6, transform=panel.transAxes, zorder=7)
    words = f"{length:g} {scene.unit}".strip()
    panel.text(0.14 + share / 2, 0.045, words, ha="center", fontsize=SIZES["text"], transform=panel.transAxes)
    if coloured is not None and not coloured.labels and coloured.values.ndim == 1:
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        unit = f", {scene.unit}" if coloured.length and scene.unit else ""
        bar = figure.colorbar(ScalarMappable(Normalize(*value_span(coloured)), SCALE), ax=panel, shrink=0.6)
        bar.set_label(f"{coloured.title or coloured.name}{unit}", color=QUIET)
    figure.set_facecolor(BACKGROUND)


def round_length(most: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is at most this.

    Examples
    --------
    >>> from tiskel.viewer.still import round_length
    >>> round_length(0.73), round_length(40.0)
    (0.5, 20.0)
    """
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(step * power for step in (1, 2, 5) if step * power <= most * (1 + 1e-9)))
