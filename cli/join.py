"""``tiskel join``."""

import json
from pathlib import Path
from typing import Annotated

import typer

from tiskel import messages
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common
from tiskel.cli.progress import shown
from tiskel.cli.skeleton import FormatName, format_of
from tiskel.cli.words import misput
from tiskel.errors import TiskelError
from tiskel.params import JoinParams

JOIN = JoinParams()

Folder = Annotated[Path, typer.Argument(metavar="DIR", help="What tiskel split made.", show_default=False)]
Skeletons = Annotated[
    Path | None,
    typer.Option(
        metavar="DIR",
        help="Where the skeletons are: NAME/skeleton.ply, NAME.skeleton.ply or NAME.ply. [default: DIR/skeletons]",
        show_default=False,
        rich_help_panel="Input",
    ),
]
Incomplete = Annotated[
    bool, typer.Option("--incomplete", help="Join what there is where skeletons are missing.", rich_help_panel="Input")
]
Keep = Annotated[
    str, typer.Option(metavar="N|all", help="Points of the cloud that the result holds.", rich_help_panel="Output")
]


@common
def join(
    folder: Folder,
    output: o.Output = None,
    skeletons: Skeletons = None,
    incomplete: Incomplete = JOIN.incomplete,
    keep: Keep = str(JOIN.keep),
    format_name: FormatName = None,
    as_json: o.Summary = False,
) -> None:
    """Make one skeleton of those of tiles or objects.

    Limbs that tiles share go on in one another; a limb that none of the next tiles continues is a warning.

    `tiskel join parts -o mine.curve.ply`
    """
    chosen = format_of(format_name, str(output or ""))
    params = JoinParams(keep="all" if keep == "all" else _number(keep), incomplete=incomplete)
    from tiskel import join_skeletons
    from tiskel.io.exports import EXPORTS
    from tiskel.io.stages.skeleton import dump_skeleton

    target = stages.output_path(output, folder, f"skeleton.{chosen}")
    if as_json and str(target) == "-":
        raise TiskelError("--json and the skeleton would both go to standard output; name a file for it with -o")
    with shown("reading") as progress:
        made, index = join_skeletons(folder, params, skeletons, progress=progress)
    console.tell(messages.of_skeleton(made))
    stages.write(target, lambda: dump_skeleton(made, index.source) if chosen == "ply" else EXPORTS[chosen](made))
    if as_json:
        typer.echo(json.dumps(messages.document_of_skeleton(index.source["name"], made), allow_nan=False))


def _number(words: str) -> int:
    try:
        return int(words)
    except ValueError:
        raise misput("--keep", "all or a number of points", words) from None
