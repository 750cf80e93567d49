"""Triangle meshes to PLY."""

from typing import Any

from tiskel.io import ply
from tiskel.slicing.mesh import Mesh


def dump_mesh(mesh: Mesh, source: dict[str, str] | None = None) -> bytes:
    """Return a binary PLY file, triangles counter-clockwise seen from outside: the same bytes for the same mesh."""
    faces: dict[str, Any] = {"vertex_indices": ply.ragged(list(mesh.triangles))}
    elements = [
        ply.element("vertex", ply.xyz(mesh.vertices)),
        ply.element("face", faces, {"vertex_indices": ("u1", "i4")}),
    ]
    return ply.dump(elements, "mesh", {"source": source or {}})
