"""``tiskel contract``."""

from collections.abc import Mapping
from typing import Any

from tiskel.cli import options as o
from tiskel.cli import stages
from tiskel.cli.common import common, reads_cloud


@common
@reads_cloud
def contract(
    source: o.Source,
    output: o.Output = None,
    method: o.Method = o.CONTRACTION.method,
    neighbours: o.Neighbours = o.CONTRACTION.neighbours,
    max_steps: o.MaxSteps = o.CONTRACTION.max_steps,
    normalise: o.Normalise = o.CONTRACTION.normalise,
    weights: o.Weights = None,
    solver: o.SolverName = None,
    *,
    conditioning: Mapping[str, Any],
) -> None:
    """Contract a cloud or mesh towards its medial curve.

    Writes contraction.ply, which `tiskel skeleton` reads: `tiskel contract scan.ply | tiskel skeleton - -o curve.ply`
    """
    params = stages.contraction_params(method, neighbours, max_steps, normalise, solver)
    cloud, points = stages.cloud_points(source, **conditioning)
    from tiskel import contract as contract_cloud
    from tiskel.io.stages.contraction import dump_contraction

    contraction = contract_cloud(points, params, stages.weights_of(cloud, points, weights))
    stages.tell_contraction(contraction)
    target = stages.output_path(output, source, "contraction.ply")
    stages.write(target, lambda: dump_contraction(contraction, cloud.source))
