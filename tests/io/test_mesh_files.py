"""Meshes for other programs: each is read back by one."""

import json
import struct
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from tiskel import TiskelError, contract, make_shape
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.io.clouds import parse_cloud
from tiskel.io.mesh_file import mesh_bytes
from tiskel.io.stages.contraction import dump_contraction, parse_contraction
from tiskel.slicing.mesh import Mesh

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + 1000
MESH = Mesh(CORNERS, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32))


@pytest.mark.parametrize("suffix", ["ply", "obj", "stl", "glb"])
def test_trimesh_reads_every_format(suffix: str) -> None:
    trimesh = pytest.importorskip("trimesh")
    found = trimesh.load(BytesIO(mesh_bytes(MESH, f"a.{suffix}")), file_type=suffix, force="mesh")
    assert found.is_watertight
    assert found.volume == pytest.approx(1 / 6, rel=1e-3)  # positive: seen from outside
    np.testing.assert_allclose(found.bounds, [[1000] * 3, [1001] * 3])


def test_an_unknown_suffix_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TiskelError, match=r"cannot be written as '\.xyz'; choose one of \.ply, \.obj, \.stl, \.glb"):
        mesh_bytes(MESH, tmp_path / "a.xyz")


def test_a_mesh_without_a_finite_face_is_refused() -> None:
    corners = b"v 0 0 0\nv 1 0 0\nv nan 1 0\nv 0 0 1\n"
    with pytest.raises(TiskelError, match=r"a\.obj has no face whose corners are finite; export it again"):
        parse_cloud(corners + b"f 1 2 3\nf 3 4 1\n", "a.obj")
    (said,) = parse_cloud(corners + b"f 1 2 3\nf 1 2 4\n", "a.obj", mesh_samples=50).warnings
    assert said == "a.obj: 1 of 2 faces have corners that are not finite and were left out"


def test_stl_holds_unit_normals_that_look_outwards() -> None:
    data = mesh_bytes(MESH, "a.stl")
    assert len(data) == 84 + 50 * len(MESH.triangles)
    assert struct.unpack_from("<I", data, 80) == (len(MESH.triangles),)
    facets = np.frombuffer(data, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("remark", "<u2")], offset=84)
    away = facets["corners"].mean(axis=1) - CORNERS.mean(axis=0)
    np.testing.assert_allclose(np.linalg.norm(facets["normal"], axis=1), 1, rtol=1e-6)
    assert (np.einsum("ij,ij->i", facets["normal"], away) > 0).all()
    edges = np.diff(facets["corners"], axis=1)
    np.testing.assert_allclose(np.einsum("ijk,ik->ij", edges, facets["normal"]), 0, atol=1e-6)


def test_glb_is_as_long_as_it_says_and_its_views_are_where_they_say() -> None:
    data = mesh_bytes(MESH, "a.glb")
    assert struct.unpack_from("<4sII", data) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert (kind, length % 4) == (b"JSON", 0)
    document = json.loads(data[20 : 20 + length])
    size, kind = struct.unpack_from("<I4s", data, 20 + length)
    body = data[28 + length :]
    assert (kind, size) == (b"BIN\0", len(body))
    assert document["buffers"] == [{"byteLength": len(body)}]
    places, corners = (body[v["byteOffset"] : v["byteOffset"] + v["byteLength"]] for v in document["bufferViews"])
    points, faces = np.frombuffer(places, "<f4").reshape(-1, 3), np.frombuffer(corners, "<u4").reshape(-1, 3)
    np.testing.assert_array_equal(points + np.array(document["nodes"][0]["translation"]), CORNERS)
    np.testing.assert_array_equal(faces, MESH.triangles)
    first, second = document["accessors"]
    assert (first["count"], first["componentType"], first["type"]) == (4, 5126, "VEC3")
    assert (first["min"], first["max"]) == (points.min(axis=0).tolist(), points.max(axis=0).tolist())
    assert (second["count"], second["componentType"], second["type"]) == (12, 5125, "SCALAR")
    assert [view["target"] for view in document["bufferViews"]] == [34962, 34963]


@pytest.mark.parametrize("handles", [1, None])
def test_a_contraction_of_a_mesh_keeps_what_is_known_of_the_mesh(handles: int | None) -> None:
    rng = np.random.default_rng(0)
    points, (cloud, _) = rng.normal(size=(300, 3)), make_shape("capsule", 300)
    surface = MeshSurface(points, rng.random(300), np.array([[0, 1], [2, 299]], np.int32), True, handles)
    contraction = replace(contract(cloud), surface=surface)
    data = dump_contraction(contraction)
    found = parse_contraction(data, "c.ply").surface
    assert found is not None
    assert (found.outward, found.handles) == (True, handles)
    for name in ("normals", "areas", "links"):
        np.testing.assert_array_equal(getattr(found, name), getattr(surface, name))
    wrong = replace(surface, links=np.array([[0, 1], [2, 300]], np.int32))
    with pytest.raises(TiskelError, match=r"surface_link.*row 1: b is 300, it must be from 0 to 299"):
        parse_contraction(dump_contraction(replace(contraction, surface=wrong)), "c.ply")
