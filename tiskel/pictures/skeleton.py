"""A cloud and its curve: front, side and top in the input's own axes at one scale, and a view in space."""

from typing import Any

from tiskel.arrays import Points
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.strays import body_of
from tiskel.geometry.views import eye_direction, screen_axes, up_axis, views
from tiskel.params import LookParams
from tiskel.pictures.canvas import Sight, cloud_panel, dots, named, new_figure, rendered
from tiskel.pictures.style import CLOUD, CURVE, SIZES, colour_of
from tiskel.skeleton import Skeleton

SHOWN_POINTS = 20_000  # more only blacken the picture
WIDTH, MARGIN, TALLEST = 11.0, 1.6, 12.0  # inches
SLENDER = 0.2  # least share of the longest extent that a panel gets
PLACES = {"top": (0, 0), "front": (1, 0), "side": (1, 1)}  # row, column: a third-angle drawing
LEGEND = (
    ("cloud, far away paler", CLOUD, "o"), ("curve", CURVE, "-"),
    ("joint", colour_of("joint"), "o"), ("end", colour_of("end"), "o"),
)  # fmt: skip


def skeleton_picture(skeleton: Skeleton, title: str, kind: str = "png", look: LookParams | None = None) -> bytes:
    """Return front, side and top view of a skeleton in its cloud, at one scale, and a view in space.

    Parameters
    ----------
    skeleton : Skeleton
        What is drawn.
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
    return rendered(skeleton_figure(skeleton, title, look), kind)


def skeleton_figure(skeleton: Skeleton, title: str = "", look: LookParams | None = None) -> Any:
    """Return front, side and top view of a skeleton in its cloud, if it has one, and a view in space.

    Parameters
    ----------
    skeleton : Skeleton
        What is drawn.
    title : str
        What stands above, before the counts.
    look : LookParams, optional
        Which axis points up, and the unit of length.

    Returns
    -------
    matplotlib.figure.Figure
    """
    places = body_of(skeleton.cloud) if len(skeleton.cloud) else skeleton.nodes
    words = f"{title}: {_counts(skeleton)}" if title else _counts(skeleton)
    return _views(places, skeleton, words, look or LookParams())


def three_views(
    cloud: Points, curve: CurveGraph | Points, title: str, kind: str = "png", look: LookParams | None = None
) -> bytes:
    """Return three views and one in space of a cloud without stray points and a curve, or contracted points (m, 3)."""
    return rendered(_views(cloud, curve, title, look or LookParams()), kind)


def _views(cloud: Points, curve: CurveGraph | Points, title: str, chosen: LookParams) -> Any:
    up = up_axis(cloud, chosen.up)
    front, side, _ = views(up)
    (across, height), (depth, _) = front.extent(cloud), side.extent(cloud)
    least = SLENDER * max(across, depth, height) or 1.0
    widths, heights = (max(across, least), max(depth, least)), (max(depth, least), max(height, least))
    tall = (WIDTH - MARGIN) * sum(heights) / sum(widths) + MARGIN
    figure = new_figure(WIDTH * min(1.0, TALLEST / tall), min(tall, TALLEST))
    grid = figure.add_gridspec(2, 2, width_ratios=widths, height_ratios=heights)
    for view in views(up):
        panel = figure.add_subplot(grid[PLACES[view.name]])
        sight = Sight(cloud, view, chosen.unit)
        cloud_panel(panel, sight)
        _drawn(panel, curve, sight.flat)
        panel.set_title(view.name, fontsize=SIZES["text"])
    _in_space(figure.add_subplot(grid[0, 1]), cloud, curve, up)
    named(figure, LEGEND if isinstance(curve, CurveGraph) else (LEGEND[0], ("contracted points", CURVE, "o")))
    figure.suptitle(title, fontsize=SIZES["title"])
    return figure


def _in_space(panel: Any, cloud: Points, curve: CurveGraph | Points, up: str) -> None:
    """Draw the view from an eye in front and above."""
    axes = screen_axes(eye_direction(cloud, up), up)  # type: ignore[arg-type]
    shown = cloud[:: -(-len(cloud) // SHOWN_POINTS) or 1] @ axes.T
    dots(panel, shown[:, :2], shown[:, 2])
    _drawn(panel, curve, lambda places: places @ axes[:2].T)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_axis_off()
    panel.set_title("in space", fontsize=SIZES["text"])


def _drawn(panel: Any, curve: CurveGraph | Points, flat: Any) -> None:
    """Draw the branches with their joints and ends, or contracted points."""
    if not isinstance(curve, CurveGraph):
        panel.scatter(*flat(curve).T, s=1.5, c=CURVE, linewidths=0, rasterized=True)
        return
    nodes = flat(curve.nodes)
    for branch in curve.branches:
        panel.plot(*nodes[branch].T, "-", color=CURVE, linewidth=1.5, solid_capstyle="round")
    degrees = curve.degrees
    for role, chosen in (("joint", degrees > 2), ("end", degrees == 1)):
        size = SIZES["knots"] * min(1.0, (60 / max(int(chosen.sum()), 1)) ** 0.5)
        panel.scatter(*nodes[chosen].T, s=size, c=colour_of(role), linewidths=0, zorder=4)


def _counts(s: Skeleton) -> str:
    words = (
        (len(s.nodes), "node"),
        (s.components, "component"),
        (s.loops, "loop"),
        (s.ends, "end"),
        (s.junctions, "joint"),
    )
    return ", ".join(f"{count} {word}{'' if count == 1 else 's'}" for count, word in words)
