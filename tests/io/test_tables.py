"""Tables of numbers in text: what is read, and what is refused because it could be read in two ways."""

import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tiskel import TiskelError, load_cloud
from tiskel.io.clouds import parse_cloud
from tiskel.io.formats import text

POINTS = np.array([[0.5, 1.5, 2.5], [3.5, -4.5, 5.5]])

READ = {
    "semicolons and decimal commas": "X;Y;Z\n0,5;1,5;2,5\n3,5;-4,5;5,5\n",
    "tabs and decimal commas": "0,5\t1,5\t2,5\n3,5\t-4,5\t5,5\n",
    "white space and decimal commas": "0,5 1,5  2,5\n3,5 -4,5  5,5\n",
    "decimal commas in quotes": '"x","y","z"\n"0,5","1,5","2,5"\n"3,5","-4,5","5,5"\n',
    "decimal commas and dates": "d;x;y;z\n24.12.2023;0,5;1,5;2,5\n25.12.2023;3,5;-4,5;5,5\n",
    "quoted cells": '"x","y","z"\n"0.5","1.5","2.5"\n"3.5","-4.5","5.5"\n',
    "named columns in the middle": "time,X(m),Y(m),Z(m),i\n0,.5,1.5,2.5,7\n1,3.5,-4.5,5.5,7\n",
    "units behind an underscore": "t x_m y_m z_m\n0 .5 1.5 2.5\n1 3.5 -4.5 5.5\n",
    "ParaView": '"i","Points:0","Points:1","Points:2"\n7,.5,1.5,2.5\n7,3.5,-4.5,5.5\n',
    "VeloView": '"i","Points_m_XYZ:0","Points_m_XYZ:1","Points_m_XYZ:2"\n7,.5,1.5,2.5\n7,3.5,-4.5,5.5\n',
    "CloudCompare": "//R G B X Y Z\n2\n7 7 7 .5 1.5 2.5\n7 7 7 3.5 -4.5 5.5\n",
    "a header in a comment": "# scan 1 of 2\n# i,x,y,z\n7,.5,1.5,2.5\n7,3.5,-4.5,5.5\n",
    "a header separated otherwise": "i, x, y, z\n7 .5 1.5 2.5\n7 3.5 -4.5 5.5\n",
    "pandas": ",x,y,z\n0,.5,1.5,2.5\n1,3.5,-4.5,5.5\n",
    "pandas without names": ",0,1,2\n0,.5,1.5,2.5\n1,3.5,-4.5,5.5\n",
    "three names": "easting,northing,height\n.5,1.5,2.5\n3.5,-4.5,5.5\n",
    "an index and three names": "Unnamed: 0,a,b,c\n0,.5,1.5,2.5\n1,3.5,-4.5,5.5\n",
    "words beside named columns": "tree,x,y,z\noak,.5,1.5,2.5\nelm,3.5,-4.5,5.5\n",
    "Fortran": "5.0D-1 1.5d+00 2.5D0\n3.5D0 -4.5D0 0.55D1\n",
    "commas and spaces": "0.5, 1.5, 2.5\n3.5, -4.5, 5.5\n",
    "separators at the ends": "x;y;z;\n.5;1.5;2.5;\n3.5;-4.5;5.5;\n",
    "a comment that names no column": "# one tree, of two\n# made here\n0.5 1.5 2.5\n3.5 -4.5 5.5\n",
    "commas in words": "x;y;z;tree\n.5;1.5;2.5;oak, old\n3.5;-4.5;5.5;elm\n",
    "words behind": "0.5 1.5 2.5 oak\n3.5 -4.5 5.5 elm\n",
}


@pytest.mark.parametrize("name", READ)
def test_tables_that_are_read(name: str) -> None:
    np.testing.assert_array_equal(text.read(READ[name].encode(), "a").points, POINTS)


@pytest.mark.parametrize("coding", ["utf-16", "utf-8-sig"])
def test_tables_with_a_byte_order_mark(coding: str) -> None:
    np.testing.assert_array_equal(text.read(READ["quoted cells"].encode(coding), "a").points, POINTS)


