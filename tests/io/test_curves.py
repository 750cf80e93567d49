"""Curves of other programs: every format, and files that are broken."""

import base64
import json
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

from reference.fixtures import Runner, one_error_line
from tiskel import Curve, Skeleton, TiskelError, load_curve, make_shape, read_skeleton, shape_graph
from tiskel.geometry.branch_table import branch_table
from tiskel.io.clouds import dump_cloud
from tiskel.io.curves import as_skeleton, holds_curve, parse_curve
from tiskel.io.exports import EXPORTS, branches_csv, export_of, write_skeleton
from tiskel.io.measurable import gather

WITH_RADII = ("ply", "graphml", "json", "node-link.json", "vtp", "csv")


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return make_shape(shape_graph("mug"))[1]


@pytest.mark.parametrize("suffix", [suffix for suffix in EXPORTS if suffix != "swc"])
def test_what_is_exported_is_read_back(suffix: str, skeleton: Skeleton, tmp_path: Path) -> None:
    path = tmp_path / f"curve.{suffix}"
    path.write_bytes(EXPORTS[suffix](skeleton))
    curve = load_curve(path)
    order = [int(np.linalg.norm(curve.nodes - node, axis=1).argmin()) for node in skeleton.nodes]
    np.testing.assert_allclose(curve.nodes[order], skeleton.nodes, atol=1e-12)
    read = {tuple(sorted(edge)) for edge in curve.edges.tolist()}
    assert read == {tuple(sorted((order[a], order[b]))) for a, b in skeleton.edges.tolist()}
    if suffix in WITH_RADII:
        np.testing.assert_allclose(curve.radii[order], skeleton.radii)
    else:
        assert np.isnan(curve.radii).all()


def test_swc_gives_the_tree_without_the_edge_that_closes_the_loop(skeleton: Skeleton, tmp_path: Path) -> None:
    path = tmp_path / "curve.swc"
    path.write_bytes(EXPORTS["swc"](skeleton))
    curve = load_curve(path)
    assert len(curve.nodes) == len(skeleton.nodes)
    assert len(curve.edges) == len(skeleton.edges) - 1


def packed(values: np.ndarray, *, zipped: bool) -> bytes:
    """Return an array as VTK packs it: a head of sizes and the values, or blocks of 16 bytes packed by zlib."""
    data = values.tobytes()
    if not zipped:
        return base64.b64encode(struct.pack("<I", len(data)) + data)
    blocks = [zlib.compress(data[i : i + 16]) for i in range(0, len(data), 16)]
    head = struct.pack(f"<{3 + len(blocks)}I", len(blocks), 16, len(data) % 16, *map(len, blocks))
    return base64.b64encode(head) + base64.b64encode(b"".join(blocks))


def vtp(where: str, *, zipped: bool) -> bytes:
    """Return three points and a polyline as ParaView writes them: arrays in place, or at the end, in text or raw."""
    arrays = {
        "Points": np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0]], "<f4"),
        "connectivity": np.arange(3, dtype="<i8"),
        "offsets": np.array([3], "<i8"),
        "Radius": np.array([0.5, 0.25, 0.125]),
    }
    kinds = {"Points": 'Float32" NumberOfComponents="3', "Radius": "Float64"}
    end, said = b"", {}
    for name, values in arrays.items():
        body = packed(values, zipped=zipped)
        if where == "raw":
            body = struct.pack("<I", values.nbytes) + values.tobytes()
        place = "binary" if where == "binary" else f'appended" offset="{len(end)}'
        text = body.decode() if where == "binary" else ""
        end += b"" if where == "binary" else body
        said[name] = f'<DataArray type="{kinds.get(name, "Int64")}" Name="{name}" format="{place}">{text}</DataArray>'
    pack = ' compressor="vtkZLibDataCompressor"' if zipped else ""
    head = (
        f'<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"{pack}><PolyData><Piece NumberOfPoints="3">'
        f"<PointData>{said['Radius']}</PointData><Points>{said['Points']}</Points>"
        f"<Lines>{said['connectivity']}{said['offsets']}</Lines></Piece></PolyData>"
    ).encode()
    kind = b"raw" if where == "raw" else b"base64"
    return (
        head + (b'<AppendedData encoding="' + kind + b'">_' + end + b"</AppendedData>" if end else b"") + b"</VTKFile>"
    )


