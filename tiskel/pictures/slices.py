"""The slices of a surface, one section in both coordinates, and the surface over the points."""

from dataclasses import replace
from textwrap import fill
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.geometry.strays import body_of
from tiskel.params import LookParams
from tiskel.pictures.canvas import Sight, cloud_panel, named, new_figure, rendered, sight_of, with_unit
from tiskel.pictures.style import CLOUD, CURVE, INK, POINTS
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.slicing.rings import around
from tiskel.slicing.sections import Case
from tiskel.surfaces.tube import V_STOP

WIDTH, WIDE, HEIGHT, HEAD = 15.0, 4.4, 3.0, 0.9  # inches: all, a panel of the body, of a section, titles
TURN = np.linspace(0, 2 * np.pi, 121)
RINGS, LINES = 40, 12  # drawn around and along
LEGEND = (("slice", POINTS, "-"), ("slice, bridged", INK, ":"), ("curve, series", CURVE, "-"), ("points", POINTS, "o"))
TITLE, NARROW = 56, 40  # letters in a line over a panel, wide and narrow
MOST = 6  # surfaces that get a row of their own
SMALL = 0.6  # of the body's diagonal: a surface below is drawn close up, with the whole body beside it
ROOM = 0.12  # of its diagonal, about a surface that is drawn close up
MAP = (0.01, 0.74, 0.25, 0.25)  # of a panel: where the whole body stands
GRIDS = 3  # circles of the polar grid; the numbers of more would lie on each other
MAPPED = 3000  # points of it


