"""Files of any kind that can be shown: clouds, meshes, curves and what the stages write."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tiskel.arrays import Edges, Numbers, Points
from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.io import ply
from tiskel.io.clouds import Cloud, parse_cloud
from tiskel.io.curves import Curve, parse_curve
from tiskel.io.formats import format_of
from tiskel.io.limits import unpacked
from tiskel.io.ply_tables import HEADER_END
from tiskel.io.stages.contraction import parse_contraction
from tiskel.io.stages.path import RolledPath, is_path, parse_paths
from tiskel.io.stages.skeleton import parse_skeleton
from tiskel.io.stages.surface import parse_surfaces
from tiskel.io.stages.which import stage_of
from tiskel.io.streams import STANDARD, read_bytes
from tiskel.skeleton import Skeleton
from tiskel.slicing.fitted import Surfaces

CURVES = (".swc", ".graphml")
HEADER = 65536  # bytes in which a PLY file names its elements
START = 4096  # bytes in which a JSON document names its stage


@dataclass(frozen=True, eq=False)
class MeshFile:
    """A mesh as it was read; coordinates in the file's unit.

    Attributes
    ----------
    name : str
        The file's name.
    points : (n, 3) float64
        The corners.
    faces : (f, 3) int32
        The corners of every triangle.
    """

    name: str
    points: Points
    faces: Edges


@dataclass(frozen=True, eq=False)
class MeasureFile:
    """Measures of a skeleton as ``tiskel metrics --ply`` writes them.

    Attributes
    ----------
    name : str
        The file's name.
    places : (n, 3) float64
        Skeletal points, then samples and vertices of the curve.
    columns : dict of str to (n,) float64
        "of_curve" (0, 1, 2), and the measures, NaN for none.
    """

    name: str
    places: Points
    columns: dict[str, Numbers]


Shown = Cloud | MeshFile | MeasureFile | Curve | Contraction | Skeleton | Surfaces | tuple[RolledPath, ...]


def read_anything(source: str | Path) -> Shown:
    """Read a file that can be shown, whatever it holds.

    Parameters
    ----------
    source : str or Path
        A path, or "-" for standard input: a cloud, a mesh, a curve, contraction.ply, skeleton.ply, metrics.ply,
        surface.json or path.csv.

    Raises
    ------
    TiskelError
        Where it is missing, damaged, or holds nothing that has a place in space.
    """
    data, name = read_bytes(source), "stdin" if str(source) == STANDARD else Path(source).name
    stage, suffix = stage_of(data), Path(name).suffix.lower()
    if stage in STAGES:
        return STAGES[stage](data, name)
    if data.lstrip()[:1] == b"{":
        return _document(data, source, name)
    if is_path(data):
        return parse_paths(data, name)
    if suffix in CURVES or (suffix == ".obj" and _lines_alone(data)) or _has_edges(data):
        return parse_curve(data, source)
    return _cloud_or_mesh(data, source, name)


@np.errstate(invalid="ignore")
def _measures(data: bytes, name: str) -> MeasureFile:
    vertex: Any = ply.parse(data, name)["vertex"].data
    columns = {key: np.array(vertex[key], np.float64) for key in ply.own(vertex.dtype.names) if key not in "xyz"}
    return MeasureFile(name, ply.points_of(vertex), columns)


STAGES: dict[str | None, Callable[[bytes, str], Shown]] = {
    "contraction": parse_contraction,
    "skeleton": parse_skeleton,
    "metrics": _measures,
}


def _document(data: bytes, source: str | Path, name: str) -> Surfaces | Curve:
    if b'"stage": "surface"' in data[:START]:
        return parse_surfaces(data, name)
    if b'"nodes"' in data[:START]:
        return parse_curve(data, source)
    raise TiskelError(f"{name} holds nothing that has a place in space; name a cloud, a curve or a stage file")


def _lines_alone(data: bytes) -> bool:
    """Return whether an OBJ file has lines and no faces."""
    return b"\nl " in data and b"\nf " not in data


def _has_edges(data: bytes) -> bool:
    """Return whether a PLY file has edges and no faces."""
    header = data[:HEADER].split(HEADER_END)[0] if data.startswith(ply.MAGIC) else b""
    return b"element edge" in header and b"element face" not in header


def _cloud_or_mesh(data: bytes, source: str | Path, name: str) -> Cloud | MeshFile:
    plain, inner = unpacked(data, name)
    parsed = format_of(inner, plain, by_content=str(source) == STANDARD).parse(plain, name)
    if len(parsed.faces):
        return MeshFile(name, parsed.points, parsed.faces)
    return parse_cloud(data, source)
