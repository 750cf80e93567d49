"""The length of a curve in small parts, and the nearest places of a curve."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Numbers, Points, within_runs
from tiskel.geometry.graph import CurveGraph

MOST = 300_000  # parts of one curve: bounds the memory; longer ones make a very long curve coarser
CANDIDATES = 8  # nearest parts whose edges are tried; a curve forks into fewer at a place
BATCH = 100_000  # queries at a time: bounds the memory, not the result


@dataclass(frozen=True, eq=False)
class Parts:
    """A curve cut into parts along its edges.

    Attributes
    ----------
    edges : (p,) int32
        The edge that each part belongs to.
    shares : (p,) float64
        Where its middle is, as a share of the way along the edge.
    lengths : (p,) float64
        How long it is, in the unit of the curve.
    points : (p, 3) float64
        Its middle.
    """

    edges: Indices
    shares: Numbers
    lengths: Numbers
    points: Points


def parts_of(curve: CurveGraph, longest: float) -> Parts:
    """Return the parts of a curve, those of an edge equally long; edges without length have none.

    Parameters
    ----------
    curve : CurveGraph
        In any unit.
    longest : float
        How long a part may be, in that unit.

    Returns
    -------
    Parts

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import CurveGraph
    >>> from tiskel.geometry.feet import parts_of
    >>> line = CurveGraph(np.array([[0.0, 0, 0], [1, 0, 0]]), np.array([[0, 1]], np.int32))
    >>> parts_of(line, 0.25).points[:, 0].tolist()
    [0.125, 0.375, 0.625, 0.875]
    """
    lengths = curve.lengths
    longest = max(longest, float(lengths.sum()) / MOST, TINY)
    counts = np.ceil(lengths / longest).astype(int)
    edge = np.repeat(np.arange(len(lengths), dtype=np.int32), counts)
    number = within_runs(counts)
    share = (number + 0.5) / counts[edge]
    return Parts(edge, share, lengths[edge] / counts[edge], _at(curve.nodes, curve, edge, share))


def even_places(curve: CurveGraph, count: int) -> tuple[Indices, Numbers]:
    """Return places evenly along all edges of a curve, one after the other, however short these are.

    Parameters
    ----------
    curve : CurveGraph
        With length.
    count : int
        How many places.

    Returns
    -------
    edges : (count,) int32
        The edge of each.
    shares : (count,) float64
        How far along it.

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.geometry.feet import even_places
    >>> even_places(shape_graph("capsule"), 2)[1].round(6).tolist()
    [0.25, 0.75]
    """
    ends = np.cumsum(curve.lengths)
    along = (np.arange(count) + 0.5) / count * ends[-1]
    edges = np.minimum(np.searchsorted(ends, along, side="right"), len(ends) - 1).astype(np.int32)
    lengths = np.maximum(curve.lengths[edges], TINY)
    return edges, np.clip(1 - (ends[edges] - along) / lengths, 0, 1)


def between(values: Numbers, curve: CurveGraph, edges: Indices, shares: Numbers) -> Numbers:
    """Return (q,) what values (v,) of the nodes are at places on edges (q,), shares (q,) of the way along them."""
    first, last = curve.edges[edges].T
    return np.asarray(values[first] + shares * (values[last] - values[first]))


def _at(values: Points, curve: CurveGraph, edges: Indices, shares: Numbers) -> Points:
    first, last = curve.edges[edges].T
    return np.asarray(values[first] + shares[:, None] * (values[last] - values[first]))


@dataclass(frozen=True, eq=False)
class Feet:
    """The places of a curve that are nearest to queries.

    Attributes
    ----------
    edges : (q,) int32
        The edge of each.
    shares : (q,) float64
        How far along the edge.
    distances : (q,) float64
        From the query to it, in the unit of the curve.
    """

    edges: Indices
    shares: Numbers
    distances: Numbers


def feet_on(curve: CurveGraph, queries: Points, longest: float) -> Feet:
    """Return the nearest place of a curve for each query.

    The edges of the parts nearest to a query are tried, and the distance to an
    edge is exact. Where more edges than are tried come near one place, the
    distance may be too long, by half a part at most.

    Parameters
    ----------
    curve : CurveGraph
        With an edge that has length, in any unit.
    queries : (q, 3) float64
        In the same unit.
    longest : float
        How long the parts may be, in the same unit.

    Returns
    -------
    Feet

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import CurveGraph
    >>> from tiskel.geometry.feet import feet_on
    >>> line = CurveGraph(np.array([[0.0, 0, 0], [1, 0, 0]]), np.array([[0, 1]], np.int32))
    >>> feet_on(line, np.array([[0.3, 0.4, 0], [4, 4, 0]]), 0.1).distances.tolist()
    [0.4, 5.0]
    """
    parts = parts_of(curve, longest)
    tree = cKDTree(parts.points)
    batches = [_feet(curve, queries[i : i + BATCH], parts, tree) for i in range(0, max(len(queries), 1), BATCH)]
    return Feet(*(np.concatenate(column) for column in zip(*batches, strict=True)))


def _feet(curve: CurveGraph, queries: Points, parts: Parts, tree: cKDTree) -> tuple[Indices, Numbers, Numbers]:
    near = tree.query(queries, k=[*range(1, min(CANDIDATES, len(parts.edges)) + 1)])[1]
    edges = parts.edges[near]
    start, axis = curve.nodes[curve.edges[:, 0]], curve.nodes[curve.edges[:, 1]] - curve.nodes[curve.edges[:, 0]]
    offset, along = queries[:, None] - start[edges], axis[edges]
    squares = np.maximum((along**2).sum(axis=2), TINY)
    shares = np.clip((offset * along).sum(axis=2) / squares, 0, 1)
    distances = np.linalg.norm(offset - shares[:, :, None] * along, axis=2)
    rows, best = np.arange(len(queries)), np.argmin(distances, axis=1)
    return edges[rows, best], shares[rows, best], distances[rows, best]
