"""Corners of a body: branches that only run into an edge, or about in a plate, and are no limbs.

The clearance of a wedge falls along its middle by the sine of half its angle: a
right angle has 0.71, the corner of a block 0.58. Round cones that are fitted
to it taper as fast. In a plate they are wider than it is thick, whichever way
they lead. A short limb on a thick trunk may taper as fast, or be flat; but
there is a gap between it and the next one, where the inside of a corner or of a plate goes on.
"""

import numpy as np

from tiskel.arrays import Indices, within_runs
from tiskel.geometry.body import Body
from tiskel.geometry.graph import edge_lengths
from tiskel.methods.robust.body.limbs import TAPERS, in_web
from tiskel.methods.robust.body.strands import plain_curve
from tiskel.methods.robust.curve import ConeCurve, contract_nodes

# Found by trial on bars, plates and brackets with 4096 to 65 536 points, and on torsos and knobs.
SHORT = 3.0  # radii of its joint, up to which a branch may be no limb: in corners 0.9 to 1.3, in plates up to 2.9
FLAT = 0.65  # of the radius of the cones along a branch, in the median: with less clearance it is in a plate, as are
# branches about in a strip with 0.53 to 0.63; an end of a thick body without a gap beside it has 0.91


def without_false_limbs(curve: ConeCurve, body: Body) -> ConeCurve | None:
    """Contract into their joint all branches that are no limbs of a body; None where there are none.

    A joint where nothing else would be left keeps them.
    """
    degree, into = curve.degrees, np.arange(len(curve.nodes), dtype=np.int32)
    ending = [path for path in curve.paths_from(ends=True) if degree[path[-1]] > 2]
    short = [path for path in ending if curve.along(path)[-1] < SHORT * curve.radii[path[-1]]]
    if not short:
        return None
    fine = _with_clearances(curve, body)
    paths = fine.paths_from(ends=False)
    finer = {int(path[-1]): path for path in paths}
    corners: dict[int, list[Indices]] = {}
    for path in short:
        its = finer[int(path[0])]
        if (_tapers(curve, path) or _in_plate(curve, path, fine, its)) and in_web(fine, its, paths, body):
            corners.setdefault(int(path[-1]), []).append(path)
    for joint, gone in corners.items():
        for path in gone if len(gone) < degree[joint] else ():
            into[path[:-1]] = joint
    return contract_nodes(curve, into) if (into != np.arange(len(into))).any() else None


def _tapers(curve: ConeCurve, path: Indices) -> bool:
    """Tell whether a branch, from its end to its joint, tapers like a corner: fitted ones have 0.46 to 0.83."""
    return bool(curve.radii[path[-1]] - curve.radii[path[0]] > TAPERS * curve.along(path)[-1])


def _in_plate(curve: ConeCurve, path: Indices, fine: ConeCurve, its: Indices) -> bool:
    """Tell whether the cones of a branch, from its end, are wider than the body; its is the same, from the joint."""
    radii = np.interp(fine.along(its), curve.along(path[::-1]), curve.radii[path[::-1]])
    return bool(np.median(fine.radii[its] - FLAT * radii) < 0)


def _with_clearances(curve: ConeCurve, body: Body) -> ConeCurve:
    """Return a curve with a node for every cell of a body's grid along it, behind its own, its clearances as radii."""
    (first, second), count = curve.edges.T, len(curve.nodes)
    parts = np.maximum(1, np.ceil(edge_lengths(curve.nodes, curve.edges) / body.step)).astype(np.int32)
    edge = np.repeat(np.arange(len(parts)), parts - 1)  # of each new node
    place = within_runs(parts - 1) + 1  # on its edge, from 1
    new = count + np.arange(len(edge))
    share = (place / parts[edge])[:, None]
    nodes = np.concatenate([curve.nodes, (1 - share) * curve.nodes[first[edge]] + share * curve.nodes[second[edge]]])
    inner = np.stack([np.where(place == 1, first[edge], new - 1), new], axis=1)
    last = np.stack([np.where(parts > 1, count + np.cumsum(parts - 1) - 1, first), second], axis=1)
    edges = np.concatenate([inner, last]).astype(np.int32)
    return plain_curve(nodes, edges, body.clearance_at(nodes))
