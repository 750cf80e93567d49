"""``tiskel roll``."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tiskel import messages
from tiskel.cli import body_options as bo
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli import surface_options as so
from tiskel.cli.common import common, looks
from tiskel.cli.progress import reading, shown
from tiskel.params import LookParams

if TYPE_CHECKING:
    from tiskel.rolling.trajectory import Trajectory

POSES = (".tum", ".yaml", ".yml")  # what a trajectory can be written as, besides CSV
BranchName = Annotated[
    str | None,
    typer.Option(
        "--branch",
        metavar="B",
        help="Which surface. [default: the longest]",
        show_default=False,
        rich_help_panel="Method",
    ),
]
Body = Annotated[
    str | None,
    typer.Option(
        "--body",
        metavar="ellipsoid:a,b,c|cylinder:r,h|FILE",
        help="Roll this in place of a sphere, or a branch of another surface.json.",
        show_default=False,
        rich_help_panel="Method",
    ),
]
Summary = Annotated[
    bool, typer.Option("--json", help="A summary in JSON on standard output.", rich_help_panel="Output")
]


@common
@looks
def roll(
    source: o.Source,
    output: o.Output = None,
    branch: BranchName = None,
    model: so.ModelsName = so.ROLL.model,
    side: so.SideName = so.ROLL.side,
    radius: so.SphereRadius = so.ROLL.radius,
    omega: so.Omega = so.OMEGA,
    velocity: so.Velocity = so.VELOCITY,
    inputs: so.InputsFile = None,
    twist: so.TwistName = so.ROLL.twist,
    duration: so.Duration = so.ROLL.duration,
    rate: so.Rate = so.ROLL.rate,
    start: so.Start = so.START,
    start_at: so.StartAt = None,
    normals: so.NormalsName = so.ROLL.normals,
    heading: bo.Heading = None,
    start_attitude: bo.AttitudeAtStart = None,
    on_meeting: bo.MeetingName = so.ROLL.on_meeting,
    trusted: bo.TrustedName = so.ROLL.trusted,
    body: Body = None,
    rtol: so.Rtol = so.ROLL.rtol,
    atol: so.Atol = so.ROLL.atol,
    as_json: Summary = False,
    plot: o.Plot = None,
    animate: so.Animate = None,
    *,
    look: LookParams,
) -> None:
    """Roll a sphere over a surface.

    Reads surface.json, writes the trajectory as CSV, with -o also as TUM (.tum) or as a nav_msgs/Path (.yaml), with
    --json the summary in its place unless -o names a file:
    `tiskel slice s.ply | tiskel roll - --omega 1,0,0 --duration 5 > path.csv`
    """
    settings = so.roll_settings(
        model, side, radius, omega, duration, start, rtol, atol,
        velocity=velocity, twist=twist, rate=rate, start_at=start_at, normals=normals,
        heading=heading, start_attitude=start_attitude, on_meeting=on_meeting, trusted=trusted,
    )  # fmt: skip
    given = so.inputs_of(inputs)
    so.refuse_both(given is not None, omega, velocity)
    if model == "both" and normals == "pca":
        console.warn(("--normals pca counts for the global model; the local one keeps those of its surface",))
    if body is not None:
        from tiskel.cli.roll_body import rolled

        return rolled(source, output, branch, body, settings, given, as_json, pictured=bool(plot or animate))
    from tiskel.io.stages.surface import read_surfaces
    from tiskel.io.stages.trajectories import as_suffixed
    from tiskel.rolling.over import ground_of, roll_over

    target = stages.output_path(output, source, "path.csv", POSES) if output is not None or not as_json else Path("-")
    stages.check_targets(plot, animate)
    with shown(reading(source)) as progress:
        surfaces = read_surfaces(source)
        surface = ground_of(surfaces, settings[0], branch)
        runs = [roll_over(surfaces, params, given, branch=branch, progress=progress) for params in settings]
    console.tell(messages.of_runs(runs))
    if plot is not None:
        from tiskel.pictures.canvas import picture_kind
        from tiskel.pictures.rolling import rolling_picture

        stages.write(plot, lambda: rolling_picture(surface, runs, source.name, picture_kind(str(plot)), look))
    if animate is not None:
        from tiskel.cli.films import film

        stages.write(animate, lambda: film(surface, runs, str(animate), look))
    if as_json:
        typer.echo(json.dumps(summary(getattr(surface, "name", "body"), runs), allow_nan=False))
    if output is not None or not as_json:
        stages.write(target, lambda: as_suffixed(str(target), runs))
    return None


def summary(branch: str, runs: "Sequence[Trajectory]") -> dict[str, Any]:
    """Return the summaries of the runs on one branch."""
    return {"branch": branch, "runs": [r.as_dict() for r in runs]}
