"""What a mesh is, counted: parts, where it is open, handles."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from tiskel.arrays import Indices
from tiskel.geometry.distinct import distinct
from tiskel.geometry.mesh import TriangleMesh


@dataclass(frozen=True)
class MeshFacts:
    """Counts of a mesh.

    Attributes
    ----------
    vertices : int
        Places of corners.
    faces : int
        Triangles that have an area.
    components : int
        Parts; triangles that share a vertex hang together.
    boundary_loops : int
        Rims where the surface ends.
    crowded : int
        Sides of triangles where more than two meet.
    agreeing : bool
        Whether neighbours have the same side out.
    genus : tuple of int
        Handles of each part, largest part first; rims count as if they were capped.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.mesh import welded
    >>> from tiskel.geometry.mesh_facts import facts_of
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> tetrahedron = welded(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32))
    >>> print(facts_of(tetrahedron))
    4 vertices, 4 faces, 1 component, genus 0, watertight
    """

    vertices: int
    faces: int
    components: int
    boundary_loops: int
    crowded: int
    agreeing: bool
    genus: tuple[int, ...]

    @property
    def watertight(self) -> bool:
        """Whether there is an inside: no rim, never more than two triangles at an edge, the same side out."""
        return self.faces > 0 and self.boundary_loops == 0 and self.crowded == 0 and self.agreeing

    @property
    def handles(self) -> int:
        """All handles; the solid inside a watertight mesh has as many, hollows included."""
        return sum(self.genus)

    def __str__(self) -> str:
        parts = "1 component" if self.components == 1 else f"{self.components} components"
        rims = "1 open rim" if self.boundary_loops == 1 else f"{self.boundary_loops} open rims"
        wrong = [
            rims if self.boundary_loops else "",
            f"{self.crowded} sides where more than two faces meet" if self.crowded else "",
            "" if self.agreeing else "faces disagree on which side is out",
        ]
        state = "watertight" if self.watertight else ", ".join(filter(None, wrong)) or "empty"
        return f"{self.vertices} vertices, {self.faces} faces, {parts}, genus {self.handles}, {state}"

    def as_dict(self) -> dict[str, Any]:
        """Return plain values, for JSON."""
        return {
            "vertices": self.vertices,
            "faces": self.faces,
            "components": self.components,
            "boundary_loops": self.boundary_loops,
            "genus": list(self.genus),
            "handles": self.handles,
            "watertight": self.watertight,
        }


def facts_of(mesh: TriangleMesh) -> MeshFacts:
    """Return the counts of a mesh."""
    halves, faces = mesh.halves, mesh.faces
    if len(faces) == 0:
        return MeshFacts(0, 0, 0, 0, 0, True, ())
    # Corners are one where triangles meet along a side: then every piece is a surface, whatever else touches it.
    start, stop = np.arange(3 * len(faces)), np.arange(3 * len(faces)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    one, other = halves.meeting.T
    to_start = np.where(halves.opposite, stop[other], start[other])
    to_stop = np.where(halves.opposite, start[other], stop[other])
    corner = _labels(np.concatenate([start[one], stop[one]]), np.concatenate([to_start, to_stop]), len(start))
    piece = _labels(one // 3, other // 3, len(faces))
    # Rims: free sides that share a corner.
    free = halves.free
    rim = _labels(np.repeat(free, 2), 3 * len(faces) + np.stack([corner[free], corner[stop[free]]], axis=1).ravel(),
                  3 * len(faces) + int(corner.max()) + 1)[free]  # fmt: skip
    pieces = int(piece.max()) + 1
    vertices = np.bincount(piece[np.unique(corner, return_index=True)[1] // 3], minlength=pieces)
    edges = np.bincount(piece[one // 3], minlength=pieces) + np.bincount(piece[free // 3], minlength=pieces)
    rims = np.bincount(piece[free[np.unique(rim, return_index=True)[1]] // 3], minlength=pieces)
    genus = np.maximum(2 - rims - (vertices - edges + np.bincount(piece, minlength=pieces)), 0) // 2
    part_of_piece = mesh.part[np.unique(piece, return_index=True)[1]]
    per_part = np.bincount(part_of_piece, genus).astype(int)
    order = np.argsort(-np.bincount(mesh.part, mesh.areas), kind="stable")
    return MeshFacts(
        len(distinct(faces)), len(faces), len(per_part), int(rims.sum()), halves.crowded,
        bool(halves.opposite.all()), tuple(per_part[order].tolist()),
    )  # fmt: skip


def _labels(first: Indices, second: Indices, count: int) -> Indices:
    links = sparse.coo_array((np.ones(len(first), bool), (first, second)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], np.int32)
