"""What is gathered to be measured, the heat map of it, and what a skeleton can be written as."""

import io
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from plyfile import PlyData

from tiskel import (
    Contraction,
    ShapeParams,
    Skeleton,
    TiskelError,
    contract,
    evaluate,
    extract_skeleton,
    make_shape,
    shape_graph,
    write_contraction,
    write_skeleton,
)
from tiskel.io import ply
from tiskel.io.exports import EXPORTS, export_of
from tiskel.io.formats import WRITTEN, writer_of
from tiskel.io.measurable import Measurable, gather
from tiskel.io.stages.heat import NAMES, dump_heat

CLOUD = make_shape(shape_graph("y"), ShapeParams(count=300))[0]
OTHER = np.random.default_rng(5).random((20, 3))
LINES = "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nl 2 3\n"


@pytest.fixture(scope="module")
def contraction() -> Contraction:
    return contract(CLOUD)


@pytest.fixture(scope="module")
def skeleton(contraction: Contraction) -> Skeleton:
    return extract_skeleton(contraction)


@pytest.fixture
def folder(tmp_path: Path, contraction: Contraction, skeleton: Skeleton) -> Path:
    write_contraction(tmp_path / "c.ply", contraction, {"name": "y.xyz", "sha256": "ab"})
    write_skeleton(tmp_path / "s.ply", skeleton)
    np.savetxt(tmp_path / "other.xyz", OTHER, fmt="%.17g")
    (tmp_path / "lines.obj").write_text(LINES)
    return tmp_path


def same(found: Measurable, name: str, *arrays: np.ndarray | None) -> None:
    """Assert that these are the name, cloud, points, origin, nodes and edges."""
    assert found.name == name
    held = (found.cloud, found.points, found.origin, found.nodes, found.edges)
    for one, other in zip(held, arrays, strict=True):
        assert (one is None) == (other is None)
        if one is not None:
            np.testing.assert_array_equal(one, other)


def test_a_contraction_brings_points_and_their_origin(folder: Path, contraction: Contraction) -> None:
    c = contraction
    same(gather(folder / "c.ply"), "c.ply", c.cloud, c.points, c.origin, None, None)


def test_a_skeleton_brings_its_curve_too(folder: Path, skeleton: Skeleton) -> None:
    s = skeleton
    same(gather(folder / "s.ply"), "s.ply", s.cloud, s.contracted, s.origin, s.nodes, s.edges)


def test_points_of_a_stage_file_bring_origin_and_cloud(folder: Path, contraction: Contraction) -> None:
    c = contraction
    same(gather(None, points=folder / "c.ply"), "c.ply", c.cloud, c.points, c.origin, None, None)


def test_a_curve_keeps_its_name_and_its_cloud_when_points_are_named(folder: Path, contraction: Contraction) -> None:
    c, nodes = contraction, np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    edges = np.array([[0, 1], [1, 2]])
    found = gather(folder / "lines.obj", folder / "other.xyz", folder / "c.ply")
    same(found, "lines.obj", OTHER, c.points, c.origin, nodes, edges)
    found = gather(folder / "lines.obj", points=folder / "c.ply")
    same(found, "lines.obj", c.cloud, c.points, c.origin, nodes, edges)


def test_the_cloud_that_is_there_stays_when_points_bring_one(folder: Path, skeleton: Skeleton) -> None:
    write_contraction(folder / "o.ply", o := contract(CLOUD[:200]))
    s = skeleton
    same(gather(folder / "s.ply", points=folder / "o.ply"), "s.ply", s.cloud, o.points, o.origin, s.nodes, s.edges)


def test_plain_points_have_no_origin(folder: Path, skeleton: Skeleton) -> None:
    s = skeleton
    same(gather(folder / "s.ply", points=folder / "other.xyz"), "s.ply", s.cloud, OTHER, None, s.nodes, s.edges)


