"""The table of commands, and a group that loads a command only where it is called.

The overview costs what Typer costs: it is made of the table, in plain text,
since Typer's own page by Rich takes longer to import than everything else.
"""

from importlib import import_module
from typing import Any, Literal, NamedTuple

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

MARKUP: Literal["markdown"] = "markdown"


class Entry(NamedTuple):
    """Where a command is, and the first paragraph of its help."""

    module: str
    function: str
    summary: str
    bare: bool = False  # does something without arguments, where the others show their help


COMMANDS = {
    "contract": Entry("contract", "contract", "Contract a cloud or mesh towards its medial curve."),
    "skeleton": Entry("skeleton", "skeleton", "Turn a contracted cloud into a curve skeleton."),
    "metrics": Entry(
        "metrics", "metrics",
        "Say how good skeletons are: topology, boundedness, inside, medialness, air, centredness and more.",
    ),
    "stability": Entry(
        "stability", "stability",
        "Say whether a contraction is stable: how normals and curvatures change from step to step.",
    ),
    "compare": Entry(
        "compare", "compare",
        "Say whether two skeletons of one body are alike: the same graph, the same ends, how far they are apart.",
    ),
    "run": Entry(
        "run", "run",
        "Do everything in one go: stage files, exports, measures, surfaces, a roll, pictures and a report in one "
        "folder.",
    ),
    "split": Entry("split", "split", "Cut a cloud that is too large into tiles that overlap, or into its objects."),
    "join": Entry("join", "join", "Make one skeleton of those of tiles or objects."),
    "view": Entry(
        "view", "view",
        "Show clouds, curves, surfaces and runs together: a page that turns under the mouse, or a picture.",
    ),
    "batch": Entry(
        "batch", "batch",
        "Do many clouds: all that run does, a sub-folder each; resumable, on one machine or many.",
    ),
    "shape": Entry(
        "shape", "shape", "Make a cloud whose curve skeleton is known: tubes, plants, blocks, torsos, wires.",
        bare=True,
    ),
    "convert": Entry("convert", "convert", "Convert a cloud, a mesh or a skeleton to another format."),
    "info": Entry(
        "info", "info",
        "Say what a file holds: points and extent of a cloud, steps of a contraction, counts of a skeleton, surfaces.",
    ),
    "doctor": Entry(
        "doctor", "doctor", "Check the installation: versions, optional parts, threads, and that a kernel runs.",
        bare=True,
    ),
    "slice": Entry(
        "slice", "slice_command",
        "Fit a smooth surface around every branch of a skeleton, slice by slice, and one surface to the whole body.",
    ),
    "roll": Entry("roll", "roll", "Roll a sphere over a surface."),
    "plan": Entry(
        "plan", "plan", "Plan how to roll a sphere from a contact to another, and to an attitude, without slip.",
    ),
}  # fmt: skip


class Commands(TyperGroup):
    """The commands of the table: their summaries in the overview, the command itself where it is called."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands = {name: TyperCommand(name, short_help=entry.summary) for name, entry in COMMANDS.items()}

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        """Return the command called, with its module loaded."""
        name, summary, rest = super().resolve_command(ctx, args)
        return name, summary and load(str(summary.name)), rest

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the overview in plain text, past Typer's page by Rich."""
        super(TyperGroup, self).format_help(ctx, formatter)


def load(name: str) -> Any:
    """Import a command and return it as Typer parses it."""
    entry = COMMANDS[name]
    one = typer.Typer(rich_markup_mode=MARKUP, pretty_exceptions_enable=False, add_completion=False)
    function = getattr(import_module(f"tiskel.cli.{entry.module}"), entry.function)
    one.command(name, no_args_is_help=not entry.bare)(function)
    return get_command(one)
