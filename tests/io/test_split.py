"""Clouds piece by piece: the same points as read whole, in every format, and what is wrong with a file is told."""

import gzip
from pathlib import Path

import numpy as np
import pytest

from tiskel import (
    JoinParams,
    ShapeParams,
    SplitParams,
    TiskelError,
    contract,
    extract_skeleton,
    join_skeletons,
    load_cloud,
    make_shape,
    named_shape,
    shape_graph,
    split_cloud,
    write_skeleton,
)
from tiskel.arrays import Points
from tiskel.io import pieces, text_pieces
from tiskel.io.clouds import dump_cloud
from tiskel.io.pieces import hash_of, pieces_of
from tiskel.io.tile_index import read_index


@pytest.fixture
def points() -> Points:
    return np.random.default_rng(0).permutation(make_shape(named_shape("knot"), ShapeParams(count=3000))[0]) * 1000


@pytest.fixture
def small_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pieces, "ROWS", 700)
    monkeypatch.setattr(text_pieces.text_pieces, "__defaults__", (20_000,))


def read(path: Path) -> list[Points]:
    return list(pieces_of(path).read())


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("suffix", ["ply", "npy", "xyz", "pts", "csv"])
def test_pieces_are_the_points_of_the_file(points: Points, tmp_path: Path, suffix: str, packed: bool) -> None:
    path = tmp_path / (f"c.{suffix}.gz" if packed else f"c.{suffix}")
    data = dump_cloud(points, f"c.{suffix}")
    path.write_bytes(gzip.compress(data) if packed else data)
    found = read(path)
    assert len(found) > 3
    np.testing.assert_array_equal(np.concatenate(found), load_cloud(path).points)


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("id;Z [m];Y;X\n", "{i};{z:.3f};{y:.3f};{x:.3f}\n"),
        ("//X Y Z Intensity\n", "{x:.3f} {y:.3f} {z:.3f} 7\n"),
        ("x;y;z\n", "{x:.3f};{y:.3f};{z:.3f}\n#comma"),
    ],
)
def test_all_pieces_of_a_table_are_read_as_its_head_says(points: Points, tmp_path: Path, header: str, row: str) -> None:
    rows = [row.format(i=i, x=x, y=y, z=z) for i, (x, y, z) in enumerate(points.tolist())]
    rows = [line.removesuffix("#comma").replace(".", ",") if "#" in line else line for line in rows]
    path = tmp_path / "c.csv"
    path.write_text(header + "".join(rows))
    found = read(path)
    assert len(found) > 3
    np.testing.assert_allclose(np.concatenate(found), points.round(3), atol=1e-9)
    np.testing.assert_array_equal(np.concatenate(found), load_cloud(path).points)


@pytest.mark.usefixtures("small_pieces")
def test_stage_files_records_and_ascii_are_read_too(points: Points, tmp_path: Path) -> None:
    skeleton = make_shape(shape_graph("y"), ShapeParams(count=2000))[1]
    write_skeleton(tmp_path / "s.ply", skeleton)
    np.testing.assert_array_equal(np.concatenate(read(tmp_path / "s.ply")), skeleton.cloud)
    records = np.zeros(3000, [("c", "i4"), ("z", "f4"), ("x", "f8"), ("y", "f8")])
    records["x"], records["y"], records["z"] = points.T
    np.save(tmp_path / "r.npy", records)
    np.testing.assert_array_equal(np.concatenate(read(tmp_path / "r.npy")), load_cloud(tmp_path / "r.npy").points)
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        "0 0 1\n0 1 0\n"
    )
    whole = pieces_of(tmp_path / "a.ply")
    assert next(whole.read()).tolist() == [[0, 0, 1], [0, 1, 0]]
    assert "read whole" in whole.notes[-1]


