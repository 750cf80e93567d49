"""File types behind the registry: NPY, PLY, meshes, gzip; and the small files of reported trouble."""

import gzip
import io
import struct
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest

from reference.pcd import POINTS, pcd_bytes
from tiskel import TiskelError, load_cloud
from tiskel.io.clouds import parse_cloud
from tiskel.io.curves import parse_curve
from tiskel.io.formats import FORMATS, SUFFIXES, format_of, numpy_arrays, obj, off, ply, stl


def test_every_suffix_belongs_to_one_format() -> None:
    assert len(SUFFIXES) == sum(len(kind.suffixes) for kind in FORMATS)
    assert all(suffix == suffix.lower() and suffix.startswith(".") for suffix in SUFFIXES)


@pytest.mark.parametrize("suffix", [".ply", ".npy", ".npz", ".pcd", ".xyz", ".off"])
def test_standard_input_is_told_by_its_first_bytes(suffix: str) -> None:
    npz = io.BytesIO()
    np.savez(npz, points=POINTS)
    data = {
        ".ply": ply.write(POINTS),
        ".npy": numpy_arrays.write(POINTS),
        ".npz": npz.getvalue(),
        ".pcd": pcd_bytes("binary"),
        ".xyz": b"1 2 3\n" * 40,
        ".off": b"OFF 40 0 0\n" + b"1 2 3\n" * 40,
    }[suffix]
    assert len(parse_cloud(data, "-").points) == 40


# -- NumPy


def npy(array: object) -> bytes:
    out = io.BytesIO()
    np.save(out, np.asarray(array), allow_pickle=True)
    return out.getvalue()


RECORDS = np.zeros(40, dtype=[("i", "u2"), ("Z", "f4"), ("Y", "f8"), ("X", "f8"), ("name", "U3")])
RECORDS["X"], RECORDS["Y"], RECORDS["Z"] = POINTS.T
HUGE = b"\x93NUMPY\x01\x00\x76\x00" + b"{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 3), }".ljust(117) + b"\n"


def test_npy_of_records_batches_of_one_and_further_columns() -> None:
    cloud = parse_cloud(npy(RECORDS), "a.npy")
    np.testing.assert_array_equal(cloud.points, np.stack([RECORDS[axis] for axis in "XYZ"], axis=1))
    assert set(cloud.properties) == {"i"}
    for array in (POINTS[None], np.c_[POINTS, POINTS[:, :1]], np.asfortranarray(POINTS)):
        np.testing.assert_array_equal(parse_cloud(npy(array), "a.npy").points, POINTS)


NPY_BROKEN = {
    "on its side": (npy(POINTS.T), "got (3, 40); transpose it"),
    "six by many": (npy(np.zeros((6, 40))), "got (6, 40); transpose it"),
    "two clouds": (npy(POINTS.reshape(2, 20, 3)), "got (2, 20, 3); save one cloud per file"),
    "other records": (npy(np.zeros(9, [("i", "u2"), ("X", "f4"), ("Y", "f4")])), "holds records of i, X, Y"),
    "complex": (npy(POINTS * 1j), "holds complex128, not real numbers"),
    "words": (npy([["1", "2", "3"]]), "not real numbers"),
    "objects": (npy([[None, 1, 2]]), "not a valid NumPy file"),
    "more than memory": (HUGE % 2**50, "not a valid NumPy file"),
    "more than numbers": (HUGE % 2**64, "not a valid NumPy file"),
    "an open bracket": (HUGE.replace(b"}", b"(") % 5, "not a valid NumPy file"),
}


@pytest.mark.parametrize("name", NPY_BROKEN)
def test_broken_npy_is_refused_with_a_reason(name: str) -> None:
    data, said = NPY_BROKEN[name]
    with pytest.raises(TiskelError) as error:
        numpy_arrays.read(data, "a.npy")
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_npz_of_an_unknown_version_is_refused_with_a_reason() -> None:
    out = io.BytesIO()
    np.savez(out, points=POINTS)
    data = out.getvalue()
    newer = data.replace(b"PK\x01\x02-\x03-", b"PK\x01\x02-\x03\x5c")  # extract version of the central directory
    assert newer != data
    with pytest.raises(TiskelError, match="not a valid NumPy file of numbers: zip file version"):
        parse_cloud(newer, "a.npz")


# -- PLY and gzip

PLY = b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float X\nproperty float Y\nproperty float Z\nend_header\n"


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("comment", ["", "comment H\xf6he \u6a39\n"])
def test_ply_in_upper_case_with_foreign_comments_and_nan_of_windows(mark: bytes, comment: str) -> None:
    data = mark + PLY.replace(b"element", comment.encode() + b"element") + b"1 2 3\n-nan(ind) nan(snan) nan\n"
    np.testing.assert_array_equal(parse_cloud(data, "a.ply").points, [[1, 2, 3], [np.nan] * 3])


