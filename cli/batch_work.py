"""What ``tiskel batch`` does with one cloud, in a child process: as ``tiskel run``, into a folder that is its own."""

import time
from collections import Counter
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from tiskel import messages
from tiskel.batch.child import CloudError
from tiskel.cli import run_files, stages
from tiskel.errors import TiskelError
from tiskel.gallery.make import make_shape, shape_graph
from tiskel.io.clouds import Cloud, load_cloud
from tiskel.io.streams import write_bytes
from tiskel.metrics.tables import row_of
from tiskel.params import ConditioningParams, PipelineParams, ShapeParams
from tiskel.pipeline import Finished, PipelineResult, run_pipeline
from tiskel.report.page import RunFacts

LONGEST = 300  # characters of a reason in the summary


def prepare(settings: Any) -> None:
    """Do a small cloud with the same settings, so that kernels are compiled before the first."""
    params: PipelineParams = settings["params"]
    points = make_shape(shape_graph("capsule"), ShapeParams(count=400))[0]
    with suppress(TiskelError):  # settings made for others need not fit it
        run_pipeline(points, replace(params, conditioning=ConditioningParams(), roll=()))


def work(path: Path, folder: Path, settings: Any) -> dict[str, Any]:
    """Do all stages of a cloud and write their files; return what the manifest is to say of it."""
    params: PipelineParams = settings["params"]
    start = time.perf_counter()
    cloud = _read(path, params)
    read = time.perf_counter() - start
    parts: list[Finished] = []
    weights = stages.weights_of(cloud, settings["weights"])
    result = run_pipeline(cloud.points, params, weights, parts.append, cloud.surface)
    start = time.perf_counter()
    files = run_files.files_of(result, cloud, history=settings["history"])
    told = [("read", messages.warned(cloud.warnings)), *((part.part, part.messages) for part in parts)]
    if settings["pictures"]:
        pictures = run_files.pictures_of(result, cloud) if stages.can_draw() else {}
        facts = RunFacts(name=cloud.name, sha256=cloud.sha256, told=told, files=(*files, *pictures))
        files |= pictures | run_files.report_of(result, facts, pictures)
    for name, make in files.items():
        if not _left_out(name, params):
            write_bytes(folder / name, make())
    document = messages.document_of_run(cloud.name, result.skeleton, told)
    seconds = {"read": read, **{part.part: result.seconds[part.part] for part in parts}}
    return {
        "warnings": dict(Counter(warning["code"] for warning in document["warnings"])),
        "row": _row(cloud, result),
        "parts": {part: round(s, 3) for part, s in (seconds | {"write": time.perf_counter() - start}).items()},
    }


def _read(path: Path, params: PipelineParams) -> Cloud:
    try:
        return load_cloud(path, mesh_samples=params.conditioning.sample, seed=params.conditioning.seed)
    except TiskelError as error:
        raise CloudError("unreadable", str(error)) from None


def _left_out(name: str, params: PipelineParams) -> bool:
    """Tell whether a file is of one of the two stages that are always done, and was not asked for."""
    stem = name.partition(".")[0]
    return (stem == "contraction" and "contract" not in params.stages) or (
        stem == "skeleton" and "skeleton" not in params.stages and not name.endswith(".png")
    )


def _row(cloud: Cloud, result: PipelineResult) -> dict[str, Any]:
    """Return the counts and measures of a cloud, for a table."""
    c, s, surfaces = result.contraction, result.skeleton, result.surfaces
    row = {
        "points": len(cloud.points),
        "method": c.params.method,
        "status_contract": c.status.value,
        "nodes": len(s.nodes),
        "edges": len(s.edges),
        **s.counts(),
        "surfaces": None if surfaces is None else len(list(surfaces)),
        "runs": " ".join(f"{run.params.model}:{run.status.value}" for run in result.trajectories),
        "reason": result.reason[:LONGEST],
    }
    return row | (row_of(result.quality.as_dict()) if result.quality is not None else {})
