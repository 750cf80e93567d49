"""Fronts: level sets of the geodesic distance from an end, over the neighbour graph of the original cloud.

What is near in space but far along the surface stays apart. What a front passes
in one bin of distance falls into connected sections; their graph is a Reeb graph
of geodesic distance (Verroust and Lazarus, Extracting skeletal curves from 3D
scattered data, Visual Computer 2000; Ge et al., Data skeletonization via Reeb
graphs, NIPS 2011), whose loops are the handles of the body. Points are moved to
the axes of their sections, and the next front is measured along the contracted
cloud, so that its sections stand across the limbs instead of lagging behind on
the outside of bends.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from tiskel.arrays import TINY, Indices, Numbers, Points
from tiskel.geometry.distinct import distinct
from tiskel.geometry.graph import component_labels
from tiskel.geometry.rings import smallest_distances
from tiskel.methods.robust.axes import on_axes
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections, Status, StepRecord, Trace
from tiskel.params import RobustParams
from tiskel.progress import SILENT, Span
from tiskel.timing import Stopwatch

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
BIN_RADII = 0.55  # local radii: width of a bin of the front, where that is more than the resolution [8, 10]
SMOOTHED = 2  # rounds in which distances are averaged over neighbours [14, 14]
EVENED = 5  # rounds in which contracted positions and radii are averaged over neighbours [14, 14]
ACROSS = 0.2  # share of its length that a step costs where the contraction took it away [14, 14]
SMALLEST_PART = 10  # points; parts with fewer are small components, unless there are no larger ones [0, 0; for debris]


def contract_by_fronts(network: Network, cloud: Points, params: RobustParams, span: Span = SILENT) -> Trace:
    """Return the trace of a cloud (n, 3) that was prepared as a network: one step for each front."""
    watch = Stopwatch()
    with watch.measure("rings"):
        rings, part = network.rings(), parts(network, params.least_part)
        first = smallest_distances(network.points, rings)
    everyone = np.arange(len(cloud), dtype=np.int32)
    contracted, widths = network.points, np.full(len(cloud), params.resolution * network.spacing)
    steps: list[StepRecord] = []
    history: list[tuple[Indices, Points]] = []
    sections = Sections(everyone, everyone)
    for number in range(params.max_steps):
        span.at(number / params.max_steps, f"front {number + 1}")
        step_watch = Stopwatch()
        with step_watch.measure("front"):
            distance = front(network, contracted, widths, part, across=ACROSS * (number > 0))
        with step_watch.measure("sections"):
            sections = cut(network, distance)
            contracted = _evened(on_axes(network, sections), network)
        widths = bin_widths(network, contracted, params.resolution)
        ratio = float(smallest_distances(contracted, rings).sum() / max(first.sum(), TINY))
        steps.append(StepRecord(0.0, ratio, None, None, len(cloud), step_watch.seconds))
        history.append((everyone, np.ascontiguousarray(contracted @ network.axes)))
    never = np.full(len(cloud), -1, np.int32)
    return Trace(
        cloud=cloud, points=history[-1][1], rows=everyone, merged_into=never, merged_step=never,
        history=tuple(history), steps=tuple(steps), status=Status.COMPLETE, sections=sections, prepared=network,
        ring_seconds=watch.seconds["rings"],
    )  # fmt: skip


def further_front(network: Network, contracted: Points, params: RobustParams, aside: int) -> Sections:
    """Return the sections of one more front over a contracted cloud (n, 3), from an end off the way of the others."""
    widths = bin_widths(network, contracted, params.resolution)
    part = parts(network, params.least_part)
    return cut(network, front(network, contracted, widths, part, across=ACROSS, aside=aside))


def parts(network: Network, least: float) -> Indices:
    """Return (n,) the connected component of every point, -1 for those with less than this share of the points."""
    part, sizes = network.component, np.bincount(network.component)
    large = sizes >= min(sizes.max(), max(SMALLEST_PART, least * len(part)))
    return np.where(large[part], part, -1).astype(np.int32)


def front(
    network: Network, contracted: Points, widths: Numbers, part: Indices, *, across: float, aside: int = 0
) -> Numbers:  # fmt: skip
    """Return (n,) the distance from an end of each part in bins, NaN in small components.

    Measured between contracted positions (n, 3), plus a share across of the
    original length; widths (n,) are those of the bins, and aside counts the
    ends that others began at.
    """
    first, second = network.edges.T
    length = np.linalg.norm(contracted[first] - contracted[second], axis=1)
    if across > 0:
        length = length + across * network.lengths
    graph = network.links.copy()
    graph.data = np.maximum(2 * length / (widths[first] + widths[second]), TINY)
    distance = np.full(len(part), np.nan)
    for number in distinct(part[part >= 0]):
        rows: Indices = np.flatnonzero(part == number).astype(np.int32)
        start = _end(graph, rows, contracted, aside)
        distance[rows] = dijkstra(graph, directed=False, indices=start)[rows]
    for _ in range(SMOOTHED):
        distance = network.averaging @ distance
    return np.asarray(distance)


def _end(graph: sparse.csr_array, rows: Indices, contracted: Points, aside: int) -> int:
    """Return an end of a part (p,) of the cloud.

    The first is the point farthest from the point farthest from the point that
    is farthest from the mean; every other is farthest from both ends of that
    way and the ends before it.
    """

    def farthest(starts: list[int]) -> int:
        return int(rows[dijkstra(graph, directed=False, indices=starts)[:, rows].min(axis=0).argmax()])

    outermost = int(rows[((contracted[rows] - contracted[rows].mean(axis=0)) ** 2).sum(axis=1).argmax()])
    behind = farthest([outermost])
    ends = [behind, farthest([behind])]
    for _ in range(aside):
        ends.append(farthest(ends))
    return ends[-1]


def cut(network: Network, distance: Numbers) -> Sections:
    """Return the connected pieces of each bin of distance (n,), numbered along the front."""
    reached = np.isfinite(distance)
    level = np.where(reached, np.floor(distance), -1).astype(np.int32)
    alike = level[network.edges[:, 0]] == level[network.edges[:, 1]]
    piece = component_labels(len(level), network.edges[alike])
    _, least, number = np.unique(np.where(reached, piece, -1), return_index=True, return_inverse=True)
    order = np.lexsort((least, level[least]))  # what was not reached has level -1 and comes first
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    section = rank[number.ravel()] - int(not reached.all())
    return Sections(np.where(reached, section, -1).astype(np.int32), level)


def _evened(contracted: Points, network: Network) -> Points:
    for _ in range(EVENED):
        contracted = network.averaging @ contracted
    return np.ascontiguousarray(contracted)


def bin_widths(network: Network, contracted: Points, resolution: float) -> Numbers:
    """Return (n,) the width of the front's bins: a share of the local radius, and never less than a few spacings."""
    radius = np.linalg.norm(network.points - contracted, axis=1)
    for _ in range(EVENED):
        radius = network.averaging @ radius
    return np.asarray(np.maximum(BIN_RADII * radius, resolution * np.maximum(network.spacings, network.spacing)))
