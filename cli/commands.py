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
    """Where a command is, what it is for, and the first paragraph of its help."""

    module: str
    function: str
    purpose: str
    summary: str
    bare: bool = False  # does something without arguments, where the others show their help


CURVE, JUDGE, SURFACE, WHOLE, FILES, HERE = PURPOSES = (
    "From a cloud to its curve", "How good a curve is", "Surfaces and rolling", "All in one go, many and large clouds",
    "Files, pictures and shapes", "This installation",
)  # fmt: skip
COMMANDS = {
    "contract": Entry("contract", "contract", CURVE, "Contract a cloud or mesh towards its medial curve."),
    "skeleton": Entry("skeleton", "skeleton", CURVE, "Turn a contracted cloud, or a cloud, into a curve skeleton."),
    "metrics": Entry(
        "metrics", "metrics", JUDGE,
        "Say how good skeletons are: topology, boundedness, inside, medialness, air, centredness and more.",
    ),
    "stability": Entry(
        "stability", "stability", JUDGE,
        "Say whether a contraction is stable: how normals and curvatures change from step to step.",
    ),
    "compare": Entry(
        "compare", "compare", JUDGE,
        "Say whether two skeletons of one body are alike: the same graph, the same ends, how far they are apart.",
    ),
    "slice": Entry(
        "slice", "slice_command", SURFACE,
        "Fit a smooth surface around every branch of a skeleton, slice by slice, and one surface to the whole body.",
    ),
    "roll": Entry("roll", "roll", SURFACE, "Roll a sphere over a surface."),
    "plan": Entry(
        "plan", "plan", SURFACE,
        "Plan how to roll a sphere from a contact to another, and to an attitude, without slip.",
    ),
    "run": Entry(
        "run", "run", WHOLE,
        "Do everything in one go: stage files, exports, measures, surfaces, a roll, pictures and a report in one "
        "folder.",
    ),
    "batch": Entry(
        "batch", "batch", WHOLE,
        "Do many clouds: all that run does, a sub-folder each; resumable, on one machine or many.",
    ),
    "split": Entry(
        "split", "split", WHOLE, "Cut a cloud that is too large into tiles that overlap, or into its objects.",
    ),
    "join": Entry("join", "join", WHOLE, "Make one skeleton of those of tiles or objects."),
    "info": Entry(
        "info", "info", FILES,
        "Say what a file holds: points and extent of a cloud, steps of a contraction, counts of a skeleton, surfaces.",
    ),
    "convert": Entry("convert", "convert", FILES, "Convert a cloud, a mesh or a skeleton to another format."),
    "view": Entry(
        "view", "view", FILES,
        "Show clouds, curves, surfaces and runs together: a page that turns under the mouse, or a picture.",
    ),
    "shape": Entry(
        "shape", "shape", FILES, "Make a cloud whose curve skeleton is known: tubes, plants, blocks, torsos, wires.",
        bare=True,
    ),
    "doctor": Entry(
        "doctor", "doctor", HERE, "Check the installation: versions, optional parts, threads, and that a kernel runs.",
        bare=True,
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
        for part in (self.format_usage, self.format_help_text, self.format_options, self.format_epilog):
            part(ctx, formatter)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options, then the commands by what they are for."""
        options = [param.get_help_record(ctx) for param in self.get_params(ctx)]
        with formatter.section("Options"):
            formatter.write_dl([record for record in options if record])
        for purpose in PURPOSES:
            with formatter.section(purpose):
                formatter.write_dl([(name, e.summary) for name, e in COMMANDS.items() if e.purpose == purpose])


def load(name: str) -> Any:
    """Import a command and return it as Typer parses it."""
    from tiskel.cli.reading import Reading, bare_flags

    entry = COMMANDS[name]
    one = typer.Typer(rich_markup_mode=MARKUP, pretty_exceptions_enable=False, add_completion=False)
    function = getattr(import_module(f"tiskel.cli.{entry.module}"), entry.function)
    one.command(name, cls=Reading, no_args_is_help=not entry.bare)(function)
    return bare_flags(get_command(one))
