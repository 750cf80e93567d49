"""The numbers that method robust rests on: found by reading its modules, and set to other values for a while."""

import ast
import importlib
import pkgutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from tiskel import RobustParams, TiskelError
from tiskel.methods import robust

PARAMS = "params"  # stands for the module of a setting
AT_MOST_ONE = {
    "branches.FARTHEST", "branches.TIP_SHARE", "branches.AHEAD", "bridges.FACING", "bridges.FACING_SIDE",
    "levels.FLAT_SHARE", "levels.MOSTLY", "cycles.ALONG", "cycles.SHARE_INSIDE",
    "cycles.FRAGMENT", "fronts.ACROSS", "network.ALONG_NORMALS", "params.least_part", "__init__.CLEARLY",
}  # fmt: skip


@dataclass(frozen=True)
class Constant:
    """A number to turn: its module (PARAMS: a setting), its name, and its element where it has several."""

    module: str
    name: str
    element: int | None
    value: float

    @property
    def label(self) -> str:
        return f"{self.module}.{self.name}" + ("" if self.element is None else f"[{self.element}]")


@cache
def modules() -> dict[str, tuple[ModuleType, ast.Module]]:
    """Return every module of the method and its syntax, by its short name."""
    found = {"__init__": robust}
    for module in pkgutil.iter_modules(robust.__path__):
        found[module.name] = importlib.import_module(f"{robust.__name__}.{module.name}")
    return {name: (module, ast.parse(Path(str(module.__file__)).read_text())) for name, module in found.items()}


def constants() -> Iterator[Constant]:
    """Yield the numbers of all modules in capitals, in order, and the numeric settings."""
    for short, (module, tree) in modules().items():
        for name in assigned(tree):
            value = getattr(module, name)
            if isinstance(value, int | float):
                yield Constant(short, name, None, value)
            elif isinstance(value, tuple | np.ndarray):
                yield from (Constant(short, name, i, float(number)) for i, number in enumerate(value))
    for setting in fields(RobustParams):
        if isinstance(setting.default, int | float):
            yield Constant(PARAMS, setting.name, None, setting.default)


def assigned(tree: ast.Module) -> list[str]:
    """Return the names in capitals that a module assigns; refuse those that something is computed from on import."""
    statements = [statement for statement in tree.body if isinstance(statement, ast.Assign | ast.AnnAssign)]
    functions = [node.args for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    defaults = [default for args in functions for default in (*args.defaults, *args.kw_defaults) if default]
    nodes = (node for root in (*statements, *defaults) for node in ast.walk(root))
    names = [node for node in nodes if isinstance(node, ast.Name) and node.id.isupper()]
    for name in names:
        if isinstance(name.ctx, ast.Load):
            raise TiskelError(f"{name.id} is read on import, where turning it has no effect; read it in a function")
    return [name.id for name in names]


def turned(constant: Constant, factor: float) -> float:
    """Return the value times a factor, within what the constant may be."""
    if isinstance(constant.value, int):
        rounded = round(factor * constant.value)
        least = constant.value + (1 if factor > 1 else -1)
        return max(rounded, least) if factor > 1 else max(min(rounded, least), 0)
    value = factor * constant.value
    return min(value, 1.0) if f"{constant.module}.{constant.name}" in AT_MOST_ONE else value


@contextmanager
def patched(constant: Constant, value: float) -> Iterator[RobustParams]:
    """Set a constant where it is defined and in every module that imports it by name; yield the settings."""
    if constant.module == PARAMS:
        yield RobustParams(**{constant.name: value})  # type: ignore[arg-type]
        return
    known = modules()
    home = known[constant.module][0]
    before = getattr(home, constant.name)
    after: Any = value
    if constant.element is not None:
        elements = [value if i == constant.element else old for i, old in enumerate(before)]
        after = np.array(elements) if isinstance(before, np.ndarray) else tuple(elements)
    users = [module for module, tree in known.values() if module is home or imports(tree, home, constant.name)]
    for module in users:
        setattr(module, constant.name, after)
    try:
        yield RobustParams()
    finally:
        for module in users:
            setattr(module, constant.name, before)


def imports(tree: ast.Module, home: ModuleType, name: str) -> bool:
    """Tell whether a module imports a name from its home."""
    froms = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module == home.__name__]
    return any(alias.name == name for node in froms for alias in node.names)
