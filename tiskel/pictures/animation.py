"""The rolling sphere as a film: GIF, or a page that turns under the mouse."""

import io
import json
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.geometry.strays import body_of
from tiskel.pictures.canvas import CLOUD, CURVE, INK, broad_view, new_figure
from tiskel.rolling.sphere import rotation_of
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.patches import BodySurface

FORMATS = ("gif", "html")
FRAMES, SECONDS, SIZE, DPI = 90, 9.0, 5.0, 80  # of a GIF; inches
SHOWN_POINTS, PAGE_POINTS = 6000, 8000
ONE_SIDED = 0.2  # length of the mean normal of a run: with less it is all around, and the broad view will do
ROOM, SHARE = 5.0, 16.0  # radii of the sphere around its way, and across the picture at least
DEPTHS, BALL = "bone_r", "#f2a65a"  # far points are pale
MERIDIANS, PARALLELS, DOTS = 6, 3, 48  # what is drawn on the sphere, so that its turning shows


def animation(surface: FittedSurface | BodySurface, run: Trajectory, kind: str) -> bytes:
    """Return a film of a run.

    Parameters
    ----------
    surface : FittedSurface or BodySurface
        What the sphere rolls over; its cloud is drawn.
    run : Trajectory
        The run.
    kind : "gif" or "html"
        The format: a GIF, or a page that turns under the mouse.

    Raises
    ------
    TiskelError
        For another kind.
    """
    if kind == "gif":
        return _gif(surface, run)
    if kind == "html":
        return _page(surface, run)
    raise TiskelError(f"an animation cannot be written as {kind!r}; choose one of {', '.join(FORMATS)}")


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


def _gif(surface: FittedSurface | BodySurface, run: Trajectory) -> bytes:
    from PIL import Image

    frames = [
        Image.open(io.BytesIO(data)).convert("P", palette=Image.Palette.ADAPTIVE) for data in _frames(surface, run)
    ]
    out = io.BytesIO()
    pause = int(1000 * SECONDS / len(frames))
    frames[0].save(out, format="GIF", save_all=True, append_images=frames[1:], duration=pause, loop=0)
    return out.getvalue()


