"""Branches: which are real, which were missed, and how far they reach."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY, Indices, Mask, Numbers, Points
from tiskel.geometry.graph import connected_sets, node_radii
from tiskel.methods.robust.axes import line_centres
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, with_nodes, without_path
from tiskel.methods.robust.fit import ConeFit, foot_points
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections
from tiskel.params import RobustParams

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
BARELY = 1.0  # radii of its junction that a branch reaches from there at least, or it is a spur [0, 2]
CONTAINED = 1.15  # radii of a node: balls within so much are part of its ball [0, 10]
STICKS_OUT_SPACINGS = 1.5  # spacings that a branch sticks out of the rest at least [1, 0]
FARTHEST = 0.98  # quantile of the distances of a branch's points that says how far it sticks out [2, 1]
SLENDER = 3.0  # radii in the length of a branch, from which on a sheet beside it does not explain it [seedlings 3.9]
HANGING = 1.3  # radii of a branch's end in which points of the junction are the branch's [0, 0; decides on noisy mugs]
TIP_SHARE = 0.05  # share of the points ahead of an end, the farthest, whose mean is its tip [1, 2]
TIP_LEAST = 3  # points that are such a share at least; fewer have no tip [1, 1]
AHEAD = 0.5  # cosine to the direction of the end from which on points are ahead of it [2, 1]
GROWS = 0.2  # radii of an end that its tip lies outside its ball at least, for the end to grow [0, 2]
GROWS_SPACINGS = 1.0  # the same in spacings [0, 0; decides where patches are missing]
GROWS_DEVIATIONS = 3.0  # the same in standard deviations of the fit, which the noise of the scan is part of [1, 0]
TIP_RADIUS = 0.5  # radii of an end: the radius that a new tip starts with, and half a spacing at least [2, 2]
OFF = 0.25  # local radii off the curve's surface: points beyond may be a missed branch [0, 0; for uneven density]
OFF_SPACINGS = 1.5  # the same in spacings [1, 0]
OFF_DEVIATIONS = 4.0  # the same in standard deviations of the fit [0, 0; for dense clouds with noise]
MISSED = 0.5  # local radii that a missed branch sticks out at least, unless by its own radius [2, 0]
MOST = 0.9  # of the points of a missed branch, whose distance from its axis is its radius
RIDGE = 1.5  # local radii along the curve: longer is the rim of a flat part, no branch [0, 0; for uneven density]
BRANCHES = 64  # whose points are placed at a time: their lists of edges are as long as the longest
FEWEST = 12  # points of a missed branch [1, 0]


def without_spurs(curve: ConeCurve, points: Points, sections: Sections) -> ConeCurve:
    """Contract, the shortest first, branches whose points do not even leave the ball of their junction."""
    while True:
        spurs = []
        own, stops = _rows_of_nodes(curve.node_of_section[sections.section], len(curve.nodes))
        for path in curve.paths_from(ends=True):
            joint = int(path[-1])
            rows = np.concatenate([own[stops[node] : stops[node + 1]] for node in path[:-1]])
            if curve.degrees[joint] > 2 and len(rows):
                others = [curve.radii[node] for node in curve.neighbours[joint] if node != path[-2]]
                radius = max(min(float(curve.radii[joint]), float(np.mean(others))), TINY)
                spurs.append((float(np.linalg.norm(points[rows] - curve.nodes[joint], axis=1).max()) / radius, path))
        shortest = min(spurs, key=lambda spur: (spur[0], int(spur[1][0])), default=None)
        if shortest is None or shortest[0] >= BARELY:
            return curve
        curve = without_path(curve, shortest[1])


def without_contained_ends(curve: ConeCurve, slack: float = 0.0) -> ConeCurve:
    """Cut ends back to the innermost node whose ball holds the balls of all nodes after it.

    The sections of a round cap are such balls; its skeleton ends in the middle
    of the last full one. slack is how far these balls may stick out besides.
    """
    into = np.arange(len(curve.nodes), dtype=np.int32)
    for path in curve.paths_from(ends=True):
        for last in range(len(path) - 2, 0, -1):
            away = np.linalg.norm(curve.nodes[path[:last]] - curve.nodes[path[last]], axis=1)
            if (away + curve.radii[path[:last]] <= CONTAINED * curve.radii[path[last]] + slack).all():
                into[path[:last]] = path[last]
                break
    return contract_nodes(curve, into)


def without_explained_branches(
    curve: ConeCurve, network: Network, sections: Sections, least: float, sheet: Mask | None = None
) -> ConeCurve | None:  # fmt: skip
    """Contract the branches that stick out too little of what the rest of the curve explains; None where all do enough.

    The least first, and with it others far enough away not to explain each
    other. least is what a branch has to stick out, in the smaller of its radius
    and its junction's.
    """
    degree = curve.degrees
    paths = [path for path in curve.paths_from(ends=True) if degree[path[-1]] > 2]
    branches = []
    for path, out in zip(paths, _protrusions(curve, network.points, sections, paths, sheet), strict=True):
        radius = min(float(curve.radii[path[:-1]].max()), float(curve.radii[path[-1]]))
        share = out / max(least * radius, STICKS_OUT_SPACINGS * network.spacing)
        if share < 1:
            branches.append((share, int(path[0]), path))
    into, chosen = np.arange(len(curve.nodes), dtype=np.int32), list[tuple[Numbers, float]]()
    for _, _, path in sorted(branches, key=lambda branch: branch[:2]):
        centre = curve.nodes[path].mean(axis=0)
        reach = float((np.linalg.norm(curve.nodes[path] - centre, axis=1) + curve.radii[path]).max())
        if all(float(np.linalg.norm(centre - other)) > reach + radius for other, radius in chosen):
            chosen.append((centre, reach))
            into[path[:-1]] = path[-1]
    return contract_nodes(curve, into) if chosen else None


def _rows_of_nodes(owner: Indices, count: int) -> tuple[Indices, Indices]:
    """Return the rows of the cloud in the order of their nodes, and where each node's begin (count + 1,)."""
    order = np.argsort(owner, kind="stable").astype(np.int32)
    return order, np.searchsorted(owner[order], np.arange(count + 1)).astype(np.int32)


