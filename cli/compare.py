"""``tiskel compare``."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tiskel.cli import console
from tiskel.cli import options as o
from tiskel.cli.common import common
from tiskel.cli.progress import reading, shown

if TYPE_CHECKING:
    from tiskel.geometry.graph import CurveGraph

First = Annotated[Path, typer.Argument(metavar="ONE", help="A skeleton or a curve.", show_default=False)]
Second = Annotated[Path, typer.Argument(metavar="OTHER", help="Another of the same body.", show_default=False)]


@common
def compare(first: First, second: Second, as_json: o.AsJson = False) -> None:
    """Say whether two skeletons of one body are alike: the same graph, the same ends, how far they are apart.

    Of a body that was scanned twice, in one frame; distances in local radii need files with radii. A table on a
    terminal, JSON otherwise: `tiskel compare monday.ply tuesday.ply | jq .same_graph`
    """
    from tiskel.metrics.repeatability import repeatability

    facts: dict[str, Any] = {"files": [first.name, second.name]}
    with shown(reading(first, second)):
        facts |= repeatability(_curve(first), _curve(second)).as_dict()
    if as_json or not sys.stdout.isatty():
        typer.echo(json.dumps(facts, allow_nan=False))
        return
    from rich.console import Console

    from tiskel.metrics.tables import said

    names = " and ".join(facts.pop("files"))
    Console().print(console.table(names, ["what", "value"], [[key, said(value)] for key, value in facts.items()]))


def _curve(path: Path) -> "CurveGraph":
    from tiskel.io.curves import parse_curve
    from tiskel.io.stages.skeleton import parse_skeleton
    from tiskel.io.stages.which import stage_of
    from tiskel.io.streams import read_bytes

    data = read_bytes(path)
    return parse_skeleton(data, str(path)) if stage_of(data) == "skeleton" else parse_curve(data, path)
