"""Files of any kind: what they hold is told by what is in them, not by how they are named alone."""

import gzip
from pathlib import Path

import numpy as np
import pytest

from tiskel import Contraction, Curve, Skeleton, TiskelError, contract, extract_skeleton, make_shape
from tiskel.io.anything import MeshFile, read_anything
from tiskel.io.clouds import Cloud, dump_cloud
from tiskel.io.exports import EXPORTS
from tiskel.io.mesh_file import mesh_bytes
from tiskel.io.stages.contraction import dump_contraction
from tiskel.slicing.mesh import Mesh

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32)
TRUE = make_shape("y", 300)[1]


def put(folder: Path, name: str, data: bytes) -> Path:
    (folder / name).write_bytes(data)
    return folder / name


@pytest.mark.parametrize("suffix", ["ply", "obj", "stl", "ply.gz"])
def test_a_mesh_is_one_whether_packed_or_not(suffix: str, tmp_path: Path) -> None:
    data = mesh_bytes(Mesh(CORNERS, FACES), f"a.{suffix.removesuffix('.gz')}")
    found = read_anything(put(tmp_path, f"a.{suffix}", gzip.compress(data) if suffix.endswith("gz") else data))
    assert isinstance(found, MeshFile)
    assert found.name == f"a.{suffix}"
    np.testing.assert_allclose(np.sort(found.points[found.faces], axis=1), np.sort(CORNERS[FACES], axis=1), atol=1e-6)


@pytest.mark.parametrize("suffix", ["ply", "xyz", "npy", "xyz.gz"])
def test_points_alone_are_a_cloud(suffix: str, tmp_path: Path) -> None:
    data = dump_cloud(CORNERS, f"a.{suffix.removesuffix('.gz')}")
    found = read_anything(put(tmp_path, f"a.{suffix}", gzip.compress(data) if suffix.endswith("gz") else data))
    assert isinstance(found, Cloud)
    np.testing.assert_array_equal(found.points, CORNERS)


@pytest.mark.parametrize("suffix", ["obj", "swc", "graphml", "json", "node-link.json"])
def test_edges_without_faces_are_a_curve(suffix: str, tmp_path: Path) -> None:
    found = read_anything(put(tmp_path, f"a.{suffix}", EXPORTS[suffix](TRUE)))
    assert isinstance(found, Curve)
    assert len(found.edges) == len(TRUE.edges)


def test_lines_and_edges_beside_faces_are_a_mesh(tmp_path: Path) -> None:
    obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\n"
    ply = (
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        b"element edge 1\nproperty int vertex1\nproperty int vertex2\n"
        b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 1\n3 0 1 2\n"
    )
    for name, data in (("a.obj", obj), ("a.ply", ply)):
        found = read_anything(put(tmp_path, name, data))
        assert isinstance(found, MeshFile)
        assert found.faces.tolist() == [[0, 1, 2]]
    bare = ply.replace(b"element face 1\nproperty list uchar int vertex_indices\n", b"").removesuffix(b"3 0 1 2\n")
    found = read_anything(put(tmp_path, "b.ply", bare))
    assert isinstance(found, Curve)
    assert found.edges.tolist() == [[0, 1]]


def test_stage_files_are_what_their_first_comment_says(tmp_path: Path) -> None:
    made = contract(make_shape("y", 300)[0])
    found = read_anything(put(tmp_path, "a.ply", dump_contraction(made)))
    assert isinstance(found, Contraction)
    np.testing.assert_array_equal(found.points, made.points)
    extract_skeleton(made).save(tmp_path / "b.ply")
    assert isinstance(read_anything(tmp_path / "b.ply"), Skeleton)


def test_documents_without_a_place_in_space_are_refused(tmp_path: Path) -> None:
    empty = b'{"stage": "surface", "format": 1, "cloud": [], "surfaces": [], "rejected": {}}'
    for data, said in (
        (b'{"counts": 3}', "a.json holds nothing that has a place in space; name a cloud, a curve"),
        (empty, "a.json holds no surface; run tiskel slice again"),
        (b'{"nodes": [[0, 0]], "edges": []}', "a.json is not a valid JSON curve: nodes have rows of 2 numbers"),
    ):
        with pytest.raises(TiskelError) as error:
            read_anything(put(tmp_path, "a.json", data))
        assert said in str(error.value)
