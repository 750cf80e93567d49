"""The report of a run: one page that holds everything, the viewer and the pictures included."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files

from tiskel.messages import Message
from tiskel.params import LookParams
from tiskel.pictures.canvas import with_palette, with_unit
from tiskel.pipeline import PipelineResult
from tiskel.report import markup as m
from tiskel.report.results import branches, measures, runs, steps, surfaces
from tiskel.report.settings import settings
from tiskel.report.words import FILES, PICTURES, STAGES
from tiskel.version import version
from tiskel.viewer.page import script, styles, viewer
from tiskel.viewer.show import view

INNER = "."  # in the name of a time: a part of a stage


@dataclass(frozen=True, kw_only=True)
class RunFacts:
    """What a run knows besides its results.

    Attributes
    ----------
    name : str
        The name of the input, without folders.
    sha256 : str
        Of the input.
    command : str
        The command line; empty where there was none.
    told : sequence of (str, sequence of Message)
        What each part said, in order.
    seconds : mapping
        Wall time by part; a name with a dot is a part of a part. Empty where times are not to be in the page.
    look : LookParams
        Which axis points up, and the unit of length.
    files : sequence of str
        The names of the files beside the report.
    """

    name: str
    sha256: str = ""
    command: str = ""
    told: Sequence[tuple[str, Sequence[Message]]] = ()
    seconds: Mapping[str, float] = field(default_factory=dict)
    look: LookParams = field(default_factory=LookParams)
    files: Sequence[str] = ()


def report(result: PipelineResult, facts: RunFacts, pictures: Mapping[str, bytes] | None = None) -> str:
    """Return the report of a run as one page that asks for nothing else.

    Parameters
    ----------
    result : PipelineResult
        What the stages made; parts that were left out are None and have no section.
    facts : RunFacts
        What else is known of the run.
    pictures : mapping of str to bytes, optional
        The pictures as PNG, by file name.

    Returns
    -------
    str
    """
    shown = {name: with_palette(data) for name, data in (pictures or {}).items()}
    unit = facts.look.unit
    scene = view(result, up=facts.look.up, unit=facts.look.unit, title=facts.name).scene
    parts = (
        viewer(scene),
        m.section("input", "What went in", _input(result, facts)),
        m.section("result", "What came out", _outcome(result, facts), _picture("skeleton.png", shown)),
        m.section("stages", "Stage by stage", _stages(facts)),
        m.section("measures", "Measures", *measures(result.quality, unit), _picture("metrics.png", shown)),
        m.section("branches", "Branches", *branches(result, unit)),
        m.section("surfaces", "Surfaces and slices", *surfaces(result, unit), _picture("slices.png", shown)),
        m.section("roll", "Rolling sphere", *runs(result, unit), _picture("roll.png", shown)),
        m.section("contraction", "Contraction and its stability", *steps(result), _picture("stability.png", shown)),
        m.section("settings", "Settings", settings(result.params)),
        m.section("files", "Files", _files(facts)),
    )
    css = (files("tiskel.report") / "report.css").read_text(encoding="utf-8")
    head = HEAD_OF_PAGE.format(title=m.text(facts.name), styles=styles(), css=css, contents=_contents(parts))
    return f"{head}{''.join(parts)}</main>{script()}</body></html>\n"


HEAD_OF_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title} - tiskel</title><link rel="icon" href="data:,">{styles}<style>{css}</style></head>
<body><main><header><h1>{title}</h1><nav>{contents}</nav></header>
"""


def _contents(parts: Sequence[str]) -> str:
    """Return links to the sections."""
    links = []
    for part in parts:
        if part.startswith("<section"):
            name, title = part.split('"')[1], part.split("<h2>")[1].split("</h2>")[0]
            links.append(f'<a href="#{name}">{title}</a>')
    return "".join(links)


def _picture(name: str, shown: Mapping[str, bytes]) -> str:
    return m.picture(name, shown.get(name), PICTURES[name])


def _input(result: PipelineResult, facts: RunFacts) -> str:
    c = result.contraction
    sides = c.cloud.max(axis=0) - c.cloud.min(axis=0) if len(c.cloud) else ()
    pairs: list[tuple[str, object]] = [
        ("file", facts.name),
        ("SHA-256", facts.sha256),
        ("points", len(c.cloud)),
        (with_unit("size in x, y and z", facts.look.unit), " by ".join(f"{side:.5g}" for side in sides)),
        ("command", facts.command),
        ("tiskel", version()),
        ("method", c.params.method),
    ]
    return m.facts((name, value) for name, value in pairs if value != "")


def _outcome(result: PipelineResult, facts: RunFacts) -> str:
    """Return the counts, then warnings and notes in words."""
    c, s = result.contraction, result.skeleton
    pairs = [
        ("contraction", f"{c.status.value}: {c.status.advice}"),
        ("points left", f"{len(c.points)} ({len(c.points) / max(len(c.cloud), 1):.1%})"),
        ("components", s.components), ("loops", s.loops), ("ends", s.ends), ("joints", s.junctions),
        ("branches", len(s.branches)), ("nodes", len(s.nodes)), (with_unit("length", facts.look.unit), s.length),
    ]  # fmt: skip
    doubts = [("warning", str(doubt)) for doubt in s.warnings] + [("note", str(doubt)) for doubt in s.notes]
    sound = [] if s.warnings else [("good", "no warnings: nothing speaks against this curve")]
    return m.messages([*sound, *doubts]) + m.facts(pairs)


def _stages(facts: RunFacts) -> str:
    """Return what every stage said and how long it took."""
    told = dict(facts.told)
    rows = []
    for part in dict.fromkeys((*told, *(name for name in facts.seconds if INNER not in name))):
        lines = [("warning" if one.warning else "plain", one.text) for one in told.get(part, ()) if not one.detail]
        inner = ", ".join(
            f"{name.partition(INNER)[2]} {seconds:.2f}" for name, seconds in facts.seconds.items()
            if name.startswith(part + INNER) and seconds >= LEAST_SECONDS
        )  # fmt: skip
        took = f"{facts.seconds[part]:.2f} s" if part in facts.seconds else ""
        small = f"<small>{m.text(inner)}</small>" if inner else ""
        rows.append(
            f'<tr><th scope="row">{m.text(STAGES.get(part, part))}</th><td class="time">{took}{small}</td>'
            f"<td>{m.folded(lines)}</td></tr>"
        )
    return f'<div class="wide"><table class="stages">{"".join(rows)}</table></div>' if rows else ""


LEAST_SECONDS = 0.005  # shorter parts of a stage are not named


def _files(facts: RunFacts) -> str:
    rows = (
        f'<tr><th scope="row"><a href="{name}">{name}</a></th><td>{m.text(FILES.get(name, ""))}</td></tr>'
        for name in map(m.text, facts.files)
    )
    return f'<div class="wide"><table class="facts">{"".join(rows)}</table></div>' if facts.files else ""
