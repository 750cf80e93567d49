"""Ways along a curve from one node: only what is near is looked at, however large the graph (Dijkstra 1959)."""

from heapq import heappop, heappush

import numpy as np

from tiskel.arrays import Mask
from tiskel.geometry.graph import CurveGraph

Steps = list[list[tuple[int, float]]]  #: for every node its neighbours along the curve, and how far they are


def steps_of(graph: CurveGraph) -> Steps:
    """Return the steps of a graph; more may be added."""
    steps: Steps = [[] for _ in graph.nodes]
    for (one, other), length in zip(graph.edges.tolist(), graph.lengths.tolist(), strict=True):
        steps[one].append((other, length))
        steps[other].append((one, length))
    return steps


def ways_from(steps: Steps, start: int, most: float, goal: int | None = None) -> dict[int, tuple[float, int]]:
    """Return the length of the way to every node no farther than most, and the node before it; up to a goal if given.

    Examples
    --------
    >>> ways_from([[(1, 2.0)], [(0, 2.0), (2, 3.0)], [(1, 3.0)]], 0, most=4.0)
    {0: (0.0, 0), 1: (2.0, 0)}
    """
    found, queue = {start: (0.0, start)}, [(0.0, start)]
    while queue:
        so_far, node = heappop(queue)
        if node == goal:
            break
        for other, length in steps[node]:
            way = so_far + length
            if way <= most and way < found.get(other, (np.inf, 0))[0]:
                found[other] = way, node
                heappush(queue, (way, other))
    return found


def way_to(found: dict[int, tuple[float, int]], goal: int) -> list[int]:
    """Return the nodes of the way to a goal, from there back; none where it was not found."""
    if goal not in found:
        return []
    way = [goal]
    while found[way[-1]][1] != way[-1]:
        way.append(found[way[-1]][1])
    return way


def on_loops(graph: CurveGraph) -> Mask:
    """Return (v,) which nodes are left when ends are taken off until there is none: loops and ways between them."""
    left, edges = np.ones(len(graph.nodes), np.bool_), graph.edges
    while (ends := left & (np.bincount(edges.ravel(), minlength=len(left)) < 2)).any():
        left[ends] = False
        edges = edges[left[edges].all(axis=1)]
    return left
