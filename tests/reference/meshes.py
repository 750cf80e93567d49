"""Meshes whose parts, rims and handles are known, and OFF files of them."""

from pathlib import Path

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Mask, Points

Mesh = tuple[Points, Edges]


def torus(large: float = 1.0, small: float = 0.25, around: int = 64, across: int = 24) -> Mesh:
    """A torus, one handle."""
    u, v = np.meshgrid(*(np.arange(n) / n * 2 * np.pi for n in (around, across)), indexing="ij")
    out = large + small * np.cos(v)
    points = np.stack([out * np.cos(u), out * np.sin(u), small * np.sin(v)], axis=-1).reshape(-1, 3)
    here = np.arange(around * across).reshape(around, across)
    return points, quads(here, np.roll(here, -1, 0), np.roll(here, (-1, -1), (0, 1)), np.roll(here, -1, 1))


def tube(start: npt.ArrayLike, stop: npt.ArrayLike, radius: float, sides: int = 32, *, caps: bool = True) -> Mesh:
    """A straight tube of long quads, closed or open at both ends."""
    p, q = np.array(start, float), np.array(stop, float)
    way = (q - p) / np.linalg.norm(q - p)
    x = np.cross(way, np.eye(3)[np.abs(way).argmin()])
    x /= np.linalg.norm(x)
    turn = np.arange(sides)[:, None] / sides * 2 * np.pi
    ring = radius * (np.cos(turn) * x + np.sin(turn) * np.cross(way, x))
    here = np.arange(2 * sides).reshape(2, sides)
    after = np.roll(here, -1, axis=1)
    side = quads(here[0], after[0], after[1], here[1])
    if not caps:
        return np.concatenate([p + ring, q + ring]), side
    low = np.stack([np.full(sides, 2 * sides), after[0], here[0]], axis=1)
    high = np.stack([np.full(sides, 2 * sides + 1), here[1], after[1]], axis=1)
    return np.concatenate([p + ring, q + ring, [p], [q]]), np.concatenate([side, low, high]).astype(np.int32)


def boxes(cells: npt.NDArray[np.bool_]) -> Mesh:
    """The surface of a union of unit cubes, four corners of its own for every side, as a file of facets has them."""
    solid, corners = np.pad(cells, 1), []
    for axis in range(3):
        one, other = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        for sign in (1, -1):
            at = np.argwhere(solid & ~np.roll(solid, -sign, axis)) + (sign > 0) * np.eye(3, dtype=int)[axis]
            square = np.stack([at, at + one, at + one + other, at + other], axis=1)
            corners.append(square if sign > 0 else square[:, ::-1])
    every = np.concatenate(corners)
    return every.reshape(-1, 3).astype(float), quads(*np.arange(4 * len(every)).reshape(-1, 4).T)


def block(holes: int, width: int = 5) -> Mesh:
    """A flat block with so many square holes right through it, each a handle."""
    cells = np.ones((width * holes + 2, width + 2, 2), bool)
    for number in range(holes):
        cells[width * number + 2 : width * number + width, 2:width] = False
    return boxes(cells)


def joined(*meshes: Mesh) -> Mesh:
    """All of them in one."""
    starts = np.cumsum([0, *(len(points) for points, _ in meshes)])
    faces = [faces + start for (_, faces), start in zip(meshes, starts, strict=False)]
    return np.concatenate([points for points, _ in meshes]), np.concatenate(faces).astype(np.int32)


def soup(mesh: Mesh) -> Mesh:
    """The same with corners of its own for every triangle."""
    points, faces = mesh
    return points[faces].reshape(-1, 3), np.arange(3 * len(faces), dtype=np.int32).reshape(-1, 3)


def without(mesh: Mesh, faces: Mask) -> Mesh:
    """A mesh without some of its triangles."""
    return mesh[0], mesh[1][~faces]


def quads(*corners: npt.NDArray[np.integer]) -> Edges:
    """Two triangles for each of the quads, whose corners are given one after the other."""
    a, b, c, d = (corner.ravel() for corner in corners)
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]).astype(np.int32)


def write_off(path: Path, mesh: Mesh) -> None:
    """Write a mesh."""
    points, faces = mesh
    rows = [" ".join(map(repr, point)) for point in points.tolist()]
    rows += [" ".join(map(str, [3, *face])) for face in faces.tolist()]
    path.write_text("\n".join(["OFF", f"{len(points)} {len(faces)} 0", *rows, ""]))
