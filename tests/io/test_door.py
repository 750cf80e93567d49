"""Stage files whose content contradicts itself: one line names element, row, property and value."""

import json
from typing import Any

import numpy as np
import pytest
from plyfile import PlyData

from tiskel import LbcParams, ShapeParams, TiskelError, contract, extract_skeleton, make_shape, shape_graph
from tiskel.io import ply
from tiskel.io.stages.contraction import dump_contraction, parse_contraction
from tiskel.io.stages.skeleton import dump_skeleton, parse_skeleton

CLOUD = make_shape(shape_graph("y"), ShapeParams(count=300))[0]


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    robust = contract(CLOUD)
    lbc = contract(CLOUD, LbcParams(max_steps=2))
    return {
        "robust": dump_contraction(robust, history=True),
        "lbc": dump_contraction(lbc, history=True),
        "skeleton": dump_skeleton(extract_skeleton(robust)),
    }


def changed(data: bytes, element: str, name: str, row: int, value: float) -> bytes:
    """Return a stage file with one value changed."""
    file = ply.parse(data, "a.ply")
    parts = []
    for part in file.elements:
        table = part.data.copy()
        if part.name == element:
            table[name][row] = value
        parts.append(ply.element(part.name, {key: table[key] for key in table.dtype.names}))
    made = PlyData(parts, text=False, byte_order="<", comments=file.comments)
    return bytes(made.header.encode() + b"\n" + b"".join(part.data.tobytes() for part in parts))


CHANGES = [
    ("robust", "vertex", "x", 5, np.nan, "row 5: x, y, z is"),
    ("robust", "vertex", "row", 5, 300, "row 5: row is 300, it must be from 0 to 299"),
    ("robust", "vertex", "row", 5, 6, "row is 6 once more"),
    ("robust", "vertex", "section", 7, 10**6, "row 7: section is 1000000"),
    ("robust", "vertex", "level", 7, -5, "row 7: level is -5"),
    ("robust", "cloud", "row", 2, -1, "row 2: row is -1"),
    ("robust", "cloud", "y", 9, np.inf, "row 9: x, y, z is"),
    ("robust", "cloud", "merged_into", 3, 4, "row 3: row is 3, which was merged into another point"),
    ("robust", "cloud", "merged_step", 3, -2, "row 3: merged_step is -2"),
    ("robust", "history", "x", 3, np.nan, "'history', row 3"),
    ("lbc", "vertex", "ring_end", 3, -1, "row 3: ring_end is -1"),
    ("lbc", "vertex", "closed", 3, 7, "row 3: closed is 7"),
    ("lbc", "ring_member", "place", 3, 300, "'ring_member', row 3: place is 300"),
    ("skeleton", "vertex", "radius", 1, -0.5, "row 1: radius is -0.5, it must be 0 or more"),
    ("skeleton", "vertex", "regime", 1, 9, "row 1: regime is 9"),
    ("skeleton", "vertex", "z", 1, np.nan, "row 1: x, y, z is"),
    ("skeleton", "edge", "vertex1", 1, 999, "'edge', row 1: vertex1 is 999"),
    ("skeleton", "edge_source", "bridged", 1, 3, "row 1: bridged is 3"),
    ("skeleton", "branch", "count", 0, -1, "row 0: count is -1"),
    ("skeleton", "branch_node", "node", 1, -1, "row 1: node is -1"),
    ("skeleton", "cloud", "node", 4, -1, "'cloud', row 4: node is -1"),
    ("skeleton", "contracted", "row", 4, 300, "'contracted', row 4: row is 300"),
    ("skeleton", "contracted", "x0", 4, np.nan, "row 4: x0, y0, z0 is"),
]


@pytest.mark.parametrize(("kind", "element", "name", "row", "value", "said"), CHANGES)
def test_one_wrong_value_is_named(
    kind: str, element: str, name: str, row: int, value: float, said: str, files: dict[str, bytes]
) -> None:
    read: Any = parse_skeleton if kind == "skeleton" else parse_contraction
    read(files[kind], "a.ply")
    with pytest.raises(TiskelError) as error:
        read(changed(files[kind], element, name, row, value), "a.ply")
    assert said in str(error.value)
    assert str(error.value).startswith("a.ply is a damaged")


def test_points_merged_in_a_circle_are_refused(files: dict[str, bytes]) -> None:
    """They would be followed for ever."""
    data = files["robust"]
    for row, into in ((10, 11), (11, 12), (12, 10)):
        data = changed(data, "cloud", "merged_into", row, into)
    with pytest.raises(TiskelError, match="row 10: row is 10, which was merged into another point"):
        parse_contraction(data, "a.ply")


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("rounds", "three", "setting rounds cannot be 'three'"),
        ("rounds", 2.5, "setting rounds cannot be '2.5'"),
        ("least_part", 10**400, "cannot be '1000000000"),
        ("straightness", True, "setting straightness cannot be 'True'"),
        ("root", "here", "setting root cannot be 'here'"),
        ("method", [1], "method must be one of"),
    ],
)
def test_settings_of_another_type_are_refused(name: str, value: Any, said: str, files: dict[str, bytes]) -> None:
    head, rest = files["robust"].split(b"comment params ", 1)
    line, rest = rest.split(b"\n", 1)
    params = json.dumps({**json.loads(line), name: value}).encode()
    with pytest.raises(TiskelError, match="^.*" + said.replace("[", r"\[")):
        parse_contraction(head + b"comment params " + params + b"\n" + rest, "a.ply")
