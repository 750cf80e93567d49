"""Triangle meshes to files of other programs: PLY, OBJ, STL, GLB, OFF, as the suffix says; and from them."""

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.io import ply
from tiskel.io.formats import format_of
from tiskel.io.limits import unpacked
from tiskel.io.streams import STANDARD
from tiskel.slicing.body_mesh import BodyMesh
from tiskel.slicing.mesh import Mesh
from tiskel.version import version

FLOATS, WHOLE, CORNERS, VERTICES = 5126, 5125, 34963, 34962  #: numbers of glTF 2.0 for types and uses of buffers


def dump_mesh(mesh: Mesh, source: dict[str, str] | None = None) -> bytes:
    """Return a mesh as binary PLY: the same bytes for the same mesh.

    Parameters
    ----------
    mesh : Mesh
        Triangles, counter-clockwise seen from outside; trust and further fields are properties of the vertices.
        Of a whole body, vertices have nx, ny, nz, curvature_min and curvature_max (1 / length), too. All of it but
        normals also under the names that CloudCompare and MeshLab know, see :func:`tiskel.io.ply.scalars`.
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
    trust: dict[str, npt.NDArray[Any]] = {} if mesh.trust is None else {"trust": mesh.trust}
    if not isinstance(mesh, BodyMesh):
        fields = {**mesh.fields, **trust}
        return fields | ply.scalars(fields, "trust")
    known: dict[str, npt.NDArray[Any]] = {
        "curvature_min": mesh.curvatures[:, 0],
        "curvature_max": mesh.curvatures[:, 1],
        **trust,
    }
    return ply.xyz(mesh.normals, ("nx", "ny", "nz")) | known | ply.scalars(known, "trust")


def mesh_bytes(mesh: Mesh, target: str | Path, source: dict[str, str] | None = None) -> bytes:
    """Return a mesh in the format that the suffix of a file names; PLY for standard output.

    Raises
    ------
    TiskelError
        For an unknown suffix.
    """
    kind = mesh_kind(target)
    return dump_mesh(mesh, source) if kind == ".ply" else WRITERS[kind](mesh)


def mesh_kind(target: str | Path) -> str:
    """Return the suffix of a file for a mesh; raise TiskelError for an unknown one."""
    path = Path(target)
    if str(target) == STANDARD or (path.exists() and not path.is_file()):
        return ".ply"
    kind = path.suffix.lower()
    if kind != ".ply" and kind not in WRITERS:
        raise TiskelError(
            f"a mesh cannot be written as {kind or path.name!r}; choose one of .ply, {', '.join(WRITERS)}"
        )
    return kind


def to_obj(mesh: Mesh) -> bytes:
    """Return OBJ: vertices and triangles."""
    rows = [f"# tiskel {version()} mesh", *(f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist())]
    rows += [f"f {a} {b} {c}" for a, b, c in (mesh.triangles + 1).tolist()]
    return ("\n".join(rows) + "\n").encode()


def to_stl(mesh: Mesh) -> bytes:
    """Return binary STL, whose numbers are single precision."""
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    facets = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("remark", "<u2")])
    facets["normal"], facets["corners"] = normals / np.where(size > 0, size, 1), corners
    return f"tiskel {version()} mesh".encode().ljust(80) + struct.pack("<I", len(facets)) + facets.tobytes()


def to_off(mesh: Mesh) -> bytes:
    """Return OFF: vertices and triangles."""
    rows = ["OFF", f"{len(mesh.vertices)} {len(mesh.triangles)} 0"]
    rows += [f"{x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    rows += [f"3 {a} {b} {c}" for a, b, c in mesh.triangles.tolist()]
    return ("\n".join(rows) + "\n").encode()


def to_glb(mesh: Mesh) -> bytes:
    """Return binary glTF 2.0: single precision about the middle of the mesh, which the node is moved to."""
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    places, corners = (mesh.vertices - middle).astype("<f4"), mesh.triangles.astype("<u4")
    body = places.tobytes() + corners.tobytes()
    document = {
        "asset": {"version": "2.0", "generator": f"tiskel {version()}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": middle.tolist()}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": FLOATS, "count": len(places), "type": "VEC3",
             "min": places.min(axis=0).tolist(), "max": places.max(axis=0).tolist()},
            {"bufferView": 1, "componentType": WHOLE, "count": corners.size, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": places.nbytes, "target": VERTICES},
            {"buffer": 0, "byteOffset": places.nbytes, "byteLength": corners.nbytes, "target": CORNERS},
        ],
        "buffers": [{"byteLength": len(body)}],
    }  # fmt: skip
    head = json.dumps(document).encode()
    head += b" " * (-len(head) % 4)
    parts = struct.pack("<I4s", len(head), b"JSON") + head + struct.pack("<I4s", len(body), b"BIN\0") + body
    return bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts)


WRITERS: dict[str, Callable[[Mesh], bytes]] = {".obj": to_obj, ".stl": to_stl, ".glb": to_glb, ".off": to_off}
MESHES = (".ply", *WRITERS)  #: suffixes of files that meshes are written to


def parse_mesh(data: bytes, source: str | Path) -> Mesh | None:
    """Return the mesh in the bytes of a file, polygons as triangles; None where it has no faces.

    Raises
    ------
    TiskelError
        Where the file is damaged or of an unknown kind.
    """
    name = "stdin" if str(source) == STANDARD else Path(source).name
    plain, inner = unpacked(data, name)
    found = format_of(inner, plain, by_content=str(source) == STANDARD).parse(plain, name)
    return Mesh(found.points, found.faces) if len(found.faces) else None
