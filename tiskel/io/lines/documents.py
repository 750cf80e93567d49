"""Curves as JSON and GraphML."""

import json
import xml.etree.ElementTree as ET
from typing import Any

from tiskel.extras import extra
from tiskel.geometry.labels import labels
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.io.limits import check_nested
from tiskel.io.lines.base import Lines, lines, radii_of
from tiskel.skeleton import Skeleton
from tiskel.version import version


def read_json(data: bytes, name: str) -> Lines:
    """Return nodes as triples, or as objects with x, y, z and id (networkx node-link), and edges or links."""
    check_nested(data, b"[{", name)
    document = json.loads(data)
    nodes, links = document["nodes"], document.get("edges", document.get("links", ()))
    if not nodes or not isinstance(nodes[0], dict):
        return lines(nodes, links, document.get("radius"))
    place = {node["id"]: i for i, node in enumerate(nodes)}
    if len(place) < len(nodes):
        raise ValueError("a node is there twice")
    ends = [(place[link["source"]], place[link["target"]]) for link in links]
    radius = radii_of(list(nodes[0]))
    radii = [node[radius] for node in nodes] if radius else None
    return lines([[node[axis] for axis in "xyz"] for node in nodes], ends, radii)


def write_json(s: Skeleton) -> bytes:
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


def write_node_link(s: Skeleton) -> bytes:
    """Return the JSON that networkx.node_link_graph(document, edges="edges") reads."""
    network = s.to_networkx()
    document = {
        "directed": False,
        "multigraph": False,
        "graph": {},
        "nodes": [{"id": node, **values} for node, values in network.nodes(data=True)],
        "edges": [{"source": a, "target": b, **values} for a, b, values in network.edges(data=True)],
    }
    return (json.dumps(document, allow_nan=False) + "\n").encode()


def parsed_xml(data: bytes, name: str) -> ET.Element:
    """Return the root of an XML document without declarations of types and entities.

    Raises
    ------
    TiskelError, ValueError
        Where it has them, is damaged, or would take far more memory than it is long.
    """
    check_nested(data, b"<", name)
    if b"\0" in data[:4096] or b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise ValueError("it declares a document type, or is not in UTF-8")
    try:
        return ET.fromstring(data)
    except ET.ParseError as error:
        raise ValueError(str(error)) from None


def _local(tag: Any) -> str:
    """Return the name of an XML element without its namespace."""
    return str(tag).rpartition("}")[2]


def read_graphml(data: bytes, name: str) -> Lines:
    """Return nodes with x, y, z, and edges."""
    keys, nodes, ends = {}, {}, []
    for part in parsed_xml(data, name).iter():
        kind = _local(part.tag)
        if kind == "key":
            keys[part.get("id")] = part.get("attr.name", "")
        elif kind == "node":
            values = {keys.get(child.get("key"), ""): child.text or "" for child in part if _local(child.tag) == "data"}
            nodes[part.attrib["id"]] = values
        elif kind == "edge":
            ends.append((part.attrib["source"], part.attrib["target"]))
    place = {node: i for i, node in enumerate(nodes)}
    radius = radii_of(list(next(iter(nodes.values()), {})))
    radii = [float(values[radius]) for values in nodes.values()] if radius else None
    places = [[float(values[axis]) for axis in "xyz"] for values in nodes.values()]
    return lines(places, [(place[a], place[b]) for a, b in ends], radii)


def write_graphml(s: Skeleton) -> bytes:
    """Return GraphML with the attributes of :meth:`tiskel.Skeleton.to_networkx`."""
    import io

    out = io.BytesIO()
    extra("networkx", "GraphML").write_graphml_xml(s.to_networkx(), out)
    return out.getvalue()
