"""Triangle meshes to PLY."""

from typing import Any

from tiskel.io import ply
from tiskel.slicing.mesh import Mesh


def dump_mesh(mesh: Mesh, source: dict[str, str] | None = None) -> bytes:
    """Return a mesh as binary PLY: the same bytes for the same mesh.

    Parameters
    ----------
    mesh : Mesh
        Triangles, counter-clockwise seen from outside; their trust, where known, is a property of the vertices.
    source : dict, optional
        Name and SHA-256 of the input.
    """
    faces: dict[str, Any] = {"vertex_indices": ply.ragged(list(mesh.triangles))}
    corners = ply.xyz(mesh.vertices) | ({} if mesh.trust is None else {"trust": mesh.trust})
    elements = [
        ply.element("vertex", corners),
        ply.element("face", faces, {"vertex_indices": ("u1", "i4")}),
    ]
    return ply.dump(elements, "mesh", {"source": source or {}})
