"""The picture of docs/robust.md: method robust on a hand, step by step; docs/pictures.py writes it."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.colors import ListedColormap
from matplotlib.patches import Circle, Polygon
from matplotlib.ticker import MaxNLocator

from tiskel import (
    Contraction,
    CurveGraph,
    LookParams,
    ShapeParams,
    contract,
    extract_skeleton,
    make_shape,
    shape_graph,
)  # fmt: skip
from tiskel.arrays import Numbers
from tiskel.methods.robust.sections import section_graph
from tiskel.pictures.canvas import Sight, cloud_panel, new_figure, rendered, sight_of
from tiskel.pictures.style import CURVE, INK, POINTS

SHAPE, NOISE, COUNT = "hand", 0.1, 3500
CONES = "#f3cfc7"
MARGIN = 0.06  # about the cloud, in its units
TURNED = np.array([[0.0, -1.0], [1.0, 0.0]])


def sections_of(c: Contraction) -> CurveGraph:
    """Return the graph of the sections of the last front, in the input's units."""
    network, frame = c.prepared, c.as_trace()[1]
    assert c.sections is not None
    graph = section_graph(network, c.sections)
    return CurveGraph(frame.undo(graph.nodes @ network.axes), graph.edges, graph.radii / frame.scale)


def outline(ends: Numbers, radii: Numbers) -> Numbers:
    """Return the four corners (4, 2) between the circles about two ends (2, 2), where the common tangents touch."""
    way = ends[1] - ends[0]
    length = float(np.linalg.norm(way))
    along, lean = way / length, np.clip((radii[0] - radii[1]) / length, -1, 1)
    sides = [lean * along + sign * np.sqrt(1 - lean**2) * (TURNED @ along) for sign in (1, -1)]
    return np.stack([ends[i] + radii[i] * sides[j] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])


def bins(count: int) -> ListedColormap:
    """Return a colour for each bin, every other one darker, so that neighbours can be told apart."""
    colours = colormaps["turbo"](np.linspace(0, 1, count))
    colours[1::2, :3] *= 0.6
    return ListedColormap(colours)


def draw_curve(panel: Any, graph: CurveGraph, sight: Sight, size: float) -> None:
    """Draw nodes and edges."""
    flat = sight.flat(graph.nodes)
    panel.add_collection(LineCollection(list(flat[graph.edges]), colors=INK, linewidths=1.0, zorder=3))
    panel.scatter(*flat.T, s=size, c=CURVE, linewidths=0, zorder=4)


def draw_cones(panel: Any, graph: CurveGraph, sight: Sight) -> None:
    """Draw the round cones of a curve as one shade: circles about the nodes and what lies between two of them."""
    flat = sight.flat(graph.nodes)
    shapes: list[Any] = [Circle(tuple(place), radius) for place, radius in zip(flat, graph.radii, strict=True)]
    shapes += [Polygon(outline(flat[edge], graph.radii[edge])) for edge in graph.edges]
    panel.add_collection(PatchCollection(shapes, facecolor=CONES, edgecolor="none", zorder=0))


def picture() -> bytes:
    """Return the PNG."""
    cloud = make_shape(shape_graph(SHAPE), ShapeParams(count=COUNT, noise=NOISE))[0]
    c = contract(cloud)
    skeleton = extract_skeleton(c)
    assert c.sections is not None
    sight = sight_of(cloud, LookParams(up="z"))
    figure = new_figure(12.0, 4.4)
    titles = (
        f"1: {len(cloud)} points, noise {NOISE:.0%}",
        "2: bins of geodesic distance",
        "3: points on their axes",
        "4: graph of the sections",
        "5: round cones",
    )
    flat = sight.flat(cloud)
    low, high = flat.min(axis=0), flat.max(axis=0)
    panels = figure.subplots(1, 5)
    for panel, title in zip(panels, titles, strict=True):
        panel.set_title(title, fontsize=10, color=INK)
        cloud_panel(panel, sight, small=True)
        panel.set_axis_off()
        panel.set_xlim(low[0] - MARGIN, high[0] + MARGIN)
        panel.set_ylim(low[1] - 2 * MARGIN, high[1] + MARGIN)
        panel.set_aspect("equal", adjustable="box")
    drawn = panels[1].scatter(*flat.T, s=5, c=c.sections.level, cmap=bins(c.sections.level.max() + 1), linewidths=0)
    bar = figure.colorbar(drawn, cax=panels[1].inset_axes((0.15, 0.02, 0.7, 0.02)), orientation="horizontal")
    bar.ax.tick_params(labelsize=7)
    bar.locator = MaxNLocator(6, integer=True)
    panels[0].scatter(*flat.T, s=2, c=INK, linewidths=0)
    panels[2].scatter(*sight.flat(c.points).T, s=2.5, c=POINTS, linewidths=0)
    draw_curve(panels[3], sections_of(c), sight, 9)
    draw_cones(panels[4], skeleton, sight)
    draw_curve(panels[4], skeleton, sight, 9)
    return rendered(figure)
