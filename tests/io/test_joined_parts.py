"""Skeletons of parts made one: what is said of the parts, whose points come to which node, what is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tiskel import (
    CurveGraph,
    CurveWarning,
    JoinParams,
    Progress,
    Skeleton,
    SplitParams,
    TiskelError,
    join_skeletons,
    load_cloud,
    split_cloud,
    write_skeleton,
)
from tiskel.io.clouds import dump_cloud
from tiskel.io.curves import as_skeleton
from tiskel.io.tile_index import TileIndex, read_index

LENGTH, RADIUS = 120.0, 1.0


@pytest.fixture
def tube(tmp_path: Path) -> Path:
    """A tube along x in two tiles, and the centre line of each as its skeleton."""
    made = np.random.default_rng(0)
    x, angle = made.uniform(0, LENGTH, 2400), made.uniform(0, 2 * np.pi, 2400)
    points = np.stack([x, RADIUS * np.cos(angle), RADIUS * np.sin(angle)], axis=1)
    (tmp_path / "c.npy").write_bytes(dump_cloud(points, "c.npy"))
    index, _ = split_cloud(tmp_path / "c.npy", tmp_path / "d", SplitParams(points=1500, overlap=10.0))
    assert [part.name for part in index.parts] == ["t0000", "t0001"]
    for part in index.parts:
        put(tmp_path / "d", part.name, line(tmp_path / "d", part.name))
    return tmp_path / "d"


def line(folder: Path, name: str) -> Skeleton:
    """Return the centre line of a part, a node to every unit; it holds no points."""
    x = load_cloud(folder / "clouds" / f"{name}.ply").points[:, 0]
    at = np.arange(np.ceil(x.min()), x.max())
    nodes = np.stack([at, 0 * at, 0 * at], axis=1)
    edges = np.stack([np.arange(len(at) - 1), np.arange(1, len(at))], axis=1).astype(np.int32)
    return as_skeleton(CurveGraph(nodes, edges, np.full(len(at), RADIUS)))


def put(folder: Path, name: str, skeleton: Skeleton, source: dict[str, str] | None = None) -> None:
    (folder / "skeletons").mkdir(exist_ok=True)
    write_skeleton(folder / "skeletons" / f"{name}.ply", skeleton, source)


def with_doubts(folder: Path, doubts: dict[str, list[CurveWarning]]) -> tuple[Skeleton, TileIndex]:
    for name, said in doubts.items():
        warnings = tuple(doubt for doubt in said if doubt.severity == "warning")
        notes = tuple(doubt for doubt in said if doubt.severity == "note")
        put(folder, name, replace(line(folder, name), warnings=warnings, notes=notes))
    return join_skeletons(folder)


def test_points_of_a_skeleton_that_holds_none_come_to_the_nearest_node(tube: Path) -> None:
    made, _ = join_skeletons(tube, JoinParams(keep="all"))
    assert (made.components, made.loops, made.ends) == (1, 0, 2)
    assert len(made.cloud) == 2400
    away = np.abs(made.nodes[made.node_of_point, 0] - made.cloud[:, 0])
    assert away.max() <= 1.5  # nodes are a unit apart, the last one is up to a unit from the end of the tube


def test_points_are_where_the_skeleton_of_a_part_has_them(tube: Path) -> None:
    """However far that is; but not where it holds another cloud of as many points, or a row of them twice."""
    cloud = load_cloud(tube / "clouds" / "t0000.ply").points
    skeleton = line(tube, "t0000")
    rows = np.random.default_rng(1).permutation(len(cloud)).astype(np.int32)
    node = np.where(cloud[rows, 0] < 9, 3, 5).astype(np.int32)
    held = replace(skeleton, cloud=cloud[rows], input_rows=rows, node_of_point=node)
    put(tube, "t0000", held)
    made, index = join_skeletons(tube, JoinParams(keep="all"))
    place = made.nodes[made.node_of_point, 0]
    core = made.cloud[:, 0] < index.parts[0].high[0]
    np.testing.assert_array_equal(place[core], np.where(made.cloud[core, 0] < 9, *skeleton.nodes[[3, 5], 0]))
    twice = np.array([*rows[:-1], rows[0]], np.int32)
    for at, others in ((rows, cloud[rows] + [0, 1, 0]), (rows + 1, cloud[rows]), (twice, cloud[twice])):
        put(tube, "t0000", replace(held, input_rows=at, cloud=others))
        made, _ = join_skeletons(tube, JoinParams(keep="all"))
        assert np.abs(made.nodes[made.node_of_point, 0] - made.cloud[:, 0]).max() <= 1.5


def test_what_both_parts_say_is_said_once_as_the_worst_of_them_does(tube: Path) -> None:
    made, index = with_doubts(
        tube,
        {
            "t0000": [CurveWarning("thin", "a bit thin", "warning", 0.1, ((5.0, 0.0, 0.0), (6.0, 0.0, 0.0)))],
            "t0001": [CurveWarning("thin", "very thin", "warning", 0.7, ((110.0, 0.0, 0.0),))],
        },
    )
    assert len(index.parts) == 2
    assert made.warnings == (
        CurveWarning("thin", "in 2 of 2 parts, in one of them: very thin", "warning", 0.7, ((5, 0, 0), (110, 0, 0))),
    )
    assert made.notes == ()


def test_limbs_cut_open_at_borders_are_no_fault_of_the_whole(tube: Path) -> None:
    """Nor is what is beyond the core: the next part says that, if it is so."""
    border = read_index(tube).parts[0].high[0]
    places = ((border + 5.0, 0.0, 0.0),)
    made, _ = with_doubts(
        tube,
        {
            "t0000": [
                CurveWarning("open-ends", "1 end is open", "warning", 0.5),
                CurveWarning("short", "a short limb", "note", 0.5, ((5.0, 0.0, 0.0),)),
                CurveWarning("noise", "rough", "warning", 0.5, places),
                CurveWarning("loops", "1 loop", "warning", 0.25, ((5.0, 0.0, 0.0),)),
                CurveWarning("even", "uneven", "note", 0.125),
            ],
            "t0001": [CurveWarning("noise", "rougher", "note", 0.2, places)],
        },
    )
    assert made.warnings == ()
    said = {(doubt.code, doubt.share, doubt.places) for doubt in made.notes}
    assert said == {("loops", 0.25, ((5, 0, 0),)), ("even", 0.125, ()), ("noise", 0.2, places)}
    assert "in 1 of 2 parts, in one of them: 1 loop" in {doubt.text for doubt in made.notes}


def test_objects_are_wholes_and_all_that_is_said_of_them_counts(tube: Path, tmp_path: Path) -> None:
    index, _ = split_cloud(tmp_path / "c.npy", tmp_path / "o", SplitParams(parts="objects", gap=5.0))
    assert [part.name for part in index.parts] == ["o0000"]
    far = CurveWarning("open-ends", "1 end is open", "warning", 0.5, ((500.0, 0.0, 0.0),))
    made, _ = with_doubts(tmp_path / "o", {"o0000": [far, CurveWarning("loops", "1 loop", "warning", 0.25)]})
    assert [(doubt.code, doubt.severity) for doubt in made.warnings] == [("open-ends", "warning"), ("loops", "warning")]


def test_a_part_without_a_curve_and_a_file_that_is_no_tile_are_refused(tube: Path) -> None:
    nothing = as_skeleton(CurveGraph(np.zeros((0, 3)), np.zeros((0, 2), np.int32), np.zeros(0)))
    put(tube, "t0001", nothing)
    with pytest.raises(TiskelError, match=r"t0001\.ply is a skeleton without nodes"):
        join_skeletons(tube)
    put(tube, "t0001", line(tube, "t0001"))
    cloud = tube / "clouds" / "t0001.ply"
    cloud.write_bytes(dump_cloud(load_cloud(cloud).points, cloud))
    with pytest.raises(TiskelError, match=r"t0001\.ply is no tile: it has no properties row and core"):
        join_skeletons(tube)


def test_split_and_join_tell_how_far_they_are_and_stay_the_same(tube: Path, tmp_path: Path) -> None:
    split: list[Progress] = []
    params = SplitParams(points=1500, overlap=10.0)
    split_cloud(tmp_path / "c.npy", tmp_path / "again", params, progress=split.append)
    assert [one.part for one in split] == ["counting", "writing", *["writing"] * 2, ""]  # two tiles, one piece
    assert {one.stage for one in split} == {"split"}
    shares = [one.share for one in split]
    assert shares[0] == 0
    assert 0 < shares[1] < shares[2] <= shares[3] == shares[4] == 1
    assert (tmp_path / "again" / "index.json").read_bytes() == (tube / "index.json").read_bytes()
    join: list[Progress] = []
    found, _ = join_skeletons(tube, progress=join.append)
    assert [(one.stage, one.part, one.share) for one in join] == [
        ("join", "reading", 0), ("join", "t0000", 0), ("join", "t0001", 0.4), ("join", "joining", 0.8), ("join", "", 1),
    ]  # fmt: skip
    np.testing.assert_array_equal(found.nodes, join_skeletons(tube)[0].nodes)