def test_nan_of_windows_is_no_number() -> None:
    found = text.read(b"1 2 3\n-nan(ind) 5 6\n7 8 NAN(SNAN)\n", "a").points
    np.testing.assert_array_equal(found, [[1, 2, 3], [np.nan, 5, 6], [7, 8, np.nan]])


def test_rows_numbered_as_r_does() -> None:
    rows = "".join(f'"{i}" {i / 4} 1.5 2.5\n' for i in range(1, 7))
    points = text.read(b'"x" "y" "z"\n' + rows.encode(), "a").points
    np.testing.assert_array_equal(points[:, 0], np.arange(1, 7) / 4)


REFUSED = {
    "pairs of whole numbers": ("1,2,3,4,5,6\n2,3,4,5,6,7\n", "6 whole numbers or 3 with decimal commas"),
    "half as many names": ("x,y,z\n1,5,2,5,-3,5\n", "its commas both separate and are decimal signs"),
    "commas and white space": ("1,2,3 4,5,6 7,8,9\n", "commas and white space"),
    "points and commas": ("1.5 2,5 3,5\n", "points and commas"),
    "commas and points between semicolons": ("1,5;2.5;3,5\n", "a decimal comma and some a point"),
    "other names": ("a,b,c,d\n1,2,3,4\n", "its columns are a, b, c, d; name those of the coordinates"),
    "three names in another order": ("z,y,w\n1,2,3\n", "its columns are z, y, w; name"),
    "x twice": ("x,X,y,z\n1,2,3,4\n", "its columns are x, X, y, z; name"),
    "too few names": ("x y z\n1 2 3 4\n5 6 7 8\n", "the header names 3 columns (x, y, z), the rows have 4"),
    "a title": ("A scan of an oak\n1 2 3\n4 5 6\n", "put # before a line that is a title"),
    "rows counted from 0": ("".join(f"{i} .5 .5 {i}.5\n" for i in range(6)), "its first column counts the rows"),
    "rows counted from 1": ("".join(f"{i},.5,.5,{i}.5\n" for i in range(1, 6)), "its first column counts the rows"),
    "words first": ("oak 1 2 3\nelm 4 5 6\n", "line 1 has words and numbers"),
    "a short row": ("1 2 3\n\n# break\n4 5\n", "line 4 has 2 columns, the rows before it have 3"),
    "a long row": ("x,y,z\n1,2,3\n1,2,3,4\n", "line 3 has 4 columns"),
    "a word": ("x,y,z\n1,2,3\n1,two,3\n", "line 3 has 'two' for a number"),
    "a superscript": ("²\n1 2 3\n", "the header names 1 columns"),
    "two scans": ("2\n1 2 3\n1 2 3\n1\n4 5 6\n", "promises 2 points, 4 follow; export it again, one cloud per file"),
    "UTF-16 without a mark": ("1\x00 \x002\x00", "is not text in UTF-8"),
    "an underscore in a number": ("1 2 3\n4 5_0 6\n", "a row is no numbers; every row needs three numbers"),
    "names of rows that count nothing": ("x y z\noak 2 3 4\nelm 5 6 7\n", "the header names 3 columns"),
    "a cell without an end": (
        'x,y,z\n"1","2","3' + "0" * 200_000 + '"\n',
        "its quoted cells cannot be read (field larger",
    ),
    "a long word in quotes": ('"' + "x" * 200_000 + '" y\n1 2 3\n', "the header names 1 columns"),
    "thousands": ("x;y;z\n1,000,000;2;3\n", "'1,000,000' for a number"),
    "atoms": ("2\n\nC 1 2 3\nH 4 5 6\n", "words and numbers"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_tables_that_are_refused(name: str) -> None:
    data, said = REFUSED[name]
    with pytest.raises(TiskelError) as error:
        text.read(data.encode(), "a.csv")
    assert said in str(error.value)


SEPARATORS = {
    "a point": "1,2,3,4,5,6.5\n",
    "a sign in the second place": "1,2,3,4,5,6\n1,-2,3,4,5,6\n",
    "a name for every column": "x,y,z,r,g,b\n1,2,3,4,5,6\n",
    "a comment with a name for every column": "# x,y,z,r,g,b\n1,2,3,4,5,6\n",
    "too few for pairs": "1,2,3,4\n",
}


@pytest.mark.parametrize("name", SEPARATORS)
def test_commas_between_whole_numbers_separate_where_something_says_so(name: str) -> None:
    np.testing.assert_array_equal(np.abs(text.read(SEPARATORS[name].encode(), "a").points[0]), [1, 2, 3])


def test_whole_coordinates_in_steps_are_no_count_of_rows() -> None:
    three = "".join(f"{i} 5 6\n" for i in range(9))
    steps = "".join(f"{2 * i} 5 6 7\n" for i in range(9))
    for rows in (three, steps):
        assert text.read(rows.encode(), "a").points.shape == (9, 3)


def test_named_numbers_become_properties_and_words_do_not() -> None:
    data = b't,x,y,z,label,late,"a 1"\n10,1,2,3,oak,1,5\n11,4,5,6,elm,n/a,6\n'
    properties = text.read(data.replace(b"n/a", b"2"), "a").properties
    assert {key: list(column) for key, column in properties.items()} == {"t": [10, 11], "late": [1, 2], "a 1": [5, 6]}
    np.testing.assert_array_equal(text.read(data, "a").properties["late"], [1, np.nan])


def test_columns_of_other_names_are_said() -> None:
    for said in ("easting, northing, height", "first, northing, height"):
        data = READ["three names"].replace("easting", said.partition(",")[0]).encode()
        assert f"{said} were taken as x, y and z" in text.read(data, "a").warnings[0]


def test_empty_cells_are_no_numbers_and_shift_no_row() -> None:
    found = text.read(b"1,2,3\n1,,3\n4,5,6\n", "a").points
    np.testing.assert_array_equal(found, [[1, 2, 3], [1, np.nan, 3], [4, 5, 6]])


@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_subnormal=False)] * 3), min_size=1, max_size=20))
def test_decimal_commas_keep_every_number(rows: list[tuple[float, float, float]]) -> None:
    points = np.array(rows)
    for separator in (";", "\t"):
        data = text.write(points, separator).replace(b".", b",")
        np.testing.assert_array_equal(text.read(data, "a").points, points)


