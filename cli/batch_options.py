"""Options of ``tiskel batch``, and how they are read."""

from pathlib import Path
from typing import Annotated, get_args

import typer

from tiskel.cli.words import chosen, completes_list, misput
from tiskel.params import STAGES, BatchParams, Stage

BATCH = BatchParams()
ALL = ",".join(STAGES)
PICTURES = "pictures"  #: beside the stages: pictures of all of them, and the report that shows them
MACHINE, LIMITS = "Machine", "Limits"

Sources = Annotated[
    list[str],
    typer.Argument(
        metavar="IN...",
        help="Folders, files, quoted patterns; @FILE a list of files, - such a list on standard input.",
        show_default=False,
    ),
]
Folder = Annotated[
    Path,
    typer.Option(
        "-o", "--output", metavar="DIR", help="A folder; made when absent, a sub-folder in it for every cloud.",
        show_default=False,
    ),
]  # fmt: skip
Stages = Annotated[
    str,
    typer.Option(
        "--stages", metavar="LIST", rich_help_panel="Method", autocompletion=completes_list(*STAGES, PICTURES),
        help=f"Which are written: {', '.join((*STAGES, PICTURES))}, with commas. The first two are always done.",
    ),
]  # fmt: skip
Jobs = Annotated[
    int | None,
    typer.Option(
        min=1, metavar="N", help="Clouds at a time, each in a process of its own. [default: one for each thread]",
        show_default=False, rich_help_panel=MACHINE,
    ),
]  # fmt: skip
Shard = Annotated[
    str, typer.Option(metavar="I/N", help="Only this part of so many of the list.", rich_help_panel=MACHINE)
]
Scheduler = Annotated[
    str,
    typer.Option(
        metavar="tcp://HOST:PORT", help="Of a Dask cluster that is to do the work (extra tiskel[cluster]).",
        show_default=False, rich_help_panel=MACHINE,
    ),
]  # fmt: skip
Lease = Annotated[
    float,
    typer.Option(
        metavar="S", rich_help_panel=MACHINE,
        help="Seconds without a sign of life after which another machine takes a cloud over.",
    ),
]  # fmt: skip
Fresh = Annotated[bool, typer.Option("--fresh", help="Do again what is done.", rich_help_panel="Output")]
Timeout = Annotated[
    float | None,
    typer.Option(metavar="S", help="Seconds that a cloud may take.", show_default=False, rich_help_panel=LIMITS),
]
Memory = Annotated[
    float | None,
    typer.Option(metavar="GB", help="Memory that a cloud may take.", show_default=False, rich_help_panel=LIMITS),
]
Summary = Annotated[
    bool, typer.Option("--json", help="Counts as JSON on standard output at the end.", rich_help_panel="Output")
]


def stages_of(words: str) -> tuple[tuple[Stage, ...], bool]:
    """Return the stages that a list names, in their order, and whether it names the pictures."""
    named = [word.strip() for word in words.split(",") if word.strip()]
    known = (*get_args(Stage), PICTURES)
    for word in named:
        chosen("--stages", word, known)
    return tuple(stage for stage in STAGES if stage in named), PICTURES in named


def shard_of(words: str) -> tuple[int, int]:
    """Return I and N of I/N."""
    part, slash, parts = words.partition("/")
    if not (slash and part.isdigit() and parts.isdigit()):
        raise misput("--shard", "I/N, such as 1/4", words)
    return int(part), int(parts)
