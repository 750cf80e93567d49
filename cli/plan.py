"""``tiskel plan``."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli import surface_options as so
from tiskel.cli.common import common
from tiskel.cli.progress import reading, shown
from tiskel.errors import TiskelError
from tiskel.params import LookParams, PlanParams

if TYPE_CHECKING:
    from tiskel.rolling.plan import Plan

Begin = Annotated[str, typer.Option("--from", metavar="x,y,z", help="The first contact.", rich_help_panel="Method")]
Goal = Annotated[str, typer.Option("--to", metavar="x,y,z", help="The last contact.", rich_help_panel="Method")]
Attitude = Annotated[
    str | None,
    typer.Option(
        "--attitude", metavar="w,x,y,z", help="Quaternion of the sphere at the goal. [default: any]",
        show_default=False, rich_help_panel="Method",
    ),
]  # fmt: skip
StartAttitude = Annotated[
    str, typer.Option("--start-attitude", metavar="w,x,y,z", help="At the start.", rich_help_panel="Method")
]
Spin = Annotated[
    bool, typer.Option("--spin", help="The sphere may turn about the normal too.", rich_help_panel="Method")
]
Avoid = Annotated[
    list[str] | None,
    typer.Option(
        "--avoid", metavar="x,y,z,r", help="A ball that the sphere keeps out of; as often as needed.",
        show_default=False, rich_help_panel="Method",
    ),
]  # fmt: skip
Speed = Annotated[
    float, typer.Option(metavar="W", help="Radians per second that it turns at most.", rich_help_panel="Method")
]
PathFile = Annotated[
    Path | None,
    typer.Option(
        "--path", metavar="OUT", help="Also the run that it gives: CSV, TUM (.tum) or nav_msgs/Path (.yaml).",
        show_default=False, rich_help_panel="Output",
    ),
]  # fmt: skip
Summary = Annotated[
    bool, typer.Option("--json", help="A summary in JSON on standard output.", rich_help_panel="Output")
]
USUAL = PlanParams(start_at=(0, 0, 0), goal=(0, 0, 0))
NO_TURN = so.joined(USUAL.start_attitude)


@common
def plan(
    source: o.Source,
    start: Begin,
    goal: Goal,
    output: o.Output = None,
    attitude: Attitude = None,
    start_attitude: StartAttitude = NO_TURN,
    spin: Spin = USUAL.spin,
    avoid: Avoid = None,
    side: so.SideName = USUAL.side,
    radius: so.SphereRadius = USUAL.radius,
    speed: Speed = USUAL.speed,
    seed: o.Seed = USUAL.seed,
    path: PathFile = None,
    as_json: Summary = False,
    animate: so.Animate = None,
) -> None:
    """Plan how to roll a sphere from a contact to another, and to an attitude, without slip.

    Reads surface.json, writes inputs for `roll --model body --inputs`; says when there is no way, and why:
    `tiskel plan surface.json --from 0,0,1 --to 2,0,1 -o inputs.csv`
    """
    params = PlanParams(
        start_at=so.three("--from", start),
        goal=so.three("--to", goal),
        attitude=None if attitude is None else so.four("--attitude", attitude),
        start_attitude=so.four("--start-attitude", start_attitude),
        spin=spin,
        avoid=tuple(so.four("--avoid", ball) for ball in avoid or ()),
        side=side,
        radius=radius,
        speed=speed,
        seed=seed,
    )
    from tiskel import plan_roll, read_surfaces
    from tiskel.io.stages.roll import inputs_csv
    from tiskel.io.stages.trajectories import as_suffixed

    with shown(reading(source)) as progress:
        body = read_surfaces(source).body
        if body is None:
            raise TiskelError("there is no surface of the whole body in the file; slice again without --no-body")
        found = plan_roll(body, params, progress=progress)
    _tell(found)
    if path is not None:
        stages.write(path, lambda: as_suffixed(str(path), [found.run]))
    if animate is not None:
        from tiskel.cli.films import film

        stages.write(animate, lambda: film(body, [found.run], str(animate), LookParams()))
    if as_json:
        typer.echo(json.dumps(found.as_dict(), allow_nan=False))
    if output is not None or not as_json:
        stages.write(stages.output_path(output, source, "inputs.csv"), lambda: inputs_csv(found.inputs))


def _tell(found: "Plan") -> None:
    """Say how well it arrives, and how to roll it."""
    turned = "" if found.turned_off is None else f" and {found.turned_off:.2g} degrees"
    console.say(
        f"a way of {found.run.path_object:.6g} in {found.inputs.t[-1]:.4g} s, "
        f"{len(found.loop)} moves for the attitude; arrives {found.off:.2g} radii{turned} off"
    )
    console.warn(found.run.warnings)
    at = ",".join(map(repr, found.run.contact[0].tolist()))
    p = found.params
    words = f"--model body --side {p.side} --radius {found.run.radius!r} --start-at={at}"
    if p.start_attitude != USUAL.start_attitude:
        words += f" --start-attitude={so.joined(p.start_attitude)}"
    console.say(f"roll it with: {words} --inputs")
