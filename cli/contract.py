"""``tiskel contract``."""

from collections.abc import Mapping
from typing import Any

from tiskel import messages
from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common, contracts, looks, reads_cloud
from tiskel.cli.progress import reading, shown
from tiskel.params import LookParams


@common
@reads_cloud
@contracts
@looks
def contract(
    source: o.Source,
    output: o.Output = None,
    method: o.MethodName = o.METHOD,
    weights: o.Weights = None,
    history: o.History = False,
    plot: o.Plot = None,
    *,
    conditioning: Mapping[str, Any],
    contracting: Mapping[str, Any],
    look: LookParams,
) -> None:
    """Contract a cloud or mesh towards its medial curve.

    Writes contraction.ply, which `tiskel skeleton` reads: `tiskel contract scan.ply | tiskel skeleton - -o curve.ply`
    """
    params = stages.contraction_params(method, contracting)
    conditioning_params = stages.conditioning_params(conditioning)
    from tiskel import condition
    from tiskel import contract as contract_cloud
    from tiskel.geometry.mesh_surface import still_on
    from tiskel.io.stages.contraction import dump_contraction

    target = stages.output_path(output, source, "contraction.ply")
    with shown(reading(source)) as progress:
        cloud = stages.read_cloud(source, conditioning_params)
        points, report = condition(cloud.points, conditioning_params)
        console.tell(messages.said(report))
        surface, weighted = still_on(cloud.surface, points, cloud.points), stages.weights_of(cloud, weights)
        contraction = contract_cloud(points, params, weighted, surface, progress=progress)
    stages.tell_contraction(contraction)
    if plot is not None:
        from tiskel.pictures.canvas import picture_kind
        from tiskel.pictures.contraction import contraction_picture

        title = f"{cloud.name}, {params.method}"
        stages.write(plot, lambda: contraction_picture(contraction, title, picture_kind(str(plot)), look))
    stages.write(target, lambda: dump_contraction(contraction, cloud.source, history=history))
