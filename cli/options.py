"""Options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

from tiskel.cli import settings_file
from tiskel.cli.words import completes
from tiskel.extras import extra
from tiskel.params import ConditioningParams, Method, NoiseKind, PipelineParams

CONDITIONING = ConditioningParams()
PIPELINE = PipelineParams()
SAMPLE = "auto"  #: of --sample: all points of a cloud; of a mesh as many as its thickness asks for
MOST_THREADS = 1024  #: as the kernels have it
METHOD: Method = PIPELINE.contraction.method


def drawn(path: Path | None) -> Path | None:
    """Refuse a picture before the work begins, where nothing is installed to draw it with."""
    if path is not None:
        extra("matplotlib", "a picture")
    return path


def capped(wanted: bool) -> bool:
    """Refuse --cap before the work begins, where nothing is installed to fill ends with."""
    if wanted:
        extra("matplotlib", "--cap")
    return wanted


Source = Annotated[Path, typer.Argument(metavar="IN", help="A file, or - for standard input.", show_default=False)]
Output = Annotated[
    Path | None,
    typer.Option(
        "-o", "--output", metavar="OUT", show_default=False, rich_help_panel="Output",
        help="A file, or - for standard output. Without it: standard output when that is a pipe or a file, "
        "NAME.STAGE.EXT here when it is a terminal.",
    ),
]  # fmt: skip

Threads = Annotated[
    int | None,
    typer.Option(
        min=1,
        max=MOST_THREADS,
        metavar="N",
        help="Threads of the kernels. [default: what the machine allows]",
        show_default=False,
        rich_help_panel="Common",
    ),
]
Quiet = Annotated[
    bool, typer.Option("--quiet", "-q", help="No messages and no progress line.", rich_help_panel="Common")
]
Verbose = Annotated[
    bool, typer.Option("--verbose", "-v", help="More messages, and tracebacks.", rich_help_panel="Common")
]
Strict = Annotated[
    bool,
    typer.Option(
        "--strict", help="Exit with 1 where there was a warning, with everything written.", rich_help_panel="Common"
    ),
]
LogFile = Annotated[
    Path | None,
    typer.Option(
        "--log",
        metavar="FILE",
        help="Append to a file what was run, with versions, settings and times, and all messages.",
        show_default=False,
        rich_help_panel="Common",
    ),
]
ConfigFile = Annotated[
    Path | None,
    typer.Option(
        "--config",
        metavar="FILE",
        help="Settings in TOML, a table for each command: [run] method = 'lbc'. The command line goes first.",
        show_default=False,
        is_eager=True,
        callback=settings_file.apply,
        rich_help_panel="Common",
    ),
]

Columns = Annotated[
    str | None,
    typer.Option(
        metavar="a,b,c",
        help="Columns of x, y and z in a text file, by name or counted from 1. [default: as its header says]",
        show_default=False,
        rich_help_panel="Input",
    ),
]
Classification = Annotated[
    str | None,
    typer.Option(
        metavar="4,5",
        help="Keep the points of these classes, of LAS and LAZ.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
Voxel = Annotated[
    float | None,
    typer.Option(
        metavar="SIZE",
        help="Replace the points in each cube of this side by their mean.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
Sample = Annotated[
    str | None,
    typer.Option(
        metavar="auto|N",
        autocompletion=completes(SAMPLE),
        help="A random subset of so many points. Of a mesh, the points to sample; auto: as its thickness asks for.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
Crop = Annotated[
    str | None,
    typer.Option(
        metavar="xmin,ymin,zmin,xmax,ymax,zmax",
        help="Keep what lies in a box.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
Outliers = Annotated[bool, typer.Option("--outliers", help="Remove statistical outliers.", rich_help_panel="Input")]
Cap = Annotated[bool, typer.Option("--cap", help="Close open tube ends.", callback=capped, rich_help_panel="Input")]
Noise = Annotated[
    float, typer.Option(metavar="SHARE", help="Add Gaussian noise, for experiments.", rich_help_panel="Input")
]
NoiseKindName = Annotated[
    NoiseKind,
    typer.Option(
        "--noise-kind",
        help="What the share is of: each centred coordinate, or half the diagonal.",
        rich_help_panel="Input",
    ),
]
Seed = Annotated[int, typer.Option(min=0, metavar="N", help="Of everything random.", rich_help_panel="Input")]

AsJson = Annotated[bool, typer.Option("--json", help="JSON on a terminal too.", rich_help_panel="Output")]
Summary = Annotated[
    bool,
    typer.Option(
        "--json",
        help="Also counts, warnings and notes, with codes, shares and places, as JSON on standard output.",
        rich_help_panel="Output",
    ),
]
Plot = Annotated[
    Path | None,
    typer.Option(
        "--plot",
        metavar="OUT",
        help="Also a picture: PNG, SVG or PDF.",
        callback=drawn,
        show_default=False,
        rich_help_panel="Output",
    ),
]

MethodName = Annotated[
    Method,
    typer.Option(
        "--method",
        help="By fronts over the cloud; GLSkeleton (Wen et al. 2024); Laplacian-based contraction (Cao et al. 2010).",
        rich_help_panel="Method",
    ),
]
History = Annotated[
    bool,
    typer.Option(
        "--history",
        help="Also the positions after every step, which `tiskel stability` needs.",
        rich_help_panel="Output",
    ),
]
Weights = Annotated[
    str | None,
    typer.Option(
        metavar="PROPERTY",
        help="Property of the PLY whose values W_L is multiplied by, point by point; for gls and lbc.",
        show_default=False,
        rich_help_panel="Method",
    ),
]
