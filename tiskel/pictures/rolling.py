"""A run as the published figures show it: both contact paths, states over time, R_o over time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tiskel.arrays import Mask, Numbers, Points, Table
from tiskel.geometry.frames import across
from tiskel.geometry.strays import body_of
from tiskel.geometry.views import View, views
from tiskel.params import LookParams
from tiskel.pictures.canvas import Sight, cloud_panel, named, new_figure, rendered, sight_of, with_unit
from tiskel.pictures.style import CURVE, INK, POINTS, SIZES, colour_of
from tiskel.rolling.sphere import rotation_of
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.patches import BodySurface
from tiskel.surfaces.tube import V_STOP

COLOURS, STYLES = (CURVE, POINTS), ("-", "--")  # of the first and the second run
LEAST_SPAN = 0.02  # of a panel, in radians or mean radii: less is no change
STATES = ("u_o", "v_o", "u_s", "v_s", "psi")
TURN = np.linspace(0, 2 * np.pi, 73)
WIDTH, OVERVIEW, CLOSE, LOWEST, LOWER = 15.0, 6.0, 4.5, 4.2, 2.6  # inches
NET, RINGS = 3.0, 25  # of the way's length: how far the net goes on beyond it; lines of the net
BALL = colour_of("ball")
AROUND = 1.6  # sphere radii of room about the spheres of the close-up
TICKS = 4  # on an axis of the close-up, at most: numbers of far clouds are long


def rolling_picture(
    surface: FittedSurface | BodySurface, runs: Sequence[Trajectory], title: str, kind: str = "png",
    look: LookParams | None = None,
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
    look : LookParams, optional
        Which axis points up, and the unit of length.

    Returns
    -------
    bytes
    """
    sight = sight_of(body_of(surface.cloud), look)
    tall = max(LOWEST, OVERVIEW * sight.ratio)
    figure = new_figure(WIDTH, tall + LOWER)
    rows = figure.add_gridspec(2, 1, height_ratios=(tall, LOWER))
    upper = rows[0].subgridspec(1, 3, width_ratios=(OVERVIEW, CLOSE, CLOSE))
    whole, close, ball = (figure.add_subplot(upper[0, i]) for i in range(3))
    frame = _frame(runs)
    _overview(whole, surface, runs, sight, frame)
    _close_up(close, surface, runs, facing(sight, runs[0]), frame)
    named(figure, _legend(runs))
    _on_sphere(ball, runs)
    below = rows[1].subgridspec(1, 6)
    radius, *states = (figure.add_subplot(below[0, i]) for i in range(6))
    _against_time(
        radius, runs, [r.object_radius for r in runs], with_unit("R_o at the contact", sight.unit), surface.radius
    )
    for panel, (heading, values) in zip(states, _states(runs), strict=False):
        _against_time(panel, runs, values, heading, 1.0)
    where = f"branch {surface.name}" if isinstance(surface, FittedSurface) else "the whole body"
    said = "; ".join(f"{_name(r)}: {r.status.value}" for r in runs)
    figure.suptitle(f"{title}, {where}. {said}", fontsize=SIZES["title"])
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


def _frame(runs: Sequence[Trajectory]) -> Points:
    """Return places that frame the ways and the spheres, with room around them."""
    corners = []
    for r in runs:
        room = AROUND * r.radius
        corners += [r.contact, r.centre, *(r.centre[[0, -1]] + sign * room for sign in (-1, 1))]
    return np.concatenate(corners)


def facing(sight: Sight, run: Trajectory) -> Sight:
    """Return how a run is looked at: along an axis of the input, from where most of its way is seen."""
    every = [view for one in views(sight.view.up) for view in (one, one.behind())]
    best = max(every, key=lambda view: faces(view, run).mean() * _spread(view, run))
    return Sight(sight.cloud, best, sight.unit)


def _spread(view: View, run: Trajectory) -> float:
    """Return how large a way looks: the diagonal of its box."""
    return float(np.hypot(*view.extent(run.contact)))


def faces(view: View, run: Trajectory) -> Mask:
    """Return (n,) where the surface at the contact is turned to the eye."""
    return np.asarray(view.depth(run.centre - run.contact) >= 0)


