"""The rolling sphere as a film."""

import io
from typing import Any

import numpy as np

from tiskel.arrays import Points
from tiskel.geometry.strays import body_of
from tiskel.params import LookParams
from tiskel.pictures.canvas import Sight, dots, framed, new_figure, rendered, sight_of, with_axes
from tiskel.pictures.rolling import facing, way
from tiskel.pictures.style import CURVE, INK, SIZES, colour_of
from tiskel.rolling.sphere import rotation_of
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.patches import BodySurface

FRAMES, SECONDS, SIZE, DPI = 90, 9.0, 5.0, 80  # of a GIF; inches
SHOWN_POINTS = 6000
ROOM = 5.0  # radii of the sphere around its way that a film shows: near enough that it is a ball, not a dot
MERIDIANS, PARALLELS, DOTS = 6, 3, 48  # what is drawn on the sphere, so that its turning shows


def animation(surface: FittedSurface | BodySurface, run: Trajectory, look: LookParams | None = None) -> bytes:
    """Return a film of a run as GIF.

    Parameters
    ----------
    surface : FittedSurface or BodySurface
        What the sphere rolls over; its cloud is drawn.
    run : Trajectory
        The run.
    look : LookParams, optional
        Which axis points up, and the unit of length.

    Returns
    -------
    bytes
        The film, seen along an axis of the input, from where most of the way is seen.
    """
    from PIL import Image

    frames = [
        Image.open(io.BytesIO(data)).convert("P", palette=Image.Palette.ADAPTIVE)
        for data in _frames(surface, run, look)
    ]
    out = io.BytesIO()
    pause = int(1000 * SECONDS / len(frames))
    frames[0].save(out, format="GIF", save_all=True, append_images=frames[1:], duration=pause, loop=0)
    return out.getvalue()


def sphere_lines() -> list[Points]:
    """Return circles (48, 3) on the unit sphere: meridians and parallels."""
    turn = np.linspace(0, 2 * np.pi, DOTS)
    c, s, zero = np.cos(turn), np.sin(turn), 0 * turn
    lines = [
        np.stack([c * np.cos(a), c * np.sin(a), s], axis=1)
        for a in np.linspace(0, np.pi, MERIDIANS, endpoint=False)
    ]  # fmt: skip
    heights = np.linspace(-1, 1, PARALLELS + 2)[1:-1] * np.pi / 2
    return lines + [np.stack([np.cos(h) * c, np.cos(h) * s, np.sin(h) + zero], axis=1) for h in heights]


def _frames(surface: FittedSurface | BodySurface, run: Trajectory, look: LookParams | None) -> list[bytes]:
    """Return pictures as PNG."""
    figure = new_figure(SIZE, SIZE)
    panel = figure.add_subplot()
    sight = facing(sight_of(body_of(surface.cloud), look), run)
    room = np.concatenate([run.centre - ROOM * run.radius, run.centre + ROOM * run.radius])
    flat, low, high = sight.flat(sight.cloud), sight.flat(room).min(axis=0), sight.flat(room).max(axis=0)
    about = sight.cloud[((flat >= low) & (flat <= high)).all(axis=1)]
    shown = about[:: -(-len(about) // SHOWN_POINTS) or 1]
    rows = np.unique(np.linspace(0, len(run.t) - 1, min(FRAMES, len(run.t))).astype(int))
    pictures = []
    for row in rows:
        panel.clear()
        dots(panel, sight.flat(shown), sight.view.depth(shown))
        way(panel, run, sight, CURVE, int(row) + 1)
        _ball(panel, run, int(row), sight)
        with_axes(panel, sight)
        framed(panel, sight, room)
        panel.set_title(f"t = {run.t[row]:.2f} s, {sight.view.name}", fontsize=SIZES["head"])
        pictures.append(rendered(figure, dpi=DPI))
    return pictures


def _ball(panel: Any, run: Trajectory, row: int, sight: Sight) -> None:
    """Draw the sphere's rim, and the near half of its lines."""
    turn = np.linspace(0, 2 * np.pi, 73)
    centre = sight.flat(run.centre[row])
    rim = centre + run.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    panel.fill(*rim.T, color=colour_of("ball"), alpha=0.6)
    rotation = rotation_of(run.orientation[row])
    for line in sphere_lines():
        placed = run.radius * line @ rotation.T
        near = np.where(sight.view.depth(placed)[:, None] >= 0, sight.flat(placed), np.nan)
        panel.plot(*(centre + near).T, color=INK, linewidth=0.7)
