"""``tiskel slice``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tiskel import messages
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli import surface_options as so
from tiskel.cli.common import common, looks
from tiskel.cli.progress import reading, shown
from tiskel.errors import TiskelError
from tiskel.params import LookParams

if TYPE_CHECKING:
    from tiskel.params import SurfaceParams
    from tiskel.progress import Report
    from tiskel.slicing.fitted import Surfaces

CurveFile = Annotated[
    Path | None,
    typer.Option(
        "--curve",
        metavar="FILE",
        help="A curve from elsewhere; IN is then the cloud.",
        show_default=False,
        rich_help_panel="Input",
    ),
]
MeshFile = Annotated[
    Path | None,
    typer.Option(
        "--mesh",
        metavar="OUT",
        help="Also the surface of the whole body as triangles, closed; PLY with normals, curvatures and trust.",
        show_default=False,
        rich_help_panel="Output",
    ),
]
Edge = Annotated[
    float | None,
    typer.Option(
        "--edge",
        metavar="LENGTH",
        min=0.0,
        help="About how long the sides of these triangles are; not given: a quarter of the radius of thin parts, "
        "longer on large bodies, whose twigs may then be missing, which is told.",
        show_default=False,
        rich_help_panel="Output",
    ),
]
NoBody = Annotated[
    bool, typer.Option("--no-body", help="Leave the surface of the whole body out.", rich_help_panel="Method")
]
Tubes = Annotated[
    bool,
    typer.Option("--tubes", help="Triangles of the branches instead, each a tube.", rich_help_panel="Output"),
]
Caps = Annotated[bool, typer.Option("--caps", help="The same, the ends of the tubes closed.", rich_help_panel="Output")]
TableFile = Annotated[
    Path | None,
    typer.Option(
        "--csv",
        metavar="OUT",
        help="Also a table: area, perimeter, radius and ellipse of every slice.",
        show_default=False,
        rich_help_panel="Output",
    ),
]


@common
@looks
def slice_command(
    source: o.Source,
    output: o.Output = None,
    curve: CurveFile = None,
    interval: so.Interval = so.SURFACE.interval,
    branch: so.Branch = so.SURFACE.branch,
    m: so.FrameField = so.M,
    order_rule: so.OrderRuleName = so.SURFACE.order_rule,
    orders: so.Orders = so.ORDERS,
    no_recentre: so.NoRecentre = not so.SURFACE.recentre,
    no_body: NoBody = False,
    mesh: MeshFile = None,
    edge: Edge = None,
    tubes: Tubes = False,
    caps: Caps = False,
    table: TableFile = None,
    plot: o.Plot = None,
    *,
    look: LookParams,
) -> None:
    """Fit a smooth surface around every branch of a skeleton, slice by slice, and one surface to the whole body.

    Reads skeleton.ply, writes surface.json, which holds all that roll needs:
    `tiskel skeleton c.ply | tiskel slice - --mesh tube.ply | tiskel roll - > path.csv`
    """
    from tiskel.io.mesh_file import mesh_kind

    params = so.surface_params(branch, interval, m, order_rule, orders, no_recentre)
    target = stages.output_path(output, source, "surface.json")
    stages.check_targets(mesh, table, plot)
    if mesh is not None:
        mesh_kind(mesh)
    with shown(reading(source, curve)) as progress:
        surfaces, origin = _fitted(source, curve, params, not no_body, progress)
    console.tell(messages.of_surfaces(surfaces))
    from tiskel.io.mesh_file import mesh_bytes
    from tiskel.io.stages.surface import dump_surfaces
    from tiskel.slicing.body_mesh import mesh_of, tubes_mesh

    if (tubes or caps or table is not None or plot is not None) and not len(surfaces):
        raise TiskelError("no branch has a tube: there are no slices to draw or tabulate; leave out what asks for them")
    if mesh is not None:
        triangles = tubes_mesh(surfaces, caps) if tubes or caps else mesh_of(surfaces, edge)
        console.warn(getattr(triangles, "warnings", ()))
        stages.write(mesh, lambda: mesh_bytes(triangles, mesh, origin))
    if table is not None:
        stages.write(table, lambda: slices_csv(surfaces))
    if plot is not None:
        from tiskel.pictures.canvas import picture_kind
        from tiskel.pictures.slices import slices_picture

        stages.write(plot, lambda: slices_picture(surfaces, source.name, picture_kind(str(plot)), look))
    stages.write(target, lambda: dump_surfaces(surfaces, params, origin))


def _fitted(
    source: Path, curve: Path | None, params: "SurfaceParams", whole: bool, progress: "Report | None"
) -> "tuple[Surfaces, dict[str, str]]":
    """Return the surfaces of a skeleton, or of a curve in a cloud, and what they were made from."""
    from tiskel import fit_surface, fit_whole, load_cloud
    from tiskel.io.curves import load_curve
    from tiskel.io.ply import source_of
    from tiskel.io.stages.skeleton import parse_skeleton
    from tiskel.io.streams import read_bytes

    fit = fit_whole if whole else fit_surface
    if curve is None:
        data = read_bytes(source)
        surfaces = fit(parse_skeleton(data, str(source)), params, progress=progress)
        return surfaces, source_of(data, "skeleton", str(source))
    if str(source) == "-" == str(curve):
        raise TiskelError("the cloud and --curve cannot both come from standard input; name a file for one of them")
    cloud = load_cloud(source)
    console.warn(cloud.warnings)
    return fit(load_curve(curve), params, cloud.points, progress=progress), cloud.source


def slices_csv(surfaces: "Surfaces") -> bytes:
    """Return the table of all slices."""
    from tiskel.metrics.tables import to_csv
    from tiskel.slicing.mesh import slice_table

    return to_csv([row for surface in surfaces for row in slice_table(surface)])
