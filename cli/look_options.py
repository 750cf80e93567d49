"""Options of commands that draw: which axis points up, and what the unit of length is called."""

from typing import Annotated

import typer

from tiskel.params import LookParams, Up

LOOK = LookParams()

UpAxis = Annotated[
    Up,
    typer.Option(
        "--up",
        help="The axis that points up in pictures; auto: z, but y where the cloud stands on y = 0 and not on z = 0.",
        rich_help_panel="Output",
    ),
]
Unit = Annotated[
    str,
    typer.Option(
        "--unit",
        metavar="NAME",
        help="What the unit of length is called in pictures, such as mm.",
        show_default=False,
        rich_help_panel="Output",
    ),
]
