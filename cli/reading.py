"""How the words of a command line are read, and how its help looks, where that is not as Typer has it."""

import re
from typing import Any

import typer
from typer.core import TyperCommand

from tiskel.cli.settings_file import remark
from tiskel.wording import meant

NO_CHOICE = re.compile(r"(?:Value error, )?('(.*)' is not one of (.*))", re.DOTALL)  #: Typer's words for a wrong choice
QUOTED = re.compile(r"'([^']*)'")


class Reading(TyperCommand):
    """A command that asks what a wrong choice may have meant, and whose flags have no type in the help."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words; typer.BadParameter says where a value is from, and which choice is most like it."""
        try:
            return super().parse_args(ctx, args)
        except typer.BadParameter as error:
            param: Any = error.param
            if found := NO_CHOICE.fullmatch(error.message):
                error.message = f"{found[1].rstrip('.')}.{meant(found[2], QUOTED.findall(found[3]))}"
            error.message += remark(ctx, param.name)
            raise

    def get_help_option(self, ctx: Any) -> Any:
        """Return the option --help, as bare as other flags."""
        option: Any = super().get_help_option(ctx)
        option.metavar = ""
        return option


def bare_flags(command: Any) -> Any:
    """Return a command, its flags without a type in the help: they take no value."""
    for param in command.params:
        if getattr(param, "is_flag", False):
            param.metavar = ""
    return command
