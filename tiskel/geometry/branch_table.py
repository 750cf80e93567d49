"""What there is to say about every branch of a curve: from where to where, how long, how thick, below which other."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.labels import labels
from tiskel.geometry.radius import RadiusSource

AWAY = 2.0  #: radii of the joint over which the direction of a branch at it is taken; nearer it is in the joint


@dataclass(frozen=True)
class BranchRow:
    """A branch; lengths in the curve's unit, None where there is no value.

    Attributes
    ----------
    branch : int
        Its number, see :attr:`tiskel.CurveGraph.branches`.
    start, end : int
        Its first and its last node, the one nearer to the root first.
    kind : str
        "end-end", "joint-end", "joint-joint", "loop" or "point".
    length, chord : float
        Along the branch, and from end to end.
    tortuosity : float or None
        The first over the second.
    radius_least, radius_mean, radius_largest : float or None
        Of its nodes; the mean is over its length.
    radius_source : str
        What most of these radii are worth, see :class:`tiskel.RadiusSource`.
    measured : float
        Share of its nodes whose radius is measured.
    volume, surface : float or None
        Of the cones between its nodes, without their flat ends.
    order : int
        How many joints lie between the root and its start.
    angle : float or None
        Degrees between the way it leaves its joint and the way its parent arrives there: 0 goes straight on.
    parent : int
        The branch that it hangs on, -1 at a root.
    bridged : float
        Share of its length that was laid over gaps.
    """

    branch: int
    start: int
    end: int
    kind: str
    length: float
    chord: float
    tortuosity: float | None
    radius_least: float | None
    radius_mean: float | None
    radius_largest: float | None
    radius_source: str
    measured: float
    volume: float | None
    surface: float | None
    order: int
    angle: float | None
    parent: int
    bridged: float


def branch_table(curve: CurveGraph, root: Sequence[float] | None = None) -> tuple[BranchRow, ...]:
    """Return a row for every branch, in their order.

    Parameters
    ----------
    curve : CurveGraph
        The curve.
    root : three numbers, optional
        A place; the nearest node is the root of its component. The root of others is the end with the largest radius,
        or the first node where there is no end.

    Returns
    -------
    tuple of BranchRow

    Examples
    --------
    >>> from tiskel import make_shape, shape_graph
    >>> from tiskel.geometry.branch_table import branch_table
    >>> rows = branch_table(make_shape(shape_graph("y"))[1])
    >>> sorted((row.order, row.kind) for row in rows)
    [(0, 'joint-end'), (1, 'joint-end'), (1, 'joint-end')]
    """
    ways = [branch.tolist() for branch in curve.branches]
    at: dict[int, list[int]] = {}
    for number, way in enumerate(ways):
        for node in {way[0], way[-1]}:
            at.setdefault(node, []).append(number)
    parent, order = np.full(len(ways), -1), np.full(len(ways), -1)
    for start in _roots(curve, at, root):
        queue = deque([(start, -1, 0)])
        while queue:
            node, above, depth = queue.popleft()
            for number in at[node]:
                if order[number] >= 0:
                    continue
                parent[number], order[number] = above, depth
                if ways[number][0] != node:
                    ways[number].reverse()
                queue.append((ways[number][-1], number, depth + 1))
    return tuple(_row(curve, ways, number, int(order[number]), int(parent[number])) for number in range(len(ways)))


def _roots(curve: CurveGraph, at: dict[int, list[int]], root: Sequence[float] | None) -> list[int]:
    """Return nodes to begin with: the root, ends from the thickest on, all others."""
    nodes = np.array(sorted(at), np.int64)
    thick = np.nan_to_num(curve.radii[nodes])
    first: list[int] = []
    if root is not None and len(nodes):
        first = [int(nodes[np.argmin(np.linalg.norm(curve.nodes[nodes] - np.asarray(root, float), axis=1))])]
    others: list[int] = nodes[np.lexsort((-thick, curve.degrees[nodes] != 1))].tolist()
    return first + others


def _row(curve: CurveGraph, ways: list[list[int]], number: int, order: int, parent: int) -> BranchRow:
    way = np.array(ways[number], np.int32)
    places, radii = curve.nodes[way], curve.radii[way]
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    length, chord = float(steps.sum()), float(np.linalg.norm(places[-1] - places[0]))
    sources = curve.radius_sources[way]
    known = bool(np.isfinite(radii).all())
    volume, surface, mean = _solid(steps, radii) if known else (None, None, None)
    return BranchRow(
        branch=number,
        start=int(way[0]),
        end=int(way[-1]),
        kind=_kind(curve, way),
        length=length,
        chord=chord,
        tortuosity=length / chord if chord > 0 else None,
        radius_least=float(radii.min()) if known else None,
        radius_mean=mean,
        radius_largest=float(radii.max()) if known else None,
        radius_source=labels(RadiusSource, np.array([np.bincount(sources).argmax()], np.uint8))[0],
        measured=float((sources == RadiusSource.MEASURED).mean()),
        volume=volume,
        surface=surface,
        order=order,
        angle=_angle(curve, ways[parent], ways[number]) if parent >= 0 else None,
        parent=parent,
        bridged=_bridged(curve, way, steps),
    )


def _kind(curve: CurveGraph, way: Indices) -> str:
    if len(way) == 1:
        return "point"
    if way[0] == way[-1]:
        return "loop"
    ends = int((curve.degrees[way[[0, -1]]] == 1).sum())
    return ("joint-joint", "joint-end", "end-end")[ends]


def _solid(steps: Numbers, radii: Numbers) -> tuple[float, float, float]:
    """Return volume and lateral surface of the cones, and the mean radius along them."""
    a, b = radii[:-1], radii[1:]
    volume = np.pi / 3 * steps @ (a * a + a * b + b * b)
    surface = np.pi * (a + b) @ np.hypot(steps, a - b)
    mean = steps @ (a + b) / 2 / steps.sum() if steps.sum() > 0 else radii.mean()
    return float(volume), float(surface), float(mean)


def _bridged(curve: CurveGraph, way: Indices, steps: Numbers) -> float:
    over = {tuple(sorted(pair)) for pair in curve.edges[curve.bridged].tolist()}
    if not over or steps.sum() == 0:
        return 0.0
    pairs = zip(way[:-1].tolist(), way[1:].tolist(), strict=True)
    return float(steps @ [tuple(sorted(pair)) in over for pair in pairs] / steps.sum())


def _angle(curve: CurveGraph, above: list[int], way: list[int]) -> float | None:
    """Return the degrees between the end of one way and the beginning of another at the joint they share."""
    joint = way[0]
    away = AWAY * float(np.nan_to_num(curve.radii[joint]))
    back = above[::-1] if above[-1] == joint else above
    arriving, leaving = -_direction(curve.nodes[back], away), _direction(curve.nodes[way], away)
    size = np.linalg.norm(arriving) * np.linalg.norm(leaving)
    return float(np.degrees(np.arccos(np.clip(arriving @ leaving / size, -1, 1)))) if size > 0 else None


def _direction(places: Points, away: float) -> Numbers:
    """Return the way from the first place to the one so far along, or to the last."""
    along = np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))
    last = min(int(np.searchsorted(along, away)) + 1, len(places) - 1)
    return np.asarray(places[last] - places[0])
