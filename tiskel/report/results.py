"""Measures, branches, surfaces, runs and steps as tables with words."""

from tiskel import messages
from tiskel.metrics.result import Quality
from tiskel.metrics.tables import COLUMNS, row_of
from tiskel.pictures.canvas import with_unit
from tiskel.pipeline import PipelineResult
from tiskel.report import markup as m
from tiskel.report.branches import HEAD, MOST, branch_rows
from tiskel.report.words import LENGTHS, MEASURES, RUN


def measures(quality: Quality | None, unit: str) -> list[str]:
    """Return every measure: its value, what is good, what it means."""
    if quality is None:
        return []
    document = quality.as_dict()
    values = row_of(document)
    rows = []
    for column in COLUMNS:
        good, meaning = MEASURES[column.key]
        reason = document[column.path[0]].get("reasons", {}).get(column.path[1], "")
        value = values[column.key]
        named = with_unit(column.heading, unit) if column.key == "graph_length" else column.heading
        rows.append((named, f"none: {reason}" if value is None and reason else value, good, meaning))
    said = m.messages(("warning", line) for line in quality.warnings)
    return [said, m.table(("measure", "value", "good is", "what it means"), rows, "measures")]


def branches(result: PipelineResult, unit: str) -> list[str]:
    """Return the table of the longest branches."""
    s = result.skeleton
    more = f"<p>The {MOST} longest of {len(s.branches)} branches.</p>" if len(s.branches) > MOST else ""
    head = [with_unit(name, unit) if name == "length" else name for name in HEAD]
    return [more, m.table(head, branch_rows(s), "numbers")] if len(s.nodes) else []


def surfaces(result: PipelineResult, unit: str) -> list[str]:
    """Return the table of surfaces, and why there are none."""
    if result.surfaces is None:
        return [f"<p>{m.text(result.reason)}</p>"] if result.reason else []
    head = (
        "branch",
        with_unit("length", unit),
        with_unit("radius", unit),
        "order",
        "misfit",
        "unseen",
        "frame",
        "slices",
        "warnings",
    )
    rows: list[tuple[object, ...]] = [
        (
            s.name, s.length, s.radius, s.order, f"{s.error:.2%}", f"{s.unseen:.0%}", s.frame,
            ", ".join(f"{count} {case}" for case, count in s.cases().items()), "; ".join(s.warnings),
        )
        for s in result.surfaces
    ]  # fmt: skip
    rows += [(branch, "", "", "", "", "", "", "no surface", why) for branch, why in result.surfaces.rejected.items()]
    covered = [("plain", one.text) for one in messages.of_coverage(result.surfaces)]
    return [m.messages(covered), m.table(head, rows, "numbers telling")]


def runs(result: PipelineResult, unit: str) -> list[str]:
    """Return the runs side by side, and why there are none."""
    if not result.trajectories:
        return [f"<p>{m.text(result.reason)}</p>"] if result.reason and result.surfaces is not None else []
    runs = [run.as_dict() for run in result.trajectories]
    names = {key: with_unit(name, unit) if key in LENGTHS else name for key, name in RUN.items()}
    rows = [(name, *(run[key] for run in runs)) for key, name in names.items()]
    return [m.table(("", *(f"run {i}" for i in range(1, len(runs) + 1))), rows)]


def steps(result: PipelineResult) -> list[str]:
    """Return the steps of the contraction, and whether it was stable."""
    steps = result.contraction.steps
    columns = {
        "step": range(1, len(steps) + 1), "contraction weight": [step.contraction_weight or None for step in steps],
        "ring ratio": [step.ring_ratio for step in steps], "explained score": [step.score for step in steps],
        "points": [step.points for step in steps],
    }  # fmt: skip
    columns = {name: cells for name, cells in columns.items() if any(cell is not None for cell in cells)}
    verdict = ""
    if result.stability is not None:
        stable = result.stability.stable
        words = f"{'Stable' if stable else 'Not stable'}: {result.stability.reason}"
        verdict = m.messages([("good" if stable else "warning", words)])
    return [verdict, m.table(list(columns), list(zip(*columns.values(), strict=True)), "numbers")]
