"""Wires side by side: the turns of a spring, no further from each other than some points on them are apart.

There the nearest neighbours lead from one turn to the next, and the curve is a ladder, or that of the tube that the
turns go about. So neighbours beyond the valley of :mod:`.directions` are none, and gaps in a wire, longer than
neighbours reach, are closed where two ends face each other along their direction.

A surface whose points lie in rows, as scanners see it, looks the same. But its rows are many, and no longer than it is:
only where all of the cloud is one wire, many times as long as its extent, are these links taken.
"""

import numpy as np
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Lists, Pairs, Points, diagonal
from tiskel.geometry.forest import spanning_links
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.methods.robust.network import Network
from tiskel.methods.robust.wire.directions import Wires, beside, beside_mean, refined, valleys, voted
from tiskel.methods.robust.wire.links import NEIGHBOURS, Links, linked

# Found by trial, as those of directions.
EMPTY = 0.1  # of what is at both sides of it, what the valley holds at most once directions are known [coils to 0.10]
REACH = 14.0  # usual steps along the wire that a gap in it is wide at most [16 384 points at random: 10]
ENDS = 0.1  # share of the points that are ends of a wire with gaps, at most [coils 0.001 to 0.05]
AHEAD = 0.7  # cosine of a direction and the way over a gap, at least
ABOUT_IT = 2.0  # steps, or widths up to the valley, between a point and the way along its wire: half a turn about it
ONE = 0.95  # share of the points that are on one wire, at least
LONG = 4.0  # extents of the cloud that this is long, at least [springs of three turns 4 to 9, rows of a surface 1 to 2]

# Most clouds are nothing of the kind: a few places tell.
PLACES, ABOUT = 5, 200  # places far from each other, and points about each
FEWEST = 200  # points of a cloud: fewer say nothing about a distribution
MOST = 100_000  # points of a cloud: on more, which are not thinned only if that is asked for, wires are resolved


def parallel_links(network: Network) -> Links | None:
    """Return the links along a wire whose turns lie side by side, None where a cloud is anything else."""
    points, spacing = network.points, network.spacing
    if not FEWEST <= len(points) <= MOST or not _in_rows(network):
        return None
    near = nearest_neighbours(points, NEIGHBOURS + 1)[0][:, 1:]
    first = voted(points, near)
    for valley in valleys(beside(points, near, first) / spacing):
        wires = refined(points, near, first, valley, spacing)
        if wires is not None and wires.valley.depth <= EMPTY:
            links = _links(points, near, wires, spacing)
            if _one_wire(points, links, wires.valley.beside * spacing):
                return links
    return None


def _in_rows(network: Network) -> bool:
    """Tell whether the points about a few places, as far from each other as may be, lie in rows."""
    points = network.points
    tree, apart = cKDTree(points), ((points - points.mean(axis=0)) ** 2).sum(axis=1)
    rows: list[Indices] = []
    for _ in range(min(PLACES, -(-len(points) // ABOUT))):
        place = points[apart.argmax()]
        apart = np.minimum(apart, ((points - place) ** 2).sum(axis=1))
        rows.append(tree.query(place, k=min(ABOUT, len(points)))[1])
    chosen = np.unique(np.concatenate(rows))
    name = np.full(len(points), -1, np.int32)
    name[chosen] = np.arange(len(chosen), dtype=np.int32)
    near = name[network.neighbours[chosen, 1:]]
    some, within = points[chosen], near >= 0
    spacing = max(float(np.median(network.spacings[chosen])), TINY)
    near = np.where(within, near, np.arange(len(chosen), dtype=np.int32)[:, None])  # who is not asked has no vote
    return bool(valleys(beside(some, near, voted(some, near))[within] / spacing))


def _links(points: Points, near: Lists, wires: Wires, spacing: float) -> Links:
    """Return the links along the wires, over their gaps, too; kept are the points of the longest."""
    first = np.repeat(np.arange(len(points), dtype=np.int32), near.shape[1])[wires.kept.ravel()]
    along = np.stack([first, near[wires.kept]], axis=1)
    gaps = _over_gaps(points, along, wires, spacing)
    return linked(points, np.concatenate([along, gaps]))


def _over_gaps(points: Points, along: Pairs, wires: Wires, spacing: float) -> Pairs:
    """Return the pairs (g, 2) of ends that face each other over a gap, the shortest that join the pieces."""
    links = linked(points, along)
    piece = connected_components(links.graph, directed=False)[1].astype(np.int32)
    end, out = _ends(points, along, wires, spacing)
    if len(end) > ENDS * len(points):
        end, out = end[:0], out[:0]
    close = cKDTree(points[end]).query_pairs(REACH * links.spacing, output_type="ndarray")
    (one, other), (ahead, back) = end[close.T], (out[close[:, 0]], out[close[:, 1]])
    ways = points[other] - points[one]
    lengths = np.maximum(np.linalg.norm(ways, axis=1), TINY)
    facing = np.minimum((ways * ahead).sum(axis=1), -(ways * back).sum(axis=1)) > AHEAD * lengths
    facing &= (beside_mean(ways, ahead, back) <= wires.valley.beside * spacing) & (piece[one] != piece[other])
    shortest = np.flatnonzero(facing)[np.argsort(lengths[facing], kind="stable")]
    joins = shortest[spanning_links(piece[one[shortest]], piece[other[shortest]], lengths[shortest])]
    return np.stack([one[joins], other[joins]], axis=1)


def _ends(points: Points, along: Pairs, wires: Wires, spacing: float) -> tuple[Indices, Points]:
    """Return the points (e,) that have no link ahead, or none behind, and the direction (e, 3) in which that is."""
    steps = points[along[:, 1]] - points[along[:, 0]]
    ahead = (steps * wires.directions[along[:, 0]]).sum(axis=1)
    found, out = [], []
    for sign in (1, -1):
        farthest = np.zeros(len(points))
        np.maximum.at(farthest, along[:, 0], sign * ahead)
        end = np.flatnonzero(farthest <= wires.valley.beside * spacing / 2).astype(np.int32)
        found.append(end)
        out.append(sign * wires.directions[end])
    return np.concatenate(found), np.concatenate(out)


def _one_wire(points: Points, links: Links, wide: float) -> bool:
    """Tell whether nearly all points are about the longest way, and that is long; a shortcut leaves out turns."""
    graph, start = links.graph, int(np.flatnonzero(links.kept)[0])
    for _ in range(2):  # the second is from an end
        ways, before = dijkstra(graph, directed=False, indices=start, return_predecessors=True)
        ways[~links.kept] = 0
        start = int(ways.argmax())
    if ways[start] < LONG * diagonal(points):
        return False
    way = [start]
    while before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    reach = ABOUT_IT * max(links.spacing, wide)
    apart = dijkstra(graph, directed=False, indices=way, min_only=True, limit=reach)
    return bool(np.isfinite(apart).mean() >= ONE)