@pytest.mark.usefixtures("small_pieces")
def test_what_is_wrong_with_a_file_is_told(points: Points, tmp_path: Path) -> None:
    def written(name: str, data: bytes) -> Path:
        (tmp_path / name).write_bytes(data)
        return tmp_path / name

    whole = dump_cloud(points, "c.ply")
    for path, words in (
        (written("cut.ply", whole[:-100]), "the file is shorter"),
        (written("empty.xyz", b""), "is empty"),
        (written("head.csv", b"x,y,z\n"), "holds no points"),
        (written("c.pts", dump_cloud(points, "c.pts") + b"1 2 3\n"), "promises 3000 points, 3001 follow"),
        (written("c.xyz", dump_cloud(points, "c.xyz") + b"1 2 word\n"), "add"),
        (written("c.foo", b"words of a letter\n"), "unknown kind"),
        (tmp_path / "none.ply", "check the path"),
        (tmp_path, "is a directory"),
        (Path("-"), "name a file"),
    ):
        with pytest.raises(TiskelError, match=words):
            read(path)


def part_clouds(folder: Path) -> list[tuple[str, Points, np.ndarray, np.ndarray]]:
    clouds = [(part.name, load_cloud(folder / "clouds" / f"{part.name}.ply")) for part in read_index(folder).parts]
    return [(name, c.points, c.properties["row"].astype(int), c.properties["core"] > 0) for name, c in clouds]


@pytest.mark.usefixtures("small_pieces")
def test_every_finite_point_is_in_one_core(points: Points, tmp_path: Path) -> None:
    points[5], points[2000, 1] = np.nan, np.inf
    (tmp_path / "c.npy").write_bytes(dump_cloud(points, "c.npy"))
    index, _ = split_cloud(tmp_path / "c.npy", tmp_path / "d", SplitParams(points=500, overlap=150.0))
    assert index == read_index(tmp_path / "d")
    assert (index.points, index.not_finite) == (3000, 2)
    assert index.source == {"name": "c.npy", "sha256": hash_of(tmp_path / "c.npy")}
    seen = np.zeros(3000, int)
    for (name, at, rows, core), part in zip(part_clouds(tmp_path / "d"), index.parts, strict=True):
        np.testing.assert_array_equal(at, points[rows])
        seen[rows[core]] += 1
        assert (part.name, part.points, part.core) == (name, len(rows), core.sum())
        assert part.sha256 == hash_of(tmp_path / "d" / "clouds" / f"{name}.ply")
        assert part.low == tuple(at[core].min(axis=0))
    np.testing.assert_array_equal(seen, np.isfinite(points).all(axis=1))


def test_a_folder_that_is_split_again_has_no_files_of_before(points: Points, tmp_path: Path) -> None:
    path = tmp_path / "c.ply"
    path.write_bytes(dump_cloud(points, path))
    for settings in (SplitParams(points=500, overlap=150.0), SplitParams(points=2000, overlap=150.0)):
        index, _ = split_cloud(path, tmp_path / "d", settings)
        files = sorted(file.name for file in (tmp_path / "d" / "clouds").iterdir())
        assert files == sorted(f"{part.name}.ply" for part in index.parts)
    data = [file.read_bytes() for file in sorted((tmp_path / "d").rglob("*.*"))]
    split_cloud(path, tmp_path / "d", settings)
    assert data == [file.read_bytes() for file in sorted((tmp_path / "d").rglob("*.*"))]


