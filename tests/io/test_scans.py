"""Scans as scanners and surveyors give them: LAS, LAZ, E57, PTX; classes, columns, and what packed files become."""

import gzip
import importlib.util
import io
import random
import re
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from reference.dying import dies
from reference.e57 import INTENSITIES
from reference.e57 import POINTS as POINTS_E57
from reference.e57 import SCAN as SCAN_E57
from tiskel import TiskelError, load_cloud
from tiskel.io.clouds import parse_cloud
from tiskel.io.formats import e57, las
from tiskel.io.formats.isolated import read_apart

POINTS = np.round(np.random.default_rng(0).random((60, 3)) * 100 + [694386, 5155487, 380], 3)
CLASSES = np.arange(60) % 5


def las_bytes(*, packed: bool = False) -> bytes:
    laspy = pytest.importorskip("laspy")
    made = laspy.create(point_format=3, file_version="1.4")
    made.header.scales, made.header.offsets = [0.001] * 3, [694000, 5155000, 0]
    made.x, made.y, made.z = POINTS.T
    made.classification, made.intensity = CLASSES, np.arange(60)
    out = io.BytesIO()
    made.write(out, do_compress=packed)
    return out.getvalue()


@pytest.mark.parametrize("packed", [False, True])
def test_las_is_exact_and_knows_classes_and_intensities(packed: bool, tmp_path: Path) -> None:
    (tmp_path / "a.laz").write_bytes(las_bytes(packed=packed))
    cloud = load_cloud(tmp_path / "a.laz")
    np.testing.assert_allclose(cloud.points, POINTS, rtol=0, atol=1e-9)  # rounding of one product and one sum
    np.testing.assert_array_equal(cloud.properties["classification"], CLASSES)
    np.testing.assert_array_equal(cloud.properties["intensity"], np.arange(60))
    some = load_cloud(tmp_path / "a.laz", classification=[3, 4])
    np.testing.assert_array_equal(some.points, cloud.points[CLASSES > 2])
    assert some.notes == ("24 of 60 points are of class 3, 4",)
    with pytest.raises(TiskelError, match="has no point of class 9; it has 0, 1, 2, 3, 4"):
        load_cloud(tmp_path / "a.laz", classification=[9])


def test_las_that_promises_more_than_it_holds_is_refused_before_any_library_sees_it() -> None:
    data = bytearray(las_bytes())
    data[247:255] = (10**15).to_bytes(8, "little")
    with pytest.raises(TiskelError, match="promises 1000000000000000 points of 34 bytes, 2040 follow"):
        las.read(bytes(data), "a.las")
    packed = bytearray(las_bytes(packed=True))
    packed[247:255] = (10**15).to_bytes(8, "little")
    with pytest.raises(TiskelError, match="more than 50 times as much"):
        las.read(bytes(packed), "a.laz")
    packed = bytearray(las_bytes(packed=True))
    at = packed.find(b"laszip encoded") - 2 + 54 + 12
    assert int.from_bytes(packed[at : at + 4], "little") in (50_000, 0xFFFFFFFF)
    packed[at : at + 4] = (8_000_000).to_bytes(4, "little")  # the library makes room for a chunk of so many points
    with pytest.raises(TiskelError, match="has chunks of 259 MB from 1 kB"):
        las.read(bytes(packed), "a.laz")
    with pytest.raises(TiskelError, match="does not begin with a whole header"):
        las.read(bytes(data[:100]), "a.las")


def test_a_real_scan_in_las(reference_folder: Path) -> None:
    pytest.importorskip("laspy")
    cloud = load_cloud(reference_folder / "clouds" / "tree_scan.las")
    assert cloud.points.shape == (20198, 3)
    np.testing.assert_allclose(cloud.points[0], [-5.4155002, 15.8999996, 19.638999], atol=1e-6)


def test_e57_stands_in_the_world() -> None:
    pytest.importorskip("e57")
    cloud = parse_cloud(SCAN_E57, "a.e57")
    np.testing.assert_allclose(cloud.points, POINTS_E57, atol=1e-9)
    np.testing.assert_allclose(cloud.properties["intensity"], INTENSITIES)


