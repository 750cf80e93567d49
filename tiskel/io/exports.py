"""Skeletons for other programs: the table of formats, SWC, and the table of branches."""

import csv
import io
from collections import deque
from collections.abc import Callable
from dataclasses import astuple, fields
from itertools import groupby
from pathlib import Path

import numpy as np

from tiskel.errors import TiskelError
from tiskel.geometry.branch_table import BranchRow
from tiskel.geometry.labels import labels
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.io.lines import documents, dxf, plain, vtp
from tiskel.io.stages.skeleton import dump_skeleton
from tiskel.io.streams import STANDARD, write_bytes
from tiskel.skeleton import Skeleton
from tiskel.version import version

# Types of SWC samples. 1 to 7 have meanings among neurons; what is read by most programs ends at 19.
TYPES: dict[int, int] = {Regime.UNKNOWN: 0, Regime.TUBE: 11, Regime.SHEET: 12, Regime.WIRE: 13}
TYPES_SAID = "# type " + ", ".join(f"{number} {Regime(regime).name.lower()}" for regime, number in TYPES.items())


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


EXPORTS: dict[str, Callable[[Skeleton], bytes]] = {
    "ply": dump_skeleton,
    "obj": plain.write_obj,
    "swc": to_swc,
    "graphml": documents.write_graphml,
    "json": documents.write_json,
    "node-link.json": documents.write_node_link,
    "vtp": vtp.write,
    "dxf": dxf.write,
    "graph": plain.write_graph,
    "csv": plain.write_segments,
}


def export_of(target: str | Path) -> str:
    """Return the format of a skeleton that the suffix of a file names; PLY for standard output, pipes and devices.

    Raises
    ------
    TiskelError
        For an unknown suffix.
    """
    path = Path(target)
    if str(target) == STANDARD or (path.exists() and not path.is_file() and not path.is_dir()):
        return "ply"
    found = [suffix for suffix in EXPORTS if path.name.lower().endswith(f".{suffix}")]
    if not found:
        raise TiskelError(
            f"a skeleton cannot be written as {path.suffix or path.name!r}; choose one of {', '.join(EXPORTS)}"
        )
    return max(found, key=len)


def write_skeleton(target: str | Path, skeleton: Skeleton, source: dict[str, str] | None = None) -> None:
    """Write a skeleton in the format that the suffix names: the stage file as PLY, the others for other programs.

    Parameters
    ----------
    target : path, or "-" for standard output
        Where to: PLY, OBJ, SWC, GraphML, JSON (.node-link.json for networkx), VTP, DXF, .graph, CSV.
    skeleton : Skeleton
        What is written.
    source : dict, optional
        Name and SHA-256 of the input; for PLY.

    Raises
    ------
    TiskelError
        Where the suffix is unknown, or the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from tiskel import make_shape, read_skeleton, shape_graph, write_skeleton
    >>> cloud, true = make_shape(shape_graph("y"))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_skeleton(f"{folder}/y.ply", true)
    ...     read_skeleton(f"{folder}/y.ply").ends
    3
    """
    kind = export_of(target)
    write_bytes(target, dump_skeleton(skeleton, source) if kind == "ply" else EXPORTS[kind](skeleton))


def branches_csv(s: Skeleton) -> bytes:
    """Return the table of branches as CSV; a cell is empty where there is no value."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow([field.name for field in fields(BranchRow)])
    for row in s.branch_table():
        table.writerow(
            ["" if value is None else repr(value) if isinstance(value, float) else value for value in astuple(row)]
        )
    return out.getvalue().encode()
