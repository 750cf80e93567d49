"""Clouds from files of many formats, or from standard input."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Points
from tiskel.errors import TiskelError
from tiskel.geometry.mesh import sample_mesh
from tiskel.io import open3d_formats, ply, text
from tiskel.io.streams import STANDARD, read_bytes

TEXT_FORMATS = (".xyz", ".pts", ".csv", ".txt")
MESH_SAMPLES = 4096  #: points that a mesh is sampled to where no number is asked for


@dataclass(frozen=True)
class Cloud:
    """A point cloud as it was read.

    Attributes
    ----------
    points : (n, 3) float64, in the file's units; rows may be NaN or Inf.
    properties : further columns of the file by name, (n,) each.
    name : file name without folders; "stdin" for standard input.
    sha256 : of the file.
    warnings : what happened on the way in.
    """

    points: Points
    properties: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    name: str = ""
    sha256: str = ""
    warnings: tuple[str, ...] = ()

    @property
    def source(self) -> dict[str, str]:
        """What a stage file records of its input: a name and a hash, no path and no time."""
        return {"name": self.name, "sha256": self.sha256}


def load_cloud(source: str | Path, *, mesh_samples: int | None = None, seed: int = 0) -> Cloud:
    """Read a cloud; a mesh is sampled to points.

    Parameters
    ----------
    source : a path (PLY, XYZ, PTS, CSV, TXT, NPY, NPZ; OFF, OBJ, STL, PCD through Open3D), or "-" for standard
        input, where PLY, NPY and text tell themselves apart.
    mesh_samples : points to sample a mesh to; None: 4096.
    seed : of that sampling.

    Raises TiskelError where the file is missing, damaged, empty or of an unknown kind.
    """
    return parse_cloud(read_bytes(source), source, mesh_samples=mesh_samples, seed=seed)


def parse_cloud(data: bytes, source: str | Path, *, mesh_samples: int | None = None, seed: int = 0) -> Cloud:
    """Return the cloud in bytes that were read from a source; see :func:`load_cloud`."""
    name = "stdin" if str(source) == STANDARD else Path(source).name
    if not data:
        raise TiskelError(f"{name} is empty; check how it was made")
    kind = _kind(name, data)
    points, faces, properties = _parse(kind, data, source, name)
    warnings: tuple[str, ...] = ()
    if len(faces):
        count = mesh_samples or MESH_SAMPLES
        points, properties = sample_mesh(points, faces, count, seed), {}
        warnings = (f"{name} is a mesh of {len(faces)} triangles; sampled to {count} points (choose with --sample)",)
    if len(points) == 0:
        raise TiskelError(f"{name} holds no points; check how it was made")
    return Cloud(points, properties, name, hashlib.sha256(data).hexdigest(), warnings)


def _kind(name: str, data: bytes) -> str:
    """Return the format by its suffix; standard input by its first bytes."""
    if name != "stdin":
        return Path(name).suffix.lower()
    if data.startswith(ply.MAGIC):
        return ".ply"
    return ".npy" if data.startswith(b"\x93NUMPY") else ".npz" if data.startswith(b"PK") else ".xyz"


Parsed = tuple[Points, Indices, Mapping[str, npt.NDArray[Any]]]


def _parse(kind: str, data: bytes, source: str | Path, name: str) -> Parsed:
    if kind == ".ply":
        return _from_ply(data, name)
    if kind in (".npy", ".npz"):
        return text.parse_numpy(data, name), NO_FACES, {}
    if kind in TEXT_FORMATS:
        return text.parse_text(data, name), NO_FACES, {}
    if kind in open3d_formats.MESHES or kind in open3d_formats.CLOUDS:
        return (*open3d_formats.read(Path(source), kind), {})
    known = ", ".join((".ply", ".npy", ".npz", *TEXT_FORMATS, *open3d_formats.MESHES, *open3d_formats.CLOUDS))
    raise TiskelError(f"{name}: unknown kind of file {kind or 'without a suffix'!r}; known are {known}")


NO_FACES: Indices = np.empty((0, 3), np.int32)


def _from_ply(data: bytes, name: str) -> Parsed:
    """Return points, triangles and further columns; a stage file gives its input cloud back."""
    file = ply.parse(data, name)
    holder = "cloud" if any(c.startswith("tiskel ") for c in file.comments) and "cloud" in file else "vertex"
    if holder not in file:
        raise TiskelError(
            f"{name} has no element 'vertex'; it holds {', '.join(e.name for e in file.elements) or 'nothing'}"
        )
    table = file[holder].data
    missing = [axis for axis in "xyz" if axis not in (table.dtype.names or ())]
    if missing:
        raise TiskelError(f"{name}: element {holder!r} has no property {', '.join(missing)}; it needs x, y and z")
    others = {key: table[key] for key in table.dtype.names or () if key not in "xyz" and table.dtype[key].kind != "O"}
    return ply.points_of(table), _triangles(file, name), others


def _triangles(file: Any, name: str) -> Indices:
    """Return faces as triangles, polygons as fans; none where the file has none."""
    if "face" not in file or len(file["face"].data) == 0:
        return NO_FACES
    table = file["face"].data
    lists = [key for key in table.dtype.names if key in ("vertex_indices", "vertex_index")]
    if not lists:
        return NO_FACES
    fans = [(face[0], face[i], face[i + 1]) for face in table[lists[0]] for i in range(1, len(face) - 1)]
    triangles = np.array(fans, np.int64).reshape(-1, 3)
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= file["vertex"].count):
        raise TiskelError(
            f"{name}: a face names vertex {triangles.max()}, there are {file['vertex'].count}; export it again"
        )
    return triangles.astype(np.int32)
