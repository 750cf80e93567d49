"""More shapes: bodies with branches, furniture, and what is knotted or linked."""

import numpy as np

from tiskel.gallery.strands import Strand, from_strands
from tiskel.geometry.round_cones import ConeGraph

TREE_LEVELS, TREE_AROUND = 10, 3  # whorls of branches on the trunk, and branches in each


def duck() -> ConeGraph:
    """A thick body with a neck, a head and a beak, and a short tail."""
    spine = [(-0.7, 0, 0.1), (-0.3, 0, 0), (0.15, 0, 0), (0.38, 0, 0.38), (0.42, 0, 0.62), (0.8, 0, 0.58)]
    return from_strands([(spine, (0.07, 0.3, 0.33, 0.14, 0.2, 0.06))])


def dog() -> ConeGraph:
    """A body with four legs, a tail, a neck, and a head with a muzzle and two ears."""
    hips, chest, head = (-0.5, 0.0, 0.0), (0.5, 0.0, 0.0), (0.85, 0.0, 0.5)
    legs: list[Strand] = [
        ([(x, 0, 0), (x, y, -0.25), (x, y, -0.9)], (0.22, 0.12, 0.07)) for x in (-0.5, 0.5) for y in (-0.24, 0.24)
    ]
    ears: list[Strand] = [([head, (0.75, y, 0.88)], (0.15, 0.05)) for y in (-0.22, 0.22)]
    tail = [hips, (-0.8, 0, 0.15), (-1.15, 0, 0.5)]
    face = [head, (1.25, 0, 0.42)]
    trunk: list[Strand] = [([hips, chest], 0.22), ([chest, head], (0.22, 0.15)), (face, (0.15, 0.08))]
    return from_strands([*trunk, (tail, (0.2, 0.08, 0.05)), *legs, *ears])


def starfish() -> ConeGraph:
    """A thick middle with six branches, two of them up and down."""
    turn = 2 * np.pi * np.arange(4) / 4
    sides = [*np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), np.array([0, 0, 1.0]), np.array([0, 0, -1.0])]
    return from_strands([([0.0 * u, 0.42 * u, 1.1 * u], (0.4, 0.14, 0.07)) for u in sides])


def tree() -> ConeGraph:
    """A trunk with thirty branches, 8:1 in thickness."""
    heights = np.linspace(0.5, 2.3, TREE_LEVELS)
    radii = np.linspace(0.28, 0.1, TREE_LEVELS)
    axis = np.stack([0 * heights, 0 * heights, heights], axis=1)
    trunk: Strand = (np.vstack([(0, 0, 0), axis, (0, 0, 2.6)]), np.concatenate([[0.32], radii, [0.05]]))
    branches: list[Strand] = []
    for level, (base, radius) in enumerate(zip(axis, radii, strict=True)):
        for number in range(TREE_AROUND):
            turn = 2 * np.pi * (number + 0.5 * (level % 2)) / TREE_AROUND
            out = np.array([np.cos(turn), np.sin(turn), 0.5])
            start, tip = base + out * radius, base + out * (radius + 0.45)
            branches.append(([base, start, tip], (radius, 0.055, 0.04)))
    return from_strands([trunk, *branches])


def ladder() -> ConeGraph:
    """Two rails and five rungs: four loops, four ends."""
    heights = [-1.0, -0.8, -0.4, 0.0, 0.4, 0.8, 1.0]
    rails: list[Strand] = [([(x, 0, z) for z in heights], 0.07) for x in (-0.35, 0.35)]
    return from_strands([*rails, *(([(-0.35, 0, z), (0.35, 0, z)], 0.05) for z in heights[1:-1])])


def chair() -> ConeGraph:
    """Four legs under a frame, and a back of two posts and a bar: two loops, four ends."""
    corners = [(-0.4, -0.4, 0.0), (0.4, -0.4, 0.0), (0.4, 0.4, 0.0), (-0.4, 0.4, 0.0)]
    frame: Strand = ([*corners, corners[0]], 0.08)
    legs: list[Strand] = [([c, (c[0], c[1], -0.75)], (0.08, 0.06)) for c in corners]
    back: Strand = ([corners[2], (0.45, 0.45, 0.8), (-0.45, 0.45, 0.8), corners[3]], 0.07)
    return from_strands([frame, *legs, back])


def knot() -> ConeGraph:
    """A trefoil: one loop that cannot be undone."""
    turn = 2 * np.pi * np.arange(97) / 96
    x = np.sin(turn) + 2 * np.sin(2 * turn)
    y = np.cos(turn) - 2 * np.cos(2 * turn)
    curve = np.stack([x, y, -1.4 * np.sin(3 * turn)], axis=1) / 2.5
    curve[-1] = curve[0]
    return from_strands([(curve, 0.14)])


def links() -> ConeGraph:
    """Two rings through each other: two components, two loops."""
    turn = 2 * np.pi * np.arange(65) / 64
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * 0.6
    ring[-1] = ring[0]
    return from_strands([(ring - [0.3, 0, 0], 0.12), (ring[:, [0, 2, 1]] + [0.3, 0, 0], 0.12)])


def fork() -> ConeGraph:
    """A handle, a neck and four tines on a bar."""
    across = (-0.3, -0.1, 0.1, 0.3)
    tines: list[Strand] = [([(x, 0, 0.3), (x, 0, 0.95)], (0.06, 0.04)) for x in across]
    bar: Strand = ([(-0.3, 0, 0.3), (-0.1, 0, 0.3), (0, 0, 0.3), (0.1, 0, 0.3), (0.3, 0, 0.3)], 0.06)
    return from_strands([([(0, 0, -1.1), (0, 0, -0.1), (0, 0, 0.3)], (0.1, 0.06, 0.07)), bar, *tines])