def test_objects_are_files_and_crumbs_are_kept_apart(tmp_path: Path) -> None:
    one = make_shape(shape_graph("y"), ShapeParams(count=3000))[0]
    other = make_shape(shape_graph("torus"), ShapeParams(count=2000))[0] + [9.0, 0, 0]
    crumbs = np.random.default_rng(0).normal(size=(20, 3)) * 0.01 + [0, 30.0, 0]
    points = np.random.default_rng(1).permutation(np.concatenate([one, other, crumbs]))
    (tmp_path / "c.npy").write_bytes(dump_cloud(points, "c.npy"))
    index, _ = split_cloud(tmp_path / "c.npy", tmp_path / "d", SplitParams(parts="objects"))
    assert [part.points for part in index.parts] == [3000, 2000]
    assert index.rest == len(load_cloud(tmp_path / "d" / "rest.ply").points) == 20
    rows = np.concatenate([rows for _, _, rows, _ in part_clouds(tmp_path / "d")])
    assert len(np.unique(rows)) == 5000
    for part in index.parts:
        cloud = load_cloud(tmp_path / "d" / "clouds" / f"{part.name}.ply")
        folder = tmp_path / "d" / "skeletons" / part.name
        folder.mkdir(parents=True)
        write_skeleton(folder / "skeleton.ply", extract_skeleton(contract(cloud.points)), cloud.source)
    made, _ = join_skeletons(tmp_path / "d")
    assert (made.components, made.loops, made.ends) == (2, 1, 3)
    np.testing.assert_array_equal(made.cloud, points[made.input_rows])
    assert len(made.cloud) == 5000


@pytest.fixture
def parts(points: Points, tmp_path: Path) -> Path:
    """A knot in tiles, each with its skeleton."""
    (tmp_path / "c.npy").write_bytes(dump_cloud(points, "c.npy"))
    split_cloud(tmp_path / "c.npy", tmp_path / "d", SplitParams(points=1600, overlap=450.0))
    (tmp_path / "d" / "skeletons").mkdir()
    for name, at, _, _ in part_clouds(tmp_path / "d"):
        source = load_cloud(tmp_path / "d" / "clouds" / f"{name}.ply").source
        skeleton = extract_skeleton(contract(at))
        write_skeleton(tmp_path / "d" / "skeletons" / f"{name}.skeleton.ply", skeleton, source)
    return tmp_path / "d"


def test_the_joined_skeleton_holds_points_of_the_cloud_and_their_nodes(parts: Path, points: Points) -> None:
    made, _ = join_skeletons(parts, JoinParams(keep="all"))
    assert len(read_index(parts).parts) > 1
    assert (made.components, made.loops, made.ends) == (1, 1, 0)
    np.testing.assert_array_equal(made.cloud, points)
    np.testing.assert_array_equal(made.input_rows, np.arange(3000))
    away = np.linalg.norm(made.nodes[made.node_of_point] - made.cloud, axis=1)
    assert (away < 2.5 * made.radii[made.node_of_point]).mean() > 0.98
    few, _ = join_skeletons(parts, JoinParams(keep=100))
    assert 90 <= len(few.cloud) <= 100
    np.testing.assert_array_equal(few.nodes, made.nodes)
    np.testing.assert_array_equal(few.cloud, points[few.input_rows])


def test_missing_foreign_and_empty_parts_are_told(parts: Path, points: Points) -> None:
    name = read_index(parts).parts[0].name
    file = parts / "skeletons" / f"{name}.skeleton.ply"
    data = file.read_bytes()
    file.unlink()
    with pytest.raises(TiskelError, match=f"{name} of . parts have no skeleton"):
        join_skeletons(parts)
    made, _ = join_skeletons(parts, JoinParams(incomplete=True))
    assert "missing" in {warning.code for warning in made.warnings}
    assert made.ends > 0
    other = parts / "skeletons" / f"{read_index(parts).parts[1].name}.skeleton.ply"
    file.write_bytes(other.read_bytes())
    with pytest.raises(TiskelError, match="another cloud"):
        join_skeletons(parts)
    file.write_bytes(data[: len(data) // 2])
    with pytest.raises(TiskelError, match="not a valid PLY"):
        join_skeletons(parts)
    (parts / "index.json").write_text('{"format": 1, "parts": []}')
    with pytest.raises(TiskelError, match="is damaged"):
        join_skeletons(parts)
    (parts / "index.json").write_text('{"format": 99}')
    with pytest.raises(TiskelError, match="newer"):
        join_skeletons(parts)
