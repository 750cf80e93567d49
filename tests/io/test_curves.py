"""Curves of other programs: every format, and files that are broken."""

import json
from pathlib import Path

import numpy as np
import pytest

from tiskel import Skeleton, TiskelError, load_curve, make_shape, read_skeleton, shape_graph
from tiskel.io.clouds import dump_cloud
from tiskel.io.exports import EXPORTS
from tiskel.io.measurable import gather


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    return make_shape(shape_graph("mug"))[1]


@pytest.mark.parametrize("suffix", ["ply", "obj", "graphml", "json"])
def test_what_is_exported_is_read_back(suffix: str, skeleton: Skeleton, tmp_path: Path) -> None:
    path = tmp_path / f"curve.{suffix}"
    path.write_bytes(EXPORTS[suffix](skeleton))
    curve = load_curve(path)
    np.testing.assert_allclose(curve.nodes, skeleton.nodes, atol=1e-12)
    read = {tuple(sorted(edge)) for edge in curve.edges.tolist()}
    assert read == {tuple(sorted(edge)) for edge in skeleton.edges.tolist()}


def test_swc_gives_the_tree_without_the_edge_that_closes_the_loop(skeleton: Skeleton, tmp_path: Path) -> None:
    path = tmp_path / "curve.swc"
    path.write_bytes(EXPORTS["swc"](skeleton))
    curve = load_curve(path)
    assert len(curve.nodes) == len(skeleton.nodes)
    assert len(curve.edges) == len(skeleton.edges) - 1


FOREIGN = {
    "lines.obj": b"# made elsewhere\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nl 1/1 2/2 3\nl -1 -3\n",
    "tree.swc": b"# comment\n\n 10 2 0 0 0 1 -1\n 20 2 1 0 0 1 10\n 5 2 1 1 0 1 20\n",
    "graph.json": b'{"nodes": [[0,0,0],[1,0,0],[1,1,0]], "edges": [[0,1],[1,2]]}',
    "link.json": json.dumps(
        {
            "nodes": [{"id": n, "x": x, "y": y, "z": 0} for n, x, y in (("a", 0, 0), ("b", 1, 0), ("c", 1, 1))],
            "links": [{"source": "a", "target": "b"}, {"source": "b", "target": "c"}],
        }
    ).encode(),
    "lines.ply": b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1\n1 2\n",
}


@pytest.mark.parametrize("name", FOREIGN)
def test_curves_of_other_programs(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(FOREIGN[name])
    curve = load_curve(tmp_path / name)
    assert curve.nodes.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    edges = {tuple(sorted(edge)) for edge in curve.edges.tolist()}
    assert edges == {(0, 1), (1, 2)} | ({(0, 2)} if name == "lines.obj" else set())


def test_points_alone_are_nodes_without_edges(tmp_path: Path) -> None:
    for suffix in ("ply", "xyz", "npy"):
        path = tmp_path / f"nodes.{suffix}"
        path.write_bytes(dump_cloud(np.eye(3), path))
        curve = load_curve(path)
        np.testing.assert_array_equal(curve.nodes, np.eye(3))
        assert curve.edges.shape == (0, 2)


BROKEN = {
    "cut.ply": (FOREIGN["lines.ply"][:-4], "not a valid PLY"),
    "far.obj": (b"v 0 0 0\nl 1 7\n", "names node 6, there are 1"),
    "back.obj": (b"v 0 0 0\nl 1 -3\n", "an edge names"),
    "words.obj": (b"v a b c\n", "not a valid OBJ"),
    "orphan.swc": (b"1 2 0 0 0 1 7\n", "not a valid SWC"),
    "short.swc": (b"1 2 0 0\n", "not a valid SWC"),
    "none.json": (b"{}", "not a valid JSON"),
    "list.json": (b"[1, 2", "not a valid JSON"),
    "flat.json": (b'{"nodes": [[0, 0]], "edges": []}', "not a valid JSON"),
    "bare.graphml": (b"<graphml", "not a valid GRAPHML"),
    "bytes.obj": (b"\xff\xfe\x00", "not a valid OBJ"),
    "what.dwg": (b"", "unknown kind of curve"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_curves_are_told_in_one_line(name: str, tmp_path: Path) -> None:
    data, said = BROKEN[name]
    (tmp_path / name).write_bytes(data)
    with pytest.raises(TiskelError, match=said) as caught:
        load_curve(tmp_path / name)
    assert "\n" not in str(caught.value)


def test_files_are_gathered_and_what_is_named_takes_precedence(skeleton: Skeleton, tmp_path: Path) -> None:
    whole, line, cloud = tmp_path / "s.ply", tmp_path / "line.obj", tmp_path / "cloud.xyz"
    whole.write_bytes(EXPORTS["ply"](skeleton))
    line.write_bytes(FOREIGN["lines.obj"])
    cloud.write_bytes(dump_cloud(np.eye(3), cloud))
    held = read_skeleton(whole)
    m = gather(whole)
    assert (len(m.cloud), m.points, m.name) == (len(held.cloud), None, "s.ply")
    assert len(gather(whole, cloud=cloud).cloud) == 3
    assert len(gather(whole, curve=line).nodes) == 3  # type: ignore[arg-type]
    assert gather(None, cloud=cloud, points=cloud).points is not None
    with pytest.raises(TiskelError, match=r"line.obj comes without its cloud"):
        gather(line)
    with pytest.raises(TiskelError, match="nothing to measure against it"):
        gather(None, cloud=cloud)
