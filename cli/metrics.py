"""``tiskel metrics``."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tiskel.cli import console, logbook, stages
from tiskel.cli import options as o
from tiskel.cli.common import common, looks
from tiskel.cli.progress import reading, shown
from tiskel.errors import TiskelError
from tiskel.params import Bars, BetaRule, LookParams, MetricParams, Normalisation

if TYPE_CHECKING:
    from tiskel.arrays import Points
    from tiskel.metrics.result import Quality

METRICS = MetricParams()

Sources = Annotated[
    list[Path] | None,
    typer.Argument(metavar="SKELETON...", help="Skeleton files; - for standard input.", show_default=False),
]
CloudFile = Annotated[
    Path | None,
    typer.Option(
        "--cloud",
        metavar="C",
        help="The cloud, for skeletons without one.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
PointsFile = Annotated[
    Path | None,
    typer.Option(
        "--points",
        metavar="P",
        help="Skeletal points: a cloud, or contraction.ply.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
CurveFile = Annotated[
    Path | None,
    typer.Option(
        "--curve",
        metavar="G",
        help="A curve: PLY, OBJ, SWC, GraphML, JSON.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
BarRule = Annotated[
    Bars,
    typer.Option(
        "--bars",
        help="Which bars are compared: as in the toolbox, or as in print.",
        rich_help_panel="Method",
    ),
]
NormaliseName = Annotated[
    Normalisation, typer.Option("--normalise", help="What is scaled to 1.6 inside.", rich_help_panel="Method")
]
NoDiagonal = Annotated[
    bool, typer.Option("--no-diagonal", help="Match bars with bars only, as in print.", rich_help_panel="Method")
]
BetaName = Annotated[
    BetaRule,
    typer.Option(
        "--beta",
        help="Boundedness by the hull of directions, by the printed map of them, or as in the toolbox.",
        rich_help_panel="Method",
    ),
]
Bounded = Annotated[
    float, typer.Option("--bounded", metavar="B", help="beta*, least of what is bounded.", rich_help_panel="Method")
]
Centred = Annotated[
    float, typer.Option("--centred", metavar="C", help="c*, least of what is centred.", rich_help_panel="Method")
]
Similar = Annotated[
    float,
    typer.Option("--similar", metavar="D", help="d*, distances of similar topology.", rich_help_panel="Method"),
]
MetricSeed = Annotated[
    int, typer.Option("--seed", min=0, metavar="N", help="Of everything random.", rich_help_panel="Method")
]
AsCsv = Annotated[bool, typer.Option("--csv", help="CSV instead of JSON.", rich_help_panel="Output")]
HeatFile = Annotated[
    Path | None,
    typer.Option(
        "--ply",
        metavar="OUT",
        help="Also the values per point, as vertex properties.",
        show_default=False,
        rich_help_panel="Output",
    ),
]


@common
@looks
def metrics(
    sources: Sources = None,
    cloud: CloudFile = None,
    points: PointsFile = None,
    curve: CurveFile = None,
    bars: BarRule = METRICS.bars,
    no_diagonal: NoDiagonal = not METRICS.diagonal,
    beta: BetaName = METRICS.beta,
    bounded: Bounded = METRICS.bounded,
    centred: Centred = METRICS.threshold,
    similar: Similar = METRICS.similar,
    normalise: NormaliseName = METRICS.normalise,
    seed: MetricSeed = METRICS.seed,
    as_json: o.AsJson = False,
    as_csv: AsCsv = False,
    heat: HeatFile = None,
    plot: o.Plot = None,
    *,
    look: LookParams,
) -> None:
    """Say how good skeletons are: topology, boundedness, inside, medialness, air, centredness and more.

    A table on a terminal, otherwise JSON, one line for each skeleton: `tiskel metrics gls.ply lbc.ply`. In the table a
    star is at the best of a row, and the column "good" has what to wish for: shares near 1, distances near 0, loops of
    the curve as many as those of the solid. Curves of other programs come with their cloud: `tiskel metrics --cloud
    scan.ply --curve other.swc | jq .inside`
    """
    params = MetricParams(
        bars=bars, diagonal=not no_diagonal, beta=beta, bounded=bounded, threshold=centred, similar=similar,
        normalise=normalise, seed=seed,
    )  # fmt: skip
    if as_json and as_csv:
        raise TiskelError("--json and --csv exclude each other; choose one")
    given: list[Path | None] = [*(sources or ())] or [None]
    if given == [None] and cloud is None and points is None:
        raise TiskelError("nothing to measure; name a skeleton, or --cloud with --points or --curve")
    if heat is not None and len(given) > 1:
        raise TiskelError(f"--ply holds one skeleton, {len(given)} are given; measure them one by one")
    measured = [_measure(source, cloud, points, curve, params) for source in given]
    _write_extras(measured, heat, plot, look)
    _show(measured, as_json, as_csv)


Measured = tuple[str, "Points", "Quality"]


def _measure(
    source: Path | None, cloud: Path | None, points: Path | None, curve: Path | None, params: MetricParams
) -> Measured:
    from tiskel import evaluate
    from tiskel.io.measurable import gather

    with shown(reading(source, cloud, points, curve)) as progress:
        m = gather(source, cloud, points, curve)
        quality = evaluate(m.cloud, m.points, m.nodes, m.edges, origin=m.origin, params=params, progress=progress)
    console.warn(tuple(f"{m.name}: {line}" for line in quality.warnings))
    if quality.correspondence == "nearest":
        console.say(f"{m.name}: no correspondence; the nearest points of the cloud stand in for the originals")
    logbook.timed(quality.seconds)
    if console.session.verbose:
        total = sum(quality.seconds.values())
        shares = ", ".join(f"{part} {s:.3f} s ({s / total:.0%})" for part, s in quality.seconds.items())
        console.say(f"{m.name}: {shares}")
    return m.name, m.cloud, quality


def _write_extras(measured: list[Measured], heat: Path | None, plot: Path | None, look: LookParams) -> None:
    if heat is not None:
        from tiskel.io.stages.heat import dump_heat

        stages.write(heat, lambda: dump_heat(measured[0][2]))
    if plot is not None:
        from tiskel.pictures.canvas import picture_kind
        from tiskel.pictures.quality import quality_picture

        stages.write(plot, lambda: quality_picture(measured, picture_kind(str(plot)), look))


def document(name: str, quality: "Quality") -> dict[str, Any]:
    """Return the measures of one file as JSON values."""
    return {"file": name, **quality.as_dict()}


def _show(measured: list[Measured], as_json: bool, as_csv: bool) -> None:
    documents = [document(name, quality) for name, _, quality in measured]
    if as_csv:
        from tiskel.metrics.tables import row_of, to_csv

        rows = [{"file": d["file"], **row_of(d)} for d in documents]
        sys.stdout.write(to_csv(rows).decode())
    elif as_json or not sys.stdout.isatty():
        for one in documents:
            typer.echo(json.dumps(one, allow_nan=False))
    else:
        from rich.console import Console

        Console().print(_table(documents))


def _table(documents: list[dict[str, Any]]):  # type: ignore[no-untyped-def]
    """Return one column per skeleton, the best values starred, what is good, and reasons where there is no value."""
    from tiskel.metrics.tables import COLUMNS, SIGNS, best_rows, row_of, said

    rows = [row_of(d) for d in documents]
    best = best_rows(rows)
    lines = []
    for column in COLUMNS:
        shown = [said(row[column.key]) + " *" * ((i, column.key) in best) for i, row in enumerate(rows)]
        reasons = [d[column.path[0]].get("reasons", {}).get(column.path[1], "") for d in documents]
        lines.append([column.heading, *shown, column.good, "; ".join(dict.fromkeys(filter(None, reasons)))])
    heads = ["measure", *(d["file"] for d in documents), "good", "why not"]
    width = len(heads) if any(line[-1] for line in lines) else len(heads) - 1
    made = console.table("skeleton quality", heads[:width], [line[:width] for line in lines])
    made.caption, made.caption_justify = SIGNS, "left"
    return made
