"""The settings of a run, those that are not the defaults first."""

from dataclasses import fields, is_dataclass
from math import isclose
from typing import Any

from tiskel.params import PipelineParams
from tiskel.report import markup as m

AS_WRITTEN = 1e-9  # relative; what ten digits of a number leave open


def settings(params: PipelineParams) -> str:
    """Return all settings; what is not the default stands first."""
    usual, rows = type(params)(), []
    for stage in fields(params):
        rows += _differing(stage.name, getattr(params, stage.name), getattr(usual, stage.name))
    changed = [row for row in rows if row[3]]
    every = m.table(("stage", "setting", "value"), [row[:3] for row in rows], "settings")
    said = m.table(("stage", "setting", "value"), [row[:3] for row in changed], "settings") if changed else ""
    first = f"<h3>Other than usual</h3>{said}" if said else "<p>All settings are the defaults.</p>"
    return f"{first}<details><summary>All {len(rows)} settings</summary>{every}</details>"


def _differing(stage: str, chosen: Any, usual: Any) -> list[tuple[str, str, str, bool]]:
    """Return (stage, setting, value, whether it differs from the default) of params, of several one after the other."""
    if isinstance(chosen, tuple) and all(map(is_dataclass, chosen)):
        pairs = zip(chosen, [*usual, *chosen[len(usual) :]], strict=False)
        return [row for i, (one, other) in enumerate(pairs, 1) for row in _differing(f"{stage} {i}", one, other)]
    if not is_dataclass(chosen):
        return [(stage, "", str(chosen), chosen != usual)]
    return [
        (
            stage,
            one.name,
            str(getattr(chosen, one.name)),
            not _same(getattr(chosen, one.name), getattr(usual, one.name, None)),
        )
        for one in fields(chosen)
    ]


def _same(chosen: Any, usual: Any) -> bool:
    """Tell whether a setting is the default, as it is written on a command line: with ten digits."""
    if isinstance(chosen, float) and isinstance(usual, float):
        return isclose(chosen, usual, rel_tol=AS_WRITTEN)
    if isinstance(chosen, tuple) and isinstance(usual, tuple) and len(chosen) == len(usual):
        return all(map(_same, chosen, usual))
    return bool(chosen == usual)
