"""Plain graph questions about a skeleton: degrees, components, loops, branches, spurs."""

from collections.abc import Iterator

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from tiskel.arrays import Indices, Numbers, Points


def degrees(count: int, edges: Indices) -> Indices:
    """Return (v,) the number of edges at each node."""
    return np.bincount(edges.ravel(), minlength=count).astype(np.int32)


def component_count(count: int, edges: Indices) -> int:
    """Return the number of connected components."""
    adjacency = sparse.coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return int(connected_components(adjacency, directed=False)[0]) if count else 0


def loop_count(count: int, edges: Indices) -> int:
    """Return the number of independent loops, e - v + components."""
    return len(edges) - count + component_count(count, edges)


def edge_lengths(nodes: Points, edges: Indices) -> Numbers:
    """Return (e,) the length of every edge."""
    return np.asarray(np.linalg.norm(nodes[edges[:, 0]] - nodes[edges[:, 1]], axis=1))


def counts(nodes: Points, edges: Indices) -> dict[str, float]:
    """Return components, loops, ends, joints and length by name."""
    degree = degrees(len(nodes), edges)
    return {
        "components": component_count(len(nodes), edges),
        "loops": loop_count(len(nodes), edges),
        "ends": int((degree == 1).sum()),
        "joints": int((degree > 2).sum()),
        "length": float(edge_lengths(nodes, edges).sum()),
    }


def neighbour_lists(count: int, edges: Indices) -> list[list[int]]:
    """Return the neighbours of every node, ascending."""
    around: list[list[int]] = [[] for _ in range(count)]
    for a, b in edges.tolist():
        around[a].append(b)
        around[b].append(a)
    return [sorted(neighbours) for neighbours in around]


def passages(count: int, edges: Indices) -> Indices:
    """Return (d, 3) one neighbour, the node, and the other neighbour, of every node with exactly two."""
    around = enumerate(neighbour_lists(count, edges))
    return np.array([(o[0], node, o[1]) for node, o in around if len(o) == 2], np.int32).reshape(-1, 3)


def node_radii(nodes: Points, cloud: Points, node_of_point: Indices) -> Numbers:
    """Return (v,) the mean distance of each node's points to it, 0 where it has none."""
    distance = np.linalg.norm(cloud - nodes[node_of_point], axis=1)
    counts = np.bincount(node_of_point, minlength=len(nodes))
    return np.asarray(np.bincount(node_of_point, distance, minlength=len(nodes)) / np.maximum(counts, 1))


def branches(count: int, edges: Indices) -> tuple[Indices, ...]:
    """Return the branches as ordered node lists.

    A branch runs from joint or end to joint or end; a loop without a joint
    repeats its first node at its end; an isolated node is a branch of one.
    """
    around = neighbour_lists(count, edges)
    stops = [node for node in range(count) if len(around[node]) != 2]
    used: set[tuple[int, int]] = set()
    found = [[node] for node in stops if not around[node]]
    for start in [*stops, *range(count)]:  # what no stop reaches is a loop of its own
        for first in around[start]:
            if (start, first) not in used and (start in stops or not _visited(start, around, used)):
                found.append(list(_walk(start, first, around, used)))
    return tuple(np.array(branch, np.int32) for branch in found)


def _visited(node: int, around: list[list[int]], used: set[tuple[int, int]]) -> bool:
    return any((node, other) in used for other in around[node])


def _walk(start: int, first: int, around: list[list[int]], used: set[tuple[int, int]]) -> Iterator[int]:
    """Follow nodes of degree two from a start until a stop, or back to the start."""
    previous, at = start, first
    yield start
    while True:
        used.update({(previous, at), (at, previous)})
        yield at
        if len(around[at]) != 2 or at == start:
            return
        previous, at = at, next(other for other in around[at] if other != previous)


def without_spurs(nodes: Points, edges: Indices, radius: Numbers) -> Indices:
    """Return for each node the one that takes its place: itself, or the joint its spur hangs on.

    A spur is an end whose single edge leads to a joint and is shorter than the
    joint's radius. The shortest goes first, and what is left is looked at again:
    a joint of three that loses one edge is no joint any more.
    """
    into = np.arange(len(nodes), dtype=np.int32)
    around = [set(neighbours) for neighbours in neighbour_lists(len(nodes), edges)]
    ends, lengths = edges, edge_lengths(nodes, edges)
    for e in np.argsort(lengths, kind="stable"):
        for end, joint in (ends[e], ends[e][::-1]):
            if len(around[end]) == 1 and len(around[joint]) > 2 and lengths[e] < radius[joint]:
                around[joint].discard(end)
                around[end].clear()
                into[end] = joint
    return into
