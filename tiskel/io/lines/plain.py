"""Curves as plain text: OBJ lines, SWC, .graph of GEL, segments as CSV."""

import io
from typing import Any

import numpy as np

from tiskel.io.formats import text
from tiskel.io.lines.base import Lines, chained, joined, lines
from tiskel.skeleton import Skeleton
from tiskel.version import version

STARTS, STOPS, WIDE = ("x1", "y1", "z1"), ("x2", "y2", "z2"), ("radius1", "radius2")  #: columns of segments


def read_obj(data: bytes, name: str) -> Lines:
    """Return vertices and what line elements join; an index counts from 1, a negative one from the last vertex."""
    nodes: list[list[float]] = []
    ways: list[list[int]] = []
    for words in map(str.split, data.decode("utf-8").splitlines()):
        if words[:1] == ["v"]:
            nodes.append([float(word) for word in words[1:4]])
        elif words[:1] == ["l"]:
            named = [int(word.split("/")[0]) for word in words[1:]]
            ways.append([i - 1 if i > 0 else len(nodes) + i for i in named])
    return lines(nodes, chained(ways))


def write_obj(s: Skeleton) -> bytes:
    """Return OBJ: vertices and a line element for each edge; of longer ones MeshLab shows the first piece alone."""
    rows = [f"# tiskel {version()} skeleton", *(f"v {x!r} {y!r} {z!r}" for x, y, z in s.nodes.tolist())]
    rows += [f"l {a + 1} {b + 1}" for way in s.branches for a, b in chained([way.tolist()])]
    return ("\n".join(rows) + "\n").encode()


def read_swc(data: bytes, name: str) -> Lines:
    """Return samples and what joins them to their parents; ids may be any whole numbers."""
    rows = [line for line in map(str.strip, data.decode("utf-8").splitlines()) if line and line[0] != "#"]
    if not rows:
        raise ValueError("it holds no sample")
    table = np.loadtxt(rows, usecols=(0, 2, 3, 4, 5, 6), ndmin=2)
    ids, parents = table[:, 0], table[:, 5]
    order = np.argsort(ids, kind="stable")
    if (np.diff(ids[order]) == 0).any():
        raise ValueError("a sample is there twice")
    below = np.flatnonzero(parents != -1)
    place = np.minimum(np.searchsorted(ids[order], parents[below]), len(ids) - 1)
    orphans = np.flatnonzero(ids[order][place] != parents[below])
    if len(orphans):
        raise ValueError(f"the parent {parents[below[orphans[0]]]:g} of a sample is not there")
    return lines(table[:, 1:4], np.stack([order[place], below], axis=1), np.abs(table[:, 4]))


def read_graph(data: bytes, name: str) -> Lines:
    """Return the nodes (n x y z) and connections (c a b) of GEL."""
    nodes: list[list[float]] = []
    edges: list[list[int]] = []
    for words in map(str.split, data.decode("utf-8").splitlines()):
        if words[:1] == ["n"]:
            nodes.append([float(word) for word in words[1:]])
        elif words[:1] == ["c"]:
            edges.append([int(word) for word in words[1:3]])
        elif words and not words[0].startswith("#"):
            raise ValueError(f"a line begins with {words[0][:20]!r}, not with n or c")
    return lines(nodes, edges)


def write_graph(s: Skeleton) -> bytes:
    """Return nodes and connections as GEL reads them."""
    rows = [f"n {x!r} {y!r} {z!r}" for x, y, z in s.nodes.tolist()]
    return ("\n".join([*rows, *(f"c {a} {b}" for a, b in s.edges.tolist())]) + "\n").encode()


def has_segments(data: bytes) -> bool:
    """Tell whether the first line of a table names the two ends of segments."""
    head = data[:4096].decode("utf-8-sig", "replace").splitlines()[:1]
    named = set("".join(head).lower().replace('"', "").replace(";", ",").replace("\t", ",").replace(" ", "").split(","))
    return {*STARTS, *STOPS} <= named


def read_segments(data: bytes, name: str) -> Lines:
    """Return the segments of a table with columns x1, y1, z1, x2, y2, z2, and radius1, radius2 where they are."""
    first, second = text.read(data, name, STARTS), text.read(data, name, STOPS)
    known = [first.properties[key] for key in WIDE if key in first.properties]
    return joined(first.points, second.points, (known[0], known[1]) if len(known) == 2 else None)


def write_segments(s: Skeleton) -> bytes:
    """Return CSV with a row for each edge: its two ends, their radii, its branch, and whether it bridges a gap."""
    branch: dict[tuple[int, ...], int] = {}
    for number, way in enumerate(s.branches):
        branch |= {tuple(sorted(pair)): number for pair in chained([way.tolist()])}
    out = io.StringIO()
    out.write(",".join((*STARTS, *STOPS, *WIDE, "branch", "bridged")) + "\n")
    radii: list[Any] = ["" if np.isnan(radius) else repr(radius) for radius in s.radii.tolist()]
    places = s.nodes.tolist()
    for (a, b), bridged in zip(s.edges.tolist(), s.bridged.tolist(), strict=True):
        numbers = ",".join(map(repr, (*places[a], *places[b])))
        out.write(f"{numbers},{radii[a]},{radii[b]},{branch[a, b]},{int(bridged)}\n")
    return out.getvalue().encode()
