"""Pieces of a crown: where patches of the scan are missing, what they cut off is joined to the rest again.

Ends at a missing patch of a crown do not face each other as the two halves of a
pipe do: forks are missing with it. A body of many ends whose pieces are close
together is one tree all the same, and its pieces are joined by the shortest ways,
which are bridges.
"""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Mask
from tiskel.geometry.graph import component_labels
from tiskel.methods.robust.curve import ConeCurve, with_nodes
from tiskel.methods.robust.wire.links import WIDEST

CROWN = 8  # ends of the largest piece, from which on it is a crown; two pipes side by side are none


def joined_pieces(curve: ConeCurve) -> ConeCurve:
    """Return the curve with pieces that are near its crown joined to it, each by an edge from one of its ends."""
    while True:
        piece = component_labels(len(curve.nodes), curve.edges)
        sizes = np.bincount(piece, minlength=1)
        largest = piece == sizes.argmax()
        if len(sizes) < 2 or (curve.degrees[largest] == 1).sum() < CROWN:
            return curve
        widest = WIDEST * float(np.linalg.norm(np.ptp(curve.nodes[largest], axis=0)))
        link = _shortest(curve, largest, widest)
        if link is None:
            return curve
        none = np.zeros((0, 3))
        curve = with_nodes(curve, none, none[:, 0], np.array([link], np.int32), np.zeros(0, np.int32), bridge=True)


def _shortest(curve: ConeCurve, largest: Mask, widest: float) -> tuple[int, int] | None:
    """Return the shortest way from an end of another piece to the largest one, None where all are wider."""
    ends = np.flatnonzero(~largest & (curve.degrees <= 1))
    rest = np.flatnonzero(largest)
    if not len(ends):
        return None
    away, nearest = cKDTree(curve.nodes[rest]).query(curve.nodes[ends])
    gap = away - curve.radii[ends] - curve.radii[rest[nearest]]
    first = int(gap.argmin())
    return (int(ends[first]), int(rest[nearest[first]])) if gap[first] <= widest else None
