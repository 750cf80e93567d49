"""Files: what is written comes back, the bytes are always the same, and broken files are refused with a reason."""

import errno
import io
import json
import os
import tracemalloc
from dataclasses import replace
from pathlib import Path

import networkx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plyfile import PlyData, PlyElement

from tiskel import (
    Contraction,
    ContractionParams,
    Skeleton,
    TiskelError,
    assess_stability,
    contract,
    extract_skeleton,
    load_cloud,
    make_shape,
    read_contraction,
    read_skeleton,
    shape_graph,
    write_contraction,
    write_skeleton,
)
from tiskel.io.clouds import dump_cloud
from tiskel.io.exports import EXPORTS, to_swc
from tiskel.io.formats import WRITTEN, numpy_arrays, ply, text
from tiskel.io.formats.ply import PLY
from tiskel.io.stages.contraction import dump_contraction
from tiskel.io.stages.skeleton import dump_skeleton


@pytest.fixture(scope="module", params=["robust", "gls"])
def contraction(capsule: np.ndarray, request: pytest.FixtureRequest) -> Contraction:
    return contract(np.concatenate([capsule, capsule[:3]]), ContractionParams(method=request.param))


@pytest.fixture(scope="module")
def skeleton(contraction: Contraction) -> Skeleton:
    return extract_skeleton(contraction)


def test_a_contraction_comes_back_whole(contraction: Contraction, tmp_path: Path) -> None:
    write_contraction(tmp_path / "c.ply", contraction, {"name": "in.ply", "sha256": "0"}, history=True)
    back = read_contraction(tmp_path / "c.ply")
    for name in ("points", "origin", "rows", "cloud", "input_rows", "merged_into", "merged_step", "history"):
        np.testing.assert_array_equal(getattr(back, name), getattr(contraction, name), err_msg=name)
    assert (back.rings is None) == (contraction.rings is None) == (contraction.params.method == "robust")
    if back.rings is not None and contraction.rings is not None:
        np.testing.assert_array_equal(back.rings.closed, contraction.rings.closed)
        assert [back.rings.of(i).tolist() for i in range(len(back.rings))] == [
            contraction.rings.of(i).tolist() for i in range(len(back.rings))
        ]
    assert (back.sections is None) == (contraction.sections is None) == (contraction.params.method == "gls")
    if back.sections is not None and contraction.sections is not None:
        np.testing.assert_array_equal(back.sections.section, contraction.sections.section)
        np.testing.assert_array_equal(back.sections.level, contraction.sections.level)
    assert back.steps == contraction.steps
    assert (back.status, back.params, back.warnings) == (contraction.status, contraction.params, contraction.warnings)
    source = {"name": "in.ply", "sha256": "0"}
    assert dump_contraction(back, source, history=True) == (tmp_path / "c.ply").read_bytes()


def test_a_file_without_history_is_smaller_and_says_what_it_lacks(contraction: Contraction, tmp_path: Path) -> None:
    write_contraction(tmp_path / "c.ply", contraction)
    assert len(dump_contraction(contraction)) < len(dump_contraction(contraction, history=True))
    back = read_contraction(tmp_path / "c.ply")
    assert back.history.shape == (0, len(back.points), 3)
    with pytest.raises(TiskelError, match="holds no history; write it with: tiskel contract --history"):
        assess_stability(back)


def test_a_skeleton_comes_back_whole(skeleton: Skeleton, tmp_path: Path) -> None:
    write_skeleton(tmp_path / "s.ply", skeleton)
    back = read_skeleton(tmp_path / "s.ply")
    for name in (
        "nodes",
        "edges",
        "radii",
        "bridged",
        "radius_sources",
        "regimes",
        "node_of_point",
        "cloud",
        "input_rows",
        "contracted",
        "origin",
        "rows",
    ):
        np.testing.assert_array_equal(getattr(back, name), getattr(skeleton, name), err_msg=name)
    assert [b.tolist() for b in back.branches] == [b.tolist() for b in skeleton.branches]
    assert back.params == skeleton.params is not None
    assert dump_skeleton(back) == (tmp_path / "s.ply").read_bytes()


