"""Curves as VTP, the XML of VTK for lines and polygons: what ParaView, PyVista and VMTK read and write."""

import base64
import re
import xml.etree.ElementTree as ET
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.io.limits import check_unpacked
from tiskel.io.lines.base import Lines, chained, lines, radii_of
from tiskel.io.lines.documents import parsed_xml
from tiskel.skeleton import Skeleton

KINDS = {
    "Float32": "f4", "Float64": "f8", "Int8": "i1", "Int16": "i2", "Int32": "i4", "Int64": "i8",
    "UInt8": "u1", "UInt16": "u2", "UInt32": "u4", "UInt64": "u8",
}  # fmt: skip
APPENDED = re.compile(rb"<AppendedData[^>]*encoding\s*=\s*[\"'](raw|base64)[\"'][^>]*>\s*_")


class _File:
    """A document with its arrays, wherever in it they are."""

    def __init__(self, data: bytes, name: str) -> None:
        found = APPENDED.search(data)
        self.encoding = found[1].decode() if found else ""
        self.appended = data[found.end() :] if found else b""
        self.size, self.name = len(data), name
        self.root = parsed_xml(data[: found.start()] + b"</VTKFile>" if found else data, name)
        self.order = ">" if self.root.get("byte_order") == "BigEndian" else "<"
        self.head = np.dtype(self.order + ("u8" if self.root.get("header_type") == "UInt64" else "u4"))
        self.packed = self.root.get("compressor")
        if self.packed not in {None, "", "vtkZLibDataCompressor"}:
            raise ValueError(f"its arrays are packed by {str(self.packed)[:40]}; write it with zlib or without")

    def array(self, part: ET.Element) -> npt.NDArray[Any]:
        """Return the values of a DataArray, in rows where they have several components."""
        kind, layout = KINDS[part.attrib["type"]], part.get("format", "ascii")
        if layout == "ascii":
            values = np.array((part.text or "").split(), np.float64 if kind[0] == "f" else np.int64)
        elif layout == "binary":
            values = np.frombuffer(self._decoded((part.text or "").strip().encode(), "base64"), self.order + kind)
        else:
            start = int(part.attrib["offset"])
            values = np.frombuffer(self._decoded(self.appended[max(start, 0) :], self.encoding), self.order + kind)
        width = int(part.get("NumberOfComponents", "1") or 1)
        return values.reshape(-1, width) if width > 1 else values

    def _decoded(self, data: bytes, encoding: str) -> bytes:
        size = self.head.itemsize
        if not self.packed:
            length = int(np.frombuffer(_some(data, 0, size, encoding), self.head)[0])
            return _some(data, 0, size + length, encoding)[size:]
        blocks = int(np.frombuffer(_some(data, 0, size, encoding), self.head)[0])
        head = np.frombuffer(_some(data, 0, size * (3 + blocks), encoding), self.head).astype(np.int64)
        check_unpacked(int(head[1]) * blocks, self.size, self.name)
        start = len(base64.b64encode(bytes(size * (3 + blocks)))) if encoding == "base64" else size * (3 + blocks)
        body, pieces, at = _some(data, start, int(head[3:].sum()), encoding), [], 0
        for length in head[3:].tolist():
            pieces.append(zlib.decompressobj().decompress(body[at : at + length], int(head[1]) or 1))
            at += length
        return b"".join(pieces)


def _some(data: bytes, start: int, count: int, encoding: str) -> bytes:
    """Return so many bytes that are written from a place on."""
    if count < 0 or count > len(data):
        raise ValueError(f"an array promises {count} bytes, the file is smaller")
    if encoding == "raw":
        found = data[start : start + count]
    else:
        found = base64.b64decode(data[start : start + (count + 2) // 3 * 4])[:count]
    if len(found) < count:
        raise ValueError(f"an array promises {count} bytes, {len(found)} are there")
    return found


def read(data: bytes, name: str) -> Lines:
    """Return the lines of all pieces and the radii that their points have."""
    file = _File(data, name)
    nodes, ways, radii, before = [], [], [], 0
    for piece in file.root.iter("Piece"):
        points = piece.find("Points/DataArray")
        if points is None:
            raise ValueError("a piece has no points")
        nodes.append(np.asarray(file.array(points), np.float64).reshape(-1, 3))
        held = {one.get("Name"): file.array(one) for one in piece.iterfind("Lines/DataArray")}
        ends = np.asarray(held.get("offsets", ()), np.int64)
        if len(ends) and ((np.diff(ends, prepend=0) < 0).any() or ends[-1] > len(held["connectivity"])):
            raise ValueError(f"lines end at {ends[-1]}, {len(held['connectivity'])} places are listed")
        whole = np.asarray(held.get("connectivity", ()), np.int64) + before
        ways += [way.tolist() for way in np.split(whole[: ends[-1]], ends[:-1])] if len(ends) else []
        known = {str(one.get("Name")): one for one in piece.iterfind("PointData/DataArray")}
        radius = radii_of(list(known))
        radii.append(np.ravel(file.array(known[radius])) if radius else np.full(len(nodes[-1]), np.nan))
        before += len(nodes[-1])
    return lines(np.concatenate([np.empty((0, 3)), *nodes]), chained(ways), np.concatenate([np.empty(0), *radii]))


def write(s: Skeleton) -> bytes:
    """Return VTP as text: a polyline for each branch, with what is known of each point and of each branch."""
    ways, rows = [branch.tolist() for branch in s.branches], s.branch_table()
    flat = [node for way in ways for node in way]
    point_data = [
        _array("radius", "Float64", s.radii.tolist()),
        _array("radius_source", "UInt8", s.radius_sources.tolist()),
        _array("regime", "UInt8", s.regimes.tolist()),
        _array("degree", "Int32", s.degrees.tolist()),
    ]
    parts = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian">',
        "<PolyData>",
        f'<Piece NumberOfPoints="{len(s.nodes)}" NumberOfVerts="0" NumberOfLines="{len(ways)}" NumberOfStrips="0" '
        'NumberOfPolys="0">',
        '<PointData Scalars="radius">',
        *point_data,
        "</PointData>",
        '<CellData Scalars="branch">',
        *(_array(key, kind, [getattr(row, key) for row in rows]) for key, kind in MEASURES.items()),
        "</CellData>",
        "<Points>",
        _array("Points", "Float64", s.nodes.ravel().tolist(), 3),
        "</Points>",
        "<Lines>",
        _array("connectivity", "Int64", flat),
        _array("offsets", "Int64", np.cumsum([len(way) for way in ways]).tolist()),
        "</Lines>",
        "</Piece>",
        "</PolyData>",
        "</VTKFile>",
    ]
    return ("\n".join(parts) + "\n").encode()


MEASURES = {  #: of branches, in cells
    "branch": "Int32", "length": "Float64", "tortuosity": "Float64", "radius_mean": "Float64",
    "volume": "Float64", "surface": "Float64", "order": "Int32", "angle": "Float64", "parent": "Int32",
}  # fmt: skip


def _array(name: str, kind: str, values: list[Any], width: int = 1) -> str:
    head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" format='
    if None not in values and np.isfinite(values).all():
        return f'{head}"ascii">{" ".join(map(repr, values))}</DataArray>'
    packed = np.array(values, "<" + KINDS[kind]).tobytes()  # in text VTK knows no NaN, and gives up the whole file
    said = base64.b64encode(len(packed).to_bytes(4, "little") + packed).decode()
    return f'{head}"binary">{said}</DataArray>'
