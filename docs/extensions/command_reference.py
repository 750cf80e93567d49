"""The reference of all commands and options, made of the commands themselves; an option is documented once.

What at least ``SHARED`` commands have in the same words stands in one table at the end, with the commands that have it.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, get_args

SHARED = 5  #: commands that have an option in the same words, from which on it is described once for all
HELP = ["--help", "-h"]
VALUES = {int: "N", float: "X", Path: "FILE"}  # by annotation, as Typer names it from 0.29 on
KINDS = {"integer": "N", "float": "X", "path": "FILE"}  # by the first word of Click's type, as it does before


class Parameter(NamedTuple):
    """An argument or option as the reference says it."""

    names: str
    value: str
    panel: str
    words: str


def parameters() -> Mapping[str, list[Parameter]]:
    """Return what every command takes, by its name; --help aside, which all of them have."""
    from tiskel.cli.commands import COMMANDS, load

    return {name: [_parameter(one) for one in load(name).params if one.opts != HELP] for name in COMMANDS}


def _parameter(one: Any) -> Parameter:
    argument = one.param_type_name == "argument"
    names = (one.metavar or one.name.upper()) if argument else ", ".join([*one.opts, *one.secondary_opts])
    flag = argument or one.is_flag
    value = "" if flag else one.metavar or _kind(one)
    default = "" if flag or one.default in (None, "", ()) or not one.show_default else _said(one.default)
    words = " ".join((one.help or "").split()) + (f" Default: {default}." if default else "")
    return Parameter(names, value, "Arguments" if argument else one.rich_help_panel or "Options", words)


def _kind(one: Any) -> str:
    """Return what stands for a value that has no name of its own: its choices, or a letter for its type."""
    if hasattr(one, "type_descriptor"):
        annotation = one.type_descriptor.annotation
        return "|".join(map(str, get_args(annotation))) or VALUES.get(annotation, "TEXT")
    return "|".join(getattr(one.type, "choices", ())) or KINDS.get(one.type.name.split()[0], "TEXT")


def _said(value: Any) -> str:
    return str(getattr(value, "value", value))


def reference() -> str:
    """Return the page's Markdown."""
    from tiskel.cli.commands import load

    taken = parameters()
    owners: dict[Parameter, list[str]] = defaultdict(list)
    for name, ones in taken.items():
        for one in ones:
            owners[one].append(name)
    shared = {one for one, names in owners.items() if len(names) >= SHARED}
    parts = [
        "\n".join([f"## tiskel {name}", "", _help(load(name)), "", *_table(one for one in ones if one not in shared)])
        for name, ones in taken.items()
    ]
    rows = [one._replace(words=f"{one.words} *{', '.join(owners[one])}*") for one in owners if one in shared]
    return "\n\n".join([*parts, "## Options of several commands", "\n".join(_table(rows))])


def _help(command: Any) -> str:
    return "\n\n".join(" ".join(part.split()) for part in (command.help or "").split("\n\n"))


def _table(ones: Iterable[Parameter]) -> list[str]:
    rows = [_row(f"`{one.names}{' ' + one.value if one.value else ''}`", one.panel, one.words) for one in ones]
    return [_row("what", "kind", "meaning"), "|---|---|---|", *rows] if rows else []


def _row(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def setup(app: Any) -> dict[str, bool]:
    """Make the directive ``{commands}``."""
    from sphinx.util.docutils import SphinxDirective

    class Commands(SphinxDirective):
        def run(self) -> list[Any]:
            return self.parse_text_to_nodes(reference(), allow_section_headings=True)

    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
