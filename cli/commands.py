"""The commands, and a group that loads one only where it is called.

The overview costs what Typer costs: it is made of the table, in plain text,
since Typer's own page by Rich takes longer to import than everything else.
"""

from importlib import import_module
from typing import Any, Literal

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from tiskel.cli.table import COMMANDS, PURPOSES

MARKUP: Literal["markdown"] = "markdown"


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
