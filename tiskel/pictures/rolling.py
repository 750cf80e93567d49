"""A run as the published figures show it: both contact paths, states over time, R_o over time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Table
from tiskel.geometry.frames import across
from tiskel.geometry.strays import body_of
from tiskel.pictures.canvas import CURVE, INK, POINTS, broad_view, cloud_panel, new_figure, rendered
from tiskel.rolling.sphere import rotation_of
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.patches import BodySurface
from tiskel.surfaces.tube import V_STOP

COLOURS, STYLES = (CURVE, POINTS), ("-", "--")  # of the first and the second run
LEAST_SPAN = 0.02  # of a panel, in radians or mean radii: less is no change
STATES = ("u_o", "v_o", "u_s", "v_s", "psi")
TURN = np.linspace(0, 2 * np.pi, 73)


def rolling_picture(
    surface: FittedSurface | BodySurface, runs: Sequence[Trajectory], title: str, kind: str = "png"
) -> bytes:  # fmt: skip
    """Return a picture of one or two runs: ways over object and sphere, R_o, and the five states over time.

    Parameters
    ----------
    surface : FittedSurface or BodySurface
        What the sphere rolls over; its cloud is drawn.
    runs : sequence of Trajectory
        One or two runs, a colour each.
    title : str
        The name of the cloud.
    kind : "png", "svg" or "pdf"
        The format.

    Returns
    -------
    bytes
    """
    figure = new_figure(15, 7.6)
    grid = figure.add_gridspec(2, 15)
    over, ball, radius = (figure.add_subplot(grid[0, 5 * i : 5 * i + 5]) for i in range(3))
    _over(over, surface, runs)
    _on_sphere(ball, runs)
    _against_time(radius, runs, [r.object_radius for r in runs], "R_o at the contact", surface.radius)
    for i, (heading, values) in enumerate(_states(runs)):
        panel = figure.add_subplot(grid[1, 3 * i : 3 * i + 3])
        _against_time(panel, runs, values, heading, 1.0)
    where = f"branch {surface.name}" if isinstance(surface, FittedSurface) else "the whole body"
    said = "; ".join(f"{_name(r)}: {r.status.value}" for r in runs)
    figure.suptitle(f"{title}, {where}. {said}", fontsize=10)
    return rendered(figure, kind)


def _states(runs: Sequence[Trajectory]) -> list[tuple[str, list[Numbers]]]:
    """Return headings and values over time: the five states; without a chart room and way in place of u_o and v_o."""
    named = [(f"{name}, radians", [r.state[:, i] for r in runs]) for i, name in enumerate(STATES)]
    if np.isfinite(runs[0].state).all():
        return named
    room = [r.margin * r.radius for r in runs]
    return [("margin, 1 on a plane", room), ("way, radii", [r.ways[:, 0] / r.radius for r in runs]), *named[2:]]


def _name(r: Trajectory) -> str:
    return r.params.model + (", normals of neighbours" if r.params.normals == "pca" else "")


def _over(panel: Any, surface: FittedSurface | BodySurface, runs: Sequence[Trajectory]) -> None:
    """Draw the cloud, a net of the surface, the ways of the contact, and the sphere where it ended."""
    cloud = body_of(surface.cloud)
    view = broad_view(cloud)
    cloud_panel(panel, cloud, view)
    if isinstance(surface, FittedSurface):
        for place in np.linspace(0, V_STOP, 24):
            ring = np.stack(surface.jet(TURN, np.full(len(TURN), place)).f, axis=1)
            panel.plot(*(ring @ view.T).T, color=INK, linewidth=0.25)
    for r, colour, style in zip(runs, COLOURS, STYLES, strict=False):
        panel.plot(*(r.contact @ view.T).T, style, color=colour, linewidth=1.6, label=_name(r))
        rim = r.centre[-1] @ view.T + r.radius * np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
        panel.plot(*rim.T, color=colour, linewidth=1)
    panel.set_title("contact on the object, and the sphere at the end", fontsize=9)
    panel.legend(fontsize=7)


def _on_sphere(panel: Any, runs: Sequence[Trajectory]) -> None:
    """Draw the way of the contact over the sphere, seen from the mean of the way; behind it dashed."""
    for number, (r, colour) in enumerate(zip(runs, COLOURS, strict=False)):
        way = np.einsum("nji,nj->ni", rotation_of(r.orientation), r.contact - r.centre) / r.radius
        if number == 0:
            view = _towards(way.mean(axis=0))
        flat, front = way @ view[:2].T, way @ view[2] >= 0
        for side, style in ((front, "-"), (~front, ":")):
            shown = np.where(side[:, None], flat, np.nan)
            panel.plot(*shown.T, color=colour, linewidth=1.4, linestyle=style)
    panel.plot(np.cos(TURN), np.sin(TURN), color=INK, linewidth=0.8)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_title("contact on the sphere, in its radii; behind it dotted", fontsize=9)
    panel.tick_params(labelsize=7)


def _towards(direction: Numbers) -> Table:
    """Return two axes across a direction, and the direction (3, 3)."""
    length = float(np.linalg.norm(direction))
    ahead = direction / length if length > 0 else np.array([0.0, 0.0, 1.0])
    return np.concatenate([-across(ahead), ahead[None]])


def _against_time(
    panel: Any, runs: Sequence[Trajectory], values: Sequence[Numbers], heading: str, unit: float
) -> None:  # fmt: skip
    for r, value, colour, style in zip(runs, values, COLOURS, STYLES, strict=False):
        panel.plot(r.t, value, style, color=colour, linewidth=1.2)
    low, high = panel.get_ylim()
    more = max(LEAST_SPAN * unit - (high - low), 0) / 2
    panel.set_ylim(low - more, high + more)
    panel.ticklabel_format(useOffset=False)
    panel.set_title(heading, fontsize=9)
    panel.set_xlabel("t, s", fontsize=7)
    panel.tick_params(labelsize=7)
