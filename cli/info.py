"""``tiskel info``."""

import json
import math
import sys
from typing import TYPE_CHECKING, Any

import typer

from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common
from tiskel.cli.progress import reading, shown

if TYPE_CHECKING:
    from tiskel.arrays import Points

DIGITS = 6  #: of a number in the table; JSON has all of them


@common
def info(source: o.Source, columns: o.Columns = None, as_json: o.AsJson = False) -> None:
    """Say what a file holds: points and extent of a cloud, steps of a contraction, counts of a skeleton, surfaces.

    A table on a terminal, JSON otherwise: `tiskel info curve.ply | jq .skeleton.ends`
    """
    with shown(reading(source)):
        facts = _facts(source, stages.columns_of(columns))
    if as_json or not sys.stdout.isatty():
        typer.echo(json.dumps(facts, allow_nan=False))
        return
    rows = [[key, rounded(value, _size(facts["cloud"]))] for key, value in _flat(facts)]
    from rich.console import Console

    Console().print(console.table(str(source), ["what", "value"], rows))


def _facts(source: Any, columns: tuple[str, ...] | None) -> dict[str, Any]:
    from tiskel.io.clouds import parse_cloud
    from tiskel.io.stages.contraction import parse_contraction
    from tiskel.io.stages.skeleton import parse_skeleton
    from tiskel.io.stages.which import stage_of
    from tiskel.io.streams import read_bytes

    data = read_bytes(source)
    stage = stage_of(data)
    if stage is None and data.lstrip().startswith(b"{"):
        return _surface_facts(data, source)
    if stage == "contraction":
        c = parse_contraction(data, str(source))
        steps = {"steps": len(c.steps), "left": len(c.points), "method": c.params.method, "status": c.status.value}
        return {"file": source.name, "stage": stage, "contraction": steps, "cloud": _extent(c.cloud)}
    if stage == "skeleton":
        s = parse_skeleton(data, str(source))
        counts = {"nodes": len(s.nodes), "edges": len(s.edges), "branches": len(s.branches), **s.counts()}
        return {"file": source.name, "stage": stage, "skeleton": counts, "cloud": _extent(s.cloud)}
    cloud = parse_cloud(data, source, columns=columns)
    properties = {"properties": sorted(cloud.properties)} if cloud.properties else {}
    mesh = {"mesh": cloud.mesh.as_dict()} if cloud.mesh else {}
    said = {"warnings": list(cloud.warnings), "notes": list(cloud.notes)}
    return {"file": cloud.name, **mesh, "cloud": _extent(cloud.points) | properties, **said}


def _surface_facts(data: bytes, source: Any) -> dict[str, Any]:
    from tiskel.io.stages.surface import parse_surfaces

    found = parse_surfaces(data, str(source))
    surfaces = {
        s.name: {"length": s.length, "radius": s.radius, "order": s.order, "error": s.error, "slices": s.cases()}
        for s in found
    }
    extra: dict[str, Any] = {"rejected": found.rejected} if found.rejected else {}
    if found.body is not None:
        extra["body"] = {"patches": len(found.body.patches), "radius": found.body.radius, **found.body.summary}
    return {"file": source.name, "stage": "surface", "surfaces": surfaces, **extra, "cloud": _extent(found.cloud)}


def _extent(points: "Points") -> dict[str, Any]:
    """Return counts and the bounding box of the finite points, and that of the body where some points are stray."""
    import numpy as np

    from tiskel.arrays import as_points
    from tiskel.geometry.strays import stray_points

    finite = as_points(points)[np.isfinite(points).all(axis=1)]
    box = {"min": finite.min(axis=0).tolist(), "max": finite.max(axis=0).tolist()} if len(finite) else {}
    stray = stray_points(finite)
    if stray.any():
        body = finite[~stray]
        box |= {"stray": int(stray.sum()), "body_min": body.min(axis=0).tolist(), "body_max": body.max(axis=0).tolist()}
    return {
        "points": len(points),
        "not_finite": len(points) - len(finite),
        "duplicates": len(finite) - len(np.unique(finite, axis=0)),
        **box,
    }


def _flat(facts: dict[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    rows: list[tuple[str, Any]] = []
    for key, value in facts.items():
        rows += _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else [(f"{prefix}{key}", value)]
    return rows


def rounded(value: Any, size: float = 0.0) -> str:
    """Return a value as the table shows it: coordinates to a hundred-thousandth of the size, else six digits."""
    if isinstance(value, list):
        return ", ".join(rounded(one, size) for one in value)
    if not isinstance(value, float):
        return str(value)
    if size > 0 and math.isfinite(value) and abs(value) >= size:  # six digits would not tell ends of a far box apart
        return f"{value:.{max(0, DIGITS - 1 - math.floor(math.log10(size)))}f}"
    return f"{value:.{DIGITS}g}"


def _size(extent: dict[str, Any]) -> float:
    """Return the longest side of a bounding box; 0 where there is none."""
    low, high = extent.get("min", ()), extent.get("max", ())
    return max((float(b) - float(a) for a, b in zip(low, high, strict=True)), default=0.0)
