"""Meshes for other programs: each is read back by one."""

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from tiskel import TiskelError
from tiskel.io.clouds import parse_cloud
from tiskel.io.mesh_file import mesh_bytes
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