def text_vtp(ends: str) -> bytes:
    """Return three points and lines along them that end at so many places, in text."""
    points = '<Points><DataArray type="Float64" NumberOfComponents="3">0 0 0 1 0 0 1 1 0</DataArray></Points>'
    lines = f'<Lines><DataArray Name="connectivity" type="Int64">0 1 2</DataArray>{{}}{ends}</DataArray></Lines>'
    lines = lines.format('<DataArray Name="offsets" type="Int64">')
    return f"<VTKFile><PolyData><Piece>{points}{lines}</Piece></PolyData></VTKFile>".encode()


DXF = """0 SECTION 2 ENTITIES 0 LINE 8 0 10 0 20 0 30 0 11 1 21 0 31 0 0 POLYLINE 66 1 70 8 0 VERTEX 10 1 20 0 30 0
 0 VERTEX 10 1 20 1 30 0 0 SEQEND 0 ENDSEC 0 EOF"""
FOREIGN = {
    "place.vtp": vtp("binary", zipped=False),
    "zipped.vtp": vtp("binary", zipped=True),
    "end.vtp": vtp("base64", zipped=True),
    "raw.vtp": vtp("raw", zipped=False),
    "lines.dxf": "\n".join(DXF.split()).encode(),
    "flat.dxf": b"0\nLWPOLYLINE\n90\n3\n70\n0\n10\n0\n20\n0\n10\n1\n20\n0\n10\n1\n20\n1\n0\nEOF\n",
    "gel.graph": b"# made elsewhere\n\nn 0 0 0\nn 1 0 0\nn 1 1 0\nc 0 1\nc 1 2\n",
    "pairs.csv": b"x1;y1;z1;x2;y2;z2\n0;0;0;1,0;0;0\n1;0;0;1;1;0\n",
    "lines.obj": b"# made elsewhere\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nl 1/1 2/2 3\nl -1 -3\n",
    "tree.swc": b"# comment\n\n 10 2 0 0 0 1 -1\n 20 2 1 0 0 1 10\n 5 2 1 1 0 1 20\n",
    "graph.json": b'{"nodes": [[0,0,0],[1,0,0],[1,1,0]], "edges": [[0,1],[1,2]]}',
    "link.json": json.dumps(
        {
            "nodes": [{"id": n, "x": x, "y": y, "z": 0} for n, x, y in (("a", 0, 0), ("b", 1, 0), ("c", 1, 1))],
            "links": [{"source": "a", "target": "b"}, {"source": "b", "target": "c"}],
        }
    ).encode(),
    "lines.ply": b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1\n1 2\n",
}


