"""Skeletons for other programs: OBJ lines, JSON, SWC, GraphML."""

import io
import json
from collections import deque
from collections.abc import Callable

import numpy as np

from tiskel.io.stages.skeleton import dump_skeleton
from tiskel.skeleton import Skeleton
from tiskel.version import version


def to_obj(s: Skeleton) -> bytes:
    """Return OBJ: vertices and one line element per branch; CloudCompare and MeshLab show these, unlike PLY edges."""
    lines = [f"# tiskel {version()} skeleton", *(f"v {x!r} {y!r} {z!r}" for x, y, z in s.nodes.tolist())]
    lines += ["l " + " ".join(str(node + 1) for node in branch) for branch in s.branches if len(branch) > 1]
    return ("\n".join(lines) + "\n").encode()


def to_json(s: Skeleton) -> bytes:
    """Return one JSON document with nodes, edges, radius, branches, the node of every point, counts and warnings."""
    document = {
        "tiskel": version(),
        "nodes": s.nodes.tolist(),
        "edges": s.edges.tolist(),
        "radius": s.radius.tolist(),
        "branches": [branch.tolist() for branch in s.branches],
        "node_of_point": s.node_of_point.tolist(),
        "graph": s.counts(),
        "warnings": list(s.warnings),
    }
    return (json.dumps(document, allow_nan=False) + "\n").encode()


def to_swc(s: Skeleton) -> bytes:
    """Return SWC: continuous ids from 1, parents before children, breadth first from an end of each component.

    SWC holds trees only. The rule for loops: the edge that would close one is
    left out of the tree and named in a comment line.
    """
    order, parent = spanning_forest(s)
    name = {node: i + 1 for i, node in enumerate(order)}
    kept = {tuple(sorted((node, up))) for node, up in parent.items() if up >= 0}
    lines = [f"# tiskel {version()} skeleton", "# id type x y z radius parent"]
    lines += [f"# loop {name[a]} {name[b]}" for a, b in s.edges.tolist() if (a, b) not in kept]
    for node in order:
        x, y, z = s.nodes[node].tolist()
        up = name[parent[node]] if parent[node] >= 0 else -1
        lines.append(f"{name[node]} 0 {x!r} {y!r} {z!r} {float(s.radius[node])!r} {up}")
    return ("\n".join(lines) + "\n").encode()


def spanning_forest(s: Skeleton) -> tuple[list[int], dict[int, int]]:
    """Return the nodes of a skeleton breadth first, and the parent of each.

    Parameters
    ----------
    s : Skeleton
        The curve; an end of each component is its root where it has one.

    Returns
    -------
    order : list of int
        All nodes, parents before children.
    parent : dict of int to int
        The parent of every node, -1 for roots.
    """
    around = s.neighbours
    order: list[int] = []
    parent: dict[int, int] = {}
    for root in np.argsort(s.degrees != 1, kind="stable").tolist():
        if root in parent:
            continue
        parent[root] = -1
        queue = deque([root])
        while queue:
            node = queue.popleft()
            order.append(node)
            for other in around[node]:
                if other not in parent:
                    parent[other] = node
                    queue.append(other)
    return order, parent


def to_graphml(s: Skeleton) -> bytes:
    """Return GraphML with node attributes x, y, z, radius and edge attribute length."""
    import networkx

    out = io.BytesIO()
    networkx.write_graphml_xml(s.to_networkx(), out)
    return out.getvalue()


EXPORTS: dict[str, Callable[[Skeleton], bytes]] = {
    "ply": dump_skeleton,
    "obj": to_obj,
    "swc": to_swc,
    "graphml": to_graphml,
    "json": to_json,
}
