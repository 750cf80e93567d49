"""The branches of a skeleton as a table."""

from collections.abc import Iterator

import numpy as np

from tiskel.geometry.radius import RadiusSource
from tiskel.skeleton import Skeleton

MOST = 200  # rows; longer tables are for files
HEAD = ("branch", "from", "to", "length", "radius: median", "least", "largest", "nodes", "points", "radius measured")


def branch_rows(s: Skeleton) -> Iterator[tuple[object, ...]]:
    """Yield a row for each of the longest branches: how it begins and ends, length, radii, how much is known of them.

    Parameters
    ----------
    s : Skeleton
        The skeleton; lengths are in its unit.
    """
    points = np.bincount(s.branch_of_node()[s.node_of_point[s.node_of_point >= 0]] + 1, minlength=len(s.branches) + 1)
    lengths = [float(np.linalg.norm(np.diff(s.nodes[branch], axis=0), axis=1).sum()) for branch in s.branches]
    for number in sorted(range(len(s.branches)), key=lambda one: -lengths[one])[:MOST]:
        branch = s.branches[number]
        radii = s.radii[branch]
        known = radii[np.isfinite(radii) & (radii > 0)]
        sizes = (float(np.median(known)), float(known.min()), float(known.max())) if len(known) else (None,) * 3
        sure = float((s.radius_sources[branch] == RadiusSource.MEASURED).mean())
        ends = (_kind(int(s.degrees[branch[0]])), _kind(int(s.degrees[branch[-1]])))
        yield (number, *ends, lengths[number], *sizes, len(branch), int(points[number + 1]), f"{sure:.0%}")


def _kind(degree: int) -> str:
    return "end" if degree == 1 else "joint" if degree > 2 else "itself" if degree == 2 else "alone"
