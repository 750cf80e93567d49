"""Triangles cut until their sides are short: the same surface, vertices shared as before."""

import numpy as np

from tiskel.arrays import Edges, Indices, Masks, Numbers, Pairs
from tiskel.geometry.mesh import TriangleMesh, pair_keys

ROUNDS = 24  # a side is halved in each
# Which triangles take the place of one, by which of its sides are cut: 0 to 2 are its corners, 3 to 5 the middles of
# the sides that begin at them. Bit i of the number: side i.
PATTERNS = {
    1: ((0, 3, 2), (3, 1, 2)),
    2: ((0, 1, 4), (0, 4, 2)),
    4: ((0, 1, 5), (5, 1, 2)),
    3: ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    6: ((4, 2, 5), (1, 4, 5), (0, 1, 5)),
    5: ((0, 3, 5), (3, 1, 5), (1, 2, 5)),
    7: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
}


def refined(mesh: TriangleMesh, longest: Numbers, most: int) -> tuple[TriangleMesh, Indices]:
    """Return a mesh whose sides are no longer than asked for, as far as a number of triangles allows.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh.
    longest : (m,) float64
        Of the sides of each triangle, in the unit of the mesh.
    most : int
        Triangles from which on nothing more is cut.

    Returns
    -------
    TriangleMesh
        With the same surface.
    source : (n,) int32
        The triangle of the given mesh that each lies on.
    """
    vertices, faces, source = mesh.vertices, mesh.faces, np.arange(len(mesh.faces), dtype=np.int32)
    for _ in range(ROUNDS):
        ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
        keys, edge = np.unique(pair_keys(ends, len(vertices)), return_inverse=True)
        edge = edge.reshape(-1, 3)
        pair = np.stack([keys // len(vertices), keys % len(vertices)], axis=1)
        limit = np.full(len(keys), np.inf)
        np.minimum.at(limit, edge, longest[source][:, None])
        cut = np.linalg.norm(vertices[pair[:, 0]] - vertices[pair[:, 1]], axis=1) > limit
        if not cut.any() or len(faces) >= most:
            break
        middle = np.full(len(keys), -1)
        middle[cut] = len(vertices) + np.arange(cut.sum())
        vertices = np.concatenate([vertices, vertices[pair[cut]].mean(axis=1)])
        faces, row = _split(np.concatenate([faces, middle[edge]], axis=1), cut[edge])
        source = source[row]
    return TriangleMesh(vertices, faces), source


def _split(corners: Pairs, cut: Masks) -> tuple[Edges, Indices]:
    """Return the triangles (n, 3) in the place of others, whose corners and middles are (m, 6), and whose they are."""
    pattern = cut @ [1, 2, 4]
    made, rows = [corners[pattern == 0, :3]], [np.flatnonzero(pattern == 0)]
    for number, triangles in PATTERNS.items():
        mine = np.flatnonzero(pattern == number)
        for triangle in triangles:
            made.append(corners[mine][:, triangle])
            rows.append(mine)
    return np.concatenate(made).astype(np.int32), np.concatenate(rows).astype(np.int32)
