"""``tiskel stability``."""

import json
import sys
from typing import TYPE_CHECKING, Annotated

import typer

from tiskel import messages
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common, looks
from tiskel.cli.progress import reading, shown
from tiskel.params import LookParams, Orientation, StabilityParams

if TYPE_CHECKING:
    from tiskel.metrics.stability import Stability


NormalsRule = Annotated[
    Orientation,
    typer.Option(
        "--normals",
        help="Which angles pictures show: normals away from the final points, towards the origin as published, or at "
        "random.",
        rich_help_panel="Method",
    ),
]


@common
@looks
def stability(
    source: o.Source,
    normals: NormalsRule = StabilityParams.normals,
    as_json: o.AsJson = False,
    plot: o.Plot = None,
    *,
    look: LookParams,
) -> None:
    """Say whether a contraction is stable: how normals and curvatures change from step to step.

    Reads contraction.ply. A table on a terminal, JSON otherwise:
    `tiskel contract scan.ply | tiskel stability - | jq .stable`
    """
    from tiskel import assess_stability
    from tiskel.io.stages.contraction import read_contraction

    with shown(reading(source)) as progress:
        contraction = read_contraction(source)
        result = assess_stability(contraction, StabilityParams(normals=normals), progress=progress)
    if plot is not None:
        from tiskel.pictures.canvas import picture_kind
        from tiskel.pictures.stability import stability_picture

        title = f"{source.name}, {contraction.params.method}"
        stages.write(plot, lambda: stability_picture(contraction, result, title, picture_kind(str(plot)), look))
    if as_json or not sys.stdout.isatty():
        method = contraction.params.method
        typer.echo(json.dumps({"file": source.name, "method": method, **result.as_dict()}, allow_nan=False))
        return
    from rich.console import Console

    Console().print(_table(result))
    for message in messages.of_stability(result):
        Console().print(message.text, markup=False)


def _table(result: "Stability"):  # type: ignore[no-untyped-def]
    """Return one column per step."""
    steps = result.steps
    rows = [
        ["turn of normals / pi: mean", *(f"{step.angle.mean:.3f}" for step in steps)],
        ["spread", *(f"{step.angle.spread:.3f}" for step in steps)],
        ["skewness", *(f"{step.angle.skewness:.2f}" for step in steps)],
        ["peaks", *(str(step.angle.peaks) for step in steps)],
        ["distance from a curve's", *(f"{step.distance:.3f}" for step in steps)],
        ["towards the origin: mean", *(f"{step.origin.mean:.3f}" for step in steps)],
        ["skewness", *(f"{step.origin.skewness:.2f}" for step in steps)],
        ["random signs: mean", *(f"{step.control.mean:.3f}" for step in steps)],
        ["distance of random signs", *(f"{step.control_distance:.3f}" for step in steps)],
        ["change of curvature: median", *(f"{step.median_curvature:+.4f}" for step in steps)],
        ["in the hull before", *(f"{step.in_hull:.3f}" for step in steps)],
        ["inside the cloud", *("" if step.in_cloud is None else f"{step.in_cloud:.3f}" for step in steps)],
        ["stable", *("yes" if step.stable else "no" for step in steps)],
    ]
    return console.table("stability of contraction", ["step", *map(str, range(1, len(steps) + 1))], rows)
