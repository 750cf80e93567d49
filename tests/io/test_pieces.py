"""Clouds piece by piece and files that grow: every kind of header, rows in the worst places, disks that refuse."""

import gzip
import io
import struct
from pathlib import Path

import numpy as np
import pytest

from tiskel import SplitParams, TiskelError, load_cloud, split_cloud
from tiskel.arrays import Points
from tiskel.io import pieces, split, tile_writer
from tiskel.io.clouds import dump_cloud
from tiskel.io.formats import text
from tiskel.io.pieces import pieces_of
from tiskel.io.text_pieces import text_pieces
from tiskel.io.tile_index import TileIndex
from tiskel.io.tile_writer import CloudFiles, read_rows

POINTS = np.random.default_rng(0).random((300, 3))


def npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def ply(*elements: str, body: bytes = b"") -> bytes:
    axes = "".join(f"property double {axis}\n" for axis in "xyz")
    head = "ply\nformat binary_little_endian 1.0\n" + "".join(elements).replace("XYZ", axes) + "end_header\n"
    return head.encode() + body


ROWS = POINTS.tobytes()
VERTEX, STRIP = "element vertex 300\nXYZ", "element strip 1\nproperty list uchar int at\n"
READ_WHOLE = {
    "lists before the points.ply": ply(STRIP, VERTEX, body=struct.pack("<B3i", 3, 0, 1, 2) + ROWS),
    "as Fortran has it.npy": npy(np.asfortranarray(POINTS)),
    "in UTF-16.xyz": dump_cloud(POINTS, "a.xyz").decode().encode("utf-16"),
}
BY_ROWS = {
    "lists behind the points.ply": ply(VERTEX, STRIP, body=ROWS + struct.pack("<B3i", 3, 0, 1, 2)),
    "cameras before the points.ply": ply("element camera 2\nproperty short f\n", VERTEX, body=bytes(4) + ROWS),
    "more columns.npy": npy(np.hstack([POINTS, POINTS])),
}


