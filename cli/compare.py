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
    """Say whether two skeletons of one body are alike: the same graph, ends and length, how far apart both ways.

    Of a body that was scanned twice, in one frame; distances in local radii need files with radii. A table on a
    terminal, JSON otherwise: `tiskel compare monday.ply tuesday.ply | jq .same_graph`
    """
    from tiskel.metrics.comparison import compare as held_against

    facts: dict[str, Any] = {"files": [first.name, second.name]}
    with shown(reading(first, second)):
        facts |= held_against(_curve(first), _curve(second)).as_dict()
    if as_json or not sys.stdout.isatty():
        typer.echo(json.dumps(facts, allow_nan=False))
        return
    from rich.console import Console

    from tiskel.metrics.tables import said

    names = " and ".join(facts.pop("files"))
    rows = [[key, said(value)] for key, value in facts.items() if not isinstance(value, (dict, list))]
    for one, length in zip((first, second), facts["lengths"], strict=True):
        rows.append([f"length of {one.name}", said(length)])
    for way, words in (("there", f"{first.name} to {second.name}"), ("back", f"{second.name} to {first.name}")):
        rows += [[f"{words}, {key}", said(value)] for key, value in (facts[way] or {}).items()]
    Console().print(console.table(names, ["what", "value"], rows))


def _curve(path: Path) -> "CurveGraph":
    from tiskel.io.curves import parse_curve
    from tiskel.io.stages.skeleton import parse_skeleton
    from tiskel.io.stages.which import stage_of
    from tiskel.io.streams import read_bytes

    data = read_bytes(path)
    return parse_skeleton(data, str(path)) if stage_of(data) == "skeleton" else parse_curve(data, path)
