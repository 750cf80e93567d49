"""The files that ``tiskel run`` makes of a result; each is a function that returns its bytes."""

import json
from collections.abc import Callable
from functools import partial
from typing import Any

from tiskel.cli.roll import summary
from tiskel.cli.slice import slices_csv
from tiskel.io.clouds import Cloud
from tiskel.io.exports import EXPORTS
from tiskel.io.mesh_file import dump_mesh
from tiskel.io.stages.contraction import dump_contraction
from tiskel.io.stages.heat import dump_heat
from tiskel.io.stages.roll import to_csv
from tiskel.io.stages.skeleton import dump_skeleton
from tiskel.io.stages.surface import dump_surfaces
from tiskel.params import LookParams
from tiskel.pictures.quality import quality_picture
from tiskel.pictures.rolling import rolling_picture
from tiskel.pictures.skeleton import skeleton_picture
from tiskel.pictures.slices import slices_picture
from tiskel.pictures.stability import stability_picture
from tiskel.pipeline import PipelineResult
from tiskel.report.page import RunFacts, report
from tiskel.rolling.over import ground_of
from tiskel.slicing.body_mesh import mesh_of

Files = dict[str, Callable[[], bytes]]


def files_of(result: PipelineResult, cloud: Cloud, *, history: bool) -> Files:
    """Return stage files, exports and documents, by name."""
    c, s, source = result.contraction, result.skeleton, cloud.source
    return {
        "contraction.ply": lambda: dump_contraction(c, source, history=history),
        "skeleton.ply": lambda: dump_skeleton(s, source),
        "skeleton.obj": lambda: EXPORTS["obj"](s),
        "skeleton.swc": lambda: EXPORTS["swc"](s),
        "skeleton.json": lambda: EXPORTS["json"](s),
        **_surface_files(result, source),
        **_measures(result),
        **_roll_documents(result),
    }


def _measures(result: PipelineResult) -> Files:
    quality, stability = result.quality, result.stability
    files: Files = {}
    if quality is not None:
        files["metrics.ply"] = lambda: dump_heat(quality)
        files["metrics.json"] = lambda: _document(quality.as_dict())
    if stability is not None:
        files["stability.json"] = lambda: _document(stability.as_dict())
    return files


def _surface_files(result: PipelineResult, source: dict[str, str]) -> Files:
    surfaces, runs = result.surfaces, result.trajectories
    if surfaces is None:
        return {}
    files: Files = {
        "surface.json": lambda: dump_surfaces(surfaces, result.params.surface, source),
        "surface.ply": lambda: dump_mesh(mesh_of(surfaces), source),
    }
    if len(surfaces):
        files["slices.csv"] = lambda: slices_csv(surfaces)
    return files | ({"path.csv": lambda: to_csv(runs)} if runs else {})


def _roll_documents(result: PipelineResult) -> Files:
    runs = result.trajectories
    if not runs:
        return {}
    name = "body" if result.surface is None or runs[0].params.model == "body" else result.surface.name
    return {"roll.json": lambda: _document(summary(name, runs))}


def report_of(result: PipelineResult, facts: RunFacts, pictures: Files) -> Files:
    """Return the page with everything in it, the pictures included."""
    return {"report.html": lambda: report(result, facts, {name: make() for name, make in pictures.items()}).encode()}


def pictures_of(result: PipelineResult, cloud: Cloud, look: LookParams | None = None) -> Files:
    """Draw all pictures and return them by name."""
    c, s, title = result.contraction, result.skeleton, f"{cloud.name}, {result.contraction.params.method}"
    drawn = {"skeleton.png": skeleton_picture(s, title, look=look)}
    if result.quality is not None:
        drawn["metrics.png"] = quality_picture([(title, s.cloud, result.quality)], look=look)
    if result.stability is not None:
        drawn["stability.png"] = stability_picture(c, result.stability, title, look=look)
    if result.surfaces is not None and len(result.surfaces):
        drawn["slices.png"] = slices_picture(result.surfaces, title, look=look)
    if result.surfaces is not None and result.trajectories:
        ground = ground_of(result.surfaces, result.trajectories[0].params)
        drawn["roll.png"] = rolling_picture(ground, result.trajectories, title, look=look)
    return {name: partial(bytes, data) for name, data in drawn.items()}


def _document(values: dict[str, Any]) -> bytes:
    return (json.dumps(values, allow_nan=False, indent=1) + "\n").encode()