PLY_BROKEN = {
    "lists": (
        PLY.replace(b"float X", b"list uchar float X") + b"1 1 2 3\n1 1 2 3\n",
        "property X of 'vertex' is a list",
    ),
    "single faces": (
        PLY.replace(b"end_", b"element face 1\nproperty int vertex_index\nend_") + b"1 2 3\n" * 2 + b"5\n",
        "vertex_index of 'face' is a single number",
    ),
    "faces beyond": (
        PLY.replace(b"end_", b"element face 1\nproperty list uchar int vertex_index\nend_")
        + b"1 2 3\n" * 2
        + b"3 0 1 -7\n",
        "a face names vertex -7, there are 2",
    ),
}


@pytest.mark.parametrize("name", PLY_BROKEN)
def test_broken_ply_is_refused_with_a_reason(name: str) -> None:
    data, said = PLY_BROKEN[name]
    with pytest.raises(TiskelError) as error:
        ply.read(data, "a.ply")
    assert said in str(error.value)


def test_binary_ply_with_lists_elsewhere_and_with_a_face_too_few() -> None:
    head = PLY.replace(b"ascii", b"binary_little_endian").replace(b"vertex 2", b"vertex 3")
    rows, list_of_three = np.arange(9, dtype="<f4").tobytes(), struct.pack("<B3i", 3, 0, 1, 2)
    strip = head.replace(b"end_", b"element strip 1\nproperty list uchar int at\nend_")
    found = parse_cloud(strip + rows + list_of_three, "a.ply")
    np.testing.assert_array_equal(found.points, np.arange(9).reshape(3, 3))
    faces = head.replace(b"end_", b"element face 2\nproperty list uchar int vertex_indices\nend_")
    with pytest.raises(TiskelError, match=r"element 'face': .*early end-of-file"):
        ply.read(faces + rows + list_of_three, "a.ply")
    assert ply.read(faces + rows + list_of_three * 2, "a.ply").faces.tolist() == [[0, 1, 2]] * 2


def test_faces_of_a_stage_file_without_vertices_are_left_out() -> None:
    data = PLY.replace(b"element vertex", b"comment tiskel 1 cloud\nelement cloud")
    data = data.replace(b"end_", b"element face 1\nproperty list uchar int vertex_index\nend_")
    assert parse_cloud(data + b"1 2 3\n" * 2 + b"3 0 1 1\n", "a.ply").points.shape == (2, 3)


def test_any_file_may_be_packed_by_gzip(tmp_path: Path) -> None:
    for suffix, data in ((".ply", ply.write(POINTS)), (".pcd", pcd_bytes("binary")), (".xyz", b"1 2 3\n" * 40)):
        path = tmp_path / f"a{suffix}.gz"
        path.write_bytes(gzip.compress(data))
        assert len(load_cloud(path).points) == 40
        path.write_bytes(gzip.compress(data)[:-9])
        with pytest.raises(TiskelError, match="no whole gzip file"):
            load_cloud(path)


# -- meshes

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


@pytest.mark.parametrize("first", ["OFF\n4 2 0", "OFF 4 2", "COFF # coloured\n\n4 2 5", "OFF4 2 0"])
def test_off_with_polygons_colours_and_comments(first: str) -> None:
    rows = "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n4 0 1 2 3 255 0 0\n3 0 1 2  # half\n"
    parsed = off.read(f"{first}\n{rows}".encode(), "a.off")
    np.testing.assert_array_equal(parsed.points, SQUARE)
    np.testing.assert_array_equal(parsed.faces, [[0, 1, 2], [0, 2, 3], [0, 1, 2]])