def test_contractions_made_twice_are_the_same_bytes(capsule: np.ndarray) -> None:
    assert dump_contraction(contract(capsule)) == dump_contraction(contract(capsule))


def test_a_stage_file_gives_its_input_cloud_back(contraction: Contraction, skeleton: Skeleton, tmp_path: Path) -> None:
    write_contraction(tmp_path / "c.ply", contraction)
    write_skeleton(tmp_path / "s.ply", skeleton)
    for name in ("c.ply", "s.ply"):
        np.testing.assert_array_equal(load_cloud(tmp_path / name).points, contraction.cloud)


@pytest.mark.parametrize("suffix", WRITTEN)
def test_clouds_come_back_to_the_last_bit(suffix: str, tmp_path: Path, capsule: np.ndarray) -> None:
    path = tmp_path / f"cloud{suffix}"
    far = capsule / 3 + 4.5e6
    path.write_bytes(dump_cloud(far, path))
    np.testing.assert_array_equal(load_cloud(path).points, far)


@pytest.mark.parametrize("layout", ["<", ">", "text"])
@pytest.mark.parametrize("kind", ["f4", "f8"])
def test_ply_of_every_layout_with_normals_colours_and_an_empty_face_list(
    layout: str, kind: str, tmp_path: Path
) -> None:
    table = np.zeros(20, dtype=[(n, kind) for n in ("x", "y", "z", "nx")] + [("red", "u1"), ("quality", "f4")])
    table["x"], table["red"] = np.arange(20), 7
    face = np.zeros(0, dtype=[("vertex_indices", "i4", (3,))])
    elements = [PlyElement.describe(table, "vertex"), PlyElement.describe(face, "face")]
    PlyData(elements, text=layout == "text", byte_order="<" if layout == "text" else layout).write(tmp_path / "a.ply")
    cloud = load_cloud(tmp_path / "a.ply")
    np.testing.assert_array_equal(cloud.points[:, 0], np.arange(20))
    assert set(cloud.properties) == {"nx", "red", "quality"}
    assert cloud.warnings == ()


def mesh_of(faces: list[list[int]], order: str) -> bytes:
    """Six corners and these faces in binary PLY, a quality before the corners of each face, a colour after."""
    table = np.zeros(6, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4")])
    table["x"], table["y"] = np.arange(6), np.arange(6) % 2
    face = np.empty(len(faces), dtype=[("quality", "f4"), ("vertex_indices", object), ("red", "u1")])
    for row, corners in zip(face, faces, strict=True):
        row["vertex_indices"] = np.array(corners, np.int32)
    out = io.BytesIO()
    PlyData([PlyElement.describe(table, "vertex"), PlyElement.describe(face, "face")], byte_order=order).write(out)
    return out.getvalue()


@pytest.mark.parametrize("order", ["<", ">"])
def test_faces_of_one_length_and_of_several_are_read_without_an_object_of_each(
    order: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    triangles = [[0, 1, 2], [1, 2, 3], [3, 4, 5]]
    mixed = PLY.read(mesh_of([*triangles, [0, 1, 2, 3]], order), "mixed.ply")
    assert mixed.faces.tolist() == [*triangles, [0, 1, 2], [0, 2, 3]]
    first = PLY.read(mesh_of([[0, 1, 2, 3], *triangles], order), "first.ply")
    assert first.faces.tolist() == [[0, 1, 2], [0, 2, 3], *triangles]
    data = mesh_of(triangles, order)
    with pytest.raises(TiskelError, match="follow the last row"):
        PLY.read(data + b"more", "long.ply")
    with pytest.raises(TiskelError, match="early end-of-file"):
        PLY.read(data[:-1], "short.ply")
    monkeypatch.setattr(PlyData, "read", None)  # of plyfile, which makes an object of every face
    assert PLY.read(data, "even.ply").faces.tolist() == triangles
    assert PLY.read(mesh_of([*triangles, [0, 1, 2, 3]], order), "mixed.ply").faces.tolist() == mixed.faces.tolist()
    none = PLY.read(mesh_of([[], [0, 1], [0, 1, 2]], order), "none.ply")
    assert none.faces.tolist() == [[0, 1, 2]]
    many = PLY.read(mesh_of([[0, 1, 2]] * 7000 + [[0, 1, 2, 3], [1, 3, 2]], order), "many.ply")
    assert many.faces[6999:].tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3], [1, 3, 2]]
    short = mesh_of([*triangles, [0, 1, 2, 3]], order)
    for cut in (1, 4, 16, 17):
        with pytest.raises(TiskelError, match="early end-of-file"):
            PLY.read(short[:-cut], "short.ply")
    with pytest.raises(TiskelError, match="follow the last row"):
        PLY.read(short + b"more", "long.ply")


