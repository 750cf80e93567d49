"""Limbs: from the tree of sections, the longest way first, what stands apart from what is there already.

A way to the root runs beside an earlier one where two limbs have not parted yet,
or where both are strands of one thick limb. What of a way has no section of an
earlier limb within reach is a limb of its own.
"""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Indices, Mask, Pairs
from tiskel.methods.robust.wire.levels import Levels

# Found by trial on generated trees.
LEAST = 1.0  # spacings that a limb stands apart at least: less finds no more tips, more misses some
DIGITS = 6  # of lengths in spacings that count: of ways as long as each other rounding must not say which is longer
BESIDE = 0.4  # share of what is left of a way that runs beside earlier limbs, from where on it is theirs


@dataclass(frozen=True, eq=False)
class Limbs:
    """The limbs, as edges between sections.

    Attributes
    ----------
    edges : (e, 2) int32
        Pairs of sections, the one further from the root first.
    bridged : (e,) bool
        Which of them lead over a gap.
    owner : (s,) int32
        For every section the one on a limb that stands for it.
    """

    edges: Pairs
    bridged: Mask
    owner: Indices


def limbs_of(levels: Levels, spacing: float) -> Limbs:
    """Return the limbs; spacing is that of the points."""
    owner = np.full(len(levels.centres), -1, np.int32)
    roots = np.flatnonzero(levels.parents < 0)
    owner[roots] = roots
    step = np.linalg.norm(levels.centres - levels.centres[levels.parents], axis=1) / spacing
    edges: list[tuple[int, int]] = []
    bridged: list[bool] = []
    for tip in _longest_first(levels, spacing).tolist():
        if owner[tip] >= 0:
            continue
        way = [tip]
        while owner[way[-1]] < 0:
            way.append(int(levels.parents[way[-1]]))
        base = int(owner[way.pop()])
        neighbours = [_beside(levels, owner, section) for section in way]
        own = _own(np.array(neighbours) >= 0, step[way])
        joint = base if own == len(way) else neighbours[own]
        if step[way[:own]].sum() > LEAST:
            chain = [*way[:own], joint]
            edges += list(zip(chain[:-1], chain[1:], strict=True))
            bridged += [bool(levels.bridged[section]) for section in way[:own]]
            owner[way[:own]] = way[:own]
            rest, last = list(zip(way[own:], neighbours[own:], strict=True)), base
        else:
            rest, last = list(zip(way, neighbours, strict=True)), base
        for section, neighbour in rest[::-1]:
            last = neighbour if neighbour >= 0 else last
            owner[section] = last
    return Limbs(np.array(edges, np.int32).reshape(-1, 2), np.array(bridged, bool), owner)


def _longest_first(levels: Levels, spacing: float) -> Indices:
    """Return the sections by the length of their ways; of ways as long as each other those further out first."""
    out = np.linalg.norm(levels.centres - levels.centres.mean(axis=0), axis=1) / spacing
    return np.lexsort((-np.round(out, DIGITS), -np.round(levels.tops, DIGITS))).astype(np.int32)


def crowding(levels: Levels, limbs: Limbs, spacing: float) -> float:
    """Return how many points there are to a spacing of the length of the limbs, in the median of their sections.

    On a thread it is about 1, on a tube of the radius r about 2 pi r in spacings:
    this is how thick the limbs are, whatever noise makes of their distances.
    """
    count = len(levels.centres)
    step = np.linalg.norm(np.diff(levels.centres[limbs.edges], axis=1)[:, 0], axis=1) / spacing
    length = np.bincount(limbs.edges.ravel(), np.repeat(step, 2) / 2, minlength=count)
    points = np.bincount(limbs.owner[levels.section[levels.section >= 0]], minlength=count)
    on = length > 0
    return float(np.median(points[on] / length[on])) if on.any() else 0.0


def _beside(levels: Levels, owner: Indices, section: int) -> int:
    """Return the nearest section on a limb that is within reach of a section or stands for one that is; -1 for none."""
    found = sorted({int(owner[other]) for other in levels.beside[section] if owner[other] >= 0})
    if len(found) < 2:
        return found[0] if found else -1
    away = ((levels.centres[found] - levels.centres[section]) ** 2).sum(axis=1)
    return found[int(away.argmin())]


def _own(linked: Mask, step: np.ndarray[tuple[int], np.dtype[np.float64]]) -> int:
    """Return how many sections of a way, from its tip on, are its own: the rest runs beside earlier limbs.

    The rest begins beside one, and enough of it runs so; a chance contact
    nearer to the tip does not end the limb.
    """
    if not linked.any():
        return len(linked)
    left = np.cumsum(step[::-1])[::-1]
    beside = np.cumsum((linked * step)[::-1])[::-1]
    ends = np.flatnonzero(linked & (beside >= BESIDE * left))
    return int(ends[0]) if len(ends) else len(linked)
