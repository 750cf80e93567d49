"""``tiskel run``."""

import json
import shlex
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tiskel import messages
from tiskel.cli import console, logbook, stages
from tiskel.cli import options as o
from tiskel.cli import surface_options as so
from tiskel.cli.common import common, contracts, curves, looks, reads_cloud, rolls
from tiskel.cli.progress import reading, shown
from tiskel.errors import TiskelError
from tiskel.params import LookParams, PipelineParams, SkeletonParams, SurfaceParams

if TYPE_CHECKING:
    from tiskel.pipeline import Finished

Folder = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="A folder; made when absent.", show_default=False)
]


@common
@reads_cloud
@contracts
@curves
@rolls
@looks
def run(
    source: o.Source,
    output: Folder,
    method: o.MethodName = o.METHOD,
    weights: o.Weights = None,
    history: o.History = False,
    branch: so.Branch = so.SURFACE.branch,
    as_json: o.Summary = False,
    *,
    conditioning: Mapping[str, Any],
    contracting: Mapping[str, Any],
    curving: Mapping[str, Any],
    rolling: Mapping[str, Any],
    look: LookParams,
) -> None:
    """Do everything in one go: stage files, exports, measures, surfaces, a roll, pictures and a report in one folder.

    `tiskel run scan.ply -o out/`
    """
    params = PipelineParams(
        conditioning=stages.conditioning_params(conditioning),
        contraction=stages.contraction_params(method, contracting),
        skeleton=SkeletonParams(**curving),
        surface=SurfaceParams(branch=branch),
        roll=so.roll_settings(**rolling),
    )
    _make_folder(output)
    start = time.perf_counter()
    parts: list[Finished] = []
    with shown(reading(source)) as progress:
        cloud = stages.read_cloud(source, params.conditioning)
        read = time.perf_counter()
        from tiskel import run_pipeline
        from tiskel.cli.run_files import files_of, pictures_of, report_of
        from tiskel.report.page import RunFacts

        weighted = stages.weights_of(cloud, weights)
        result = run_pipeline(
            cloud.points, params, weighted, lambda done: _tell(done, parts), cloud.surface, progress=progress
        )
    drawing = time.perf_counter()
    with shown("pictures"):
        pictures = pictures_of(result, cloud, look) if stages.can_draw() else {}
    seconds = {"read": read - start, **result.seconds, "pictures": time.perf_counter() - drawing}
    logbook.timed(seconds)
    files = files_of(result, cloud, history=history) | pictures
    files["timings.json"] = (json.dumps(seconds, indent=1) + "\n").encode
    told = [("read", messages.warned(cloud.warnings)), *((done.part, done.messages) for done in parts)]
    facts = RunFacts(
        name=cloud.name, sha256=cloud.sha256, command=shlex.join(["tiskel", *sys.argv[1:]]),
        told=[("read", messages.said(cloud.notes) + told[0][1]), *told[1:]], seconds=seconds, look=look,
        files=tuple(files),
    )  # fmt: skip
    files |= report_of(result, facts, pictures)
    for name, make in files.items():
        stages.write(output / name, make)
    console.say(f"wrote {', '.join(files)} to {output}")
    if as_json:
        typer.echo(json.dumps(messages.document_of_run(cloud.name, result.skeleton, told), allow_nan=False))


def _tell(finished: "Finished", parts: "list[Finished]") -> None:
    parts.append(finished)
    console.tell(finished.messages)
    if finished.part == "contract":
        stages.tell_steps(finished.result)


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TiskelError(f"cannot make the folder {folder}: {error.strerror}; choose another with -o") from None
