"""Our files in other programs, where these are installed: edges and values are there, by names they know."""

import json
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from plyfile import PlyData

from tiskel import Skeleton, evaluate, load_curve, make_shape
from tiskel.io.anything import MeasureFile, read_anything
from tiskel.io.mesh_file import MESHES, dump_mesh, mesh_bytes, parse_mesh
from tiskel.io.stages.heat import dump_heat
from tiskel.slicing.mesh import Mesh

CLOUD, TRUE = make_shape("y", 600)
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
MESH = Mesh(CORNERS, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32), np.array([2, 2, 1, 0], np.uint8))


def test_radii_are_named_for_cloudcompare_and_meshlab(tmp_path: Path) -> None:
    TRUE.save(tmp_path / "s.ply")
    vertex = PlyData.read(tmp_path / "s.ply")["vertex"]
    assert vertex["scalar_radius"].dtype == vertex["quality"].dtype == np.float32
    assert np.allclose(vertex["scalar_radius"], TRUE.radii)
    assert np.allclose(vertex["quality"], TRUE.radii)
    assert np.array_equal(Skeleton.load(tmp_path / "s.ply").radii, TRUE.radii)  # as they were, in double precision


def test_measures_are_named_for_them_and_read_back_once(tmp_path: Path) -> None:
    (tmp_path / "m.ply").write_bytes(dump_heat(evaluate(TRUE)))
    vertex = PlyData.read(tmp_path / "m.ply")["vertex"]
    assert np.array_equal(vertex["scalar_beta"], vertex["beta"], equal_nan=True)
    assert np.array_equal(vertex["quality"], vertex["beta"], equal_nan=True)
    read = read_anything(tmp_path / "m.ply")
    assert isinstance(read, MeasureFile)
    assert not {name for name in read.columns if name == "quality" or name.startswith("scalar_")}
    assert "beta" in read.columns


def test_trust_of_a_surface_is_its_quality() -> None:
    vertex = PlyData.read(BytesIO(dump_mesh(MESH)))["vertex"]
    assert vertex["quality"].tolist() == vertex["scalar_trust"].tolist() == [2, 2, 1, 0]


def test_missing_values_of_vtp_are_not_text(tmp_path: Path) -> None:
    """VTK knows no NaN in text, and reads nothing of a file that has one."""
    assert any(row.angle is None for row in TRUE.branch_table())
    TRUE.save(tmp_path / "s.vtp")
    assert "nan" not in (tmp_path / "s.vtp").read_text()
    read = load_curve(tmp_path / "s.vtp")
    assert np.array_equal(read.nodes, TRUE.nodes)
    assert np.array_equal(read.radii, TRUE.radii)


@pytest.mark.parametrize("suffix", [one for one in MESHES if one != ".glb"])
def test_meshes_come_back(suffix: str, tmp_path: Path) -> None:
    found = parse_mesh(mesh_bytes(MESH, tmp_path / f"a{suffix}"), f"a{suffix}")
    assert found is not None
    assert np.array_equal(found.vertices[found.triangles], MESH.vertices[MESH.triangles])


def test_what_has_no_faces_is_no_mesh() -> None:
    assert parse_mesh(b"OFF 2 0 0\n0 0 0\n1 1 1\n", "a.off") is None


def test_a_mesh_is_converted_to_a_mesh(tiskel: Any, tmp_path: Path) -> None:
    (tmp_path / "a.off").write_bytes(mesh_bytes(MESH, "a.off"))
    for source, target in (("a.off", "a.stl"), ("a.off", "a.obj"), ("a.obj", "b.ply"), ("b.ply", "b.off")):
        assert tiskel("convert", source, target).returncode == 0
    assert (tmp_path / "b.off").read_bytes() == (tmp_path / "a.off").read_bytes()
    assert tiskel("convert", "a.off", "c.ply", "--sample", 50).returncode == 0  # a cloud, where so many are asked for
    assert len(PlyData.read(tmp_path / "c.ply")["vertex"].data) == 50
    assert b"cannot be written as" in tiskel("convert", "c.ply", "c.stl").stderr


def test_trimesh_keeps_the_edges_of_ply(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    TRUE.save(tmp_path / "s.ply")
    raw = trimesh.load(tmp_path / "s.ply").metadata["_ply_raw"]
    assert np.array_equal(np.c_[raw["edge"]["data"]["vertex1"], raw["edge"]["data"]["vertex2"]], TRUE.edges)


def test_networkx_reads_graphml_and_node_link(tmp_path: Path) -> None:
    networkx = pytest.importorskip("networkx")
    TRUE.save(tmp_path / "s.graphml")
    TRUE.save(tmp_path / "s.node-link.json")
    document = json.loads((tmp_path / "s.node-link.json").read_text())
    for graph in (
        networkx.read_graphml(tmp_path / "s.graphml", node_type=int),
        networkx.node_link_graph(document, edges="edges" if "edges" in document else "links"),
    ):
        assert {tuple(sorted(edge)) for edge in graph.edges} == set(map(tuple, TRUE.edges.tolist()))
        assert graph.nodes[1]["radius"] == TRUE.radii[1]


def test_pandas_reads_segments_and_ours_of_it_are_read(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    TRUE.save(tmp_path / "s.csv")
    table = pandas.read_csv(tmp_path / "s.csv")
    assert len(table) == len(TRUE.edges)
    table.to_csv(tmp_path / "t.csv")  # with an index in front
    assert load_curve(tmp_path / "t.csv").length == pytest.approx(TRUE.length)


def test_meshio_reads_surfaces_with_their_values(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    (tmp_path / "a.ply").write_bytes(dump_mesh(MESH))
    found = meshio.read(tmp_path / "a.ply")
    assert np.array_equal(found.cells_dict["triangle"], MESH.triangles)
    assert found.point_data["trust"].tolist() == [2, 2, 1, 0]
    for suffix in ("off", "obj", "stl", "ply"):
        meshio.Mesh(found.points, found.cells).write(tmp_path / f"b.{suffix}")
        mesh = parse_mesh((tmp_path / f"b.{suffix}").read_bytes(), f"b.{suffix}")
        assert mesh is not None
        assert np.allclose(mesh.vertices[mesh.triangles], MESH.vertices[MESH.triangles])
