"""The paths of a curve that surfaces are fitted along: its branches, or the longest way through it."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from tiskel.arrays import TINY, Indices, Points
from tiskel.errors import TiskelError
from tiskel.geometry.frames import step_lengths
from tiskel.geometry.graph import CurveGraph, component_labels

LEAST_NODES = 3  # fewer have no direction to follow


@dataclass(frozen=True, eq=False)
class Path:
    """A path along a curve.

    Attributes
    ----------
    name : str
        The number of its branch, or "longest".
    nodes : (k,) int32
        Its nodes in order; a closed path repeats its first.
    """

    name: str
    nodes: Indices

    @property
    def closed(self) -> bool:
        """Whether the path ends where it begins."""
        return len(self.nodes) > 1 and bool(self.nodes[0] == self.nodes[-1])


def paths_of(curve: CurveGraph, branch: str) -> tuple[Path, ...]:
    """Return the paths that a choice of branch names.

    A curve without edges is taken as one path in the order of its nodes.

    Parameters
    ----------
    curve : CurveGraph
        The curve.
    branch : str
        "all", "longest" or a number.

    Returns
    -------
    tuple of Path

    Raises
    ------
    TiskelError
        Where the curve has no nodes, or no branch of this number.

    Examples
    --------
    >>> from tiskel import shape_graph
    >>> from tiskel.slicing.paths import paths_of
    >>> [path.name for path in paths_of(shape_graph("y"), "all")]
    ['0', '1', '2']
    """
    if len(curve.nodes) == 0:
        raise TiskelError("the skeleton has no nodes; run tiskel skeleton again")
    if len(curve.edges) == 0 and len(curve.nodes) > 1:
        links = np.arange(len(curve.nodes), dtype=np.int32)
        curve = CurveGraph(curve.nodes, np.stack([links[:-1], links[1:]], axis=1))
    every = curve.branches
    if branch == "longest":
        return (Path("longest", longest_path(curve)),)
    if branch == "all":
        return tuple(Path(str(number), path) for number, path in enumerate(every))
    if int(branch) >= len(every):
        raise TiskelError(f"there is no branch {branch}; the skeleton has {len(every)}, from 0 to {len(every) - 1}")
    return (Path(branch, every[int(branch)]),)


def longest_path(curve: CurveGraph) -> Indices:
    """Return (k,) the nodes of the longest shortest way between two ends; of loops alone, the longest branch."""
    count, ends = len(curve.nodes), np.flatnonzero(curve.degrees == 1)
    if len(ends) < 2:
        return max(curve.branches, key=lambda path: _length(curve, path))
    lengths = np.maximum(curve.lengths, TINY)
    linked = sparse.coo_array((lengths, (curve.edges[:, 0], curve.edges[:, 1])), shape=(count, count)).tocsr()
    part = component_labels(count, curve.edges)
    distance, before = dijkstra(linked, directed=False, indices=ends, return_predecessors=True)
    far = np.where(part[ends][:, None] == part[ends][None, :], distance[:, ends], -1.0)
    start, stop = np.unravel_index(int(far.argmax()), far.shape)
    path = [int(ends[stop])]
    while path[-1] != ends[start]:
        path.append(int(before[start, path[-1]]))
    return np.array(path[::-1], np.int32)


def _length(curve: CurveGraph, path: Indices) -> float:
    return float(step_lengths(curve.nodes[path]).sum())


def dense(polyline: Points, step: float) -> Points:
    """Return places (m, 3) along a polyline (n, 3), no further apart than a step."""
    parts = [polyline[-1:]]
    for a, b in zip(polyline[:-1], polyline[1:], strict=True):
        share = np.linspace(0, 1, 1 + int(np.ceil(np.linalg.norm(b - a) / step)), endpoint=False)
        parts.append(a + share[:, None] * (b - a))
    return np.concatenate(parts)
