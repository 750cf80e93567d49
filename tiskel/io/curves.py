"""Curves from files of this and of other programs."""

import io
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tiskel.errors import TiskelError
from tiskel.geometry.graph import CurveGraph
from tiskel.io import ply
from tiskel.io.clouds import parse_cloud
from tiskel.io.formats import numpy_arrays, text
from tiskel.io.stages.skeleton import parse_skeleton
from tiskel.io.stages.which import stage_of
from tiskel.io.streams import STANDARD, read_bytes

NODES_ALONE = (text.XYZ, text.PTS, text.CSV, numpy_arrays.NPY, numpy_arrays.NPZ)
FORMATS = (".ply", ".obj", ".swc", ".graphml", ".json", *(suffix for kind in NODES_ALONE for suffix in kind.suffixes))


@dataclass(frozen=True, eq=False)
class Curve(CurveGraph):
    """A curve as it was read, in the file's units; see :class:`tiskel.CurveGraph`.

    Attributes
    ----------
    nodes : (v, 3) float64
        Where the nodes are.
    edges : (e, 2) int32
        The two nodes of every edge, as the file has them.
    radii : (v,) float64
        NaN: radii are not read.
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

    name: str = field(default="", kw_only=True)


def load_curve(source: str | Path) -> Curve:
    """Read a curve.

    Parameters
    ----------
    source : str or Path
        A path (PLY with or without edges, OBJ lines, SWC, GraphML, JSON), or "-" for standard input. Text and NumPy
        files give nodes without edges.

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
        nodes, edges = _parse(kind, data, source, name)
        places = np.array(nodes, np.float64).reshape(-1, 3)
        links = np.array(edges, np.int64).reshape(-1, 2)
    except TiskelError:
        raise
    except Exception as error:
        raise TiskelError(f"{name} is not a valid {kind[1:].upper()} curve: {error}; export it again") from None
    if len(links) and (links.min() < 0 or links.max() >= len(places)):
        raise TiskelError(f"{name}: an edge names node {links.max()}, there are {len(places)}; export it again")
    return Curve(places, links.astype(np.int32), name=name)


def _kind(data: bytes) -> str:
    start = data.lstrip()[:1]
    return (
        ".ply" if data.startswith(ply.MAGIC) else ".json" if start == b"{" else ".graphml" if start == b"<" else ".swc"
    )


def _parse(kind: str, data: bytes, source: str | Path, name: str) -> tuple[Any, Any]:
    if kind == ".ply":
        return _from_ply(data, name)
    if kind in (".obj", ".swc"):
        return (_from_obj if kind == ".obj" else _from_swc)(data.decode("utf-8").splitlines())
    if kind == ".json":
        return _from_json(json.loads(data))
    if kind == ".graphml":
        return _from_graphml(data)
    return parse_cloud(data, source).points, ()


def _from_ply(data: bytes, name: str) -> tuple[Any, Any]:
    if stage_of(data) == "skeleton":
        skeleton = parse_skeleton(data, name)
        return skeleton.nodes, skeleton.edges
    file = ply.parse(data, name)
    if "edge" not in file:
        return ply.points_of(file["vertex"].data), ()
    edge = file["edge"].data
    return ply.points_of(file["vertex"].data), np.stack([edge["vertex1"], edge["vertex2"]], axis=1)


def _from_obj(lines: list[str]) -> tuple[Any, Any]:
    """Return vertices and what line elements join; an index counts from 1, a negative one from the last vertex."""
    nodes: list[list[float]] = []
    edges: list[tuple[int, int]] = []
    for words in map(str.split, lines):
        if words[:1] == ["v"]:
            nodes.append([float(word) for word in words[1:4]])
        elif words[:1] == ["l"]:
            named = [int(word.split("/")[0]) for word in words[1:]]
            places = [i - 1 if i > 0 else len(nodes) + i for i in named]
            edges += zip(places[:-1], places[1:], strict=True)
    return nodes, edges


def _from_swc(lines: list[str]) -> tuple[Any, Any]:
    """Return samples and what joins them to their parents; ids may be any whole numbers."""
    rows = [line.split() for line in map(str.strip, lines) if line and not line.startswith("#")]
    place = {int(float(row[0])): i for i, row in enumerate(rows)}
    parents = [int(float(row[6])) for row in rows]
    edges = [(place[parent], i) for i, parent in enumerate(parents) if parent != -1]
    return [[float(word) for word in row[2:5]] for row in rows], edges


def _from_json(document: dict[str, Any]) -> tuple[Any, Any]:
    """Return nodes as triples, or as objects with x, y, z and id (networkx node-link), and edges or links."""
    nodes, links = document["nodes"], document.get("edges", document.get("links", ()))
    place = {node["id"]: i for i, node in enumerate(nodes)} if nodes and isinstance(nodes[0], dict) else None
    if place is None:
        return nodes, links
    ends = [(place[link["source"]], place[link["target"]]) for link in links]
    return [[node[axis] for axis in "xyz"] for node in nodes], ends


def _from_graphml(data: bytes) -> tuple[Any, Any]:
    import networkx

    network = networkx.read_graphml(io.BytesIO(data))
    place = {node: i for i, node in enumerate(network.nodes)}
    nodes = [[float(values[axis]) for axis in "xyz"] for _, values in network.nodes(data=True)]
    return nodes, [(place[edge[0]], place[edge[1]]) for edge in network.edges]
