"""``tiskel split``."""

from pathlib import Path
from typing import Annotated

import typer

from tiskel.cli import console
from tiskel.cli.common import common
from tiskel.cli.progress import shown
from tiskel.params import SplitParams

SPLIT = SplitParams()
TILES, OBJECTS = "Tiles", "Objects"

Source = Annotated[Path, typer.Argument(metavar="IN", help="A file; it is read twice.", show_default=False)]
Folder = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="A folder; made when absent.", show_default=False)
]
Objects = Annotated[bool, typer.Option("--objects/--tiles", help="What hangs together, or boxes that overlap.")]
Points = Annotated[
    int, typer.Option(metavar="N", help="Points of a tile without its margin, at most.", rich_help_panel=TILES)
]
Size = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        help="Longest side of a tile without its margin, instead of points.",
        show_default=False,
        rich_help_panel=TILES,
    ),
]
Overlap = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        help="Width of the margin about a tile: four radii of the thickest body. [default: as a sample says]",
        show_default=False,
        rich_help_panel=TILES,
    ),
]
Gap = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        help="What is nearer is one object. [default: about three spacings]",
        show_default=False,
        rich_help_panel=OBJECTS,
    ),
]
Least = Annotated[
    int,
    typer.Option(metavar="N", help="Points of an object; smaller ones go into rest.ply.", rich_help_panel=OBJECTS),
]


@common
def split(
    source: Source,
    output: Folder,
    objects: Objects = False,
    points: Points = SPLIT.points,
    size: Size = SPLIT.size,
    overlap: Overlap = SPLIT.overlap,
    gap: Gap = SPLIT.gap,
    least: Least = SPLIT.least,
) -> None:
    """Cut a cloud that is too large into tiles that overlap, or into its objects.

    Writes DIR/clouds/NAME.ply and DIR/index.json, piece by piece; then come skeletons of all, and one of these:

    `tiskel split mine.ply -o d && tiskel batch d/clouds -o d/skeletons && tiskel join d -o curve.ply`
    """
    from tiskel import split_cloud

    params = SplitParams(
        parts="objects" if objects else "tiles", points=points, size=size, overlap=overlap, gap=gap, least=least
    )
    with shown("counting") as progress:
        index, notes = split_cloud(source, output, params, progress=progress)
    for note in notes:
        console.say(f"note: {note}")
    console.say(_summary(index.points, index.not_finite, [part.points for part in index.parts], index.rest, output))
    if index.tiling:
        console.say(f"spacing about {index.spacing:.4g}, overlap {index.tiling.overlap:.4g}")
    else:
        console.say(f"spacing about {index.spacing:.4g}, gap {index.gap:.4g}")


def _summary(points: int, not_finite: int, counts: list[int], rest: int, folder: Path) -> str:
    """Return what was made of how many points, in a line."""
    extra = f", {not_finite} rows without a place left out" if not_finite else ""
    extra += f", {rest} points of smaller objects in rest.ply" if rest else ""
    sizes = f" of {min(counts)} to {max(counts)} points" if counts else ""
    return f"{points} points, {len(counts)} files{sizes} in {folder}{extra}"