@pytest.mark.parametrize("name", FOREIGN)
def test_curves_of_other_programs(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(FOREIGN[name])
    curve = load_curve(tmp_path / name)
    assert curve.nodes.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    edges = {tuple(sorted(edge)) for edge in curve.edges.tolist()}
    assert edges == {(0, 1), (1, 2)} | ({(0, 2)} if name == "lines.obj" else set())


def test_points_alone_are_nodes_without_edges(tmp_path: Path) -> None:
    for suffix in ("ply", "xyz", "npy"):
        path = tmp_path / f"nodes.{suffix}"
        path.write_bytes(dump_cloud(np.eye(3), path))
        curve = load_curve(path)
        np.testing.assert_array_equal(curve.nodes, np.eye(3))
        assert curve.edges.shape == (0, 2)


def test_radii_of_other_programs_are_read(tmp_path: Path) -> None:
    for name in ("place.vtp", "zipped.vtp", "end.vtp", "raw.vtp"):
        np.testing.assert_array_equal(parse_curve(FOREIGN[name], name).radii, [0.5, 0.25, 0.125])
    np.testing.assert_array_equal(parse_curve(FOREIGN["tree.swc"], "tree.swc").radii, [1, 1, 1])


@pytest.mark.parametrize("first", [0, 1])
def test_points_and_the_pairs_of_their_rows_in_two_files(first: int, tmp_path: Path) -> None:
    (tmp_path / "a_nodes.csv").write_text("x,y,z\n0,0,0\n1,0,0\n1,1,0\n")
    (tmp_path / "a_edges.csv").write_text(f"source,target\n{first},{first + 1}\n{first + 1},{first + 2}\n")
    assert load_curve(tmp_path / "a_nodes.csv").edges.tolist() == [[0, 1], [1, 2]]


@pytest.mark.parametrize("name", ["place.vtp", "lines.ply", "graph.json", "tree.swc", "graphml"])
def test_curves_on_standard_input_are_told_by_their_first_bytes(name: str, skeleton: Skeleton) -> None:
    data, kind = (EXPORTS["graphml"](skeleton), "a.graphml") if name == "graphml" else (FOREIGN[name], name)
    found, same = parse_curve(b" \n" + data if kind == "graph.json" else data, "-"), parse_curve(data, kind)
    assert found.name == "stdin"
    np.testing.assert_array_equal(found.nodes, same.nodes)
    assert len(found.edges) == len(same.edges) > 0


def test_what_holds_edges_is_a_curve(skeleton: Skeleton) -> None:
    cloud = {suffix: dump_cloud(np.eye(3), f"a.{suffix}") for suffix in ("ply", "xyz", "csv")}
    for data, name in (
        *((FOREIGN[name], name) for name in ("lines.ply", "lines.obj", "pairs.csv", "tree.swc", "raw.vtp")),
        (EXPORTS["ply"](skeleton), "skeleton.ply"),
        (FOREIGN["graph.json"], "-"),
    ):
        assert holds_curve(data, name), name
    for data, name in (*((cloud[kind], f"a.{kind}") for kind in cloud), (b"v 0 0 0\n", "a.obj"), (cloud["ply"], "-")):
        assert not holds_curve(data, name), name


BROKEN = {
    "far.vtp": (FOREIGN["raw.vtp"].replace(b'offset="0"', b'offset="9999"'), "not a valid VTP"),
    "bomb.vtp": (b'<!DOCTYPE a [<!ENTITY b "c">]><VTKFile/>', "declares a document type"),
    "none.dxf": (b"0\nEOF\n", "holds no LINE"),
    "far.graph": (b"n 0 0 0\nc 0 1\n", r"joins nodes \[0, 1\], there are 1"),
    "four.json": (b'{"nodes": [[0, 0, 0, 1]], "edges": []}', "rows of 4 numbers"),
    "nan.swc": (b"1 2 0 nan 0 1 -1\n", "node 0 is at"),
    "cut.ply": (FOREIGN["lines.ply"][:-4], "not a valid PLY"),
    "far.obj": (b"v 0 0 0\nl 1 7\n", r"joins nodes \[0, 6\], there are 1"),
    "back.obj": (b"v 0 0 0\nl 1 -3\n", "edge 0 joins"),
    "words.obj": (b"v a b c\n", "not a valid OBJ"),
    "orphan.swc": (b"1 2 0 0 0 1 7\n", "not a valid SWC"),
    "short.swc": (b"1 2 0 0\n", "not a valid SWC"),
    "none.json": (b"{}", "not a valid JSON"),
    "list.json": (b"[1, 2", "not a valid JSON"),
    "flat.json": (b'{"nodes": [[0, 0]], "edges": []}', "not a valid JSON"),
    "bare.graphml": (b"<graphml", "not a valid GRAPHML"),
    "bytes.obj": (b"\xff\xfe\x00", "not a valid OBJ"),
    "what.dwg": (b"", "unknown kind of curve"),
    "packer.vtp": (b'<VTKFile compressor="vtkLZ4DataCompressor"/>', "packed by vtkLZ4DataCompressor"),
    "short.vtp": (FOREIGN["place.vtp"].replace(b"JAAAA", b"JgAAA"), "an array promises 42 bytes, 40 are there"),
    "huge.vtp": (FOREIGN["place.vtp"].replace(b"JAAAA", b"OTk5O"), "promises 943274301 bytes, the file is smaller"),
    "bare.vtp": (b"<VTKFile><Piece/></VTKFile>", "a piece has no points"),
    "long.vtp": (text_vtp(ends="2 9"), "lines end at 9, 3 places are listed"),
    "fewer.vtp": (text_vtp(ends="2 1"), "lines end at 1, 3 places are listed"),
    "binary.dxf": (b"AutoCAD Binary DXF\r\n\x1a", "it is a binary DXF; save it as text"),
    "letters.json": (b'{"nodes": [[0, "a", 1]], "edges": []}', "nodes hold something that is no number"),
    "half.json": (b'{"nodes": [[0, 0, 0]], "edges": [[0, 0.5]]}', "edges hold something that is no whole number"),
    "radii.json": (b'{"nodes": [[0, 0, 0]], "edges": [], "radius": [1, 2]}', "2 radii for 1 nodes"),
    "thin.json": (b'{"nodes": [[0, 0, 0]], "edges": [], "radius": [-1]}', "the radius of node 0 is -1"),
    "twins.json": (b'{"nodes": [{"id": 1}, {"id": 1}]}', "a node is there twice"),
    "deep.json": (b"[" * 3_000_000, "has parts that would take 257 MB of memory, it has 2 MB"),
    "nan.csv": (b"x1,y1,z1,x2,y2,z2\n0,0,0,nan,0,0\n", "a segment has an end that is not finite"),
    "none.swc": (b"# nothing\n", "it holds no sample"),
    "twins.swc": (b"1 2 0 0 0 1 -1\n1 2 1 0 0 1 -1\n", "a sample is there twice"),
    "words.graph": (b"n 0 0 0\nmany words\n", "a line begins with 'many', not with n or c"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_curves_are_told_in_one_line(name: str, tmp_path: Path) -> None:
    data, said = BROKEN[name]
    (tmp_path / name).write_bytes(data)
    with pytest.raises(TiskelError, match=said) as caught:
        load_curve(tmp_path / name)
    assert "\n" not in str(caught.value)


def test_files_are_gathered_and_what_is_named_takes_precedence(skeleton: Skeleton, tmp_path: Path) -> None:
    whole, line, cloud = tmp_path / "s.ply", tmp_path / "line.obj", tmp_path / "cloud.xyz"
    whole.write_bytes(EXPORTS["ply"](skeleton))
    line.write_bytes(FOREIGN["lines.obj"])
    cloud.write_bytes(dump_cloud(np.eye(3), cloud))
    held = read_skeleton(whole)
    m = gather(whole)
    assert (len(m.cloud), m.points, m.name) == (len(held.cloud), None, "s.ply")
    assert len(gather(whole, cloud=cloud).cloud) == 3
    assert len(gather(whole, curve=line).nodes) == 3  # type: ignore[arg-type]
    assert gather(None, cloud=cloud, points=cloud).points is not None
    with pytest.raises(TiskelError, match=r"line.obj comes without its cloud"):
        gather(line)
    with pytest.raises(TiskelError, match="nothing to measure against it"):
        gather(None, cloud=cloud)


def test_every_curve_becomes_every_format(skeleton: Skeleton, tmp_path: Path) -> None:
    """Counts stay, through 10 x 10 formats; SWC has no loops, so a tree is sent round."""
    tree = make_shape(shape_graph("y"))[1]
    for one in EXPORTS:
        first = as_skeleton(parse_curve(EXPORTS[one](tree), f"a.{one}"))
        for other in EXPORTS:
            found = parse_curve(EXPORTS[other](first), f"a.{other}")
            assert (found.components, found.loops, found.ends, len(found.edges)) == (1, 0, 3, len(tree.edges))


def test_convert_writes_what_the_name_says(tiskel: Runner, tmp_path: Path, skeleton: Skeleton) -> None:
    write_skeleton(tmp_path / "a.vtp", skeleton)
    for source, target in (("a.vtp", "b.dxf"), ("b.dxf", "c.csv"), ("c.csv", "d.ply"), ("d.ply", "e.node-link.json")):
        done = tiskel("convert", source, target)
        assert done.returncode == 0, done.stderr
        assert load_curve(tmp_path / target).loops == 1
    import networkx

    document = json.loads((tmp_path / "e.node-link.json").read_text())
    assert networkx.node_link_graph(document, edges="edges").number_of_edges() == len(skeleton.edges)
    assert "cannot be written as '.dwg'" in one_error_line(tiskel("convert", "a.vtp", "b.dwg"))
    with pytest.raises(TiskelError, match="cannot be written as '\\.xml'"):
        write_skeleton(tmp_path / "a.xml", skeleton)
    assert export_of("a.node-link.JSON") == "node-link.json"


def test_the_table_of_branches_of_a_cone_and_its_child() -> None:
    """A straight cone of length 2 from radius 1 to 0.5, then two limbs of 1 at 90 degrees to either side."""
    nodes = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [-1, 0, 2], [5, 5, 5]], float)
    edges = np.array([[0, 1], [1, 2], [2, 3], [2, 4]], np.int32)
    radii = np.array([1, 0.75, 0.5, 0.1, 0.1, 0.3])
    s = as_skeleton(Curve(nodes, edges, radii))
    rows = {(row.start, row.end): row for row in s.branch_table()}
    trunk, limb, point = rows[0, 2], rows[2, 3], rows[5, 5]
    assert (trunk.kind, trunk.order, trunk.parent, trunk.angle) == ("joint-end", 0, -1, None)
    assert (limb.order, limb.parent, point.kind, point.length) == (1, trunk.branch, "point", 0)
    assert limb.angle == pytest.approx(90)
    assert trunk.volume == pytest.approx(np.pi * 2 / 3 * (1 + 0.5 + 0.25))
    assert trunk.surface == pytest.approx(np.pi * 1.5 * np.hypot(2, 0.5))
    assert (trunk.length, trunk.tortuosity, trunk.radius_mean) == pytest.approx((2, 1, 0.75))
    assert (trunk.radius_least, trunk.radius_largest, trunk.radius_source) == (0.5, 1, "unknown")
    from_the_limb = {row.end: row for row in branch_table(s, root=(1, 0, 2))}
    assert (from_the_limb[2].start, from_the_limb[0].order) == (3, 1)
    table = branches_csv(s).decode().splitlines()
    assert table[0].startswith("branch,start,end,kind,length,chord,tortuosity,radius_least")
    assert len(table) == 5


def test_skeleton_writes_the_table_of_branches(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    assert tiskel("contract", cloud, "-o", "c.ply").returncode == 0
    assert tiskel("skeleton", "c.ply", "-o", "s.vtp", "--branches", "b.csv").returncode == 0
    assert len((tmp_path / "b.csv").read_text().splitlines()) == 4


def test_the_table_of_branches_of_a_loop_and_of_a_bridge() -> None:
    """A triangle of sides 3, 4 and 5; then a way of 1 and 3 whose second half was laid over a gap."""
    triangle = Curve(np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0]]), np.array([[0, 1], [1, 2], [0, 2]], np.int32))
    (loop,) = branch_table(triangle)
    assert (loop.kind, loop.start, loop.length, loop.chord, loop.tortuosity) == ("loop", loop.end, 12, 0, None)
    path = Curve(np.array([[0.0, 0, 0], [1, 0, 0], [4, 0, 0]]), np.array([[0, 1], [1, 2]], np.int32),
                 bridged=np.array([False, True]))  # fmt: skip
    (way,) = branch_table(path)
    assert (way.kind, way.bridged, loop.bridged) == ("end-end", 0.75, 0.0)


def test_every_piece_of_vtp_counts_its_points_from_the_first_of_its_own() -> None:
    head, piece, tail = text_vtp("3").partition(b"<Piece>")[0], text_vtp("3"), b"</PolyData></VTKFile>"
    one = piece[len(head) : -len(tail)]
    curve = parse_curve(head + 3 * one + tail, "a.vtp")
    assert len(curve.nodes) == 9
    assert curve.edges.tolist() == [[0, 1], [1, 2], [3, 4], [4, 5], [6, 7], [7, 8]]


def test_a_node_alone_is_no_polyline(tmp_path: Path) -> None:
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [5, 5, 5]])
    data = EXPORTS["dxf"](as_skeleton(Curve(nodes, np.array([[0, 1]], np.int32))))
    assert data.count(b"POLYLINE") == data.count(b"SEQEND") == 1
    assert parse_curve(data, "a.dxf").nodes.tolist() == nodes[:2].tolist()
