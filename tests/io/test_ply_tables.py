"""Tables of PLY files, written at once as plyfile writes them row by row."""

import io
from typing import Any

import numpy as np
import pytest
from plyfile import PlyData

from tiskel.io import ply

LISTS: dict[str, list[list[int]]] = {
    "triangles": [[0, 1, 2], [2, 1, 3], [3, 1, 0]],
    "faces of several lengths": [[0, 1, 2], [2, 1, 3, 0]],
    "no corners": [[], []],
    "no faces": [],
}


@pytest.mark.parametrize("name", LISTS)
def test_lists_are_written_as_plyfile_writes_them(name: str) -> None:
    rows = [np.array(row, np.int32) for row in LISTS[name]]
    columns: dict[str, Any] = {"corners": ply.ragged(rows), "group": np.arange(len(rows), dtype=np.uint8)}
    elements = [
        ply.element("vertex", ply.xyz(np.arange(12.0).reshape(4, 3))),
        ply.element("face", columns, {"corners": ("u1", "i4")}),
    ]
    ours, theirs = ply.dump(elements, "mesh", {}), io.BytesIO()
    comments = [line.split(" ", 1)[1] for line in ours.decode("latin-1").splitlines() if line.startswith("comment")]
    PlyData(elements, text=False, byte_order="<", comments=comments).write(theirs)
    assert ours == theirs.getvalue()