def test_messages_name_the_file(folder: Path) -> None:
    with pytest.raises(TiskelError, match=r"^lines.obj comes without its cloud; name it with --cloud$"):
        gather(folder / "lines.obj")
    for stage in ("c.ply", "s.ply"):
        (folder / stage).write_bytes((folder / stage).read_bytes()[:-9])
        for way in ({"skeleton": folder / stage}, {"skeleton": None, "points": folder / stage}):
            with pytest.raises(TiskelError, match=str(folder / stage)):
                gather(**way)


def test_stage_files_say_what_they_were_made_from(folder: Path) -> None:
    data = (folder / "c.ply").read_bytes()
    assert ply.source_of(data, "contraction", "c.ply") == {"name": "y.xyz", "sha256": "ab"}
    assert ply.source_of((folder / "s.ply").read_bytes(), "skeleton", "s.ply") == {}
    with pytest.raises(TiskelError, match=r"c\.ply"):
        ply.source_of(data, "skeleton", "c.ply")
    with pytest.raises(TiskelError, match=r"cut\.ply"):
        ply.source_of(data[:300], "contraction", "cut.ply")


def test_the_heat_map_holds_every_value_of_points_samples_and_vertices(skeleton: Skeleton) -> None:
    quality = evaluate(skeleton)
    table = PlyData.read(io.BytesIO(dump_heat(quality)))["vertex"]
    p, c = quality.points, quality.curve
    assert p is not None
    assert c is not None
    counts = len(p.points), len(c.samples.points), len(c.vertices)
    np.testing.assert_array_equal(table["of_curve"], np.repeat([0, 1, 2], counts))
    places = np.concatenate([p.points, c.samples.points, c.nodes[c.vertices]])
    np.testing.assert_array_equal(np.stack([table[axis] for axis in "xyz"], axis=1), places)
    none = np.full(sum(counts), np.nan)
    asked: dict[str, tuple[Any, ...]] = {
        "beta": (p.boundedness and p.boundedness.beta, c.boundedness and c.boundedness.beta, None),
        "bounded": (p.boundedness and p.boundedness.bounded, c.boundedness and c.boundedness.bounded, None),
        "inside": (p.inside, c.inside, None),
        "centredness": (p.centredness, c.centredness, None),
        "smoothness": (p.smoothness, None, c.smoothness),
        "in_air": (None, c.in_air, None),
        "medialness": (None, c.medialness, None),
    }
    assert set(NAMES) == {"of_curve", *asked}
    for name, parts in asked.items():
        said = [none[:count] if part is None else part for count, part in zip(counts, parts, strict=True)]
        np.testing.assert_array_equal(table[name], np.concatenate(said).astype(np.float32), err_msg=name)
        np.testing.assert_array_equal(table[f"scalar_{name}"], table[name])
    np.testing.assert_array_equal(table["quality"], table["beta"])


def test_standard_output_and_pipes_take_ply_and_files_what_their_suffix_names(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "file.swc").write_text("")
    assert [export_of(target) for target in ("-", tmp_path / "pipe", "a.SWC", "b.ply")] == ["ply", "ply", "swc", "ply"]
    assert export_of(tmp_path / "file.swc") == "swc"
    for suffix in EXPORTS:
        assert export_of(f"a.{suffix}") == suffix
    listed = ", ".join(EXPORTS)
    for target, asked in (("a.doc", ".doc"), ("doc", "doc"), (tmp_path, tmp_path.suffix or tmp_path.name)):
        with pytest.raises(TiskelError) as caught:
            export_of(target)
        assert str(caught.value) == f"a skeleton cannot be written as {asked!r}; choose one of {listed}"


def test_clouds_are_refused_with_what_they_can_be_written_as() -> None:
    for suffix, asked in ((".doc", "'.doc'"), ("", "'a file without a suffix'")):
        with pytest.raises(TiskelError) as caught:
            writer_of(suffix)
        assert str(caught.value) == f"a cloud cannot be written as {asked}; choose {', '.join(WRITTEN)}"
