"""Skeletons for other programs: OBJ lines, JSON, SWC, GraphML."""

import io
import json
from collections import deque
from collections.abc import Callable
from itertools import groupby

import numpy as np

from tiskel.geometry.labels import labels
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.io.stages.skeleton import dump_skeleton
from tiskel.skeleton import Skeleton
from tiskel.version import version

# Types of SWC samples. 1 to 7 have meanings among neurons; what is read by most programs ends at 19.
TYPES: dict[int, int] = {Regime.UNKNOWN: 0, Regime.TUBE: 11, Regime.SHEET: 12, Regime.WIRE: 13}
TYPES_SAID = "# type " + ", ".join(f"{number} {Regime(regime).name.lower()}" for regime, number in TYPES.items())


def to_obj(s: Skeleton) -> bytes:
    """Return OBJ: vertices and one line element per branch; CloudCompare and MeshLab show these, unlike PLY edges."""
    lines = [f"# tiskel {version()} skeleton", *(f"v {x!r} {y!r} {z!r}" for x, y, z in s.nodes.tolist())]
    lines += ["l " + " ".join(str(node + 1) for node in branch) for branch in s.branches if len(branch) > 1]
    return ("\n".join(lines) + "\n").encode()


def to_json(s: Skeleton) -> bytes:
    """Return one JSON document.

    Of every node its place, radius, radius_source and regime, of every edge its
    nodes and whether it was bridged; branches, the node of every point, counts,
    warnings and notes.
    """
    document = {
        "tiskel": version(),
        "nodes": s.nodes.tolist(),
        "edges": s.edges.tolist(),
        "bridged": s.bridged.tolist(),
        "radius": s.radius.tolist(),
        "radius_source": labels(RadiusSource, s.radius_sources),
        "regime": labels(Regime, s.regimes),
        "branches": [branch.tolist() for branch in s.branches],
        "node_of_point": s.node_of_point.tolist(),
        "graph": s.counts(),
        **s.doubts(),
    }
    return (json.dumps(document, allow_nan=False) + "\n").encode()


def to_swc(s: Skeleton) -> bytes:
    """Return SWC: continuous ids from 1, parents before children, breadth first from an end of each component.

    SWC holds trees only. The rule for loops: the edge that would close one is
    left out of the tree and named in a comment line. The type of a sample is
    the regime of its node, see :data:`TYPES`. Comment lines name the two
    samples of every edge over a gap (``# bridged 3 4``) and say what radii are
    worth, by ranges of ids (``# radius_source bounded 1-7 12``).
    """
    order, parent = spanning_forest(s)
    name = {node: i + 1 for i, node in enumerate(order)}
    kept = {tuple(sorted((node, up))) for node, up in parent.items() if up >= 0}
    lines = [f"# tiskel {version()} skeleton", "# id type x y z radius parent", TYPES_SAID]
    lines += [f"# loop {name[a]} {name[b]}" for a, b in s.edges.tolist() if (a, b) not in kept]
    lines += [f"# bridged {name[a]} {name[b]}" for a, b in s.edges[s.bridged].tolist()]
    lines += _sources(labels(RadiusSource, s.radius_sources[order]))
    for node in order:
        x, y, z = s.nodes[node].tolist()
        up = name[parent[node]] if parent[node] >= 0 else -1
        kind = TYPES.get(int(s.regimes[node]), 0)
        lines.append(f"{name[node]} {kind} {x!r} {y!r} {z!r} {float(s.radius[node])!r} {up}")
    return ("\n".join(lines) + "\n").encode()


def _sources(said: list[str]) -> list[str]:
    """Return a comment line for each source of radii with the ids, from 1, of the samples that have it."""
    runs: dict[str, list[str]] = {}
    start = 1
    for source, same in groupby(said):
        end = start + len(list(same)) - 1
        runs.setdefault(source, []).append(f"{start}-{end}" if end > start else f"{start}")
        start = end + 1
    return [f"# radius_source {source} {' '.join(ids)}" for source, ids in sorted(runs.items())]


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
    """Return GraphML with the attributes of :meth:`tiskel.Skeleton.to_networkx`."""
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
