"""Branches of a graph: the ways from junction or end to junction or end."""

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
    stops = [node for node, others in enumerate(around) if len(others) != 2]
    walked: set[tuple[int, int]] = set()  # the other ends of branches, and the node before
    seen = bytearray(len(around))  # of nodes between stops
    found = [[node] for node in stops if not around[node]]
    for start in stops:
        for first in around[start]:
            if (start, first) not in walked:
                found.append(_walk(start, first, around, seen))
                walked.add((found[-1][-1], found[-1][-2]))
    for start, others in enumerate(around):  # what no stop reaches is a loop of its own
        if len(others) == 2 and not seen[start]:
            found.append(_walk(start, others[0], around, seen))
    return tuple(np.array(branch, np.int32) for branch in found)


def _walk(start: int, first: int, around: list[list[int]], seen: bytearray) -> list[int]:
    """Follow nodes of degree two from a start until a stop, or back to the start."""
    way, previous, at = [start, first], start, first
    while at != start and len(others := around[at]) == 2:
        seen[at] = 1
        previous, at = at, others[1] if others[0] == previous else others[0]
        way.append(at)
    return way
