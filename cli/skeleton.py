"""``tiskel skeleton``."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, cast

import typer

from tiskel import messages
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common, curves, looks
from tiskel.cli.progress import reading, shown
from tiskel.errors import TiskelError
from tiskel.params import LookParams, SkeletonParams

Format = Literal["ply", "obj", "swc", "graphml", "json", "node-link.json", "vtp", "dxf", "graph", "csv"]

FormatName = Annotated[
    Format | None,
    typer.Option(
        "--format",
        help="Format. [default: by the suffix of OUT, else ply]",
        show_default=False,
        rich_help_panel="Output",
    ),
]


Branches = Annotated[
    Path | None,
    typer.Option(
        "--branches",
        metavar="CSV",
        help="Also a table of branches: ends, length, radii, volume, order from the root, angle, parent.",
        show_default=False,
        rich_help_panel="Output",
    ),
]


@common
@curves
@looks
def skeleton(
    source: o.Source,
    output: o.Output = None,
    format_name: FormatName = None,
    branches: Branches = None,
    as_json: o.Summary = False,
    plot: o.Plot = None,
    *,
    curving: Mapping[str, Any],
    look: LookParams,
) -> None:
    """Turn a contracted cloud, or a cloud, into a curve skeleton.

    Reads contraction.ply, or a cloud, which is contracted by the default method first: `tiskel skeleton scan.ply -o
    curve.ply`. Writes skeleton.ply, which Open3D, trimesh and plyfile read as a line set; CloudCompare and MeshLab show
    lines from OBJ: `tiskel contract scan.ply | tiskel skeleton - -o curve.obj`. What may be wrong with the curve:
    `tiskel skeleton c.ply -o curve.ply --json | jq .warnings`
    """
    chosen = format_of(format_name, str(output or ""))
    params = SkeletonParams(**curving)
    from tiskel import extract_skeleton
    from tiskel.io.exports import EXPORTS, branches_csv
    from tiskel.io.stages.skeleton import dump_skeleton
    from tiskel.io.streams import read_bytes

    target = stages.output_path(output, source, f"skeleton.{chosen}")
    if as_json and str(target) == "-":
        raise TiskelError("--json and the skeleton would both go to standard output; name a file for it with -o")
    stages.check_targets(branches)
    with shown(reading(source)) as progress:
        data = read_bytes(source)
        contraction, origin = stages.contracted(data, source, progress)
        made = extract_skeleton(contraction, params, progress=progress)
    console.tell(messages.of_skeleton(made))
    if plot is not None:
        from tiskel.pictures.canvas import picture_kind
        from tiskel.pictures.skeleton import skeleton_picture

        stages.write(plot, lambda: skeleton_picture(made, source.name, picture_kind(str(plot)), look))
    if chosen == "ply":
        stages.write(target, lambda: dump_skeleton(made, origin))
    else:
        stages.write(target, lambda: EXPORTS[chosen](made))
    if branches is not None:
        stages.write(branches, lambda: branches_csv(made))
    if as_json:
        typer.echo(json.dumps(messages.document_of_skeleton(source.name, made), allow_nan=False))


def format_of(name: Format | None, output: str) -> Format:
    """Return the format named, or that of the suffix, or PLY."""
    if name or not output or output == "-":
        return name or "ply"
    from tiskel.io.exports import export_of

    return cast(Format, export_of(output))