def test_without_the_reader_of_e57_its_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    with pytest.raises(TiskelError, match=r"a\.e57: E57 needs a reader; pip install 'tiskel\[e57\]'"):
        parse_cloud(SCAN_E57, "a.e57")


@pytest.mark.parametrize("proc", [True, False])
def test_the_reader_of_e57_leaves_no_file_behind(proc: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It reads from a name only; where no /proc names what has none, it gets one."""
    e57_reader = pytest.importorskip("e57")
    exists = Path.exists
    monkeypatch.setattr(Path, "exists", lambda path: (proc or "/proc" not in str(path)) and exists(path))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    arrays = e57.arrays_of(SCAN_E57)
    assert set(arrays) == {"points", "intensity", "red", "green", "blue"}
    np.testing.assert_allclose(arrays["points"], POINTS_E57, atol=1e-9)
    assert list(tmp_path.iterdir()) == []
    found = SimpleNamespace(points=arrays["points"], intensity=np.zeros(0), color=np.zeros((0, 3)))
    monkeypatch.setattr(e57_reader, "read_points", lambda name: found if Path(name).read_bytes() == SCAN_E57 else None)
    assert set(e57.arrays_of(SCAN_E57)) == {"points"}


def test_a_compiled_reader_that_dies_is_one_line() -> None:
    with pytest.raises(TiskelError, match=r"a\.laz is not a valid LAZ file: its reader died \(-6\)"):
        read_apart(dies, b"", "a.laz", "LAZ")


def test_laz_whose_chunks_are_larger_than_the_file_is_refused() -> None:
    data = bytearray(las_bytes(packed=True))
    start = int.from_bytes(data[96:100], "little")
    table = int.from_bytes(data[start : start + 8], "little")
    data[table + 8 :] = random.Random(0).randbytes(40)  # packed: a chunk of more bytes than anyone has
    with pytest.raises(
        TiskelError, match=r"its table promises chunks of \d{8,} bytes, the file has \d+; export it again"
    ):
        parse_cloud(bytes(data), "a.laz")


@pytest.mark.parametrize("at_the_end", [False, True])
def test_laz_with_more_chunks_than_points_is_refused(at_the_end: bool) -> None:
    """Its reader makes room for all of them, and aborts."""
    data = bytearray(las_bytes(packed=True))
    start = int.from_bytes(data[96:100], "little")
    table = int.from_bytes(data[start : start + 8], "little")
    data[table + 4 : table + 8] = b"\xff\xff\xff\x7f"
    if at_the_end:
        data += data[start : start + 8]
        data[start : start + 8] = b"\xff" * 8
    with pytest.raises(TiskelError, match="table promises 2147483647 chunks for 60 points"):
        parse_cloud(bytes(data), "a.laz")


def test_e57_that_is_cut_short_is_refused() -> None:
    header = b"ASTM-E57" + bytes(8) + (1000).to_bytes(8, "little") + bytes(24)
    with pytest.raises(TiskelError, match="promises 1000 bytes, there are 48"):
        parse_cloud(header, "a.e57")
    pytest.importorskip("e57")
    with pytest.raises(TiskelError, match="is not a valid E57 file"):
        parse_cloud(header[:16] + (48).to_bytes(8, "little") + bytes(24), "a.e57")


SCAN = (
    "2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n1 2 3 .5\n0 0 0 .5\n0 0 1 .1\n4 5 6 .2\n"
)


def test_ptx_is_told_by_its_first_lines() -> None:
    np.testing.assert_array_equal(parse_cloud(SCAN.encode(), "-").points, parse_cloud(SCAN.encode(), "a.ptx").points)


def test_ptx_of_two_scans_is_turned_and_shifted_and_lost_pulses_have_no_place() -> None:
    """A row times the matrix: x goes to y, y to -x."""
    cloud = parse_cloud((SCAN + SCAN).encode(), "a.ptx")
    one = [[8, 21, 33], [np.nan] * 3, [10, 20, 31], [5, 24, 36]]
    np.testing.assert_array_equal(cloud.points, one + one)
    np.testing.assert_array_equal(cloud.properties["intensity"][:4], [0.5, 0.5, 0.1, 0.2])


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (SCAN[:-12], "promises 4 points"),
        (SCAN.replace("1 2 3 .5", "1 2 x .5"), "every row needs the same numbers"),
        (SCAN.replace("2\n2\n", "2\n"), "no header of a scan"),
        (SCAN + "3\n", "no header of a scan"),
        (SCAN.replace("2\n2\n", "0\n2\n"), "promises 0 points"),
        (SCAN + re.sub(r" \.\d\n", "\n", SCAN), "rows of different lengths"),
        (re.sub(r" \.\d\n", " 1 2\n", SCAN), "4 rows of 5 numbers after line 10, 4 are promised"),
    ],
)
def test_broken_ptx_is_refused_with_a_reason(data: str, said: str) -> None:
    with pytest.raises(TiskelError, match=said):
        parse_cloud(data.encode(), "a.ptx")


TABLE = b"a,b,c,d\n1,2,3,4\n5,6,7,8\n"


def test_columns_by_name_and_number() -> None:
    for asked in (["b", "D", "a"], ["2", "4", "1"]):
        np.testing.assert_array_equal(parse_cloud(TABLE, "a.csv", columns=asked).points, [[2, 4, 1], [6, 8, 5]])
    for wrong, said in ((["b", "q", "a"], "no column 'q'; it has a, b, c, d"), (["1", "1", "2"], "three different")):
        with pytest.raises(TiskelError, match=said):
            parse_cloud(TABLE, "a.csv", columns=wrong)
    with pytest.raises(TiskelError, match="columns are chosen in text"):
        parse_cloud(b"OFF 1 0 0\n0 0 0\n", "a.off", columns=["1", "2", "3"])


def test_empty_cells_are_no_numbers_and_shift_nothing() -> None:
    nan = np.nan
    for data in (
        b"x,y,z\n1,2,3\n4,,6\n,,\n7,8,NA\n",
        b"x\ty\tz\n1\t2\t3\n4\t\t6\n\t\t\n7\t8\t\n".replace(b"\t\n", b"\tNA\n"),
    ):
        found = parse_cloud(data, "a.csv").points
        np.testing.assert_array_equal(found, [[1, 2, 3], [4, nan, 6], [nan] * 3, [7, 8, nan]])


def test_surveyed_coordinates_are_found_by_name() -> None:
    cloud = parse_cloud(b"code,Northing (m),Easting (m),Elevation (m)\n7,1,2,3\n8,4,5,6\n", "a.csv")
    np.testing.assert_array_equal(cloud.points, [[2, 1, 3], [5, 4, 6]])


def test_where_the_suffix_says_nothing_the_content_does() -> None:
    rows = b"1 2 3\n" * 20
    assert len(parse_cloud(rows, "scan.dat").points) == 20
    assert len(parse_cloud(b"OFF 20 0 0\n" + rows, "scan").points) == 20
    with pytest.raises(TiskelError, match=r"unknown kind of file '\.dat'"):
        parse_cloud(b"to be or not to be\nthat is the question\n" * 9, "scan.dat")


def test_gzip_files_that_are_cut_short_or_empty_are_told() -> None:
    packed = gzip.compress(b"1 2 3\n" * 100)
    for data, said in (
        (packed[:-9], r"a\.xyz\.gz is no whole gzip file: .*; pack it again"),
        (gzip.compress(b"", mtime=0), r"a\.xyz\.gz is empty; check how it was made"),
    ):
        with pytest.raises(TiskelError, match=said):
            parse_cloud(data, "a.xyz.gz")


def test_bombs_are_refused() -> None:
    with pytest.raises(TiskelError, match="more than 50 times as much"):
        parse_cloud(gzip.compress(bytes(30 << 20)), "a.xyz.gz")
    out = io.BytesIO()
    np.savez_compressed(out, points=np.zeros((10**6, 3)))
    with pytest.raises(TiskelError, match="more than 50 times as much"):
        parse_cloud(out.getvalue(), "a.npz")
