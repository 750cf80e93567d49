"""``tiskel contract``."""

from collections.abc import Mapping
from typing import Any

from tiskel.cli import options as o
from tiskel.cli import stages
from tiskel.cli.common import common, contracts, reads_cloud


@common
@reads_cloud
@contracts
def contract(
    source: o.Source,
    output: o.Output = None,
    method: o.MethodName = o.METHOD,
    weights: o.Weights = None,
    history: o.History = False,
    *,
    conditioning: Mapping[str, Any],
    contracting: Mapping[str, Any],
) -> None:
    """Contract a cloud or mesh towards its medial curve.

    Writes contraction.ply, which `tiskel skeleton` reads: `tiskel contract scan.ply | tiskel skeleton - -o curve.ply`
    """
    params = stages.contraction_params(method, contracting)
    cloud, points = stages.cloud_points(source, **conditioning)
    from tiskel import contract as contract_cloud
    from tiskel.io.stages.contraction import dump_contraction

    contraction = contract_cloud(points, params, stages.weights_of(cloud, points, weights))
    stages.tell_contraction(contraction)
    target = stages.output_path(output, source, "contraction.ply")
    stages.write(target, lambda: dump_contraction(contraction, cloud.source, history=history))
