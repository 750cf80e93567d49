"""Options of the commands that slice and roll."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tiskel.cli.stages import numbers_of
from tiskel.errors import TiskelError
from tiskel.params import RollParams, SurfaceParams

if TYPE_CHECKING:
    from tiskel.rolling.inputs import Inputs

SURFACE, ROLL = SurfaceParams(), RollParams()
MODELS = {"global": ("global",), "local": ("local",), "both": ("global", "local")}


def joined(values: tuple[float, ...] | str) -> str:
    """Return numbers as an option takes them."""
    return values if isinstance(values, str) else ",".join(f"{value:.10g}" for value in values)


M, OMEGA, VELOCITY, START = (joined(values) for values in (SURFACE.m, ROLL.omega, ROLL.velocity, ROLL.start))

Branch = Annotated[
    str, typer.Option("--branch", metavar="B|longest|all", help="Which branches.", rich_help_panel="Method")
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
        rich_help_panel="Method",
    ),
]
OrderRuleName = Annotated[
    str,
    typer.Option(
        "--order-rule",
        metavar="cross-validated|published",
        help="How the order of the Fourier series is chosen.",
        rich_help_panel="Method",
    ),
]
NoRecentre = Annotated[
    bool,
    typer.Option("--no-recentre", help="Keep the curve where it is, smoothed only.", rich_help_panel="Method"),
]
Model = Annotated[
    str,
    typer.Option(
        metavar="global|local|both",
        help="The surface as it is, or straight along its skeleton; both side by side.",
        rich_help_panel="Method",
    ),
]
SideName = Annotated[
    str, typer.Option("--side", metavar="outside|inside", help="Of the surface.", rich_help_panel="Method")
]
_SPHERE = {
    "metavar": "R",
    "help": "Of the sphere. [default: a quarter of the branch's median radius]",
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
    str,
    typer.Option(
        "--twist",
        metavar="object|sphere|world",
        help="Whose twist: the object's relative to the sphere in the contact frame; the sphere's in its own; the "
        "sphere's in the axes of the cloud.",
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
    str,
    typer.Option(
        "--normals",
        metavar="surface|pca",
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
        "--animate", metavar="OUT", help="Also a film: GIF or HTML.", show_default=False, rich_help_panel="Output"
    ),
]


def surface_params(
    branch: str, interval: float, m: str, order_rule: str, no_recentre: bool
) -> SurfaceParams:  # fmt: skip
    """Return the settings of slice."""
    direction = m if m in ("normal", "rotation-minimising") else numbers_of("--m", m, 3)
    return SurfaceParams(
        branch=branch, interval=interval, m=direction, order_rule=order_rule, recentre=not no_recentre,  # type: ignore[arg-type]
    )  # fmt: skip


def roll_settings(
    model: str, side: str, radius: float | None, omega: str, velocity: str, twist: str, duration: float | None,
    rate: float, start: str, start_at: str | None, normals: str, rtol: float, atol: float,
) -> list[RollParams]:  # fmt: skip
    """Return the settings of every run that a choice of model asks for."""
    if model not in MODELS:
        raise TiskelError(f"--model must be one of {', '.join(MODELS)}, got {model!r}")
    return [
        RollParams(
            model=one,  # type: ignore[arg-type]
            side=side,  # type: ignore[arg-type]
            radius=radius,
            omega=numbers_of("--omega", omega, 3),  # type: ignore[arg-type]
            velocity=numbers_of("--velocity", velocity, 3),  # type: ignore[arg-type]
            twist=twist,  # type: ignore[arg-type]
            duration=duration,
            rate=rate,
            start=numbers_of("--start", start, 5),  # type: ignore[arg-type]
            start_at=None if start_at is None else numbers_of("--start-at", start_at, 3),  # type: ignore[arg-type]
            normals=normals if one == "global" else "surface",  # type: ignore[arg-type]
            rtol=rtol,
            atol=atol,
        )
        for one in MODELS[model]
    ]


def inputs_of(path: Path | None) -> "Inputs | None":
    """Return the inputs of a file, nothing where none is named."""
    from tiskel.io.stages.roll import read_inputs

    return None if path is None else read_inputs(path)
