"""PCD: every layout and type of field, and files that are broken; and LZF, which packs them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference.pcd import VALUES, packed, pcd_bytes
from tiskel import TiskelError
from tiskel.io.clouds import parse_cloud
from tiskel.io.formats import lzf, pcd


@pytest.mark.parametrize("layout", ["ascii", "binary", "binary_compressed"])
def test_pcd_of_every_layout_and_type(layout: str) -> None:
    cloud = parse_cloud(pcd_bytes(layout), "a.pcd")
    np.testing.assert_array_equal(cloud.points, np.stack([VALUES[axis] for axis in "xyz"], axis=1))
    assert set(cloud.properties) == {"rgb"}
    blank = pcd_bytes(layout).replace(b"\nFIELDS", b"\n\n# by hand\nFIELDS")
    np.testing.assert_array_equal(parse_cloud(blank, "-").points, cloud.points)
    np.testing.assert_array_equal(cloud.properties["rgb"], VALUES["rgb"])


PCD_BROKEN = {
    "cut": (pcd_bytes("binary")[:-1], "promises 40 points"),
    "cut text": (pcd_bytes("ascii")[:-200], "promises 40 points"),
    "surplus": (pcd_bytes("binary") + b"x", "promises 40 points"),
    "cut within the compressed data": (pcd_bytes("binary_compressed")[:-9], "compressed data are damaged"),
    "nothing compressed": (
        pcd_bytes("binary_compressed").partition(b"compressed\n")[0] + b"compressed\n",
        "ends before",
    ),
    "billions": (pcd_bytes("binary", WIDTH="", HEIGHT="", POINTS="9" * 15), "promises 999999999999999 points"),
    "beyond numbers": (pcd_bytes("binary", POINTS="9" * 5000), "POINTS '999"),
    "two counts": (pcd_bytes("binary", POINTS="41"), "promises 41 points and 40"),
    "no count": (pcd_bytes("binary", POINTS="", WIDTH=""), "neither POINTS nor WIDTH"),
    "no points": (pcd_bytes("binary", POINTS="0"), "holds no points"),
    "infinitely many of a field": (pcd_bytes("binary", COUNT="1 1 1e309 1 1 1 1"), "COUNT '1e309'"),
    "too many of a field": (pcd_bytes("binary", COUNT="1 1 999999999999 1 1 1 1"), "promises 40 points"),
    "fewer sizes": (pcd_bytes("binary", SIZE="8 8 8"), "differ in length"),
    "unknown type": (pcd_bytes("binary", SIZE="3 8 4 4 8 2 1"), "'u3' is unknown"),
    "no z": (pcd_bytes("binary", FIELDS="_ w rgb y x hist _"), "has no field z"),
    "unknown layout": (pcd_bytes("binary", DATA="octal"), "DATA 'octal' is unknown"),
    "no header": (b"1 2 3\n4 5 6\n", "no header that ends with DATA"),
    "a number more": (pcd_bytes("ascii").replace(b"0 0 0 ", b"0 0 0 0 "), "rows of 14 numbers, the header promises 12"),
    "words": (pcd_bytes("ascii").replace(b"0 0 0 ", b"0 a 0 ", 1), "could not convert string 'a'"),
}


@pytest.mark.parametrize("name", PCD_BROKEN)
def test_broken_pcd_is_refused_with_a_reason(name: str) -> None:
    data, said = PCD_BROKEN[name]
    with pytest.raises(TiskelError) as error:
        pcd.read(data, "a.pcd")
    assert said in str(error.value)


@given(st.lists(st.tuples(st.integers(0, 255), st.integers(1, 400)), max_size=20))
def test_lzf_gives_back_what_was_packed(runs: list[tuple[int, int]]) -> None:
    data = b"".join(bytes([value]) * many for value, many in runs)
    assert lzf.decompress(packed(data), len(data)) == data


def test_lzf_copies_from_far_back_and_refuses_what_is_not_there() -> None:
    there = bytes(range(32))
    far = bytes([31]) + there + bytes([31]) + there[::-1] + bytes([3 << 5, 63])
    assert lzf.decompress(far, 69) == there + there[::-1] + there[:5]
    with pytest.raises(ValueError, match="before the start"):
        lzf.decompress(bytes([0, 1, 1 << 5, 9]), 4)
    with pytest.raises(ValueError, match="within a copy"):
        lzf.decompress(bytes([0, 1, 7 << 5, 9]), 4)
