"""Method "robust", its first half: from a cloud to the sections of fronts, and the points on their axes."""

from dataclasses import replace

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.methods.robust.fronts import contract_by_fronts
from tiskel.methods.robust.network import prepared
from tiskel.methods.robust.thinning import thinned
from tiskel.methods.trace import Trace
from tiskel.params import RobustParams
from tiskel.progress import SILENT, Span
from tiskel.timing import Stopwatch


def contract(
    points: Points, params: RobustParams, weights: Numbers | None = None, surface: MeshSurface | None = None,
    span: Span = SILENT,
) -> Trace:  # fmt: skip
    """Contract a cloud (n, 3) by fronts, one step each; of points on a mesh, along it.

    Raises TiskelError for weights: every part goes to its axis at once, whatever its thickness.
    """
    if weights is not None:
        raise TiskelError("method robust takes no weights; leave them out, or choose method lbc or gls")
    watch = Stopwatch()
    span.at(0, "neighbours")
    with watch.measure("network"):
        few = thinned(points, params.max_points if surface is None else "all")  # a mesh was sampled as it needs
        network = prepared(few.points, params.neighbours_for(len(few.points)), surface)
    trace = few.whole(contract_by_fronts(network, few.points, params, span.within(0.5, 1)), points)
    return replace(trace, ring_seconds=trace.ring_seconds + watch.seconds["network"])
