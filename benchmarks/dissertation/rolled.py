"""Runs of a sphere on fitted surfaces."""

import statistics
import time
from functools import lru_cache
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from tiskel import (
    FittedSurface,
    RollParams,
    SurfaceParams,
    contract,
    extract_skeleton,
    fit_surface,
    load_cloud,
    make_shape,
    roll,
    shape_graph,
)
from tiskel.surfaces.tube import V_STOP

Json = dict[str, Any]
INPUTS = {"A": (0.0, 1.0, 0.0), "B": (1.0, 0.0, 0.0), "C": (1.0, 1.0, 0.0)}  # D: C with slip along y
SLIP = 0.2  # of the sphere's radius
CAVE_START = (pi / 2, pi / 10, 0.1, 0.1, pi / 2)
RTOL, ATOL = 1e-3, 1e-5  # as published
ROWS_KEPT, CLOUD_KEPT = 200, 4000  # of a run, of a cloud


@lru_cache(maxsize=8)
def surface(name: str, folder: Path) -> FittedSurface:
    path = folder / "clouds" / f"{name}.ply"
    real = name in ("hammer", "cave") and path.exists()
    points = load_cloud(path).points if real else make_shape(shape_graph("tunnel" if name == "cave" else name))[0]
    return fit_surface(extract_skeleton(contract(points)), SurfaceParams(branch="longest")).named(None)


def rolls(name: str, folder: Path) -> Json:
    """Return runs under inputs A to D by both models, and some of the cloud."""
    body = surface(name, folder)
    runs = {model: {key: rolled(body, name, key, model, (0.0, SLIP if key == "D" else 0.0)) for key in (*INPUTS, "D")}
            for model in ("global", "local")}  # fmt: skip
    some = np.linspace(0, len(body.cloud) - 1, min(CLOUD_KEPT, len(body.cloud))).astype(int)
    return {"cloud": body.cloud[some].tolist(), "runs": runs}


def slid(name: str, folder: Path, slip: list[float]) -> Json:
    """Return a run under input C with slip."""
    return rolled(surface(name, folder), name, "C", "global", (slip[0], slip[1]))


def rolled(body: FittedSurface, name: str, key: str, model: str, slip: tuple[float, float]) -> Json:
    """Return a run: its ways, its end, its states."""
    radius = body.radius / 4
    inside: dict[str, Any] = {"side": "inside", "start": CAVE_START} if name == "cave" else {}
    params = RollParams(
        model=model, radius=radius, omega=INPUTS["C" if key == "D" else key], rtol=RTOL, atol=ATOL, meet=False,
        velocity=(slip[0] * radius, slip[1] * radius, 0.0), **inside,
    )  # fmt: skip
    run = roll(body, params)
    seconds = []
    for _ in range(3):
        start = time.process_time()
        roll(body, params)
        seconds.append(time.process_time() - start)
    some = np.linspace(0, len(run.t) - 1, min(ROWS_KEPT, len(run.t))).astype(int)
    return {
        "t": run.t[some].tolist(), "state": run.state[some].tolist(), "contact": run.contact[some].tolist(),
        "R_o": run.object_radius[some].tolist(), "way": run.path_object, "sphere": run.path_sphere, "radius": radius,
        "status": run.status.value, "seconds": statistics.median(seconds), "det": float(np.abs(run.determinant).min()),
    }  # fmt: skip


def turned(name: str, folder: Path, direction: list[float]) -> Json:
    """Return where the same roll ends on a surface whose u starts elsewhere."""
    base = surface(name, folder)
    other = fit_surface(
        extract_skeleton(contract(base.cloud)), SurfaceParams(branch="longest", m=tuple(direction))
    ).named(None)  # type: ignore[arg-type]
    place = tuple(float(x) for x in base.jet(0.3, V_STOP / 2).f)
    run = roll(other, RollParams(radius=base.radius / 4, omega=(1, 1, 0), start_at=place, duration=3, meet=False))  # type: ignore[arg-type]
    return {"end": run.contact[-1].tolist(), "radius": base.radius}
