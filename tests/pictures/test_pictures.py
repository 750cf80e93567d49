"""Pictures are drawn without touching what the user has set up in matplotlib.

In processes of their own: whether pyplot is imported, and which backend is chosen, is a matter of the whole process.
"""

import os
import subprocess
import sys

import pytest

EVERY_PICTURE = """
import sys
import matplotlib
import numpy as np
from tiskel import (
    ContractionParams, RollParams, ShapeParams, assess_stability, contract, evaluate, extract_skeleton, fit_surface,
    make_shape, roll, shape_graph,
)
from tiskel.pictures.animation import animation
from tiskel.pictures.canvas import new_figure, rendered
from tiskel.pictures.quality import quality_picture
from tiskel.pictures.rolling import rolling_picture
from tiskel.pictures.skeleton import skeleton_picture
from tiskel.pictures.slices import slices_picture
from tiskel.pictures.stability import stability_picture

def backend():
    return matplotlib.rcParams._get_backend_or_none()

before = backend()
cloud = make_shape(shape_graph("capsule"), ShapeParams(count=400))[0]
contraction = contract(cloud, ContractionParams(method="gls"))
skeleton = extract_skeleton(contraction)
surfaces = fit_surface(skeleton)
run = roll(surfaces[0], RollParams(duration=0.03))
quality = evaluate(cloud, contraction.points, skeleton.nodes, skeleton.edges)
drawn = {
    "skeleton.png": skeleton_picture(skeleton, "capsule"),
    "quality.png": quality_picture([("capsule", cloud, quality)]),
    "stability.png": stability_picture(contraction, assess_stability(contraction), "capsule"),
    "slices.png": slices_picture(surfaces, "capsule"),
    **{f"empty.{kind}": rendered(new_figure(1, 1), kind) for kind in ("svg", "pdf")},
    "rolling.png": rolling_picture(surfaces[0], [run], "capsule"),
    "film.gif": animation(surfaces[0], run),
}
starts = {"png": b"\\x89PNG", "svg": b"<?xml", "pdf": b"%PDF", "gif": b"GIF8"}
assert all(data.startswith(starts[name[-3:]]) for name, data in drawn.items())
print(before, backend(), "matplotlib.pyplot" in sys.modules)
"""


@pytest.mark.parametrize("chosen", [None, "svg"])
def test_backend_and_pyplot_are_left_alone(chosen: str | None) -> None:
    """None chosen: matplotlib still picks one when the user opens the first window."""
    environment = {key: value for key, value in os.environ.items() if key != "MPLBACKEND"}
    if chosen is not None:
        environment["MPLBACKEND"] = chosen
    done = subprocess.run(
        [sys.executable, "-c", EVERY_PICTURE], capture_output=True, text=True, check=False, timeout=240, env=environment
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [str(chosen), str(chosen), "False"]
