"""Triangle meshes to PLY."""

from typing import Any

from tiskel.io import ply
from tiskel.slicing.body_mesh import BodyMesh
from tiskel.slicing.mesh import Mesh


def dump_mesh(mesh: Mesh, source: dict[str, str] | None = None) -> bytes:
    """Return a mesh as binary PLY: the same bytes for the same mesh.

    Parameters
    ----------
    mesh : Mesh
        Triangles, counter-clockwise seen from outside; their trust, where known, is a property of the vertices.
        Of a whole body, vertices have nx, ny, nz, curvature_min and curvature_max (1 / length), too.
    source : dict, optional
        Name and SHA-256 of the input.
    """
    faces: dict[str, Any] = {"vertex_indices": ply.ragged(list(mesh.triangles))}
    corners = ply.xyz(mesh.vertices) | _more(mesh)
    elements = [
        ply.element("vertex", corners),
        ply.element("face", faces, {"vertex_indices": ("u1", "i4")}),
    ]
    return ply.dump(elements, "mesh", {"source": source or {}})


def _more(mesh: Mesh) -> dict[str, Any]:
    """Return what else is known about the vertices."""
    trust = {} if mesh.trust is None else {"trust": mesh.trust}
    if not isinstance(mesh, BodyMesh):
        return trust
    bends = {"curvature_min": mesh.curvatures[:, 0], "curvature_max": mesh.curvatures[:, 1]}
    return ply.xyz(mesh.normals, ("nx", "ny", "nz")) | bends | trust
