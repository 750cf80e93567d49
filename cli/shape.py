"""``tiskel shape``."""

from pathlib import Path
from typing import Annotated

import typer

from tiskel.cli import options as o
from tiskel.cli import stages
from tiskel.cli.common import common
from tiskel.cli.skeleton import format_of
from tiskel.params import ShapeParams

SHAPE = ShapeParams()

Name = Annotated[str | None, typer.Argument(metavar="[NAME]", help="A shape; none lists them.", show_default=False)]
Count = Annotated[int, typer.Option("-n", "--count", min=1, metavar="N", help="Points.")]
Noise = Annotated[float, typer.Option(metavar="F", help="Gaussian noise, in smallest radii of the shape.")]
Missing = Annotated[float, typer.Option(metavar="F", help="Share of the surface cut out in patches.")]
Uneven = Annotated[float, typer.Option(metavar="F", help="Ratio of highest to lowest density.")]
Seed = Annotated[int, typer.Option(min=0, help="Of everything random.")]
SkeletonOutput = Annotated[
    Path | None, typer.Option("--skeleton", metavar="OUT", help="Also write the analytic skeleton.", show_default=False)
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
    skeleton: SkeletonOutput = None,
) -> None:
    """Make a cloud whose curve skeleton is known: a union of round cones.

    `tiskel shape hand -n 16384 -o hand.ply --skeleton hand.skeleton.ply`
    """
    from tiskel import make_shape, shape_graph
    from tiskel.gallery.catalogue import SHAPES
    from tiskel.io.clouds import dump_cloud
    from tiskel.io.exports import EXPORTS

    if name is None:
        typer.echo("\n".join(SHAPES))
        return
    params = ShapeParams(count=count, noise=noise, missing=missing, uneven=uneven, seed=seed)
    points, truth = make_shape(shape_graph(name), params)
    target = stages.output_path(output, Path(name), "ply")
    stages.write(target, lambda: dump_cloud(points, target))
    if skeleton is not None:
        stages.write(skeleton, lambda: EXPORTS[format_of(None, str(skeleton))](truth))