@pytest.mark.parametrize("face", ["1 2 3 4", "-4 -3 -2 -1", "1/1 2/2 3/3 4/4", "1//9 2//9 3//9 4//9", "1 2 \\\n3 4"])
def test_obj_with_polygons_and_every_way_to_count(face: str) -> None:
    rows = "".join(f"v {x} {y} {z} 1.0\n" for x, y, z in SQUARE)
    parsed = obj.read(f"o square\n{rows}vn 0 0 1\nusemtl grey\nf {face}\n".encode(), "a.obj")
    np.testing.assert_array_equal(parsed.points, SQUARE)
    np.testing.assert_array_equal(parsed.faces, [[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize("kind", ["off", "obj"])
@pytest.mark.parametrize("sides", [2, 4])
def test_a_mesh_takes_few_times_its_size_in_memory(kind: str, sides: int) -> None:
    """As lists of whole numbers polygons took ten to twenty-five times as much."""
    count, one = 40_000, kind == "obj"
    corners = " ".join(str(c + one) for c in range(sides))
    face = f"f {corners}" if one else f"{sides} {corners}"
    points = "\n".join(f"{'v ' * one}{x} {x * x} 1" for x in range(100))
    file = f"{'' if one else f'OFF 100 {count} 0'}\n{points}\n{(face + chr(10)) * count}".encode()
    tracemalloc.start()
    try:
        found = (obj if one else off).read(file, "a")
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert found.faces.shape == (count * (sides - 2), 3)
    assert peak < 9 * len(file)  # of 400 kB; four corners become two triangles of three whole numbers, held twice


def test_obj_and_off_of_points_alone_are_clouds() -> None:
    assert parse_cloud(b"v 1 2 3\n" * 20, "a.obj").points.shape == (20, 3)
    assert parse_cloud(b"OFF\n20 0 0\n" + b"1 2 3\n" * 20, "a.off").points.shape == (20, 3)


MESHES_BROKEN = {
    "promises.off": (
        b"OFF\n2000000000 1 0\n0 0 0\n3 0 1 2\n",
        "promises 2000000000 vertices and 1 faces, 2 rows follow",
    ),
    "cut.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3\n", "'3' is no face"),
    "ragged.off": (b"OFF\n3 0 0\n0 0 0\n1 0 0 1\n0 1 0\n", "every vertex needs the same numbers"),
    "beyond.off": (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 33\n", "names vertex 33, there are 3"),
    "endless.off": (b"OFF\n1 1 0\n0 0 0\n1 " + b"9" * 30 + b"\n", "a vertex beyond all numbers"),
    "further.off": (b"OFF\n1 1 0\n0 0 0\n2 0 12000000000000000000\n", "a vertex beyond all numbers"),
    "further.obj": (b"v 0 0 0\nf 1 12000000000000000000 1\n", "a vertex beyond all numbers"),
    "counts.off": (b"OFF\n3 x 0\n0 0 0\n", "no counts of vertices and faces"),
    "no rows.off": (b"OFF\n0 0 0\n", "holds no points"),
    "none.off": (b"4 4 0\n0 0 0\n", "does not begin with OFF"),
    "word.obj": (b"v 0 0 0//\nv 1 0 0\n", "every vertex needs three numbers"),
    "nothing.obj": (b"v \nv 1 0 0\n", "vertex 1 holds nothing; every vertex needs three numbers"),
    "zero.obj": (b"v 0 0 0\nf 0 1 1\n", "'f 0 1 1' is no face"),
    "beyond.obj": (b"v 0 0 0\nf 1 2 3\n", "names vertex 2, there are 1"),
    "none.obj": (b"o nothing\n", "holds no points"),
    "damaged.stl": (b"solid x\nfacet\nloop^vertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendfacet\n", "no whole STL file"),
    "cut.stl": (bytes(80) + struct.pack("<I", 2) + bytes(50), "no whole STL file"),
}


@pytest.mark.parametrize("name", MESHES_BROKEN)
def test_broken_meshes_are_refused_with_a_reason(name: str) -> None:
    data, said = MESHES_BROKEN[name]
    with pytest.raises(TiskelError) as error:
        parse_cloud(data, name)
    assert said in str(error.value)


def test_stl_files_of_both_kinds_give_the_corners_of_their_facets() -> None:
    facets = np.arange(18, dtype=np.float32).reshape(2, 3, 3) - 1.5e-3
    text = "solid a\r\n" + "".join(
        "facet normal 0 0 1\r\nouter loop\r\n"
        + "".join(f"  vertex {x:.8g} {y:+.9e} {z:.9g}\r\n" for x, y, z in facet.tolist())
        + "endloop\r\nendfacet\r\n"
        for facet in facets
    )
    binary = b"solid, some begin like this".ljust(80) + struct.pack("<I", 2)
    binary += b"".join(bytes(12) + facet.tobytes() + bytes(2) for facet in facets)
    for data in (text.encode(), binary):
        parsed = stl.read(data, "a.stl")
        np.testing.assert_allclose(parsed.points, facets.reshape(-1, 3), rtol=1e-6)
        assert parsed.faces.tolist() == [[0, 1, 2], [3, 4, 5]]
    with pytest.raises(TiskelError, match="three numbers"):
        stl.read(text.replace("e+00", "e+e+00").encode(), "a.stl")
    with pytest.raises(TiskelError, match="no facets"):
        stl.read(bytes(84), "a.stl")


def test_signalling_nans_of_single_precision_are_nans_without_a_warning() -> None:
    rows = np.arange(12, dtype="<f4").reshape(4, 3)
    rows.view("<u4")[1, 2] = 0x7FA00000  # an invalid operation to whoever makes it a float64
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n"
    facets = b"".join(bytes(12) + facet.tobytes() + bytes(2) for facet in (rows[:3], rows[1:]))
    table = io.BytesIO()
    np.save(table, rows)
    pcd = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA binary\n"
    files = {
        "a.ply": head.encode() + rows.tobytes(),
        "a.stl": bytes(80) + struct.pack("<I", 2) + facets,
        "a.npy": table.getvalue(),
        "a.pcd": pcd.encode() + rows.tobytes(),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name, data in files.items():
            parsed = format_of(name, data).parse(data, name)
            assert np.isnan(parsed.points[1, 2])
            assert np.isfinite(parsed.points[0]).all()
        with pytest.raises(TiskelError, match=r"node 1 is at \[3.0, 4.0, nan\]"):
            parse_curve(files["a.ply"], "a.ply")
