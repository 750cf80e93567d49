"""The slices of a surface, one section in both coordinates, and the surface over the points."""

from textwrap import fill
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.geometry.strays import body_of
from tiskel.pictures.canvas import CURVE, INK, POINTS, broad_view, cloud_panel, new_figure, rendered
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.slicing.rings import around
from tiskel.slicing.sections import Case
from tiskel.surfaces.tube import V_STOP

WIDTH, HEIGHT = 14.0, 4.2  # inches, of one row
TURN = np.linspace(0, 2 * np.pi, 121)
RINGS, LINES = 40, 12  # drawn around and along
TITLE = 56  # letters in a line over a panel
MOST = 6  # surfaces that get a row of their own


def slices_picture(surfaces: Surfaces, title: str, kind: str = "png") -> bytes:
    """Return a picture of the longest surfaces: slices, a section in polar and Cartesian form, the surface; a row each.

    Parameters
    ----------
    surfaces : Surfaces
        The surfaces of a skeleton; the six longest are drawn.
    title : str
        The name of the cloud.
    kind : "png", "svg" or "pdf"
        The format.

    Returns
    -------
    bytes
    """
    longest = sorted(surfaces, key=lambda s: -s.length)[:MOST]
    body = body_of(longest[0].cloud)
    figure = new_figure(WIDTH, HEIGHT * len(longest) + 0.4)
    grid = figure.add_gridspec(len(longest), 4)
    for row, surface in enumerate(longest):
        cloud = body if surface.cloud is longest[0].cloud else body_of(surface.cloud)
        view = broad_view(cloud)
        _slices(figure.add_subplot(grid[row, 0]), surface, cloud, view)
        _section(figure.add_subplot(grid[row, 1], projection="polar"), figure.add_subplot(grid[row, 2]), surface)
        _surface(figure.add_subplot(grid[row, 3]), surface, cloud, view)
    more = "" if len(longest) == len(surfaces) else f", the {MOST} longest of {len(surfaces)} surfaces"
    figure.suptitle(f"{title}{more}", fontsize=10)
    return rendered(figure, kind)


def _slices(panel: Any, s: FittedSurface, cloud: Points, view: Points) -> None:
    """Draw the outline of every slice, those that were bridged dashed, and the skeleton curve."""
    cloud_panel(panel, cloud, view)
    for section in s.sections:
        fitted = section.case is Case.FITTED
        ring = np.stack(s.jet(TURN, np.full(len(TURN), section.v)).f, axis=1)
        panel.plot(*(ring @ view.T).T, color=POINTS if fitted else INK, linewidth=0.6, linestyle="-" if fitted else ":")
    panel.plot(*(s.tube.curve(np.linspace(0, V_STOP, 200)) @ view.T).T, color=CURVE, linewidth=1.4)
    told = ", ".join(f"{count} {case}" for case, count in s.cases().items())
    panel.set_title(fill(f"branch {s.name}: {told}", TITLE), fontsize=8)


def _section(polar: Any, flat: Any, s: FittedSurface) -> None:
    """Draw the fitted section nearest to the middle, its points and its series."""
    fitted = [section for section in s.sections if section.case is Case.FITTED]
    section = min(fitted, key=lambda one: abs(one.v - V_STOP / 2))
    rows = s.rows[np.abs(_places(s) - section.v) < 0.5 * V_STOP / len(s.sections)]
    ring = around(s.cloud, rows, s.tube.axis, s.tube.field, np.full(len(rows), section.v))
    r = s.tube.at(TURN, np.full(len(TURN), section.v))[1].R
    polar.plot(ring.u, ring.r, ".", color=POINTS, markersize=3)
    polar.plot(TURN, r, color=CURVE, linewidth=1.2)
    polar.tick_params(labelsize=6)
    polar.set_title(f"section at v = {section.v:.2f}: order {s.order}, error {section.error:.2%}", fontsize=8)
    flat.plot(np.mod(ring.u, 2 * np.pi), ring.r, ".", color=POINTS, markersize=3)
    flat.plot(TURN, r, color=CURVE, linewidth=1.2)
    flat.set_xlabel("u, radians", fontsize=7)
    flat.set_ylabel("R", fontsize=7)
    flat.set_ylim(0, 1.25 * max(float(r.max()), float(ring.r.max(initial=0))))
    flat.tick_params(labelsize=6)


def _places(s: FittedSurface) -> Numbers:
    """Return v of the fitted points."""
    from scipy.spatial import cKDTree

    v = np.linspace(0, V_STOP, 10 * len(s.sections))
    start = v[cKDTree(s.tube.curve(v)).query(s.cloud[s.rows])[1]]
    return around(s.cloud, s.rows, s.tube.axis, s.tube.field, start).v


def _surface(panel: Any, s: FittedSurface, cloud: Points, view: Points) -> None:
    """Draw a net of the surface over the points."""
    cloud_panel(panel, cloud, view)
    v = np.linspace(0, V_STOP, 200)
    for place in np.linspace(0, V_STOP, RINGS):
        panel.plot(*_flat(s, TURN, np.full(len(TURN), place), view), color=INK, linewidth=0.3)
    for turn in np.linspace(0, 2 * np.pi, LINES, endpoint=False):
        panel.plot(*_flat(s, np.full(len(v), turn), v, view), color=INK, linewidth=0.3)
    panel.set_title(f"surface: misfit {s.error:.2%} of the radius", fontsize=8)


def _flat(s: FittedSurface, u: Any, v: Any, view: Points) -> Any:
    return (np.stack(s.jet(u, v).f, axis=1) @ view.T).T
