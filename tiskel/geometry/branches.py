"""Branches of a graph: the ways from junction or end to junction or end."""

from collections.abc import Iterator

import numpy as np

from tiskel.arrays import Indices


def branches_of(around: list[list[int]]) -> tuple[Indices, ...]:
    """Return the branches of a graph as ordered node lists.

    Parameters
    ----------
    around : list of list of int
        The neighbours of every node.

    Returns
    -------
    tuple of (b,) int32
        From stop to stop, a stop being a node with other than two neighbours; loops without one begin and end at
        the same node.
    """
    stops = [node for node in range(len(around)) if len(around[node]) != 2]
    used: set[tuple[int, int]] = set()
    found = [[node] for node in stops if not around[node]]
    for start in [*stops, *range(len(around))]:  # what no stop reaches is a loop of its own
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
