"""Cycles that are no loops of the body.

A stride of the front that falls apart, over a hole in the scan or by chance,
makes a cycle in the graph of sections. It is no loop of the body if it bounds a
disc inside it: if the straight lines between its two sides, level by level, stay
inside. What is inside, the winding number tells, which closes holes.
"""

from collections.abc import Iterator

import numpy as np

from tiskel.arrays import Edges, Indices, Mask, Numbers, Table
from tiskel.geometry.solid import Solid
from tiskel.methods.robust.curve import ConeCurve, contract_nodes
from tiskel.methods.robust.network import Network
from tiskel.methods.robust.sections import centred
from tiskel.methods.trace import Sections

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
ROUNDS = 100  # of contraction at most; each takes away a cycle, so that only a graph of chance gets there
ALONG = np.array([0.25, 0.5, 0.75])  # where a line between two sides is probed [0, 0; the middle alone fails on mugs]
SHARE_INSIDE = 0.5  # of the winding number along the cycle: more is inside [0, 0; for uneven density]
LOWEST = 0.4  # what the winding number along a cycle is held to be at least [0, 0; for a cycle outside the body]
FRAGMENT = 0.3  # of the points of the other side: fewer do not know their centre [0, 0; for noise and missing patches]
SMALL = 4  # nodes: hardly a loop; a line to a fragment, or inside in the mean, will do [0, 0; for uneven density]