def _overview(
    panel: Any, surface: FittedSurface | BodySurface, runs: Sequence[Trajectory], sight: Sight, frame: Points
) -> None:
    """Draw the cloud, a net of the surface, the ways, and the frame of the close-up."""
    cloud_panel(panel, sight)
    if isinstance(surface, FittedSurface):
        for place in np.linspace(0, V_STOP, 24):
            ring = np.stack(surface.jet(TURN, np.full(len(TURN), place)).f, axis=1)
            panel.plot(*sight.flat(ring).T, color=INK, linewidth=0.25)
    for r, colour in zip(runs, COLOURS, strict=False):
        way(panel, r, sight, colour)
    low, high = sight.flat(frame).min(axis=0), sight.flat(frame).max(axis=0)
    box = np.array([low, (high[0], low[1]), high, (low[0], high[1]), low])
    panel.plot(*box.T, color=INK, linewidth=0.8, linestyle="--")
    panel.set_title("the surface, and what the close-up shows", fontsize=SIZES["head"])


def _close_up(
    panel: Any, surface: FittedSurface | BodySurface, runs: Sequence[Trajectory], sight: Sight, frame: Points
) -> None:
    """Draw the ways of the contact, turned away from the eye dotted, and the spheres at the start and at the end."""
    cloud_panel(panel, sight, frame)
    panel.locator_params(nbins=TICKS)
    if isinstance(surface, FittedSurface):
        _net(panel, surface, runs, sight)
    for r, colour in zip(runs, COLOURS, strict=False):
        for row, style in ((0, ":"), (-1, "-")):
            rim = sight.flat(r.centre[row]) + r.radius * np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
            panel.fill(*rim.T, color=colour_of("ball"), alpha=0.35 if row else 0.15, linewidth=0)
            panel.plot(*rim.T, color=colour, linewidth=1.1, linestyle=style)
        way(panel, r, sight, colour)
        panel.scatter(*sight.flat(r.contact[[0]]).T, s=SIZES["knots"], color=colour, zorder=5)
    panel.set_title(f"contact, {sight.view.name}; away from the eye dotted", fontsize=SIZES["head"])


def _legend(runs: Sequence[Trajectory]) -> list[tuple[str, str, str]]:
    ways = [(f"way, {_name(r)}", colour, "-") for r, colour in zip(runs, COLOURS, strict=False)]
    return [*ways, ("away from the eye", INK, ":"), ("start", INK, "o"), ("sphere, dotted where it starts", BALL, "o")]


def _net(panel: Any, surface: FittedSurface, runs: Sequence[Trajectory], sight: Sight) -> None:
    """Draw the surface about the ways, paler where it is turned away from the eye."""
    v = np.concatenate([r.state[:, 1] for r in runs])
    room = max(NET * float(np.ptp(v)), NET * 2 * runs[0].radius / surface.length * V_STOP)
    places = np.linspace(max(v.min() - room, 0), min(v.max() + room, V_STOP), RINGS)
    lines = [(TURN, np.full(len(TURN), place)) for place in places]
    lines += [(np.full(len(places), turn), places) for turn in np.linspace(0, 2 * np.pi, RINGS, endpoint=False)]
    middle = sight.view.depth(surface.tube.curve(places)).mean()
    for u, along in lines:
        line = np.stack(surface.jet(u, along).f, axis=1)
        near = sight.view.depth(line) >= middle
        for side, alpha in ((near, 0.5), (~near, 0.12)):
            panel.plot(*np.where(side[:, None], sight.flat(line), np.nan).T, color=INK, linewidth=0.4, alpha=alpha)


def way(panel: Any, run: Trajectory, sight: Sight, colour: str, stop: int | None = None) -> None:
    """Draw the way of the contact up to a row: whole lines where it faces the eye, dotted where it does not."""
    flat, seen = sight.flat(run.contact[:stop]), faces(sight.view, run)[:stop]
    for side, style in ((seen, "-"), (~seen, ":")):
        panel.plot(*np.where(side[:, None], flat, np.nan).T, style, color=colour, linewidth=1.6)


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
    panel.set_aspect("equal", adjustable="box")
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
