"""Spurs: end branches that hardly leave what they grow from, as noise about a limb makes them."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices
from tiskel.geometry.frames import step_lengths
from tiskel.methods.robust.curve import ConeCurve, contract_nodes

SPUR = 2.0  # radii of its joint that an end branch is long at least [by trial on noisy trees: 1 finds 5 % more tips,
# and of its tips 8 % fewer are real]
SPARSE = 2.0  # standard deviations, of the number of points that its length has elsewhere, that it has fewer
SHORT = 4.5  # spacings: longer ones are no noise, however few their points are [of noisy trees 6 finds 4 % fewer tips,
# and of its tips 1 % more are real; 2 finds 3 % more, and 3 % fewer of its tips are]
# Strands of one limb run beside each other, twigs part.
STRANDS = 3.0  # spacings from strand to strand at most
CROWDED = 2.0  # points to a spacing of length, from which on limbs may be strands [threads 1.3 to 1.9, tubes from 2.0]
PARTS = 0.4  # of its length that the end of a twig is from all other limbs, at least


def without_spurs(curve: ConeCurve, spacing: float, crowding: float, few: float = 0.0) -> ConeCurve:
    """Contract the end branches that are noise, the shortest of each joint first.

    They are short against the radius of their joint, or stay within so much of
    the limbs beside them, or are strands. Where limbs have crowding points to a
    spacing of their length, so do their ends: a short branch of few points is
    noise, too; of a crowding below few, ends have one or two points, and are
    not asked for more.
    """
    strand = STRANDS * spacing if crowding >= CROWDED else 0.0
    while True:
        shortest: dict[int, tuple[float, int]] = {}
        paths = curve.paths_from(ends=True)
        tree, points = cKDTree(curve.nodes), curve.point_counts
        for number, path in enumerate(paths):
            joint = int(path[-1])
            if curve.degrees[joint] > 2:
                length = float(step_lengths(curve.nodes[path]).sum())
                expected = crowding * length / spacing if crowding >= few else 0.0
                noise = float(points[path[:-1]].sum()) < expected - SPARSE * np.sqrt(expected)
                least = max(SPUR * float(curve.radii[joint]), SHORT * spacing if noise else 0.0)
                if length < least or _beside(curve, tree, path, strand, PARTS * length):
                    shortest[joint] = min(shortest.get(joint, (np.inf, 0)), (length, number))
        if not shortest:
            return curve
        into = np.arange(len(curve.nodes), dtype=np.int32)
        for joint, (_, number) in shortest.items():
            into[paths[number][:-1]] = joint
        curve = contract_nodes(curve, into)


def _beside(curve: ConeCurve, tree: cKDTree, path: Indices, close: float, parted: float) -> bool:
    """Tell whether an end branch runs within the reach of nodes that are not on it, or beside them all its length.

    It does so where it is close to them everywhere, and has not parted from them at its end.
    """
    own = path[:-1]
    distance, near = tree.query(curve.nodes[own], k=min(len(own) + 1, len(curve.nodes)))
    other = ~np.isin(near, own)
    nearest = np.where(other, distance, np.inf).argmin(axis=1)
    rows = np.arange(len(own))
    away = distance[rows, nearest]
    strand = away[0] < parted and (away <= close).all()
    return bool(strand or (away <= SPUR * curve.radii[near[rows, nearest]]).all())