def without_filled_cycles(
    curve: ConeCurve, network: Network, sections: Sections, solid: Solid, *, fitted: bool
) -> ConeCurve:
    """Contract the cycles that bound a disc inside the body.

    Nodes of sections are centred anew after that. Fitted ones are where they
    should be: their two sides must run within one another, and go to their mean.
    Where there is no inside to speak of, that will do for sections, too.
    """
    for _ in range(ROUNDS):
        cycles = short_cycles(curve)
        if not cycles:
            break
        rungs, owner = _rungs(cycles, curve)
        start, stop = curve.nodes[rungs[:, 0]], curve.nodes[rungs[:, 1]]
        probes = start[:, None] + ALONG[None, :, None] * (stop - start)[:, None]
        winding = solid.oriented.winding_numbers(np.concatenate([probes.reshape(-1, 3), curve.nodes]))
        across, own = winding[: probes.size // 3].reshape(-1, len(ALONG)), winding[probes.size // 3 :]
        one, overlapping = _inside(rungs, owner, cycles, curve, across, own), _overlapping(rungs, curve)
        if fitted:
            one &= overlapping
        elif not solid.trusted:
            one |= overlapping
        filled = np.bincount(owner[~one], minlength=len(cycles)) == 0
        if not filled.any():
            break
        curve = contract_nodes(curve, _contraction(cycles, filled, rungs, owner, curve.levels), mean=fitted)
        curve = curve if fitted else centred(curve, network, sections)
    return curve


def without_tight_cycles(curve: ConeCurve) -> ConeCurve:
    """Contract, one by one, the cycles no wider than their thickest place: a hole has to fit between the two sides."""
    while True:
        cycle = next(filter(lambda nodes: _tight(curve, nodes), _cycles(curve)), None)
        if cycle is None:
            return curve
        into = np.arange(len(curve.nodes), dtype=np.int32)
        into[cycle] = min(cycle)
        curve = contract_nodes(curve, into, mean=True)


def _tight(curve: ConeCurve, cycle: list[int]) -> bool:
    nodes = curve.nodes[cycle]
    apart = np.linalg.norm(nodes[:, None] - nodes, axis=2)
    return bool(apart.max() < 2 * curve.radii[cycle].max())


def _cycles(curve: ConeCurve) -> Iterator[list[int]]:
    """Yield a shortest cycle through each edge that a spanning forest leaves out."""
    around, before = curve.neighbours, {}
    for start in range(len(around)):
        if start in before:
            continue
        before[start], todo = -1, [start]
        for node in todo:
            for other in around[node]:
                if other not in before:
                    before[other] = node
                    todo.append(other)
    for a, b in curve.edges.tolist():
        if before[a] != b and before[b] != a:
            cut = [[o for o in others if {node, o} != {a, b}] for node, others in enumerate(around)]
            yield _way(cut, a, b, -1)


def short_cycles(curve: ConeCurve) -> list[list[int]]:
    """Return the shortest cycles through each node and two neighbours on one side of the front, shortest first."""
    around, levels = curve.neighbours, curve.levels.tolist()
    found: dict[tuple[int, ...], list[int]] = {}
    for node, others in enumerate(around):
        for i, a in enumerate(others):
            for b in others[:i]:
                if (levels[a] - levels[node]) * (levels[b] - levels[node]) > 0:
                    way = _way(around, a, b, node)
                    if way:
                        found[tuple(sorted([node, *way]))] = [node, *way]
    return [found[key] for key in sorted(found, key=lambda key: (len(key), key))]


def _way(around: list[list[int]], a: int, b: int, without: int) -> list[int]:
    """Return a shortest way from b to a around a node, empty where there is none."""
    before, todo = {a: -1}, [a]
    while todo and b not in before:
        reached = []
        for node in todo:
            for other in around[node]:
                if other != without and other not in before:
                    before[other] = node
                    reached.append(other)
        todo = reached
    way, at = [], b if b in before else -1
    while at >= 0:
        way.append(at)
        at = before[at]
    return way


def _rungs(cycles: list[list[int]], curve: ConeCurve) -> tuple[Edges, Indices]:
    """Return pairs (r, 2) of nodes across the cycles, the larger section first, and the cycle of each."""
    size = curve.point_counts
    pairs, owner = [], []
    for number, cycle in enumerate(cycles):
        top = int(np.abs(curve.levels[cycle] - curve.levels[cycle[0]]).argmax())
        sides = cycle[1:top], cycle[:top:-1]
        for one, other in (sides, sides[::-1]) if all(sides) else ((cycle[1:], cycle[:1]),):
            for node in one:
                across = other[int(np.abs(curve.levels[other] - curve.levels[node]).argmin())]
                pairs.append((node, across) if size[node] >= size[across] else (across, node))
                owner.append(number)
    return np.array(pairs, np.int32), np.array(owner, np.int32)


def _inside(
    rungs: Edges, owner: Indices, cycles: list[list[int]], curve: ConeCurve, winding: Table, own: Numbers,
) -> Mask:  # fmt: skip
    """Tell which lines stay inside; towards a fragment only up to its half.

    winding (r, 3) are the winding numbers along each line, own (v,) those of
    the nodes.
    """
    level = SHARE_INSIDE * np.array([max(float(np.median(own[cycle])), LOWEST) for cycle in cycles])
    size = curve.point_counts
    fragment = size[rungs[:, 1]] < FRAGMENT * size[rungs[:, 0]]
    winding[fragment, -1] = np.inf
    inside = (winding > level[owner][:, None]).all(axis=1)
    small = np.array([len(cycle) for cycle in cycles])[owner] <= SMALL
    return np.asarray(inside | small & (fragment | (winding.mean(axis=1) > level[owner])))


def _overlapping(rungs: Edges, curve: ConeCurve) -> Mask:
    """Tell which lines end within the ball at their other end."""
    length = np.linalg.norm(curve.nodes[rungs[:, 0]] - curve.nodes[rungs[:, 1]], axis=1)
    return np.asarray(length < curve.radii[rungs].max(axis=1))


def _contraction(cycles: list[list[int]], filled: Mask, rungs: Edges, owner: Indices, levels: Indices) -> Indices:
    """Return for each node the one that takes its place: both sides of filled cycles that do not touch become one.

    Level by level; all at once only where the sides have no level in common.
    """
    into, taken = np.arange(len(levels), dtype=np.int32), np.zeros(len(levels), bool)
    for number in np.flatnonzero(filled):
        if taken[cycles[number]].any():
            continue
        taken[cycles[number]] = True
        pairs = rungs[owner == number]
        level = levels[pairs[:, 0]] == levels[pairs[:, 1]]
        for pair in pairs[level] if level.any() else pairs:
            low, high = np.sort(into[pair])
            into[into == high] = low
    return into
