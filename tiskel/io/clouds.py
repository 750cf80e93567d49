"""Clouds from files of many formats, or from standard input."""

import gzip
import hashlib
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy.typing as npt

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.geometry.mesh import sample_mesh
from tiskel.io.formats import format_of, writer_of
from tiskel.io.streams import STANDARD, read_bytes

GZIP = b"\x1f\x8b"  #: first bytes of a file packed by gzip
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
    source : a path (PLY, XYZ, PTS, CSV, TXT, NPY, NPZ, PCD, OFF, OBJ; STL through Open3D; each also packed by gzip),
        or "-" for standard input, where PLY, NPY, NPZ, PCD, OFF and text tell themselves apart.
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
    plain, inner = _unpacked(data, name)
    parsed = format_of(inner, plain, by_content=str(source) == STANDARD).read(plain, name)
    points, properties, warnings = parsed.points, parsed.properties, parsed.warnings
    if len(parsed.faces):
        count = mesh_samples or MESH_SAMPLES
        points, properties = sample_mesh(points, parsed.faces, count, seed), {}
        said = f"{name} is a mesh of {len(parsed.faces)} triangles; sampled to {count} points (choose with --sample)"
        warnings = (*warnings, said)
    if len(points) == 0:
        raise TiskelError(f"{name} holds no points; check how it was made")
    return Cloud(points, properties, name, hashlib.sha256(data).hexdigest(), warnings)


def dump_cloud(points: Points, target: str | Path) -> bytes:
    """Return the points in the format that the suffix of the target asks for; PLY for standard output."""
    return writer_of(".ply" if str(target) == STANDARD else Path(target).suffix)(points)


def _unpacked(data: bytes, name: str) -> tuple[bytes, str]:
    """Return what gzip packed, and the name without its suffix; anything else as it is."""
    if not data.startswith(GZIP):
        return data, name
    try:
        return gzip.decompress(data), name.removesuffix(".gz").removesuffix(".GZ")
    except (OSError, EOFError, zlib.error, MemoryError) as error:
        raise TiskelError(f"{name} is no whole gzip file: {error}; pack it again") from None
