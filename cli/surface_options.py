"""Options of the commands that slice and roll."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, get_args

import typer

from tiskel.cli.options import PIPELINE, drawn
from tiskel.cli.stages import numbers_of
from tiskel.cli.words import chosen, completes
from tiskel.errors import TiskelError
from tiskel.params import FrameRule, Model, Normals, OrderRule, RollParams, Side, SurfaceParams, Twist
from tiskel.params.roll import OnMeeting, Trusted

if TYPE_CHECKING:
    from tiskel.rolling.inputs import Inputs

Models = Literal["global", "local", "both", "body"]
MODELS: dict[Models, tuple[Model, ...]] = {
    "global": ("global",), "local": ("local",), "both": ("global", "local"), "body": ("body",),
}  # fmt: skip
SURFACE, ROLL = PIPELINE.surface, RollParams()
USUAL = next(name for name, models in MODELS.items() if models == tuple(run.model for run in PIPELINE.roll))


def joined(values: tuple[float, ...] | str) -> str:
    """Return numbers as an option takes them."""
    return values if isinstance(values, str) else ",".join(f"{value:.10g}" for value in values)


ORDERS = joined((SURFACE.least_order, SURFACE.most_order))
M, OMEGA, VELOCITY, START = (joined(values) for values in (SURFACE.m, ROLL.omega, ROLL.velocity, ROLL.start))

Branch = Annotated[
    str,
    typer.Option(
        "--branch",
        metavar="B|longest|all",
        help="Which branches.",
        autocompletion=completes("longest", "all"),
        rich_help_panel="Method",
    ),
]
Interval = Annotated[
    float,
    typer.Option(metavar="I", help="Between slices, as a share of the cloud's diagonal.", rich_help_panel="Method"),
]
FrameField = Annotated[
    str,
    typer.Option(
        "--m",
        metavar="x,y,z|normal|rotation-minimising",
        help="Direction that sets where u is 0.",
        autocompletion=completes(*get_args(FrameRule)),
        rich_help_panel="Method",
    ),
]
OrderRuleName = Annotated[
    OrderRule,
    typer.Option(
        "--order-rule",
        help="How the order of the Fourier series is chosen.",
        rich_help_panel="Method",
    ),
]
Orders = Annotated[
    str,
    typer.Option(
        "--orders", metavar="LOW,HIGH", help="Least and most order of the Fourier series.", rich_help_panel="Method"
    ),
]
NoRecentre = Annotated[
    bool,
    typer.Option("--no-recentre", help="Keep the curve where it is, smoothed only.", rich_help_panel="Method"),
]
ModelsName = Annotated[
    Models,
    typer.Option(
        "--model",
        help="A branch as it is, or straight along its skeleton, or both side by side; or the whole body.",
        rich_help_panel="Method",
    ),
]
SideName = Annotated[Side, typer.Option("--side", help="Of the surface.", rich_help_panel="Method")]
_SPHERE = {
    "metavar": "R",
    "help": "Of the sphere. [default: a quarter of the median radius]",
    "show_default": False,
    "rich_help_panel": "Method",
}
SphereRadius = Annotated[float | None, typer.Option("--radius", "--sphere", **_SPHERE)]
Sphere = Annotated[float | None, typer.Option("--sphere", **_SPHERE)]  # where --radius is that of the sampling balls
Omega = Annotated[str, typer.Option(metavar="x,y,z", help="Angular velocity, rad/s.", rich_help_panel="Method")]
Velocity = Annotated[
    str, typer.Option(metavar="x,y,z", help="Slip, the cloud's unit per second.", rich_help_panel="Method")
]
InputsFile = Annotated[
    Path | None,
    typer.Option(
        "--inputs",
        metavar="CSV",
        help="Both over time: t,wx,wy,wz,vx,vy,vz.",
        show_default=False,
        rich_help_panel="Method",
    ),
]
TwistName = Annotated[
    Twist,
    typer.Option(
        "--twist",
        help="Whose twist: the object's relative to the sphere in the contact frame; the sphere's in axes fixed in "
        "it; the sphere's in the axes of the cloud.",
        rich_help_panel="Method",
    ),
]
Duration = Annotated[
    float | None,
    typer.Option(
        metavar="T", help="Seconds. [default: 10, or the inputs']", show_default=False, rich_help_panel="Method"
    ),
]
Rate = Annotated[float, typer.Option(metavar="HZ", help="Rows per second.", rich_help_panel="Output")]
Start = Annotated[
    str,
    typer.Option(
        metavar="u,v,us,vs,psi", help="Radians; pi, pi/2 and the like are numbers too.", rich_help_panel="Method"
    ),
]
StartAt = Annotated[
    str | None,
    typer.Option(
        metavar="x,y,z",
        help="Begin at the surface point nearest to this one.",
        show_default=False,
        rich_help_panel="Method",
    ),
]
NormalsName = Annotated[
    Normals,
    typer.Option(
        "--normals",
        help="Where curvature comes from; pca is the printed variant, for comparison.",
        rich_help_panel="Method",
    ),
]
Rtol = Annotated[
    float,
    typer.Option(
        metavar="TOL",
        help="Relative tolerance of the solver of rolling; published: 1e-3, with --atol 1e-5.",
        rich_help_panel="Method",
    ),
]
Atol = Annotated[
    float,
    typer.Option(
        metavar="TOL", help="Absolute tolerance of the solver of rolling; published: 1e-5.", rich_help_panel="Method"
    ),
]
Animate = Annotated[
    Path | None,
    typer.Option(
        "--animate",
        metavar="OUT",
        help="Also a film: GIF or HTML.",
        show_default=False,
        rich_help_panel="Output",
        callback=drawn,
    ),
]


def surface_params(
    branch: str, interval: float, m: str, order_rule: OrderRule, orders: str, no_recentre: bool
) -> SurfaceParams:
    """Return the settings of slice."""
    least, most = (round(order) for order in numbers_of("--orders", orders, 2))
    return SurfaceParams(
        branch=branch, interval=interval, m=_direction(m), order_rule=order_rule, least_order=least, most_order=most,
        recentre=not no_recentre,
    )  # fmt: skip


def _direction(m: str) -> tuple[float, float, float] | FrameRule:
    rules: tuple[FrameRule, ...] = get_args(FrameRule)
    if m[:1].isalpha() and "," not in m:
        chosen("--m", m, rules)
    return next((rule for rule in rules if m == rule), None) or three("--m", m)


def roll_settings(
    model: Models, side: Side, sphere: float | None, omega: str, duration: float | None, start: str, rtol: float,
    atol: float, *, velocity: str = VELOCITY, twist: Twist = ROLL.twist, rate: float = ROLL.rate,
    start_at: str | None = None, normals: Normals = ROLL.normals, heading: str | None = None,
    start_attitude: str | None = None, on_meeting: OnMeeting = ROLL.on_meeting, trusted: Trusted = ROLL.trusted,
) -> tuple[RollParams, ...]:  # fmt: skip
    """Return the settings of every run that a choice of model asks for."""
    u, v, us, vs, psi = numbers_of("--start", start, 5)
    return tuple(
        RollParams(
            model=one,
            side=side,
            radius=sphere,
            omega=three("--omega", omega),
            velocity=three("--velocity", velocity),
            twist=twist,
            duration=duration,
            rate=rate,
            start=(u, v, us, vs, psi),
            start_at=None if start_at is None else three("--start-at", start_at),
            heading=None if heading is None else three("--heading", heading),
            attitude=ROLL.attitude if start_attitude is None else four("--start-attitude", start_attitude),
            on_meeting=on_meeting,
            trusted=trusted,
            normals=normals if model != "both" or one == "global" else "surface",
            rtol=rtol,
            atol=atol,
        )
        for one in MODELS[model]
    )


def three(option: str, value: str) -> tuple[float, float, float]:
    """Return the three numbers of an option."""
    x, y, z = numbers_of(option, value, 3)
    return x, y, z


def refuse_both(inputs: bool, omega: str, velocity: str) -> None:
    """Raise where a constant twist other than the usual one comes beside a file of inputs, which holds both parts."""
    both = ("--omega", omega, OMEGA), ("--velocity", velocity, VELOCITY)
    given = [option for option, value, usual in both if value != usual]
    if inputs and given:
        raise TiskelError(
            f"--inputs holds omega and velocity over time, {' and '.join(given)} would not count; drop one"
        )


def four(option: str, value: str) -> tuple[float, float, float, float]:
    """Return the four numbers of an option."""
    w, x, y, z = numbers_of(option, value, 4)
    return w, x, y, z


def inputs_of(path: Path | None) -> "Inputs | None":
    """Return the inputs of a file, nothing where none is named."""
    from tiskel.io.stages.roll import read_inputs

    return None if path is None else read_inputs(path)