@pytest.mark.parametrize("order", ["<", ">"])
def test_lists_of_faces_beside_other_properties_are_found(order: str) -> None:
    face = np.empty(3, dtype=[("red", "u1"), ("vertex_indices", object), ("area", "f8"), ("texcoord", object)])
    for row, corners in enumerate(([0, 1, 2], [0, 1, 2, 3], [3, 2, 1])):
        face[row] = (row, np.array(corners, np.int32), 0.5, np.arange(2 * len(corners), dtype=np.float32))
    table = np.zeros(6, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4")])
    out = io.BytesIO()
    elements = [PlyElement.describe(face, "face"), PlyElement.describe(table, "vertex")]
    PlyData(elements, byte_order=order).write(out)
    assert PLY.read(out.getvalue(), "a.ply").faces.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3], [3, 2, 1]]


@pytest.mark.parametrize("last", [[0, 1, 2], [0, 1, 2, 3]])
def test_a_mesh_takes_less_than_ten_times_its_file(last: list[int]) -> None:
    data = mesh_of([[0, 1, 2]] * 30_000 + [last], "<")
    tracemalloc.start()
    PLY.read(data, "large.ply")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10 * len(data)


def write_mesh(path: Path) -> None:
    """A unit square of one quad."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=[("x", "f4"), ("y", "f4"), ("z", "f4")])
    face = np.empty(1, dtype=[("vertex_indices", object)])
    face["vertex_indices"][0] = np.arange(4, dtype=np.int32)
    PlyData([PlyElement.describe(corners, "vertex"), PlyElement.describe(face, "face")]).write(path)


def test_a_mesh_is_sampled_evenly_by_seed(tmp_path: Path) -> None:
    write_mesh(tmp_path / "m.ply")
    one, same, other = (load_cloud(tmp_path / "m.ply", mesh_samples=4000, seed=s) for s in (0, 0, 1))
    assert one.points.tobytes() == same.points.tobytes() != other.points.tobytes()
    assert "sampled to 4000 points" in one.notes[1]
    quadrants = np.histogram2d(one.points[:, 0], one.points[:, 1], bins=2, range=[[0, 1], [0, 1]])[0]
    # Even by construction: what is off by the points along the borders of the quadrants, one row of sixty each.
    assert np.abs(quadrants - 1000).max() < 60


@pytest.mark.parametrize("suffix", [".off", ".obj", ".stl", ".pcd"])
def test_open3d_formats(suffix: str, tmp_path: Path) -> None:
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    path = tmp_path / f"a{suffix}"
    if suffix == ".pcd":
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(np.random.default_rng(0).random((50, 3))))
        open3d.io.write_point_cloud(str(path), cloud)
    else:
        mesh = open3d.geometry.TriangleMesh.create_sphere(1.0)
        mesh.compute_vertex_normals()
        open3d.io.write_triangle_mesh(str(path), mesh)
    loaded = load_cloud(path, mesh_samples=500)
    assert len(loaded.points) == (50 if suffix == ".pcd" else 500)


TEXTS = {
    "xyz": "0 1 2\n3 4 5\n",
    "commas, a header and more columns": "x,y,z,i\n0,1,2,9\n3,4,5,9\n",
    "named columns in another order": "i;z;y;x\n9;2;1;0\n9;5;4;3\n",
    "pts with a count": "2\n0 1 2\n3 4 5\n",
    "comments and blank lines": "# scan\n\n// more\n0\t1\t2\n  3 4 5  \n",
    "byte order mark and DOS ends": "\ufeff0 1 2\r\n3 4 5\r\n",
}


@pytest.mark.parametrize("name", TEXTS)
def test_text_dialects(name: str) -> None:
    np.testing.assert_array_equal(text.read(TEXTS[name].encode(), "a").points, [[0, 1, 2], [3, 4, 5]])


@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_subnormal=False)] * 3), min_size=1, max_size=20))
def test_text_keeps_every_number(rows: list[tuple[float, float, float]]) -> None:
    points = np.array(rows)
    np.testing.assert_array_equal(text.read(text.write(points), "a").points, points)


def ply_bytes(count: int = 3, promised: int | None = None, form: str = "ascii") -> bytes:
    header = f"ply\nformat {form} 1.0\nelement vertex {count if promised is None else promised}\n"
    header += "property double x\nproperty double y\nproperty double z\nend_header\n"
    body = np.arange(3.0 * count)
    rows = body.tobytes() if form != "ascii" else "".join(f"{a} {b} {c}\n" for a, b, c in body.reshape(-1, 3)).encode()
    return header.encode() + rows


BROKEN = {
    "empty.ply": (b"", "is empty"),
    "promises too many.ply": (ply_bytes(3, 5), "not a valid PLY"),
    "promises too few.ply": (ply_bytes(5, 3), "2 rows follow the last row"),
    "binary promises too many.ply": (ply_bytes(3, 5, "binary_little_endian"), "not a valid PLY"),
    "binary promises too few.ply": (ply_bytes(5, 3, "binary_little_endian"), "48 bytes follow the last row"),
    "binary promises billions.ply": (ply_bytes(3, 10**12, "binary_little_endian"), "the file is smaller"),
    "negative count.ply": (ply_bytes(3, -1), "PLY"),
    "header only.ply": (b"ply\nformat ascii 1.0\n", "not a valid PLY"),
    "noise.ply": (bytes(range(256)), "not a valid PLY"),
    "no vertices.ply": (b"ply\nformat ascii 1.0\nelement edge 0\nproperty int a\nend_header\n", "no element 'vertex'"),
    "no z.ply": (ply_bytes().replace(b"double z", b"double w"), "no property z"),
    "no points.ply": (ply_bytes(0), "holds no points"),
    "words.xyz": (b"0 1 2\none two three\n", "three numbers"),
    "two columns.xyz": (b"0 1\n2 3\n", "three numbers"),
    "count.pts": (b"5\n0 1 2\n3 4 5\n", "promises 5 points, 2 follow"),
    "only a header.csv": (b"x,y,z\n", "holds no points"),
    "latin.txt": ("0 1 2 \xe9\n".encode("latin-1"), "not text"),
    "noise.npy": (b"\x93NUMPY" + bytes(40), "not a valid NumPy file"),
    "flat.npy": (
        numpy_arrays.write(np.arange(5.0)),  # type: ignore[arg-type]
        "must hold an array of shape (n, 3), got (5,)",
    ),
    "noise.npz": (b"PK not a zip", "not a valid NumPy file"),
    "cloud.docx": (b"x", "unknown kind of file '.docx'"),
    "cloud": (b"x", "unknown kind of file without a suffix"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files_are_refused_with_a_reason(name: str, tmp_path: Path) -> None:
    data, said = BROKEN[name]
    (tmp_path / name).write_bytes(data)
    with pytest.raises(TiskelError) as error:
        load_cloud(tmp_path / name)
    assert said in str(error.value)


@given(st.binary(max_size=300))
def test_no_bytes_after_a_ply_header_cause_anything_but_a_reason(data: bytes) -> None:
    with pytest.raises(TiskelError):
        ply.read(b"ply\nformat binary_little_endian 1.0\n" + data, "a.ply")


@pytest.mark.parametrize("at", [0.1, 0.5, 0.9, 0.999])
def test_stage_files_cut_short_are_refused(
    at: float, contraction: Contraction, skeleton: Skeleton, tmp_path: Path
) -> None:
    for data, read in ((dump_contraction(contraction), read_contraction), (dump_skeleton(skeleton), read_skeleton)):
        (tmp_path / "cut.ply").write_bytes(data[: int(at * len(data))])
        with pytest.raises(TiskelError):
            read(tmp_path / "cut.ply")


def test_a_file_of_the_wrong_stage_says_which_is_needed(contraction: Contraction, tmp_path: Path) -> None:
    write_contraction(tmp_path / "c.ply", contraction)
    with pytest.raises(TiskelError, match="is a contraction file, a skeleton file is needed"):
        read_skeleton(tmp_path / "c.ply")
    (tmp_path / "p.ply").write_bytes(ply_bytes())
    with pytest.raises(TiskelError, match="is no tiskel stage file"):
        read_contraction(tmp_path / "p.ply")


@pytest.mark.parametrize("step", ["write", "flush", "chmod", "replace"])
def test_a_failed_write_leaves_the_old_file_and_no_other(
    step: str, tmp_path: Path, contraction: Contraction, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At whichever step the disk gives up."""

    def refuse(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    class Refusing(io.FileIO):
        pass

    target = tmp_path / "c.ply"
    target.write_bytes(b"old")
    if step in ("chmod", "replace"):
        monkeypatch.setattr(Path, step, refuse)
    else:
        setattr(Refusing, step, refuse)
        monkeypatch.setattr(os, "fdopen", Refusing)
    with pytest.raises(TiskelError, match=r"cannot write .*No space left on device"):
        write_contraction(target, contraction)
    monkeypatch.undo()
    assert [path.name for path in tmp_path.iterdir()] == ["c.ply"]
    assert target.read_bytes() == b"old"
    write_contraction(target, contraction)
    assert target.read_bytes() == dump_contraction(contraction)
    with pytest.raises(TiskelError, match="is a directory"):
        write_contraction(tmp_path, contraction)


def test_other_programs_read_the_skeleton_as_a_line_set(skeleton: Skeleton, tmp_path: Path) -> None:
    path = tmp_path / "s.ply"
    write_skeleton(path, skeleton)
    ply = PlyData.read(path)
    assert (ply["vertex"].count, ply["edge"].count) == (len(skeleton.nodes), len(skeleton.edges))
    trimesh = pytest.importorskip("trimesh")
    path3d = trimesh.load(path)
    np.testing.assert_allclose(path3d.vertices, skeleton.nodes)
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    lines = open3d.io.read_line_set(str(path))
    np.testing.assert_allclose(np.asarray(lines.points), skeleton.nodes)
    np.testing.assert_array_equal(np.asarray(lines.lines), skeleton.edges)


LOOPED = make_shape(shape_graph("mug"))[1]


def test_obj_lines_cover_every_edge_once() -> None:
    rows = EXPORTS["obj"](LOOPED).decode().splitlines()
    assert sum(row.startswith("v ") for row in rows) == len(LOOPED.nodes)
    pairs = [
        tuple(sorted(map(int, p)))
        for row in rows
        if row.startswith("l ")
        for p in zip(row.split()[1:], row.split()[2:], strict=False)
    ]
    assert sorted(pairs) == sorted((a + 1, b + 1) for a, b in LOOPED.edges.tolist())


def test_swc_ids_are_continuous_parents_come_first_and_loops_are_said() -> None:
    rows = to_swc(LOOPED).decode().splitlines()
    loops = [row for row in rows if row.startswith("# loop")]
    data = [row.split() for row in rows if not row.startswith("#")]
    assert [int(row[0]) for row in data] == list(range(1, len(LOOPED.nodes) + 1))
    assert all(int(row[6]) < int(row[0]) for row in data)
    assert sum(row[6] == "-1" for row in data) == LOOPED.components
    assert len(loops) == LOOPED.loops == 1
    tree = {tuple(sorted((int(row[0]), int(row[6])))) for row in data if row[6] != "-1"}
    assert len(tree) + len(loops) == len(LOOPED.edges)
    assert float(data[0][5]) > 0


def test_graphml_and_json_hold_the_graph() -> None:
    network = networkx.read_graphml(io.BytesIO(EXPORTS["graphml"](LOOPED)))
    assert network.number_of_edges() == len(LOOPED.edges)
    assert float(network.nodes["0"]["radius"]) == LOOPED.radius[0]
    document = json.loads(EXPORTS["json"](LOOPED))
    assert document["graph"]["loops"] == 1
    np.testing.assert_array_equal(document["edges"], LOOPED.edges)


def mixed(s: Skeleton) -> Skeleton:
    """Return the skeleton with every regime, every worth of a radius, and a bridge."""
    count = len(s.nodes)
    sources, regimes = (np.arange(count) % 4).astype(np.uint8), (np.arange(count) // 2 % 4).astype(np.uint8)
    return replace(s, bridged=np.arange(len(s.edges)) == 1, radius_sources=sources, regimes=regimes)


MIXED = mixed(LOOPED)
SOURCES = [("unknown", "measured", "bounded", "modelled")[i] for i in MIXED.radius_sources.tolist()]
REGIMES = [("unknown", "tube", "sheet", "wire")[i] for i in MIXED.regimes.tolist()]


def test_a_stage_file_gives_regimes_sources_and_bridges_back(tmp_path: Path) -> None:
    write_skeleton(tmp_path / "s.ply", MIXED)
    back = read_skeleton(tmp_path / "s.ply")
    for name in ("bridged", "radius_sources", "regimes"):
        np.testing.assert_array_equal(getattr(back, name), getattr(MIXED, name))


def test_json_and_graphml_name_regimes_sources_and_bridges() -> None:
    document = json.loads(EXPORTS["json"](MIXED))
    assert (document["radius_source"], document["regime"]) == (SOURCES, REGIMES)
    assert document["bridged"] == MIXED.bridged.tolist()
    network = networkx.read_graphml(io.BytesIO(EXPORTS["graphml"](MIXED)))
    assert [network.nodes[str(i)]["radius_source"] for i in range(len(SOURCES))] == SOURCES
    assert [network.nodes[str(i)]["regime"] for i in range(len(REGIMES))] == REGIMES
    assert [network.edges[str(a), str(b)]["bridged"] for a, b in MIXED.edges.tolist()] == MIXED.bridged.tolist()


def test_swc_types_are_regimes_and_comments_say_bridges_and_sources() -> None:
    rows = to_swc(MIXED).decode().splitlines()
    data = [row.split() for row in rows if not row.startswith("#")]
    place = {tuple(map(float, row[2:5])): int(row[0]) for row in data}
    name = [place[tuple(node)] for node in MIXED.nodes.tolist()]
    kinds = {"unknown": "0", "tube": "11", "sheet": "12", "wire": "13"}
    assert [data[name[i] - 1][1] for i in range(len(name))] == [kinds[regime] for regime in REGIMES]
    a, b = MIXED.edges[1].tolist()
    assert f"# bridged {name[a]} {name[b]}" in rows
    said: dict[int, str] = {}
    for words in (row.split() for row in rows if row.startswith("# radius_source")):
        for first, _, last in (ids.partition("-") for ids in words[3:]):
            said |= dict.fromkeys(range(int(first), int(last or first) + 1), words[2])
    assert [said[name[i]] for i in range(len(name))] == SOURCES
