"""The stage file ``skeleton.ply``: a line set that other tools read, and all that later stages need.

Elements: ``vertex`` (x y z radius branch degree; branch is -1 for a joint,
which belongs to several) and ``edge`` (vertex1 vertex2); ``branch``, how many
nodes each has, and ``branch_node``, these nodes one branch after the other
(trimesh gives up on lists of different lengths); ``contracted``, the contracted
points with origin, row in ``cloud`` and node; ``cloud``, every finite input
point with its row in the input and its node.
"""

from pathlib import Path
from typing import Any

import numpy as np

from tiskel.arrays import Indices
from tiskel.errors import TiskelError
from tiskel.io import ply
from tiskel.io.stages.contraction import ORIGIN
from tiskel.io.streams import read_bytes, write_bytes
from tiskel.params import SkeletonParams
from tiskel.skeleton import Skeleton

STAGE = "skeleton"


def write_skeleton(
    target: str | Path, skeleton: Skeleton, params: SkeletonParams | None = None, source: dict[str, str] | None = None
) -> None:
    """Write a stage file; "-" is standard output."""
    write_bytes(target, dump_skeleton(skeleton, params, source))


def dump_skeleton(s: Skeleton, params: SkeletonParams | None = None, source: dict[str, str] | None = None) -> bytes:
    """Return the bytes of a stage file: the same bytes for the same skeleton."""
    vertex: dict[str, Any] = {**ply.xyz(s.nodes), "radius": s.radius, "branch": s.branch_of_node(), "degree": s.degrees}
    contracted: dict[str, Any] = {**ply.xyz(s.contracted), **ply.xyz(s.origin, ORIGIN), "row": s.rows}
    contracted["node"] = s.node_of_point[s.rows]
    cloud: dict[str, Any] = {**ply.xyz(s.cloud), "row": s.input_rows, "node": s.node_of_point}
    elements = [
        ply.element("vertex", vertex),
        ply.element("edge", {"vertex1": s.edges[:, 0], "vertex2": s.edges[:, 1]}),
        ply.element("branch", {"count": np.array([len(branch) for branch in s.branches], np.int32)}),
        ply.element("branch_node", {"node": np.concatenate([np.empty(0, np.int32), *s.branches])}),
        ply.element("contracted", contracted),
        ply.element("cloud", cloud),
    ]
    facts = {"source": source or {}, "warnings": list(s.warnings)}
    if params is not None:
        facts["params"] = ply.plain(params)
    return ply.dump(elements, STAGE, facts)


def read_skeleton(source: str | Path) -> Skeleton:
    """Read a stage file; "-" is standard input."""
    return parse_skeleton(read_bytes(source), str(source))


def parse_skeleton(data: bytes, name: str) -> Skeleton:
    """Return the skeleton that a stage file holds."""
    file = ply.parse(data, name)
    facts = ply.facts(file, STAGE, name)
    try:
        vertex, edge, contracted, cloud = (file[part].data for part in ("vertex", "edge", "contracted", "cloud"))
        return Skeleton(
            nodes=ply.points_of(vertex),
            edges=np.stack([edge["vertex1"], edge["vertex2"]], axis=1).astype(np.int32),
            radius=np.array(vertex["radius"], np.float64),
            branches=_branches(file["branch"].data["count"], file["branch_node"].data["node"]),
            node_of_point=np.array(cloud["node"], np.int32),
            cloud=ply.points_of(cloud),
            input_rows=np.array(cloud["row"], np.int32),
            contracted=ply.points_of(contracted),
            origin=ply.points_of(contracted, ORIGIN),
            rows=np.array(contracted["row"], np.int32),
            warnings=tuple(facts.get("warnings", ())),
        )
    except (KeyError, ValueError, TypeError) as error:
        raise TiskelError(f"{name} is a damaged skeleton file: {error}; run tiskel skeleton again") from None


def _branches(counts: Indices, nodes: Indices) -> tuple[Indices, ...]:
    if counts.sum() != len(nodes):
        raise ValueError(f"branches have {counts.sum()} nodes, {len(nodes)} are listed")
    return tuple(np.split(np.array(nodes, np.int32), np.cumsum(counts)[:-1]))
