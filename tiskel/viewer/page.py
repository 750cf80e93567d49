"""A scene as HTML: markup, data and scripts in one file that asks for nothing else."""

import base64
import html
import json
from functools import cache
from importlib.resources import files
from typing import Any

from tiskel.extras import there
from tiskel.pictures.canvas import with_palette
from tiskel.viewer.packed import pack
from tiskel.viewer.scene import Remark, Scene
from tiskel.viewer.still import still

STILL_POINTS = 12_000  # of the picture that stands in where there is no WebGL
KEYS = (
    ("drag, arrows", "turn"), ("wheel, pinch, + -", "nearer and farther"), ("right drag, two fingers", "shift"),
    ("click, tap", "select a branch or a place"), ("F, double click", "zoom to what is selected"), ("H", "show all"),
    ("X Y Z", "look along an axis"), ("C", "next colours"), ("1 to 9", "layers"), ("space", "play"),
    ("D", "light or dark"), ("?", "these keys"),
)  # fmt: skip


@cache
def asset(name: str) -> str:
    """Return a file that comes with the viewer, as text."""
    return (files("tiskel.viewer") / "assets" / name).read_text(encoding="utf-8")


def styles() -> str:
    """Return the style sheet of the viewer, for the head of a page."""
    return f"<style>{asset('viewer.css')}</style>"


def script() -> str:
    """Return the script of the viewer, for the end of a page; it starts every viewer that stands before it."""
    return f"<script>{asset('viewer.js')}</script>"


def page(scene: Scene) -> str:
    """Return one page that holds a viewer and nothing else."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f"<title>{html.escape(scene.title)} - tiskel</title>"
        '<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">'
        f'{styles()}</head><body class="alone">{viewer(scene, alone=True)}{script()}</body></html>\n'
    )


def viewer(scene: Scene, *, alone: bool = False) -> str:
    """Return the markup and the data of a viewer.

    Parameters
    ----------
    scene : Scene
        What it shows.
    alone : bool
        Whether the page holds nothing else; then the wheel always zooms.
    """
    document, data = pack(scene)
    title = html.escape(scene.title)
    return MARKUP.format(
        alone=" data-alone" if alone else "",
        title=title,
        said="".join(f"<p>{html.escape(line)}</p>" for line in scene.said),
        remarks=_remarks(scene),
        keys="".join(f"<tr><th>{html.escape(key)}</th><td>{html.escape(act)}</td></tr>" for key, act in KEYS),
        picture=_still(scene, title) if there("matplotlib") else "",
        document=_json(document),
        data=base64.b64encode(data).decode(),
    )


def _still(scene: Scene, title: str) -> str:
    """Return what stands in where there is no WebGL; drawing needs matplotlib."""
    picture = base64.b64encode(with_palette(still(scene, "png", STILL_POINTS))).decode()
    return f'<img alt="{title}" src="data:image/png;base64,{picture}">'


def _json(document: Any) -> str:
    """Return JSON that cannot end the element it stands in."""
    text = json.dumps(document, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("&", "\\u0026")


def _remarks(scene: Scene) -> str:
    """Return warnings and notes as a list; what has a place is a button that goes there."""
    lines = []
    for severity, layer in (("warning", "warnings"), ("note", "notes")):
        row = 0
        for remark in (one for one in scene.remarks if one.severity == severity):
            lines.append(_remark(remark, layer, row))
            row += len(remark.places)
    return f"<ul>{''.join(lines)}</ul>" if lines else ""


def _remark(remark: Remark, layer: str, row: int) -> str:
    text = html.escape(remark.text)
    if len(remark.places):
        text = f'<button type="button" data-layer="{layer}" data-mark="{row}">{text}</button>'
    return f'<li class="{remark.severity}">{text}</li>'


MARKUP = """<div class="tiskel-viewer"{alone} tabindex="0" aria-label="{title}: a model that turns">
<div class="stage"><canvas></canvas></div>
<div class="panel"><header><button type="button" class="fold" title="fold">&#9776;</button><b>{title}</b></header>
<div class="layers"></div>
<label class="by">colour <select><option value="">plain</option></select></label>
<div class="tools"><button type="button" class="home">all</button><button type="button" class="zoom">zoom</button>
<button type="button" class="dark">light/dark</button><button type="button" class="help">keys</button></div>
<div class="said">{said}{remarks}</div></div>
<table class="keys" hidden>{keys}</table>
<div class="legend" hidden></div>
<div class="foot"><svg class="axes" viewBox="0 0 80 80" aria-hidden="true"></svg><div class="scale"></div></div>
<div class="player" hidden><button type="button" aria-label="play">&#9654;</button>
<input type="range" min="0" value="0" aria-label="time"><output></output></div>
<div class="tip" hidden></div>
<figure class="still">{picture}
<figcaption>A still picture: this browser has no WebGL. {title}</figcaption></figure>
<script type="application/json" class="scene">{document}</script>
<script type="application/octet-stream" class="bytes">{data}</script>
</div>
<noscript><style>.tiskel-viewer .panel, .tiskel-viewer .stage, .tiskel-viewer .foot {{ display: none !important }}
.tiskel-viewer .still {{ display: block !important }}</style></noscript>
"""