def _frames(surface: FittedSurface | BodySurface, run: Trajectory) -> list[bytes]:
    """Return pictures as PNG: seen from where the sphere is in front, and near enough that it is a ball, not a dot."""
    figure = new_figure(SIZE, SIZE)
    panel = figure.add_subplot()
    cloud = body_of(surface.cloud)
    view = seen_from(cloud, run)
    low, high = window(cloud, run, view)
    flat = cloud @ view.T
    flat = flat[((flat[:, :2] >= low) & (flat[:, :2] <= high)).all(axis=1)]
    shown = flat[:: max(1, len(flat) // SHOWN_POINTS)]
    pale = 1.4 * shown[:, 2].min() - 0.4 * shown[:, 2].max()
    rows = np.unique(np.linspace(0, len(run.t) - 1, min(FRAMES, len(run.t))).astype(int))
    pictures = []
    for row in rows:
        panel.clear()
        centre = view @ run.centre[row]
        hiding = (shown[:, 2] > centre[2]) & (np.linalg.norm(shown[:, :2] - centre[:2], axis=1) < run.radius)
        panel.scatter(*shown[:, :2].T, s=2.5, c=shown[:, 2], cmap=DEPTHS, vmin=pale, linewidths=0)
        panel.plot(*(run.contact[: row + 1] @ view[:2].T).T, color=CURVE, linewidth=1.2)
        _ball(panel, run, int(row), view)
        panel.scatter(*shown[hiding, :2].T, s=2.5, c=CLOUD, linewidths=0, zorder=5)  # what is before it
        panel.set_xlim(low[0], high[0])
        panel.set_ylim(low[1], high[1])
        panel.set_aspect("equal")
        panel.set_axis_off()
        panel.set_title(f"t = {run.t[row]:.2f} s", fontsize=9)
        out = io.BytesIO()
        figure.savefig(out, format="png", dpi=DPI, metadata={"Software": None})
        pictures.append(out.getvalue())
    return pictures


def seen_from(cloud: Points, run: Trajectory) -> Numbers:
    """Return three axes (3, 3), across, up and to the eye: the eye is on the side on which most of the run is."""
    axes = broad_view(cloud)
    view = np.concatenate([axes, np.cross(*axes)[None]])
    ahead = run.normal.mean(axis=0) * (1.0 if run.params.side == "outside" else -1.0)
    if np.linalg.norm(ahead) < ONE_SIDED:
        return view
    ahead = ahead / np.linalg.norm(ahead)
    up = axes[int(np.argmin(np.abs(axes @ ahead)))]
    up = up - ahead * (up @ ahead)
    up = up / np.linalg.norm(up)
    return np.stack([np.cross(up, ahead), up, ahead])


def window(cloud: Points, run: Trajectory, view: Numbers) -> tuple[Numbers, Numbers]:
    """Return the least and largest coordinates (2,) of the picture: the run and some room, and no more than all."""
    way, whole = run.centre @ view[:2].T, cloud @ view[:2].T
    room = ROOM * run.radius
    low, high = way.min(axis=0) - room, way.max(axis=0) + room
    middle, half = (low + high) / 2, max(float((high - low).max()), SHARE * run.radius) / 2
    every = np.concatenate([whole, way - 2 * run.radius, way + 2 * run.radius])
    half = min(half, float(np.ptp(every, axis=0).max()) / 2)
    return middle - half, middle + half


def _ball(panel: Any, run: Trajectory, row: int, view: Numbers) -> None:
    """Draw the sphere's rim, and the near half of its lines."""
    turn = np.linspace(0, 2 * np.pi, 73)
    centre = run.centre[row] @ view.T
    rim = centre[:2] + run.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    panel.fill(*rim.T, facecolor=BALL, edgecolor=INK, linewidth=0.8, zorder=3)
    rotation = rotation_of(run.orientation[row])
    for line in sphere_lines():
        placed = run.radius * line @ rotation.T @ view.T
        near = np.where(placed[:, 2:] >= 0, placed[:, :2], np.nan)
        panel.plot(*(centre[:2] + near).T, color=INK, linewidth=0.7, zorder=4)


def _page(surface: FittedSurface | BodySurface, run: Trajectory) -> bytes:
    rows = np.unique(np.linspace(0, len(run.t) - 1, min(600, len(run.t))).astype(int))
    cloud = body_of(surface.cloud)
    middle = (run.centre.min(axis=0) + run.centre.max(axis=0)) / 2
    reach = max(float(np.linalg.norm(run.centre - middle, axis=1).max()) + ROOM * run.radius, SHARE / 2 * run.radius)
    data = {
        "cloud": cloud[:: max(1, len(cloud) // PAGE_POINTS)].round(6).tolist(),
        "t": run.t[rows].tolist(),
        "contact": run.contact[rows].tolist(),
        "centre": run.centre[rows].tolist(),
        "rotation": rotation_of(run.orientation[rows]).reshape(-1, 9).tolist(),
        "radius": run.radius,
        "middle": middle.tolist(),
        "reach": min(reach, float(np.linalg.norm(cloud - middle, axis=1).max())),
        "lines": [line.round(4).tolist() for line in sphere_lines()],
    }
    return PAGE.replace("DATA", json.dumps(data, allow_nan=False)).encode()


PAGE = """<!doctype html>
<meta charset="utf-8">
<title>tiskel: a rolling sphere</title>
<style>body { margin: 0; font: 14px sans-serif } canvas { display: block }
#bar { position: fixed; left: 1em; bottom: 1em }
input { width: 30em; vertical-align: middle }</style>
<canvas id="c"></canvas>
<div id="bar"><button id="play">pause</button> <input id="time" type="range" min="0" value="0"> <span id="said"></span>
drag to turn, wheel to zoom</div>
<script>
const d = DATA;
const c = document.getElementById('c'), g = c.getContext('2d'), bar = document.getElementById('time');
bar.max = d.t.length - 1;
const mid = d.middle, size = d.reach;
let a = 0.6, b = 0.4, zoom = 0.85, row = 0, on = true;
function seen(p) {
  const x = p[0] - mid[0], y = p[1] - mid[1], z = p[2] - mid[2];
  const x1 = Math.cos(a) * x + Math.sin(a) * y, y1 = -Math.sin(a) * x + Math.cos(a) * y;
  const s = zoom * Math.min(c.width, c.height) / 2 / size;
  return [c.width / 2 + s * x1, c.height / 2 - s * (Math.cos(b) * z - Math.sin(b) * y1),
          Math.sin(b) * z + Math.cos(b) * y1, s];
}
function path(points, colour, near) {
  g.strokeStyle = colour; g.beginPath(); let down = false;
  for (const p of points) {
    const q = seen(p);
    if (near !== undefined && q[2] > near) { down = false; continue; }
    down ? g.lineTo(q[0], q[1]) : g.moveTo(q[0], q[1]); down = true;
  }
  g.stroke();
}
function draw() {
  c.width = innerWidth; c.height = innerHeight; g.fillStyle = '#8f9aa5';
  for (const p of d.cloud) { const q = seen(p); g.fillRect(q[0], q[1], 1.5, 1.5); }
  g.lineWidth = 2; path(d.contact.slice(0, row + 1), '#c0392b');
  const m = d.centre[row], q = seen(m), r = d.rotation[row];
  g.fillStyle = 'rgba(242, 166, 90, 0.9)'; g.beginPath(); g.arc(q[0], q[1], q[3] * d.radius, 0, 7); g.fill();
  g.lineWidth = 1;
  for (const line of d.lines) path(line.map(p => [0, 1, 2].map(k =>
    m[k] + d.radius * (r[3 * k] * p[0] + r[3 * k + 1] * p[1] + r[3 * k + 2] * p[2]))), '#1f3a5f', q[2]);
  document.getElementById('said').textContent = 't = ' + d.t[row].toFixed(2) + ' s';
  bar.value = row;
}
let from = null;
c.onmousedown = e => { from = [e.clientX, e.clientY]; };
onmouseup = () => { from = null; };
onmousemove = e => { if (from) { a -= (e.clientX - from[0]) / 150; b += (e.clientY - from[1]) / 150;
  from = [e.clientX, e.clientY]; draw(); } };
c.onwheel = e => { zoom *= Math.exp(-e.deltaY / 800); draw(); e.preventDefault(); };
bar.oninput = () => { row = +bar.value; on = false; draw(); };
document.getElementById('play').onclick = e => { on = !on; e.target.textContent = on ? 'pause' : 'play'; };
setInterval(() => { if (on) { row = (row + 1) % d.t.length; draw(); } },
  1000 * (d.t[d.t.length - 1] || 1) / d.t.length);
onresize = draw; draw();
</script>
"""
