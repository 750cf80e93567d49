"""``--config``: settings from a file in TOML, a table for each command; what the command line says goes first."""

import sys
from pathlib import Path
from typing import Any

import typer

from tiskel.cli.table import COMMANDS
from tiskel.wording import meant

LARGEST = 1 << 20  # bytes of a settings file; what is larger is none
NOT_SET = ("config", "help")  #: options that a file cannot set
KEPT = "tiskel.config"  #: where the context keeps the name of the file and what it sets


def apply(ctx: typer.Context, value: Path | None) -> Path | None:
    """Make the table of the command the defaults of its options.

    Raises
    ------
    typer.BadParameter
        Where the file cannot be read or is no TOML, and for tables, keys and values that mean nothing: exit code 2.
    """
    if value is not None and not ctx.resilient_parsing:
        command = str(ctx.info_name)
        table = _tables(value).get(command, {})
        defaults = {}
        for key, given in table.items():
            param = _option(ctx, command, key)
            defaults[param.name] = _as_words(f"{key} in [{command}]", given, param)
        ctx.default_map = defaults
        ctx.meta[KEPT] = (str(value), frozenset(defaults))
    return value


def remark(ctx: Any, name: str) -> str:
    """Return which file the value of an option is from, where it is from one."""
    file, names = ctx.meta.get(KEPT, ("", ()))
    source = ctx.get_parameter_source(name)
    return f" (from {file})" if name in names and source is not None and source.name == "DEFAULT_MAP" else ""


def _tables(path: Path) -> dict[str, dict[str, Any]]:
    """Return the tables of a file, every one of which has the name of a command."""
    found = _parsed(path)
    for name, table in found.items():
        if not isinstance(table, dict):
            raise typer.BadParameter(f"{name!r} stands outside of a table; put it under the command, such as [run]")
        if name not in COMMANDS:
            raise typer.BadParameter(f"[{name}] is no command of tiskel.{meant(name, COMMANDS)}")
    return found


def _parsed(path: Path) -> dict[str, Any]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
        if len(data) > LARGEST:
            raise typer.BadParameter(f"{path} has more than {LARGEST >> 20} MB; settings are a few lines of TOML")
        found: dict[str, Any] = tomllib.loads(data.decode())
    except OSError as error:
        raise typer.BadParameter(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:  # TOMLDecodeError and UnicodeDecodeError are ValueErrors
        raise typer.BadParameter(f"{path} is not valid TOML: {error}") from None
    return found


def _option(ctx: typer.Context, command: str, key: str) -> Any:
    """Return the option that a key sets."""
    options = {word.removeprefix("--"): p for p in ctx.command.params for word in p.opts if word.startswith("--")}
    known = {name: param for name, param in options.items() if name not in NOT_SET}
    wanted = key.replace("_", "-")
    if wanted not in known:
        raise typer.BadParameter(f"tiskel {command} has no setting {key!r}.{meant(wanted, known)}")
    return known[wanted]


def _as_words(where: str, given: Any, param: Any) -> Any:
    """Return a value as the command line would have it: words, lists with commas, flags as they are."""
    flag = bool(getattr(param, "is_flag", False))
    if flag != isinstance(given, bool):
        raise typer.BadParameter(f"{where} must be {'true or false' if flag else 'a value'}, got {given!r}")
    if flag:
        return given
    if param.multiple or param.nargs != 1:
        return [_word(where, one) for one in (given if isinstance(given, list) else [given])]
    return _word(where, given)


def _word(where: str, given: Any) -> str:
    if isinstance(given, list):
        return ",".join(_word(where, one) for one in given)
    if isinstance(given, bool) or not isinstance(given, (str, int, float)):
        raise typer.BadParameter(f"{where} must be text, numbers or a list of them, got {given!r}")
    return str(given)
