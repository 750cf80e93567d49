"""``tiskel shape``."""

from pathlib import Path
from typing import Annotated

import typer

from tiskel.cli import options as o
from tiskel.cli import stages, words
from tiskel.cli.common import common
from tiskel.cli.progress import shown
from tiskel.cli.skeleton import format_of
from tiskel.params import ShapeParams
from tiskel.wording import meant

SHAPE = ShapeParams()
SCAN = "Scan"

Name = Annotated[
    str | None,
    typer.Argument(
        metavar="NAME", help="A shape; none lists them.", show_default=False, autocompletion=words.shape_names
    ),
]
Count = Annotated[int, typer.Option("-n", "--count", min=1, metavar="N", help="Points.")]
Noise = Annotated[float, typer.Option(metavar="F", help="Gaussian noise, in smallest radii of the shape.")]
Missing = Annotated[float, typer.Option(metavar="F", help="Share of the surface cut out in patches.")]
Uneven = Annotated[float, typer.Option(metavar="F", help="Ratio of highest to lowest density.")]
Seed = Annotated[int, typer.Option(min=0, metavar="N", help="Of everything random.")]
View = Annotated[
    list[str] | None,
    typer.Option(
        "--view",
        metavar="x,y,z",
        help="Only what a sensor in this direction sees (hidden-point removal); again for more sides.",
        show_default=False,
        rich_help_panel=SCAN,
    ),
]
SensorDistance = Annotated[
    float, typer.Option(metavar="F", help="How far sensors are, in diagonals of the shape.", rich_help_panel=SCAN)
]
SensorNoise = Annotated[
    float, typer.Option(metavar="F", help="Noise along the rays, in smallest radii of the shape.", rich_help_panel=SCAN)
]
Table = Annotated[
    bool,
    typer.Option("--table", help="A table under it, normal to z; a quarter of the points.", rich_help_panel=SCAN),
]
SkeletonOutput = Annotated[
    Path | None, typer.Option("--skeleton", metavar="OUT", help="Also write the true skeleton.", show_default=False)
]


@common
def shape(
    name: Name = None,
    output: o.Output = None,
    count: Count = SHAPE.count,
    noise: Noise = SHAPE.noise,
    missing: Missing = SHAPE.missing,
    uneven: Uneven = SHAPE.uneven,
    seed: Seed = SHAPE.seed,
    view: View = None,
    sensor_distance: SensorDistance = SHAPE.sensor_distance,
    sensor_noise: SensorNoise = SHAPE.sensor_noise,
    table: Table = SHAPE.table,
    skeleton: SkeletonOutput = None,
) -> None:
    """Make a cloud whose curve skeleton is known: tubes, plants, blocks, torsos, wires.

    `tiskel shape hand -n 16384 -o hand.ply --skeleton hand.skeleton.ply`

    `tiskel shape torso --view 1,-2,0.5 --sensor-noise 0.05 --table -o scan.ply`
    """
    from tiskel import make_shape, named_shape
    from tiskel.io.clouds import dump_cloud
    from tiskel.io.exports import EXPORTS

    if name is None:
        typer.echo(listing())
        return
    if name not in (every := words.all_shapes()):
        said = f"no shape is called {name!r}.{meant(name, every)} tiskel shape lists all {len(every)}"
        raise typer.BadParameter(said, param_hint="NAME")
    params = ShapeParams(
        count=count,
        noise=noise,
        missing=missing,
        uneven=uneven,
        seed=seed,
        views=tuple(direction(one) for one in view or ()),
        sensor_distance=sensor_distance,
        sensor_noise=sensor_noise,
        table=table,
    )
    with shown("sampling"):
        points, truth = make_shape(named_shape(name), params)
    target = stages.output_path(output, Path(name), "ply")
    stages.write(target, lambda: dump_cloud(points, target))
    if skeleton is not None:
        stages.write(skeleton, lambda: EXPORTS[format_of(None, str(skeleton))](truth))


def direction(given: str) -> tuple[float, float, float]:
    """Return the three numbers of a direction; raise TiskelError where they are others."""
    x, y, z = stages.numbers_of("--view", given, 3)
    return x, y, z


def listing() -> str:
    """Return the names of all shapes, a line for each group."""
    from tiskel.gallery.families import GROUPS

    return "\n".join(f"{group}: {' '.join(names)}" for group, names in GROUPS.items())