@given(st.text(alphabet="01259.,;- \t\n\"'exyzXdDn#/()", max_size=80))
def test_no_text_causes_anything_but_numbers_or_a_short_reason(data: str) -> None:
    said = ""
    try:
        assert text.read(data.encode(), "a").points.shape[1] == 3
    except TiskelError as error:
        said = str(error)
    assert "\n" not in said
    assert len(said) < 500


@pytest.mark.parametrize("data", ["1" * 200_000 + "x\n", "\t" * 200_000 + "1\n", "1 " + "(" * 200_000 + "\n1 2\n"])
def test_long_rows_take_no_long_time(data: str) -> None:
    began = time.perf_counter()
    with pytest.raises(TiskelError):
        text.read(data.encode(), "a")
    assert time.perf_counter() - began < 5


@pytest.mark.parametrize("suffix", [".asc", ".xyzn", ".xyzrgb", ".TXT"])
def test_other_suffixes_of_text(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_text("0.5 1.5 2.5 0 0 1\n3.5 -4.5 5.5 0 0 1\n")
    np.testing.assert_array_equal(load_cloud(path).points, POINTS)


def test_columns_that_were_asked_for_are_no_properties() -> None:
    table = b'x,y,z,"",w\n' + b"".join(b"%d,%d,%d,8,9\n" % (i, i * i, 7 - i) for i in range(5))
    cloud = parse_cloud(table, "a.csv", columns=("w", "Y", "x"))
    np.testing.assert_array_equal(cloud.points[:2], [[9, 0, 0], [9, 1, 1]])
    assert set(cloud.properties) == {"z"}
