"""Stage files whose content contradicts itself: one line names element, row, property and value."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from plyfile import PlyData

from tiskel import LbcParams, ShapeParams, TiskelError, contract, extract_skeleton, make_shape, shape_graph
from tiskel.io import ply
from tiskel.io.stages import door
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

    def edit(columns: dict[str, Any]) -> dict[str, Any]:
        columns[name][row] = value
        return columns

    return edited(data, element, edit)


def edited(data: bytes, element: str, edit: Callable[[dict[str, Any]], dict[str, Any]]) -> bytes:
    """Return a stage file with the columns of an element changed."""
    file = ply.parse(data, "a.ply")
    parts = []
    for part in file.elements:
        columns = {key: part.data[key].copy() for key in part.data.dtype.names}
        parts.append(ply.element(part.name, edit(columns) if part.name == element else columns))
    made = PlyData(parts, text=False, byte_order="<", comments=file.comments)
    return bytes(made.header.encode() + b"\n" + b"".join(part.data.tobytes() for part in parts))


CHANGES = [
    ("robust", "vertex", "x", 5, np.nan, "row 5: x, y, z is"),
    ("robust", "vertex", "x0", 5, np.nan, "element 'vertex', row 5: x0, y0, z0 is"),
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
    ("lbc", "vertex", "ring_end", -1, 10**6, "rings end at 1000000, "),
    ("lbc", "vertex", "ring_end", 3, 10**6, "rings end at "),
    ("lbc", "vertex", "closed", 3, 7, "row 3: closed is 7"),
    ("lbc", "ring_member", "place", 3, 300, "'ring_member', row 3: place is 300"),
    ("skeleton", "vertex", "radius", 1, -0.5, "row 1: radius is -0.5, it must be 0 or more"),
    ("skeleton", "vertex", "regime", 1, 9, "row 1: regime is 9"),
    ("skeleton", "vertex", "z", 1, np.nan, "row 1: x, y, z is"),
    ("skeleton", "edge", "vertex1", 1, 999, "'edge', row 1: vertex1 is 999"),
    ("skeleton", "edge_source", "bridged", 1, 3, "row 1: bridged is 3"),
    ("skeleton", "branch", "count", 0, -1, "row 0: count is -1"),
    ("skeleton", "branch", "count", 0, 10**6, "branches have 10000"),
    ("skeleton", "branch_node", "node", 1, -1, "row 1: node is -1"),
    ("skeleton", "cloud", "node", 4, -1, "'cloud', row 4: node is -1"),
    ("skeleton", "contracted", "row", 4, 300, "'contracted', row 4: row is 300"),
    ("skeleton", "contracted", "x0", 4, np.nan, "row 4: x0, y0, z0 is"),
]
OF_SEVERAL = ("merged_into", "ring_end", "count")  # what is said of these, it is said of another element, or of several


@pytest.mark.parametrize(("kind", "element", "name", "row", "value", "said"), CHANGES)
def test_one_wrong_value_is_named(
    kind: str, element: str, name: str, row: int, value: float, said: str, files: dict[str, bytes]
) -> None:
    read: Any = parse_skeleton if kind == "skeleton" else parse_contraction
    read(files[kind], "a.ply")
    with pytest.raises(TiskelError) as error:
        read(changed(files[kind], element, name, row, value), "a.ply")
    text = str(error.value)
    assert said in text
    assert text.startswith("a.ply is a damaged")
    assert f"element '{element}'" in text or name in OF_SEVERAL


def shorter(columns: dict[str, Any]) -> dict[str, Any]:
    return {name: values[:-1] for name, values in columns.items()}


@pytest.mark.parametrize(
    ("kind", "element", "edit", "said"),
    [
        ("robust", "vertex", shorter, "merged_into is -1, which leads to no point of element 'vertex'"),
        ("robust", "history", shorter, "rows, 300 are left after each step"),
        ("skeleton", "edge_source", shorter, "sources of edges for"),
        ("skeleton", "vertex", lambda c: c | {"radius_source": c["radius"]}, "element 'vertex' must be single whole"),
        ("skeleton", "cloud", lambda c: {n: v for n, v in c.items() if n != "x"}, "'cloud' has no property x"),
    ],
    ids=["points", "history", "sources", "kind", "property"],
)
def test_elements_that_do_not_fit_each_other_are_told(
    kind: str, element: str, edit: Any, said: str, files: dict[str, bytes]
) -> None:
    read: Any = parse_skeleton if kind == "skeleton" else parse_contraction
    with pytest.raises(TiskelError, match=r"a\.ply is a damaged") as error:
        read(edited(files[kind], element, edit), "a.ply")
    assert said in str(error.value)


def test_an_edge_from_a_node_to_itself_or_laid_twice_is_told(files: dict[str, bytes]) -> None:
    edge = ply.parse(files["skeleton"], "a.ply")["edge"].data
    loop = changed(files["skeleton"], "edge", "vertex1", 2, edge["vertex2"][2])
    with pytest.raises(TiskelError, match=f"'edge', row 2: it joins node {edge['vertex2'][2]} to itself"):
        parse_skeleton(loop, "a.ply")
    twice = changed(files["skeleton"], "edge", "vertex1", 2, edge["vertex2"][0])
    twice = changed(twice, "edge", "vertex2", 2, edge["vertex1"][0])
    said = f"'edge', row 2: it joins nodes {edge['vertex2'][0]} and {edge['vertex1'][0]} once more"
    with pytest.raises(TiskelError, match=said):
        parse_skeleton(twice, "a.ply")


def test_a_file_may_ask_for_so_much_memory_and_no_more() -> None:
    most = door.ROOM + 1000 * door.PER_BYTE
    door.check_room(most, 1000, "the rings")
    with pytest.raises(ValueError, match="the rings would take 200 MB, the file has 0 kB"):
        door.check_room(most + 1, 1000, "the rings")


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
