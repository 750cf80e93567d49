"""Options of rolling over a whole body, which has no chart."""

from typing import Annotated

import typer

from tiskel.params.roll import OnMeeting, Trusted

Heading = Annotated[
    str | None,
    typer.Option(
        metavar="x,y,z",
        help="Body: where --omega 1,0,0 rolls to at first. [default: up]",
        show_default=False,
        rich_help_panel="Method",
    ),
]
AttitudeAtStart = Annotated[
    str | None,
    typer.Option(
        "--start-attitude",
        metavar="w,x,y,z",
        help="Body: quaternion of the sphere at the start. [default: 1,0,0,0]",
        show_default=False,
        rich_help_panel="Method",
    ),
]
MeetingName = Annotated[
    OnMeeting,
    typer.Option(
        "--on-meeting", help="Body: what a second contact does: ends the run, or replaces the first.",
        rich_help_panel="Method",
    ),
]  # fmt: skip
TrustedName = Annotated[
    Trusted,
    typer.Option("--trusted", help="Body: the run ends where the surface is worth less.", rich_help_panel="Method"),
]
