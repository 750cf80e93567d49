"""What tables, curves and clouds hold, to the last column, row and word: generated files, values known."""

import csv
import io
from pathlib import Path

import numpy as np
import pytest

from tiskel import Cloud, Skeleton, TiskelError, load_cloud, make_shape, skeleton_table
from tiskel.geometry.branch_table import BranchRow
from tiskel.io.clouds import dump_cloud
from tiskel.io.exports import branches_csv, to_swc

BOX = """0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"""
FACES = """0 2 1\n1 2 3\n4 5 6\n5 7 6\n0 1 4\n1 5 4\n2 6 3\n3 6 7\n0 4 2\n2 4 6\n1 3 5\n3 7 5\n"""


@pytest.fixture(scope="module")
def mug() -> Skeleton:
    return make_shape("mug", 500)[1]


def test_tables_of_pandas_have_the_columns_that_are_told(mug: Skeleton) -> None:
    pytest.importorskip("pandas")
    nodes, edges = skeleton_table(mug), skeleton_table(mug, "edges")
    assert list(nodes) == ["x", "y", "z", "radius", "radius_source", "regime", "branch", "degree"]
    np.testing.assert_array_equal(nodes[["x", "y", "z"]], mug.nodes)
    np.testing.assert_array_equal(nodes["radius"], mug.radii)
    np.testing.assert_array_equal(nodes["branch"], mug.branch_of_node())
    np.testing.assert_array_equal(nodes["degree"], mug.degrees)
    assert list(edges) == ["first", "last", "length", "bridged"]
    np.testing.assert_array_equal(edges[["first", "last"]], mug.edges)
    np.testing.assert_array_equal(edges["length"], mug.lengths)
    np.testing.assert_array_equal(edges["bridged"], mug.bridged)


def test_the_table_of_branches_holds_every_number_as_it_is(mug: Skeleton) -> None:
    text = branches_csv(mug).decode()
    assert "\r" not in text
    head, *rows = csv.reader(io.StringIO(text))
    assert head == list(BranchRow.__dataclass_fields__)
    assert len(rows) == len(mug.branch_table())
    for cells, row in zip(rows, mug.branch_table(), strict=True):
        for name, cell in zip(head, cells, strict=True):
            value = getattr(row, name)
            assert cell == ("" if value is None else str(value))  # str of a float is all of its digits


def test_swc_starts_at_an_end_and_names_what_its_tree_leaves_out(mug: Skeleton) -> None:
    lines = to_swc(mug).decode().splitlines()
    assert lines[0].startswith("# tiskel ")
    assert lines[1] == "# id type x y z radius parent"
    loops = [line for line in lines if line.startswith("# loop ")]
    samples = [line.split() for line in lines if not line.startswith("#")]
    assert [int(sample[0]) for sample in samples] == list(range(1, len(mug.nodes) + 1))
    parents = [int(sample[6]) for sample in samples]
    assert [parent for parent in parents if parent < 1] == [-1]  # one component
    assert all(parent < child for child, parent in enumerate(parents, 1))
    root = np.array(samples[0][2:5], float)
    (node,) = np.flatnonzero((mug.nodes == root).all(axis=1))
    assert mug.degrees[node] == 1
    named = {tuple(sorted(map(int, line.split()[2:]))) for line in loops}
    tree = {tuple(sorted((child, parent))) for child, parent in enumerate(parents, 1) if parent > 0}
    assert len(named) == mug.loops == 1
    assert len(tree | named) == len(mug.edges)


def mesh_of(path: Path, extra: str, faces: str) -> Path:
    """Write a box as PLY with a value at every corner, and more corners and faces if there are."""
    vertices = [f"{line} {0.5 * i}" for i, line in enumerate((BOX + extra).splitlines())]
    triangles = [f"3 {line}" for line in faces.splitlines()]
    head = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property float {c}" for c in "xyz")]
    head += ["property float quality", f"element face {len(triangles)}", "property list uchar int vertex_indices"]
    path.write_text("\n".join([*head, "end_header", *vertices, *triangles]) + "\n")
    return path


def test_a_mesh_is_sampled_by_its_seed_and_keeps_no_values_of_its_corners(tmp_path: Path) -> None:
    path = mesh_of(tmp_path / "box.ply", "", FACES)
    one, same, other = (load_cloud(path, mesh_samples=300, seed=seed) for seed in (0, 0, 1))
    np.testing.assert_array_equal(one.points, same.points)
    assert not np.array_equal(one.points, other.points)
    assert one.properties == {}
    assert one.surface is not None
    assert one.mesh is not None
    assert any("sampled to" in note and "(as asked)" in note for note in one.notes)
    assert not any("hardly hang together" in note or "inside other parts" in note for note in one.notes)


def test_faces_with_corners_that_are_no_numbers_are_left_out_and_counted(tmp_path: Path) -> None:
    path = mesh_of(tmp_path / "torn.ply", "nan 0 0\n", FACES + "0 1 8\n")
    cloud = load_cloud(path, mesh_samples=200)
    assert "torn.ply: 1 of 13 faces have corners that are not finite and were left out" in cloud.warnings
    assert np.isfinite(cloud.points).all()


def test_columns_are_taken_by_name_in_the_order_that_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("a,b,c,d\n" + "".join(f"{i},{10 * i},{100 * i},{i * i}\n" for i in range(5)))
    found = load_cloud(path, columns=("c", "a", "b")).points
    np.testing.assert_array_equal(found, np.arange(5.0)[:, None] * [100, 1, 10])


def test_points_of_a_class_keep_their_values() -> None:
    points = np.arange(12.0).reshape(4, 3)
    values = {"classification": np.array([2.0, 5, 2, 6]), "intensity": np.array([1.0, 2, 3, 4])}
    cloud = Cloud(points, properties=values, name="scan.las")
    found = cloud.of_classes([2])
    np.testing.assert_array_equal(found.points, points[[0, 2]])
    np.testing.assert_array_equal(found.properties["intensity"], [1, 3])
    np.testing.assert_array_equal(found.properties["classification"], [2, 2])
    assert "2 of 4 points are of class 2" in found.notes
    with pytest.raises(TiskelError, match=r"scan\.las has no point of class 7, 8; it has 2, 5, 6"):
        cloud.of_classes([7, 8])
    with pytest.raises(TiskelError, match="plain says no classification of its points; leave --classification out"):
        Cloud(points, name="plain").of_classes([2])


def test_a_cloud_for_standard_output_is_ply() -> None:
    assert dump_cloud(np.zeros((2, 3)), "-").startswith(b"ply\n")
