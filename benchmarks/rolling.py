"""The experiments of the chapter on rolling contact, and how exact the fitted surfaces are.

    python benchmarks/rolling.py [folder]

1. Carrot, banana and egg rolled over, a cave rolled through along its longest path (where the reference clouds are),
   with inputs A omega = (0, 1, 0), B (1, 0, 0), C (1, 1, 0) and D, C with slip V = 0.2 R_s along y: the local model
   against the global one, at the published tolerances of the solver. A figure of each, as the published ones, and a
   table of differences and times.
2. Fitted surfaces against shapes whose surface is known: errors of radius and of both curvatures, clean and with noise
   of half a percent of the smallest radius.
3. Times, medians in process: slice of 4096 points, roll with input C on the carrot for 10 s.

Writes table.md and the figures to benchmarks/rolling.
"""

import io
import os
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi
from pathlib import Path

import numpy as np
from PIL import Image

from tiskel import (
    FittedSurface,
    RollParams,
    ShapeParams,
    SurfaceParams,
    Trajectory,
    contract,
    extract_skeleton,
    fit_surface,
    load_cloud,
    make_shape,
    roll,
    shape_graph,
)
from tiskel.arrays import Numbers, Points
from tiskel.geometry.round_cones import union_distance
from tiskel.pictures.rolling import rolling_picture
from tiskel.surfaces.forms import forms_of, principal_curvatures
from tiskel.surfaces.tube import V_STOP

HERE = Path(__file__).parent
OUT = HERE / "rolling"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", HERE / ".." / ".." / "shared" / "reference")) / "clouds"
INPUTS = {"A": (0.0, 1.0, 0.0), "B": (1.0, 0.0, 0.0), "C": (1.0, 1.0, 0.0), "D": (1.0, 1.0, 0.0)}
COLOURS = 48  # of the figures
SLIP = 0.2  # of the sphere's radius, along y, in D
RTOL, ATOL = 1e-3, 1e-5  # as published, in the experiments and their times
ROUNDS = 11
NOISE = 0.005
CAVE_START = (pi / 2, pi / 10, 0.1, 0.1, pi / 2)
SHAPES = ("carrot", "banana", "egg")


def main() -> None:
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    out.mkdir(exist_ok=True, parents=True)
    lines = ["# Rolling contact", "", "Made by `python benchmarks/rolling.py`.", "", *experiments(out), "", *accuracy()]
    lines += ["", *times()]
    (out / "table.md").write_text("\n".join(lines) + "\n")
    sys.stdout.write("\n".join(lines) + "\n")


def subjects() -> dict[str, tuple[FittedSurface, RollParams]]:
    """Return surfaces by name, and the settings that all their runs share."""
    found = {name: (surface_of(make_shape(shape_graph(name))[0], "all"), RollParams()) for name in SHAPES}
    if REFERENCE.is_dir():
        cave = surface_of(load_cloud(REFERENCE / "cave.ply").points, "longest")
        found["cave"] = cave, RollParams(side="inside", start=CAVE_START)
    return found


def surface_of(cloud: Points, branch: str) -> FittedSurface:
    return fit_surface(extract_skeleton(contract(cloud)), SurfaceParams(branch=branch)).named(None)


def experiments(out: Path) -> list[str]:
    """Run all inputs on all subjects with both models; return the table of differences."""
    head = "| subject | input | model | status | time, s | way, object | way, sphere | largest difference of u_o |"
    head += " of v_o | of the place, in R_s | evaluations | ms |"
    lines = ["## Local against global", "", head, "|---" * 12 + "|"]
    for name, (surface, settings) in subjects().items():
        for key, omega in INPUTS.items():
            runs, seconds = [], []
            for model in ("global", "local"):
                params = configured(settings, surface, key, omega, model)
                runs.append(roll(surface, params))
                seconds.append(median_seconds(lambda p=params, s=surface: roll(s, p)))  # type: ignore[misc]
            (out / f"{name}-{key}.png").write_bytes(few_colours(rolling_picture(surface, runs, f"{name}, input {key}")))
            lines += [row(name, key, run, runs[0], t) for run, t in zip(runs, seconds, strict=True)]
    return lines


def few_colours(picture: bytes) -> bytes:
    """Return a PNG of a quarter of the size."""
    out = io.BytesIO()
    Image.open(io.BytesIO(picture)).convert("RGB").quantize(COLOURS).save(out, format="PNG", optimize=True)
    return out.getvalue()


def configured(
    settings: RollParams, surface: FittedSurface, key: str, omega: tuple[float, float, float], model: str
) -> RollParams:
    radius = surface.radius / 4
    velocity = (0.0, SLIP * radius, 0.0) if key == "D" else (0.0, 0.0, 0.0)
    return RollParams(
        model=model, side=settings.side, start=settings.start, radius=radius, omega=omega, velocity=velocity,  # type: ignore[arg-type]
        rtol=RTOL, atol=ATOL,
    )  # fmt: skip


