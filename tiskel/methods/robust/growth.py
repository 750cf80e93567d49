"""Limbs that the sections missed: connected points that stand out of the curve grow a branch of their own.

A front that reaches a limb sideways takes it in together with what it hangs on.
After the fit such a limb is what no round cone explains.
"""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from tiskel.arrays import Indices, Numbers
from tiskel.geometry.graph import node_radii
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.fit import Feet
from tiskel.methods.robust.fronts import STRIDE, line_centres
from tiskel.methods.robust.network import Network

OFF, OFF_SPACINGS, OFF_DEVIATIONS = 0.25, 1.5, 4.0  # points further off the curve: in local radii, and at least
LIMB = 0.5  # local radii that a limb sticks out
RIDGE = 1.5  # local radii along the curve: what is longer is the rim of a flat part, and no limb
FEWEST = 12  # points of a limb


def with_missed_limbs(curve: ConeCurve, network: Network, at: Feet) -> ConeCurve | None:
    """Return the curve with a branch for every connected set of points that stands out of it, None where none does."""
    radius = at.radii(curve)
    least = np.maximum(OFF * radius, max(OFF_SPACINGS * network.spacing, OFF_DEVIATIONS * at.deviation))
    places = at.places(curve)
    off = np.flatnonzero(at.residual > least)
    grown = curve
    for cluster in _clusters(network, at.rows[off]):
        mine = off[cluster]
        thick = float(radius[mine].max())
        compact = np.linalg.norm(np.ptp(places[mine], axis=0)) < RIDGE * thick
        if len(mine) >= FEWEST and at.residual[mine].max() > LIMB * thick and compact:
            grown = _with_limb(grown, network, at.rows[mine], at.residual[mine], at.node(curve)[mine])
    return None if grown is curve else grown


def _clusters(network: Network, rows: Indices) -> list[Indices]:
    """Return the connected sets of some rows of the cloud, as places in rows."""
    place = np.full(len(network.points), -1)
    place[rows] = np.arange(len(rows))
    links = place[network.edges]
    links = links[(links >= 0).all(axis=1)]
    graph = sparse.coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(len(rows), len(rows)))
    count, label = connected_components(graph, directed=False)
    return [np.flatnonzero(label == number).astype(np.int32) for number in range(count)]


def _with_limb(curve: ConeCurve, network: Network, rows: Indices, height: Numbers, foot: Indices) -> ConeCurve:
    """Add a chain of nodes, one for every stride of height, at the node that most of the lowest points stand on."""
    stride = max(STRIDE * network.spacing, float(np.ptp(height)) / len(rows))
    layer = np.floor((height - height.min()) / stride).astype(np.int32)
    layer = np.unique(layer, return_inverse=True)[1].ravel().astype(np.int32)
    count, first = int(layer.max()) + 1, len(curve.nodes)
    nodes = line_centres(network.points[rows], network.normals[rows], layer, count)[0]
    root = int(np.bincount(foot[layer == 0]).argmax())
    chain = np.array([root, *range(first, first + count)], np.int32)
    owner = curve.owner.copy()
    owner[rows] = first + layer
    levels = curve.levels[root] + np.arange(1, count + 1, dtype=np.int32)
    radii = node_radii(nodes, network.points[rows], layer)
    return with_nodes(
        replace(curve, owner=owner), nodes, radii, np.stack([chain[:-1], chain[1:]], axis=1), levels
    )  # fmt: skip
