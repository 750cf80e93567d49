"""Contraction by fronts: every point moves to the axis of the section it belongs to.

A front runs from a tip over the neighbour graph of the *original* cloud, so what
is near in space but far along the surface stays apart. What it passes in one
stride falls into connected sections (level sets of geodesic distance; their
graph is a Reeb graph, whose loops are the handles of the body). Of each section
the axis is known: the line that the normals' lines come closest to, along the
direction that the normals have least of (Tagliasacchi et al., Curve Skeleton
Extraction from Incomplete Point Cloud, SIGGRAPH 2009, use the same two facts for
planar cuts). Points are moved there, and the next front is measured along the
contracted cloud, so that its sections stand across the limbs instead of lagging
behind on the outside of bends.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, dijkstra

from tiskel.arrays import Indices, Numbers, Points
from tiskel.errors import TiskelError
from tiskel.geometry.rings import smallest_distances
from tiskel.methods.robust.network import Network, neighbour_network, own_axes
from tiskel.methods.trace import Status, StepRecord, Stopwatch, Trace
from tiskel.params import ContractionParams

STRIDE = 2.5  # of the front, in spacings: thinner sections would fall apart between the points
STRIDE_RADII = 0.55  # the same in local radii
SMOOTHED = 2  # how often distances are averaged over neighbours
EVENED = 5  # the same for contracted positions
ACROSS = 0.2  # share of its length that a step costs where the contraction took it away
SMALLEST_PART, SMALLEST_SHARE = 10, 0.005  # points, of the cloud; smaller parts are debris
PULL = 0.05  # towards the mean of a section, against the lines of the normals
ROUND, RAGGED = 0.2, 0.45  # spread of the distance to the axis, in its mean: contracted up to one, left from the other


@dataclass(frozen=True)
class Sections:
    """The section of every point (n,) int32, -1 for debris, and the level of the front there, likewise."""

    section: Indices
    level: Indices

    @property
    def count(self) -> int:
        return int(self.section.max(initial=-1)) + 1


def contract_robust(points: Points, params: ContractionParams, weights: Numbers | None = None) -> Trace:
    """Contract by fronts, one step each; points normalised.

    Raises TiskelError for weights: every part goes to its axis at once, whatever its thickness.
    """
    if weights is not None:
        raise TiskelError("method robust takes no weights; leave them out, or choose method lbc or gls")
    watch = Stopwatch()
    with watch.measure("rings"):
        axes = own_axes(points)
        points = np.ascontiguousarray(points @ axes.T)
        network = neighbour_network(points, params.neighbours_for(len(points)))
        averaging, rings = network.averaging(), network.rings()
        part = parts(network)
    first = smallest_distances(points, rings)
    everyone = np.arange(len(points), dtype=np.int32)
    there, strides = points, np.full(len(points), STRIDE * network.spacing)
    steps: list[StepRecord] = []
    history: list[tuple[Indices, Points]] = []
    sections = Sections(everyone, everyone)
    for _ in range(params.step_limit()):
        step_watch = Stopwatch()
        with step_watch.measure("front"):
            distance = front(network, there, strides, part, averaging)
        with step_watch.measure("sections"):
            sections = cut(network, distance)
            there = _evened(on_axes(network, sections), averaging)
        strides = _strides(network, there, averaging)
        ratio = float(smallest_distances(there, rings).sum() / first.sum())
        steps.append(StepRecord(0.0, ratio, None, None, len(points), step_watch.seconds))
        history.append((everyone, np.ascontiguousarray(there @ axes)))
    never = np.full(len(points), -1, np.int32)
    return Trace(
        history[-1][1], everyone, rings, never, never, tuple(history), tuple(steps), Status.COMPLETE,
        watch.seconds["rings"], sections.section, sections.level,
    )  # fmt: skip


def parts(network: Network) -> Indices:
    """Return (n,) the connected part of every point, -1 for debris."""
    part = connected_components(network.graph(network.lengths), directed=False)[1].astype(np.int32)
    sizes = np.bincount(part)
    large = sizes >= min(sizes.max(), max(SMALLEST_PART, SMALLEST_SHARE * len(part)))
    return np.where(large[part], part, -1).astype(np.int32)


def front_from_aside(network: Network, there: Points, times: int) -> Sections:
    """Return the sections of one more front over a contracted cloud (n, 3), from a tip off the way of the others."""
    averaging = network.averaging()
    strides = _strides(network, there, averaging)
    return cut(network, front(network, there, strides, parts(network), averaging, aside=times))


def front(
    network: Network,
    there: Points,
    strides: Numbers,
    part: Indices,
    averaging: sparse.csr_array,
    *,
    aside: int = 0,
) -> Numbers:
    """Return (n,) the distance from a tip of each part in strides, NaN for debris.

    Measured between contracted positions (n, 3), plus a share of the original
    length; aside counts the tips that others began at.
    """
    first, second = network.edges.T
    length = np.linalg.norm(there[first] - there[second], axis=1)
    if there is not network.points:
        length = length + ACROSS * network.lengths
    graph = network.graph(np.maximum(2 * length / (strides[first] + strides[second]), np.finfo(float).tiny))
    distance = np.full(len(part), np.nan)
    for number in np.unique(part[part >= 0]):
        rows: Indices = np.flatnonzero(part == number).astype(np.int32)
        start = _tip(graph, rows, there, aside)
        distance[rows] = dijkstra(graph, directed=False, indices=start)[rows]
    for _ in range(SMOOTHED):
        distance = averaging @ distance
    return np.asarray(distance)


def _tip(graph: sparse.csr_array, rows: Indices, there: Points, aside: int) -> int:
    """Return a tip of a part (p,) of the cloud.

    The first is the point farthest from the point farthest from the point that
    is farthest from the mean; every other is farthest from both ends of that
    way and the tips before it.
    """

    def farthest(places: list[int]) -> int:
        return int(rows[dijkstra(graph, directed=False, indices=places)[:, rows].min(axis=0).argmax()])

    outermost = int(rows[((there[rows] - there[rows].mean(axis=0)) ** 2).sum(axis=1).argmax()])
    behind = farthest([outermost])
    tips = [behind, farthest([behind])]
    for _ in range(aside):
        tips.append(farthest(tips))
    return tips[-1]


def cut(network: Network, distance: Numbers) -> Sections:
    """Return the connected pieces of each stride, numbered along the front."""
    there = np.isfinite(distance)
    level = np.where(there, np.floor(distance), -1).astype(np.int32)
    first, second = network.edges[(level[network.edges[:, 0]] == level[network.edges[:, 1]])].T
    count = len(level)
    linked = sparse.coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    piece = connected_components(linked, directed=False)[1]
    _, least, number = np.unique(np.where(there, piece, -1), return_index=True, return_inverse=True)
    order = np.lexsort((least, level[least]))  # debris has level -1 and comes first
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    section = rank[number.ravel()] - int(not there.all())
    return Sections(np.where(there, section, -1).astype(np.int32), level)


def line_centres(points: Points, normals: Points, label: Indices, count: int) -> tuple[Points, Numbers]:
    """Return the centre (count, 3) of each labelled set, and how many points it has.

    The place that the lines along the normals come closest to, in least
    squares, pulled a little to the mean: of a full ring and of an arc alike it
    lies on the axis, of a round cap in the middle of its ball.
    """
    size = np.bincount(label, minlength=count).astype(float)
    mean = _sums(points, label, count) / np.maximum(size, 1)[:, None]
    offset = points - mean[label]
    across = np.eye(3) * (1 + PULL) - normals[:, :, None] * normals[:, None, :]
    matrix = _sums(across.reshape(-1, 9), label, count).reshape(-1, 3, 3)
    right = _sums(np.einsum("nij,nj->ni", across, offset), label, count) - PULL * _sums(offset, label, count)
    matrix[size == 0] = np.eye(3)
    return mean + np.linalg.solve(matrix, right[..., None])[..., 0], size


def on_axes(network: Network, sections: Sections) -> Points:
    """Return the points (n, 3) on the axes of their sections, as far as these are round."""
    rows = np.flatnonzero(sections.section >= 0)
    label, count = sections.section[rows], sections.count
    points, normals = network.points[rows], network.normals[rows]
    centre, size = line_centres(points, normals, label, count)
    scatter = _sums((normals[:, :, None] * normals[:, None, :]).reshape(-1, 9), label, count).reshape(-1, 3, 3)
    values, vectors = np.linalg.eigh(scatter)
    # A tube has no normals along its axis, a ball as many as in any direction.
    tubular = np.clip(1 - 2 * values[:, 0] / np.maximum(values[:, 1], np.finfo(float).tiny), 0, 1)
    axis = vectors[:, :, 0] * np.where(size < 4, 0, tubular)[:, None] ** 0.5
    offset = points - centre[label]
    moved = centre[label] + np.einsum("ij,ij->i", offset, axis[label])[:, None] * axis[label]
    share = _roundness(np.linalg.norm(points - moved, axis=1), label, size)[label][:, None]
    there = network.points.copy()
    there[rows] = share * moved + (1 - share) * points
    return np.asarray(there)


def _roundness(distance: Numbers, label: Indices, size: Numbers) -> Numbers:
    """Return 1 for sections whose points are equally far from the axis, 0 where they are not at all."""
    mean = np.bincount(label, distance, minlength=len(size)) / size
    square = np.bincount(label, distance**2, minlength=len(size)) / size
    spread = np.sqrt(np.maximum(square - mean**2, 0)) / np.maximum(mean, np.finfo(float).tiny)
    return np.asarray(np.clip((RAGGED - spread) / (RAGGED - ROUND), 0, 1))


def _evened(there: Points, averaging: sparse.csr_array) -> Points:
    for _ in range(EVENED):
        there = averaging @ there
    return np.ascontiguousarray(there)


def _strides(network: Network, there: Points, averaging: sparse.csr_array) -> Numbers:
    """Return (n,) the stride of the front: a share of the local radius, and never less than a few spacings."""
    radius = np.linalg.norm(network.points - there, axis=1)
    for _ in range(EVENED):
        radius = averaging @ radius
    return np.asarray(np.maximum(STRIDE_RADII * radius, STRIDE * np.maximum(network.spacings, network.spacing)))


def _sums(values: Numbers, label: Indices, count: int) -> Numbers:
    """Return (count, d) the sums of values (n, d) by label."""
    return np.asarray(np.stack([np.bincount(label, column, minlength=count) for column in values.T], axis=1))