def row(name: str, key: str, run: Trajectory, reference: Trajectory, seconds: float) -> str:
    count = min(len(run.t), len(reference.t)) - 1  # the last row of a run that ended early is at its own time
    off = np.abs(run.state[:count] - reference.state[:count]).max(axis=0)
    apart = np.linalg.norm(run.contact[:count] - reference.contact[:count], axis=1).max() / run.radius
    same = run is reference
    cells = [
        name, key, run.params.model, run.status.value, f"{run.t[-1]:.2f}", f"{run.path_object:.5g}",
        f"{run.path_sphere:.5g}", "" if same else f"{off[0]:.2e}", "" if same else f"{off[1]:.2e}",
        "" if same else f"{apart:.3f}", str(run.evaluations), f"{1000 * seconds:.1f}",
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"


@dataclass(frozen=True)
class Known:
    """A tube of one radius about a curve of one curvature: curvatures 1/r and -k cos t / (1 - k r cos t)."""

    name: str
    radius: float
    bend: float

    def curvatures(self, towards: Numbers) -> tuple[Numbers, Numbers]:
        """Return both from the cosine of the angle between the normal and the principal normal of the curve."""
        along = -self.bend * towards / (1 - self.bend * self.radius * towards)
        around = np.full(len(towards), 1 / self.radius)
        return np.minimum(along, around), np.maximum(along, around)


HELIX_RADIUS, HELIX_RISE = 0.6, 1 / 8  # of the shape helix; per radian


def known_tubes() -> list[Known]:
    bend = HELIX_RADIUS / (HELIX_RADIUS**2 + HELIX_RISE**2)
    return [Known("capsule", 0.2, 0.0), Known("torus", 0.2, 1 / 0.7), Known("helix", 0.12, bend)]


def accuracy() -> list[str]:
    lines = [
        "## Fitted surfaces against known ones", "",
        "Errors over the inner 90 % of the branch: of the radius, relative; of curvatures, in 1/R.", "",
        "| shape | noise | order | radius: mean | most | least curvature: mean | 95 % | largest: mean | 95 % |",
        "|---" * 9 + "|",
    ]  # fmt: skip
    for known in known_tubes():
        for noise in (0.0, NOISE):
            lines.append(accuracy_row(known, noise))
    lines += [cone_row(noise) for noise in (0.0, NOISE)]
    return lines


def places(surface: FittedSurface) -> tuple[Numbers, Numbers]:
    u, v = np.meshgrid(np.linspace(0, 2 * pi, 48, endpoint=False), np.linspace(0.05, 0.95, 120) * V_STOP)
    return u.ravel(), v.ravel()


def accuracy_row(known: Known, noise: float) -> str:
    shape = shape_graph(known.name)
    surface = surface_of(make_shape(shape, ShapeParams(noise=noise))[0], "all")
    u, v = places(surface)
    forms = forms_of(surface.jet(u, v))
    rows = surface.tube.axis.along(v)
    bend = np.cross(np.cross(rows[:, 1], rows[:, 2]), rows[:, 1])
    towards = (bend * np.array(forms.z).T).sum(axis=1) / np.maximum(np.linalg.norm(bend, axis=1), 1e-300)
    return errors_row(known.name, noise, surface, u, v, known.curvatures(towards), known.radius)


def cone_row(noise: float) -> str:
    """The carrot: a cone from 0.3 to 0.06 over 1.6, half-angle asin(0.24 / 1.6)."""
    sine = 0.24 / 1.6
    surface = surface_of(make_shape(shape_graph("carrot"), ShapeParams(noise=noise))[0], "all")
    u, v = places(surface)
    x, y, _ = surface.jet(u, v).f
    around = cos(np.arcsin(sine)) / np.hypot(x, y)
    return errors_row("carrot", noise, surface, u, v, (0 * around, around), 1 / around)


def errors_row(
    name: str, noise: float, surface: FittedSurface, u: Numbers, v: Numbers, truth: tuple[Numbers, Numbers],
    radius: Numbers | float,
) -> str:  # fmt: skip
    jet = surface.jet(u, v)
    off = np.abs(union_distance(np.stack(jet.f, axis=1), shape_graph(name))) / radius
    found = principal_curvatures(forms_of(jet))
    cells = [name, f"{noise:.1%}", str(surface.order), f"{off.mean():.3%}", f"{off.max():.3%}"]
    for ours, right in zip(found, truth, strict=True):
        error = np.abs(ours - right) * radius
        cells += [f"{error.mean():.3%}", f"{np.quantile(error, 0.95):.3%}"]
    return "| " + " | ".join(cells) + " |"


def times() -> list[str]:
    lines = ["## Times", "", "| what | median, s |", "|---|---|"]
    for name in (*SHAPES, "hammer", "torus", "helix"):
        skeleton = extract_skeleton(contract(make_shape(shape_graph(name))[0]))
        lines.append(f"| slice, {name}, 4096 points | {median_seconds(lambda s=skeleton: fit_surface(s)):.3f} |")  # type: ignore[misc]
    carrot = surface_of(make_shape(shape_graph("carrot"))[0], "all")
    for model in ("local", "global"):
        params = configured(RollParams(), carrot, "C", INPUTS["C"], model)
        lines.append(
            f"| roll, carrot, input C, 10 s, {model} | {median_seconds(lambda p=params: roll(carrot, p)):.4f} |"
        )  # type: ignore[misc]
    return lines


def median_seconds(work: Callable[[], object]) -> float:
    found = []
    for _ in range(ROUNDS + 1):
        start = time.perf_counter()
        work()
        found.append(time.perf_counter() - start)
    return statistics.median(found[1:])


if __name__ == "__main__":
    main()
