"""Curves from files of this and of other programs."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tiskel.errors import TiskelError
from tiskel.geometry.graph import CurveGraph, tidy_edges
from tiskel.io import ply
from tiskel.io.clouds import parse_cloud
from tiskel.io.formats import numpy_arrays, text
from tiskel.io.formats.base import short
from tiskel.io.lines import documents, dxf, plain, vtp
from tiskel.io.lines.base import Lines, lines, radii_of
from tiskel.io.ply_tables import HEADER_END
from tiskel.io.stages.skeleton import parse_skeleton
from tiskel.io.stages.which import stage_of
from tiskel.io.streams import STANDARD, read_bytes
from tiskel.skeleton import Skeleton

NODES_ALONE = (text.XYZ, text.PTS, text.CSV, text.TSV, numpy_arrays.NPY, numpy_arrays.NPZ)
CURVES: dict[str, Callable[[bytes, str], Lines]] = {
    ".obj": plain.read_obj,
    ".swc": plain.read_swc,
    ".graphml": documents.read_graphml,
    ".json": documents.read_json,
    ".vtp": vtp.read,
    ".dxf": dxf.read,
    ".graph": plain.read_graph,
}
FORMATS = (".ply", *CURVES, *(suffix for kind in NODES_ALONE for suffix in kind.suffixes))
NODES_FILE = re.compile(r"nodes|vertices|points", re.IGNORECASE)
OBJ_LINE = re.compile(rb"^l[ \t]", re.MULTILINE)


@dataclass(frozen=True, eq=False, repr=False)
class Curve(CurveGraph):
    """A curve as it was read, in the file's units; see :class:`tiskel.CurveGraph`.

    Attributes
    ----------
    nodes : (v, 3) float64
        Where the nodes are.
    edges : (e, 2) int32
        The two nodes of every edge, as the file has them.
    radii : (v,) float64
        NaN where the file does not say.
    bridged : (e,) bool
        False: files of curves do not say.
    name : str
        The file's name without folders; "stdin" for standard input.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import Curve
    >>> curve = Curve(np.eye(3), np.array([[0, 1], [1, 2]], np.int32), name="bow.obj")
    >>> curve.name, curve.ends, round(curve.length, 3)
    ('bow.obj', 2, 2.828)
    """

    _said = ("name", "nodes", "components", "loops", "ends", "junctions", "length")

    name: str = field(default="", kw_only=True)


def load_curve(source: str | Path) -> Curve:
    """Read a curve.

    Parameters
    ----------
    source : str or Path
        A path (PLY with or without edges, OBJ lines, SWC, GraphML, JSON, VTP, DXF, .graph, CSV of segments x1, y1, z1,
        x2, y2, z2), or "-" for standard input. Text and NumPy files give nodes without edges, but those in a_nodes.csv
        are joined by the pairs of rows in a_edges.csv beside it.

    Returns
    -------
    Curve

    Raises
    ------
    TiskelError
        Where the file is missing, damaged or of an unknown kind.

    Examples
    --------
    >>> import json, tempfile
    >>> from pathlib import Path
    >>> from tiskel import load_curve
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "c.json").write_text(json.dumps({"nodes": [[0, 0, 0], [0, 0, 2]], "edges": [[0, 1]]}))
    ...     load_curve(f"{folder}/c.json").length
    2.0
    """
    return parse_curve(read_bytes(source), source)


@np.errstate(invalid="ignore")
def parse_curve(data: bytes, source: str | Path) -> Curve:
    """Return the curve in the bytes of a file.

    Parameters
    ----------
    data : bytes
        What the file holds.
    source : str or Path
        Where it was read from; the suffix says of which kind it is, "-" that the bytes do.

    Returns
    -------
    Curve

    Raises
    ------
    TiskelError
        Where the bytes are damaged or of an unknown kind.
    """
    name = "stdin" if str(source) == STANDARD else Path(source).name
    kind = Path(name).suffix.lower() if name != "stdin" else _kind(data)
    if kind not in FORMATS:
        raise TiskelError(
            f"{name}: unknown kind of curve {kind or 'without a suffix'!r}; known are {', '.join(FORMATS)}"
        )
    try:
        found = _parse(kind, data, source, name)
    except TiskelError:
        raise
    except Exception as error:
        said = short(f"there is no {error}" if isinstance(error, KeyError) else str(error) or type(error).__name__)
        raise TiskelError(f"{name} is not a valid {kind[1:].upper()} curve: {said}; export it again") from None
    radii = np.full(len(found.nodes), np.nan) if found.radii is None else found.radii
    return Curve(found.nodes, found.edges, radii, name=name)


def holds_curve(data: bytes, source: str | Path) -> bool:
    """Tell whether a file that may be a cloud or a curve holds edges: by its suffix, or by what it says."""
    kind = Path(source).suffix.lower() if str(source) != STANDARD else _kind(data)
    if kind in (".ply", ".obj", ".csv", ".tsv", ".txt"):
        head = data[: max(data.find(HEADER_END), 0)]
        return (
            b"\nelement edge" in head
            if kind == ".ply"
            else OBJ_LINE.search(data) is not None
            if kind == ".obj"
            else plain.has_segments(data)
        )
    return kind in CURVES


def as_skeleton(curve: CurveGraph) -> Skeleton:
    """Return a curve as a skeleton without a cloud, so that all formats can be written; unknown radii are 0."""
    none, nowhere = np.empty(0, np.int32), np.empty((0, 3))
    radii = np.nan_to_num(curve.radii)
    return Skeleton(
        nodes=curve.nodes, edges=tidy_edges(curve.edges), radii=radii, node_of_point=none, cloud=nowhere,
        input_rows=none, contracted=nowhere, origin=nowhere, rows=none,
    )  # fmt: skip


def _kind(data: bytes) -> str:
    start = data.lstrip()[:1]
    if start == b"<":
        return ".vtp" if b"<VTKFile" in data[:1000] else ".graphml"
    return ".ply" if data.startswith(ply.MAGIC) else ".json" if start == b"{" else ".swc"


def _parse(kind: str, data: bytes, source: str | Path, name: str) -> Lines:
    if kind == ".ply":
        return _from_ply(data, name)
    if kind in CURVES:
        return CURVES[kind](data, name)
    if plain.has_segments(data):
        return plain.read_segments(data, name)
    nodes = parse_cloud(data, source).points
    return lines(nodes, _edges_beside(source, len(nodes)))


def _edges_beside(source: str | Path, count: int) -> Any:
    """Return the pairs of nodes in the other file of two: points in a_nodes.csv, pairs of their rows in a_edges.csv.

    Rows count from 0, or from 1 where none is 0 and one is the number of nodes.
    """
    path = Path(source)
    other = path.with_name(re.sub(NODES_FILE, "edges", path.name, count=1))
    if other == path or str(source) == STANDARD or not other.is_file():
        return ()
    rows = [row for row in re.split(r"[\r\n]+", read_bytes(other).decode("utf-8-sig")) if row.strip()]
    words = [re.split(r"[\s,;]+", row.strip())[:2] for row in rows]
    words = words if all(word.isdigit() for word in words[0]) else words[1:]
    pairs = np.array([[int(word) for word in pair] for pair in words], np.int64).reshape(-1, 2)
    return pairs - 1 if len(pairs) and pairs.min() == 1 and pairs.max() == count else pairs


def _from_ply(data: bytes, name: str) -> Lines:
    if stage_of(data) == "skeleton":
        skeleton = parse_skeleton(data, name)
        return lines(skeleton.nodes, skeleton.edges, skeleton.radii)
    file = ply.parse(data, name)
    table = file["vertex"].data
    radius = radii_of(table.dtype.names or ())
    radii = None if radius is None else table[radius]
    if "edge" not in file:
        return lines(ply.points_of(table), (), radii)
    edge = file["edge"].data
    return lines(ply.points_of(table), np.stack([edge["vertex1"], edge["vertex2"]], axis=1), radii)
