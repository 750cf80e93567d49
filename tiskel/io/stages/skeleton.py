"""The stage file ``skeleton.ply``, format 2: a line set that other tools read, and all that later stages need.

Elements: ``vertex`` (x y z radius branch degree radius_source regime; branch is -1
for a junction, which belongs to several; radius_source is a number of
:class:`tiskel.RadiusSource`, regime of :class:`tiskel.Regime`; scalar_radius and quality are the radius by the names
that CloudCompare and MeshLab know) and ``edge``
(vertex1 vertex2); ``edge_source`` (bridged: 1 where an edge was laid over a gap, 0
where it follows points; trimesh reads no edges of more than two properties);
``branch``, how many nodes each has, and ``branch_node``, these nodes one branch
after the other (trimesh gives up on lists of different lengths); ``contracted``, the contracted points with origin,
row in ``cloud`` and node; ``cloud``, every finite input point with its row in the
input and its node. Comments hold JSON: source, params, warnings and notes (see
:class:`tiskel.CurveWarning`; plain texts in older files). Format 1, which is still read, does not say what was bridged,
and some files of format 2 do not say the regime.
"""

from enum import IntEnum
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Mask
from tiskel.errors import TiskelError
from tiskel.geometry.doubt import warning_from
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.io import ply
from tiskel.io.stages import door
from tiskel.io.stages.contraction import ORIGIN
from tiskel.io.streams import Bytes, mapped
from tiskel.params import known_settings
from tiskel.skeleton import Skeleton

STAGE = "skeleton"


def dump_skeleton(s: Skeleton, source: dict[str, str] | None = None) -> bytes:
    """Return the bytes of a stage file, the same for the same skeleton; see :func:`tiskel.write_skeleton`."""
    vertex: dict[str, Any] = {**ply.xyz(s.nodes), "radius": s.radii, "branch": s.branch_of_node(), "degree": s.degrees}
    vertex |= {"radius_source": s.radius_sources, "regime": s.regimes, **ply.scalars({"radius": s.radii}, "radius")}
    contracted: dict[str, Any] = {**ply.xyz(s.contracted), **ply.xyz(s.origin, ORIGIN), "row": s.rows}
    contracted["node"] = s.node_of_point[s.rows]
    cloud: dict[str, Any] = {**ply.xyz(s.cloud), "row": s.input_rows, "node": s.node_of_point}
    elements = [
        ply.element("vertex", vertex),
        ply.element("edge", {"vertex1": s.edges[:, 0], "vertex2": s.edges[:, 1]}),
        ply.element("edge_source", {"bridged": s.bridged.astype(np.uint8)}),
        ply.element("branch", {"count": np.array([len(branch) for branch in s.branches], np.int32)}),
        ply.element("branch_node", {"node": np.concatenate([np.empty(0, np.int32), *s.branches])}),
        ply.element("contracted", contracted),
        ply.element("cloud", cloud),
    ]
    facts: dict[str, Any] = {"source": source or {}, **s.doubts()}
    if s.params is not None:
        facts["params"] = ply.plain(s.params)
    return ply.dump(elements, STAGE, facts)


def read_skeleton(source: str | Path) -> Skeleton:
    """Read a stage file.

    Parameters
    ----------
    source : str or Path
        A path, or "-" for standard input.

    Returns
    -------
    Skeleton

    Raises
    ------
    TiskelError
        Where the file is missing, damaged, or none of this stage.

    Examples
    --------
    >>> from tiskel import TiskelError, read_skeleton
    >>> try:
    ...     read_skeleton("missing.ply")
    ... except TiskelError as error:
    ...     print(error)
    no file missing.ply; check the path
    """
    return parse_skeleton(mapped(source), str(source))


def parse_skeleton(data: Bytes, name: str) -> Skeleton:
    """Return the skeleton in the bytes of a stage file.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is damaged or none of this stage.
    """
    file = ply.parse(data, name)
    facts = ply.facts(file, STAGE, name)
    try:
        vertex, edge, contracted, cloud = (
            door.element(file, part) for part in ("vertex", "edge", "contracted", "cloud")
        )
        _check_branches(file, len(vertex))
        params = facts.get("params", {})
        return Skeleton(
            nodes=door.places(vertex, "vertex"),
            edges=_edges(edge, len(vertex)),
            radii=door.sizes(vertex, "vertex", "radius"),
            bridged=_bridged(file, len(edge)),
            radius_sources=_said(vertex, "radius_source", RadiusSource),
            regimes=_said(vertex, "regime", Regime),
            node_of_point=door.whole(cloud, "cloud", "node", len(vertex)),
            cloud=door.places(cloud, "cloud"),
            input_rows=door.whole(cloud, "cloud", "row"),
            contracted=door.places(contracted, "contracted"),
            origin=door.places(contracted, "contracted", ORIGIN),
            rows=door.whole(contracted, "contracted", "row", len(cloud)),
            warnings=tuple(map(warning_from, facts.get("warnings", ()))),
            notes=tuple(map(warning_from, facts.get("notes", ()))),
            params=known_settings(params) if "method" in params else None,
        )
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError) as error:
        raise TiskelError(f"{name} is a damaged skeleton file: {error}; run tiskel skeleton again") from None


def _said(vertex: Any, what: str, kind: type[IntEnum]) -> npt.NDArray[np.uint8]:
    """Return what the vertices say of radii or regimes; 0, unknown, in an older file."""
    if what not in (vertex.dtype.names or ()):
        return np.zeros(len(vertex), np.uint8)
    return door.whole(vertex, "vertex", what, len(kind)).astype(np.uint8)


def _bridged(file: Any, count: int) -> Mask:
    """Return which edges were bridged; none in a file of format 1."""
    if "edge_source" not in file:
        return np.zeros(count, bool)
    bridged = door.whole(file["edge_source"].data, "edge_source", "bridged", 2).astype(bool)
    if len(bridged) != count:
        raise ValueError(f"{len(bridged)} sources of edges for {count} edges")
    return bridged


def _edges(edge: Any, count: int) -> Edges:
    edges = np.stack([door.whole(edge, "edge", end, count) for end in ("vertex1", "vertex2")], axis=1)
    loops = np.flatnonzero(edges[:, 0] == edges[:, 1])
    if len(loops):
        raise ValueError(f"element 'edge', row {loops[0]}: it joins node {edges[loops[0], 0]} to itself")
    first = np.unique(np.sort(edges, axis=1), axis=0, return_index=True)[1]
    again = np.setdiff1d(np.arange(len(edges)), first)
    if len(again):
        a, b = edges[again[0]].tolist()
        raise ValueError(f"element 'edge', row {again[0]}: it joins nodes {a} and {b} once more")
    return edges


def _check_branches(file: Any, count: int) -> None:
    """Raise where the lists of branches contradict the nodes; they are not read, they follow from the edges."""
    counts = door.whole(door.element(file, "branch"), "branch", "count")
    nodes = door.whole(door.element(file, "branch_node"), "branch_node", "node", count)
    if counts.sum(dtype=np.int64) != len(nodes):
        raise ValueError(f"branches have {counts.sum(dtype=np.int64)} nodes, {len(nodes)} are listed")