def slices_picture(
    surfaces: Surfaces, title: str, kind: str = "png", look: LookParams | None = None
) -> bytes:  # fmt: skip
    """Return a picture of the longest surfaces: slices, a section in polar and Cartesian form, the surface; a row each.

    Parameters
    ----------
    surfaces : Surfaces
        The surfaces of a skeleton; the six longest are drawn.
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
    longest = sorted(surfaces, key=lambda s: -s.length)[:MOST]
    body = sight_of(body_of(longest[0].cloud), look)
    frames = [frame_of(surface, body) for surface in longest]
    heights = [max(HEIGHT, WIDE * min(replace(body, cloud=frame).ratio, 1.0) + HEAD) for frame in frames]
    figure = new_figure(WIDTH, sum(heights) + 0.4)
    grid = figure.add_gridspec(len(longest), 4, width_ratios=(WIDE, HEIGHT, HEIGHT, WIDE), height_ratios=heights)
    for row, (surface, frame) in enumerate(zip(longest, frames, strict=True)):
        _slices(figure.add_subplot(grid[row, 0]), surface, body, frame)
        _section(figure.add_subplot(grid[row, 1], projection="polar"), figure.add_subplot(grid[row, 2]), surface, body)
        _surface(figure.add_subplot(grid[row, 3]), surface, body, frame)
    named(figure, LEGEND)
    more = "" if len(longest) == len(surfaces) else f", the {MOST} longest of {len(surfaces)} surfaces"
    figure.suptitle(f"{title}{more}", fontsize=10)
    return rendered(figure, kind)


def frame_of(s: FittedSurface, body: Sight) -> Points:
    """Return places that frame a surface (k, 3): the whole body, or what is about a surface much smaller than it."""
    places = s.cloud[s.rows]
    low, high = places.min(axis=0), places.max(axis=0)
    size = float(np.linalg.norm(high - low))
    if size > SMALL * float(np.linalg.norm(np.ptp(body.cloud, axis=0))):
        return body.cloud
    return np.stack([low - ROOM * size, high + ROOM * size])


def _map(panel: Any, sight: Sight, frame: Points) -> None:
    """Draw the whole body small, and where in it the panel is."""
    corner = panel.inset_axes(MAP)
    shown = sight.flat(sight.cloud[:: -(-len(sight.cloud) // MAPPED)])
    corner.scatter(*shown.T, s=0.3, c=CLOUD, linewidths=0, rasterized=True)
    (left, low), (right, high) = sight.flat(frame)
    corner.plot([left, right, right, left, left], [low, low, high, high, low], color=CURVE, linewidth=0.9)
    corner.set_aspect("equal", adjustable="datalim")
    corner.set(xticks=[], yticks=[], facecolor="white")
    for axis, sign in zip((corner.xaxis, corner.yaxis), sight.view.signs, strict=True):
        axis.set_inverted(sign < 0)


def _slices(panel: Any, s: FittedSurface, sight: Sight, frame: Points) -> None:
    """Draw the outline of every slice, those that were bridged dashed, and the skeleton curve."""
    cloud_panel(panel, sight, frame, small=frame is sight.cloud)
    if frame is not sight.cloud:
        _map(panel, sight, frame)
    for section in s.sections:
        fitted = section.case is Case.FITTED
        ring = np.stack(s.jet(TURN, np.full(len(TURN), section.v)).f, axis=1)
        panel.plot(
            *sight.flat(ring).T, color=POINTS if fitted else INK, linewidth=0.6, linestyle="-" if fitted else ":"
        )
    panel.plot(*sight.flat(s.tube.curve(np.linspace(0, V_STOP, 200))).T, color=CURVE, linewidth=1.4)
    told = ", ".join(f"{count} {case}" for case, count in s.cases().items())
    panel.set_title(fill(f"branch {s.name}: {told}", TITLE), fontsize=8)


def _section(polar: Any, flat: Any, s: FittedSurface, sight: Sight) -> None:
    """Draw the fitted section nearest to the middle, its points and its series."""
    from matplotlib.ticker import MaxNLocator

    fitted = [section for section in s.sections if section.case is Case.FITTED]
    section = min(fitted, key=lambda one: abs(one.v - V_STOP / 2))
    rows = s.rows[np.abs(_places(s) - section.v) < 0.5 * V_STOP / len(s.sections)]
    ring = around(s.cloud, rows, s.tube.axis, s.tube.field, np.full(len(rows), section.v))
    r = s.tube.at(TURN, np.full(len(TURN), section.v))[1].R
    off = float(np.sqrt(np.mean((ring.r - s.tube.at(ring.u, ring.v)[1].R) ** 2)) / r.mean())
    polar.plot(ring.u, ring.r, ".", color=POINTS, markersize=3)
    polar.plot(TURN, r, color=CURVE, linewidth=1.2)
    polar.tick_params(labelsize=6)
    polar.yaxis.set_major_locator(MaxNLocator(GRIDS))
    told = f"section at v = {section.v:.2f} of the joined surface: order {s.order}, points off by {off:.2%} of R"
    polar.set_title(fill(told, NARROW), fontsize=8)
    flat.plot(np.mod(ring.u, 2 * np.pi), ring.r, ".", color=POINTS, markersize=3)
    flat.plot(TURN, r, color=CURVE, linewidth=1.2)
    flat.set_xlabel("u, radians", fontsize=7)
    flat.set_ylabel(with_unit("R", sight.unit or "in the cloud's unit"), fontsize=7)
    flat.set_ylim(0, 1.25 * max(float(r.max()), float(ring.r.max(initial=0))))
    flat.tick_params(labelsize=6)
    flat.set_box_aspect(1)


def _places(s: FittedSurface) -> Numbers:
    """Return v of the fitted points."""
    from scipy.spatial import cKDTree

    v = np.linspace(0, V_STOP, 10 * len(s.sections))
    start = v[cKDTree(s.tube.curve(v)).query(s.cloud[s.rows])[1]]
    return around(s.cloud, s.rows, s.tube.axis, s.tube.field, start).v


def _surface(panel: Any, s: FittedSurface, sight: Sight, frame: Points) -> None:
    """Draw a net of the surface over the points."""
    cloud_panel(panel, sight, frame, small=frame is sight.cloud)
    v = np.linspace(0, V_STOP, 200)
    for place in np.linspace(0, V_STOP, RINGS):
        panel.plot(*_flat(s, TURN, np.full(len(TURN), place), sight), color=INK, linewidth=0.3)
    for turn in np.linspace(0, 2 * np.pi, LINES, endpoint=False):
        panel.plot(*_flat(s, np.full(len(v), turn), v, sight), color=INK, linewidth=0.3)
    panel.set_title(f"surface: misfit {s.error:.2%} of the radius", fontsize=8)


def _flat(s: FittedSurface, u: Any, v: Any, sight: Sight) -> Any:
    return sight.flat(np.stack(s.jet(u, v).f, axis=1)).T
