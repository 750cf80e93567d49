"""``tiskel view``."""

from pathlib import Path
from typing import Annotated

import typer

from tiskel.cli import console, stages
from tiskel.cli import look_options as lo
from tiskel.cli.common import common
from tiskel.cli.progress import reading, shown
from tiskel.params import LookParams

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILE...", help="Clouds, meshes, curves and stage files; - for standard input.", show_default=False
    ),
]
Target = Annotated[
    Path,
    typer.Option(
        "-o", "--output", metavar="OUT", show_default=False, rich_help_panel="Output",
        help="A page (.html) or a picture (.png, .svg, .pdf).",
    ),
]  # fmt: skip
Title = Annotated[
    str | None,
    typer.Option(
        metavar="TEXT",
        help="What the page is called. [default: the files' names]",
        show_default=False,
        rich_help_panel="Output",
    ),
]


@common
def view(
    sources: Files,
    output: Target,
    up: lo.UpAxis = lo.LOOK.up,
    unit: lo.Unit = lo.LOOK.unit,
    title: Title = None,
) -> None:
    """Show clouds, curves, surfaces and runs together: a page that turns under the mouse, or a picture.

    The page needs nothing else, no network and no other file:
    `tiskel view out/skeleton.ply out/metrics.ply out/surface.json out/path.csv -o look.html`
    """
    look = LookParams(up=up, unit=unit)
    with shown(reading(*sources)):
        from tiskel.io.anything import read_anything

        things = [read_anything(source) for source in sources]
        from tiskel.viewer.show import view as look_at

        names = ", ".join(dict.fromkeys("stdin" if str(source) == "-" else source.name for source in sources))
        made = look_at(*things, up=look.up, unit=look.unit, title=title or names)
        data = made.dump("." + str(output).rpartition(".")[2] if str(output) != "-" else ".html")
    for line in made.scene.said:
        console.say(line)
    stages.write(output, lambda: data)