def _protrusions(
    curve: ConeCurve, points: Points, sections: Sections, paths: list[Indices], sheet: Mask | None
) -> list[float]:
    """Return how far the points of each branch lie from the surface of the rest, 0 where it has none."""
    order, stops = _rows_of_nodes(curve.node_of_section[sections.section], len(curve.nodes))
    own = [_own_rows(curve, points, [order[stops[node] : stops[node + 1]] for node in path], path) for path in paths]
    rest = [_possible(curve, path, points[rows], sheet) for path, rows in zip(paths, own, strict=True)]
    out = [np.inf if len(rows) else 0.0 for rows in own]
    asked = [i for i in range(len(paths)) if len(own[i]) and len(rest[i])]
    for some in np.array_split(asked, -(-len(asked) // BRANCHES)) if asked else []:
        candidates = np.full((len(some), max(len(rest[i]) for i in some)), -1, np.int32)
        for place, i in enumerate(some):
            candidates[place, : len(rest[i])] = rest[i]
        sizes = [len(own[i]) for i in some]
        lists = np.repeat(np.arange(len(some), dtype=np.int32), sizes)
        rows = np.concatenate([own[i] for i in some])
        found = foot_points(curve, points, rows, lists, candidates, signed=True).residual
        for i, residual in zip(some, np.split(found, np.cumsum(sizes)[:-1]), strict=True):
            out[i] = float(np.quantile(residual, FARTHEST))
    return out


def _own_rows(curve: ConeCurve, points: Points, own: list[Indices], path: Indices) -> Indices:
    """Return the rows of the cloud that are a branch's; own are those of every node of its path."""
    at_joint = own[-1]
    near = np.linalg.norm(points[at_joint] - curve.nodes[path[0]], axis=1) < HANGING * curve.radii[path[0]]
    return np.sort(np.concatenate([*own[:-1], at_joint[near]]))


def _possible(curve: ConeCurve, path: Indices, points: Points, sheet: Mask | None) -> Indices:
    """Return the edges off a path whose cones may be the deepest about some points (n, 3): no other is for any."""
    there = np.ones(len(curve.nodes), np.bool_)
    slender = curve.along(path)[-1] >= SLENDER * curve.radii[path[:-1]].max()
    if sheet is not None and slender and not sheet[path[:-1]].any():
        there &= ~sheet
    there[path[:-1]] = False
    edges: Indices = np.flatnonzero(there[curve.edges].all(axis=1)).astype(np.int32)
    if not len(points) or not len(edges):
        return edges
    centre = points.mean(axis=0)
    extent = float(np.linalg.norm(points - centre, axis=1).max())
    ends, radii = curve.nodes[curve.edges[edges]], curve.radii[curve.edges[edges]]
    away = np.linalg.norm(ends.mean(axis=1) - centre, axis=1)
    half = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2
    most = (away + extent - radii.mean(axis=1)).min()  # the ball in the middle of an edge is part of its cone
    return np.asarray(edges[away - extent - half - radii.max(axis=1) <= most])


def with_tips(fit: ConeFit, network: Network, sections: Sections) -> ConeCurve | None:
    """Add a node where points lie further ahead of an end than its ball reaches; None where none do."""
    curve, points = fit.curve, network.points
    edges, least = curve.edges[fit.edge], max(GROWS_SPACINGS * network.spacing, GROWS_DEVIATIONS * fit.deviation)
    owner = curve.node_of_section[sections.section[fit.rows]]
    tips = []
    for path in curve.paths_from(ends=True):
        end = int(path[0])
        stands = ((edges[:, 0] == end) & (fit.share == 0)) | ((edges[:, 1] == end) & (fit.share == 1))
        mine = fit.rows[stands | (owner == end)]
        tip = _tip(points[mine] - curve.nodes[end], curve.heading(path))
        reach, radius = float(np.linalg.norm(tip)), float(curve.radii[end])
        if reach - radius > max(GROWS * radius, least):
            new = max(TIP_RADIUS * radius, 0.5 * network.spacing)
            tips.append((end, curve.nodes[end] + tip * (1 - new / reach), new))
    if not tips:
        return None
    ends, nodes, radii = (np.array(column) for column in zip(*tips, strict=True))
    links = np.stack([ends, len(curve.nodes) + np.arange(len(ends))], axis=1)
    return with_nodes(curve, nodes, radii, links, curve.levels[ends])


def _tip(offsets: Points, direction: Numbers) -> Numbers:
    """Return the mean of the farthest offsets (p, 3) ahead, zero where there are too few."""
    distance = np.linalg.norm(offsets, axis=1)
    ahead = np.flatnonzero(offsets @ direction > AHEAD * distance * np.linalg.norm(direction))
    if len(ahead) < TIP_LEAST:
        return np.zeros(3)
    farthest = ahead[np.argsort(-distance[ahead], kind="stable")]
    return np.asarray(offsets[farthest[: max(TIP_LEAST, int(TIP_SHARE * len(ahead)))]].mean(axis=0))


def with_missed_branches(
    fit: ConeFit, network: Network, sections: Sections, params: RobustParams
) -> tuple[ConeCurve, Sections] | None:
    """Return the curve with a branch for every connected set of points that stands out of it, None where none does.

    A front that reaches a branch sideways takes it in together with what it
    hangs on. After the fit such a branch is what no round cone explains. Its
    layers become sections of their own.
    """
    least = np.maximum(OFF * fit.radii, max(OFF_SPACINGS * network.spacing, OFF_DEVIATIONS * fit.deviation))
    off = np.flatnonzero(fit.residual > least)
    curve, section = fit.curve, sections.section.copy()
    for members in _clusters(network, fit.rows[off]):
        mine = off[members]
        thick = float(fit.radii[mine].max())
        compact = np.linalg.norm(np.ptp(fit.places[mine], axis=0)) < RIDGE * thick
        asked = min(MISSED * thick, _thickness(network.points[fit.rows[mine]], fit.places[mine]))
        if len(mine) >= FEWEST and fit.residual[mine].max() > asked and compact:
            layer = _layers(fit.residual[mine], params.resolution * network.spacing)
            root = int(np.bincount(fit.nodes[mine][layer == 0]).argmax())
            section[fit.rows[mine]] = len(curve.section_sizes) + layer
            curve = _with_branch(curve, network, fit.rows[mine], layer, root)
    if curve is fit.curve:
        return None
    sizes = np.bincount(section[section >= 0], minlength=len(curve.section_sizes)).astype(float)
    return replace(curve, section_sizes=sizes), Sections(section, sections.level)


def _thickness(points: Points, feet: Points) -> float:
    """Return the radius about their middle, across the way out of the curve, that most points (p, 3) lie within."""
    out = (points - feet).mean(axis=0)
    out /= max(float(np.linalg.norm(out)), TINY)
    across = points - points.mean(axis=0)
    return float(np.quantile(np.linalg.norm(across - np.outer(across @ out, out), axis=1), MOST))


def _clusters(network: Network, rows: Indices) -> list[Indices]:
    """Return the connected sets of some rows of the cloud, as places in rows."""
    place = np.full(len(network.points), -1)
    place[rows] = np.arange(len(rows))
    links = place[network.edges]
    return connected_sets(len(rows), links[(links >= 0).all(axis=1)])


def _layers(height: Numbers, width: float) -> Indices:
    """Return the layer of each height (p,), numbered from the lowest without gaps."""
    width = max(width, float(np.ptp(height)) / len(height))
    layer = np.floor((height - height.min()) / width).astype(np.int32)
    return np.unique(layer, return_inverse=True)[1].ravel().astype(np.int32)


def _with_branch(curve: ConeCurve, network: Network, rows: Indices, layer: Indices, root: int) -> ConeCurve:
    """Add a chain of nodes, one for every layer of the points, at the node that most of the lowest points stand on."""
    count, first = int(layer.max()) + 1, len(curve.nodes)
    nodes = line_centres(network.points[rows], network.normals[rows], layer, count)[0]
    chain = np.array([root, *range(first, first + count)], np.int32)
    grown = with_nodes(
        curve, nodes, node_radii(nodes, network.points[rows], layer), np.stack([chain[:-1], chain[1:]], axis=1),
        curve.levels[root] + np.arange(1, count + 1, dtype=np.int32),
    )  # fmt: skip
    owners = np.concatenate([curve.node_of_section[:-1], np.arange(first, first + count), [-1]]).astype(np.int32)
    return replace(grown, node_of_section=owners, section_sizes=np.append(curve.section_sizes, np.zeros(count)))
