"""The page that ``tiskel run`` writes."""

import html
from typing import TYPE_CHECKING, Any

from tiskel import messages

if TYPE_CHECKING:
    from tiskel.metrics.result import Quality
    from tiskel.pipeline import PipelineResult


def report(name: str, result: "PipelineResult") -> str:
    """Return one page: what went in, what came out, the steps, the measures, the pictures."""
    c, s, q = result.contraction, result.skeleton, result.quality
    facts = {
        "points": len(c.cloud),
        "method": c.params.method,
        "steps": len(c.steps),
        "status": f"{c.status.value}: {c.status.advice}",
        "points left": f"{len(c.points)} ({len(c.points) / len(c.cloud):.1%})",
        "nodes": len(s.nodes),
        "components": s.components,
        "loops": s.loops,
        "ends": s.ends,
        "joints": s.junctions,
        "length": f"{s.length:.6g}",
    }
    head = ("step", "contraction weight", "ring ratio", "explained score", "points")
    steps = [
        (i, f"{t.contraction_weight:.4g}", f"{t.ring_ratio:.4f}", "" if t.score is None else f"{t.score:.5f}", t.points)
        for i, t in enumerate(c.steps, 1)
    ]
    lines = (*c.warnings, *map(str, s.warnings), *(f"note: {note}" for note in s.notes), *q.warnings)
    warnings = "".join(f"<li>{html.escape(line)}</li>" for line in lines)
    table = "".join(_row(pair) for pair in facts.items())
    history = _row(head, "th") + "".join(_row(step) for step in steps)
    return PAGE.format(
        name=html.escape(name),
        table=table,
        warnings=warnings,
        history=history,
        stability=html.escape("; ".join(m.text for m in messages.of_stability(result.stability))),
        measures="".join(map(_row, _measures(q))),
        surfaces=_surfaces(result),
    )


def _surfaces(result: "PipelineResult") -> str:
    """Return tables of surfaces and runs with their pictures, and why there are none."""
    parts = []
    if result.surfaces is not None:
        head = ("branch", "length", "radius", "order", "misfit", "unseen", "frame", "slices", "warnings")
        rows: list[tuple[object, ...]] = [
            (
                s.name, f"{s.length:.6g}", f"{s.radius:.4g}", s.order, f"{s.error:.2%}", f"{s.unseen:.0%}", s.frame,
                ", ".join(f"{count} {case}" for case, count in s.cases().items()), "; ".join(s.warnings),
            )
            for s in result.surfaces
        ]  # fmt: skip
        rows += [(branch, "", "", "", "", "", "", "", why) for branch, why in result.surfaces.rejected.items()]
        parts += [_row(head, "th"), *map(_row, rows), IMAGE.format("slices.png", "slices, a section, the surface")]
    if result.trajectories:
        parts += [_row((key, *(r.as_dict()[key] for r in result.trajectories))) for key in TOLD]
        parts.append(IMAGE.format("roll.png", "the contact on object and sphere, and the states over time"))
    said = [m.text for m in messages.of_coverage(result.surfaces)] if result.surfaces is not None else []
    parts.append(f"</table><p>{html.escape('; '.join(said))}</p><table>")
    return f"<table>{''.join(parts)}</table><p>{html.escape(result.reason)}</p>"


TOLD = ("model", "side", "radius", "status", "reason", "path_object", "path_sphere", "least_margin", "evaluations")
IMAGE = '</table><img src="{}" alt="{}"><table>'


def _measures(quality: "Quality") -> list[tuple[str, str, str]]:
    """Return heading, value and, where there is none, the reason of every measure."""
    from tiskel.metrics.tables import COLUMNS, row_of, said

    document = quality.as_dict()
    row = row_of(document)
    reasons = [document[column.path[0]].get("reasons", {}).get(column.path[1], "") for column in COLUMNS]
    return [(c.heading, said(row[c.key]), reason) for c, reason in zip(COLUMNS, reasons, strict=True)]


PAGE = """<!doctype html>
<meta charset="utf-8">
<title>tiskel</title>
<style>
body {{ font: 15px sans-serif; margin: 2em; max-width: 75em }}
td, th {{ padding: .2em .8em; text-align: right }}
img {{ max-width: 100% }}
</style>
<h1>{name}</h1>
<img src="skeleton.png" alt="the cloud and its curve skeleton">
<table>{table}</table>
<ul>{warnings}</ul>
<h2>Quality</h2>
<img src="metrics.png" alt="the measures as heat maps, barcodes and histograms">
<table>{measures}</table>
<h2>Surface and rolling</h2>
{surfaces}
<h2>Contraction</h2>
<table>{history}</table>
<p>{stability}</p>
<img src="stability.png" alt="turns of normals and changes of curvature, step by step">
"""


def _row(cells: tuple[Any, ...], tag: str = "td") -> str:
    return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
