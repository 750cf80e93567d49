"""Polylines with radii, joined into graphs of round cones."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers
from tiskel.geometry.round_cones import ConeGraph

Strand = tuple[npt.ArrayLike, npt.ArrayLike]  # positions (m, 3) along a strand, radii (m,) or one radius

JOIN = 1e-9  # strand points closer than this are one node


def from_strands(strands: Iterable[Strand], *, open_ends: bool = False) -> ConeGraph:
    """Join polylines into one graph; nodes at the same place become one, with the larger radius.

    Parameters
    ----------
    strands : iterable of (positions, radii)
        Positions (m, 3) along each polyline, and its radii (m,) or one radius, in the same unit.
    open_ends : bool
        Whether the first and the last node leave no ball, so that the tube is open there.

    Returns
    -------
    ConeGraph

    Examples
    --------
    >>> from tiskel.gallery.strands import from_strands
    >>> cross = from_strands([([(-1, 0, 0), (0, 0, 0), (1, 0, 0)], 0.2), ([(0, 0, 0), (0, 1, 0)], (0.3, 0.1))])
    >>> cross.radii.tolist()
    [0.2, 0.3, 0.2, 0.1]
    """
    nodes: list[Numbers] = []
    radii: list[float] = []
    edges: list[tuple[int, int]] = []
    for positions, given in strands:
        line = np.asarray(positions, dtype=float)
        names = [_node(nodes, radii, p, r) for p, r in zip(line, np.broadcast_to(given, len(line)), strict=True)]
        edges += [(min(a, b), max(a, b)) for a, b in pairwise(names)]
    opened = (0, len(nodes) - 1) if open_ends else ()
    return ConeGraph(np.array(nodes), np.array(edges, np.int32), np.array(radii), open_ends=opened)


def _node(nodes: list[Numbers], radii: list[float], position: Numbers, radius: float) -> int:
    for i, node in enumerate(nodes):
        if np.linalg.norm(node - position) < JOIN:
            radii[i] = max(radii[i], float(radius))
            return i
    nodes.append(position)
    radii.append(float(radius))
    return len(nodes) - 1