@pytest.mark.parametrize("name", [*READ_WHOLE, *BY_ROWS])
def test_points_stand_anywhere_in_a_file(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes((READ_WHOLE | BY_ROWS)[name])
    found = pieces_of(tmp_path / name)
    np.testing.assert_array_equal(np.concatenate(list(found.read())), POINTS)
    assert any("is read whole" in note for note in found.notes) == (name in READ_WHOLE)


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.ply", ply("element vertex 2\nproperty double x\n", body=bytes(16)), "it needs x, y and z"),
        ("a.ply", ply("elephants 2\n"), "not a valid PLY"),
        ("a.ply", b"ply\nformat ascii 1.0\n", "not a valid PLY"),
        ("a.npy", npy(np.zeros((4, 3), bool)), "a.npy holds bool, not real numbers"),
        ("a.npy", npy(np.zeros((3, 4))), "got (3, 4); transpose it"),
        ("a.npy", npy(np.zeros((4, 3), object)), "Object arrays cannot be loaded"),
        ("a.npy", b"\x93NUMPY\x01\x00\x10\x00" + b"{" * 16, "a.npy is not a valid NumPy file"),
        ("a.npy", b"\x93NUMPY\x09\x00\x10\x00" + b" " * 16, "not (9, 0); save it again"),
        ("a.npy", npy(np.zeros(4, [("x", "f8"), ("y", "f8")])), "a.npy holds records of x, y"),
        ("a.xyz.gz", gzip.compress(ROWS, mtime=0)[:5], "a.xyz.gz is no whole gzip file"),
        ("a.xyz", b"0 0 1\n" * 70 + b"0 0 one\n", "line 71 has 'one'"),
    ],
)
def test_what_cannot_be_read_is_told_as_it_is_of_a_whole_file(
    name: str, data: bytes, said: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(TiskelError) as error:
        list(pieces_of(tmp_path / name).read())
    assert said in str(error.value)
    assert "(add" not in str(error.value)  # of a number of lines that a reader would have to add: it is right as it is
    with pytest.raises(TiskelError) as error:
        load_cloud(tmp_path / name)
    assert said in str(error.value)


def test_a_name_that_no_file_can_have_is_told() -> None:
    for name, said in (
        ("a" * 300 + ".ply", r"cannot read aaa.*: File name too long"),
        ("a\0b.ply", "null (byte|character).*; check"),
    ):
        with pytest.raises(TiskelError, match=said):
            pieces_of(name)


def test_pieces_of_comments_and_of_blank_lines_hold_no_points() -> None:
    rows = [f"{i} {i * i} 1\n" for i in range(140)]
    data = "".join([*rows[:70], "# a comment\n\n" * 40, *rows[70:]]).encode()
    found = list(text_pieces(lambda: io.BytesIO(data), text.XYZ.read, "a.xyz", 60))
    assert all(len(piece) for piece in found)
    assert np.concatenate(found)[:, 0].tolist() == list(range(140))
    with pytest.raises(TiskelError, match=r"a\.xyz holds no points; check how it was made"):
        next(text_pieces(lambda: io.BytesIO(b"5\n"), text.XYZ.read, "a.xyz"))


def test_a_part_that_grows_in_several_writes_is_what_it_is_in_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def written(folder: Path) -> bytes:
        folder.mkdir()
        with CloudFiles(folder) as files:
            for start in range(0, 300, 50):
                rows = np.arange(start, start + 50)
                files.add("a", POINTS[rows], rows, rows % 2 == 0)
            files.finish()
        assert [file.name for file in folder.iterdir()] == ["a.ply"]
        return (folder / "a.ply").read_bytes()

    once = written(tmp_path / "once")
    monkeypatch.setattr(tile_writer, "WAITING", 100 * tile_writer.ROW.itemsize)
    assert written(tmp_path / "often") == once
    points, rows, core = read_rows(tmp_path / "often" / "a.ply")
    np.testing.assert_array_equal(points, POINTS)
    np.testing.assert_array_equal(rows, np.arange(300))
    np.testing.assert_array_equal(core, rows % 2 == 0)


def test_a_folder_that_takes_no_parts_is_told_and_no_part_is_left(tmp_path: Path) -> None:
    rows = np.arange(300)
    (tmp_path / "a.ply").mkdir()  # in the place of what is to be
    for folder, said in ((tmp_path / "none", "No such file or directory"), (tmp_path, "Is a directory")):
        with CloudFiles(folder) as files:
            files.add("a", POINTS, rows, rows >= 0)
            with pytest.raises(TiskelError, match=f"cannot write into {folder}: {said}; check its permissions and"):
                files.finish()
    assert [file.name for file in tmp_path.iterdir()] == ["a.ply"]


def divided(folder: Path, points: Points, params: SplitParams) -> tuple[TileIndex, tuple[str, ...]]:
    folder.mkdir()
    (folder / "c.npy").write_bytes(npy(points))
    return split_cloud(folder / "c.npy", folder / "d", params)


def test_the_order_of_the_rows_changes_no_tile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces of nothing but rows that are not finite, and pieces that lie in the margin of a tile alone."""
    x = np.linspace(0, 100, 3000)
    points = np.stack([x, np.cos(7 * x), np.sin(7 * x)], axis=1)
    params = SplitParams(points=1600, overlap=10.0)
    whole, _ = divided(tmp_path / "a", points, params)
    monkeypatch.setattr(pieces, "ROWS", 50)
    with_holes = np.concatenate([points[:1500], np.full((120, 3), np.nan), points[1500:]])
    found, _ = divided(tmp_path / "b", with_holes, params)
    assert (found.points, found.not_finite) == (3120, 120)
    assert len(found.parts) > 1
    for part, same in zip(found.parts, whole.parts, strict=True):
        assert (part.points, part.core, part.low, part.high) == (same.points, same.core, same.low, same.high)
        at, rows, core = read_rows(tmp_path / "b" / "d" / "clouds" / f"{part.name}.ply")
        np.testing.assert_array_equal(at, with_holes[rows])
        assert (part.low, part.high) == (tuple(at[core].min(axis=0)), tuple(at[core].max(axis=0)))


def test_tiles_larger_than_asked_for_are_told(tmp_path: Path) -> None:
    x = np.linspace(0, 100, 3000)
    points = np.stack([x, np.cos(7 * x), np.sin(7 * x)], axis=1)
    index, notes = divided(tmp_path / "a", points, SplitParams(points=500, overlap=20.0))
    largest = max(part.core for part in index.parts)
    assert notes == (
        f"tiles hold up to {largest} points without their margins, 500 were asked for: none is narrower than two "
        "overlaps of 20; choose a smaller one with --overlap",
    )
    assert divided(tmp_path / "b", points, SplitParams(points=500, overlap=2.0))[1] == ()


def test_clouds_of_too_many_rows_and_folders_that_cannot_be_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "c.npy").write_bytes(npy(POINTS))
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(TiskelError, match=r"cannot make the folder .*clouds: Not a directory; choose another with -o"):
        split_cloud(tmp_path / "c.npy", tmp_path / "file" / "d")
    monkeypatch.setattr(split, "MOST_ROWS", 299)
    with pytest.raises(TiskelError, match=r"c\.npy has 300 rows, files name at most 299; cut it in two first"):
        split_cloud(tmp_path / "c.npy", tmp_path / "d")
