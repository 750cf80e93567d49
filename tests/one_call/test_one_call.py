"""A skeleton in one call, in and out of files, tables and pictures."""

from pathlib import Path

import numpy as np
import pytest

from tiskel import Cloud, Skeleton, TiskelError, contract, extract_skeleton, load_skeleton, make_shape, skeletonize
from tiskel.io.exports import EXPORTS

CLOUD, TRUE = make_shape("y", 700)


def test_one_call_does_what_two_do(tmp_path: Path) -> None:
    two = extract_skeleton(contract(CLOUD, method="gls", max_steps=3))
    np.save(tmp_path / "y.npy", CLOUD)
    for cloud in (CLOUD, tmp_path / "y.npy", str(tmp_path / "y.npy")):
        one = skeletonize(cloud, method="gls", max_steps=3)
        assert np.array_equal(one.nodes, two.nodes)
        assert np.array_equal(one.edges, two.edges)


def test_what_was_said_on_the_way_is_among_the_warnings() -> None:
    skeleton = skeletonize(np.concatenate([CLOUD, CLOUD[:5], [[np.nan] * 3]]), method="lbc", max_steps=2)
    said = [warning.text for warning in skeleton.warnings if warning.code == "contract"]
    assert said[:2] == ["1 rows with NaN or Inf were dropped", "5 exact duplicates were merged"]
    assert said[2].startswith("stopped early: the step limit")


def test_what_was_odd_about_a_file_is_among_them_too() -> None:
    first = skeletonize(Cloud(CLOUD, warnings=("the file is odd",))).warnings[0]
    assert (first.code, first.text) == ("reading", "the file is odd")


def test_progress_only_tells() -> None:
    told: list[tuple[str, float]] = []
    skeleton = skeletonize(CLOUD, progress=lambda p: told.append((p.stage, p.share)))
    assert np.array_equal(skeleton.nodes, skeletonize(CLOUD).nodes)
    assert list(dict.fromkeys(stage for stage, _ in told)) == ["contract", "skeleton"]
    for name in ("contract", "skeleton"):
        shares = [share for stage, share in told if stage == name]
        assert shares == sorted(shares)
        assert (shares[0], shares[-1]) == (0, 1)


@pytest.mark.parametrize("suffix", EXPORTS)
def test_what_is_saved_can_be_loaded(suffix: str, tmp_path: Path) -> None:
    TRUE.save(tmp_path / f"y.{suffix}")
    read = Skeleton.load(tmp_path / f"y.{suffix}")
    assert (read.ends, read.loops, read.components) == (3, 0, 1)
    assert read.length == pytest.approx(TRUE.length)
    assert len(read.cloud) == (700 if suffix == "ply" else 0)


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(TiskelError, match=r"no file .*none\.ply; check the path"):
        load_skeleton(tmp_path / "none.ply")
    with pytest.raises(TiskelError, match=r"no file .*none\.ply; check the path"):
        skeletonize(tmp_path / "none.ply")


def test_a_picture_is_drawn_with_and_without_a_cloud(tmp_path: Path) -> None:
    figure = TRUE.plot(tmp_path / "y.png", title="mine", up="z", unit="m")
    assert (tmp_path / "y.png").read_bytes().startswith(b"\x89PNG")
    assert figure._suptitle.get_text() == "mine: 4 nodes, 1 component, 0 loops, 3 ends, 1 joint"
    TRUE.save(tmp_path / "y.obj")
    assert len(Skeleton.load(tmp_path / "y.obj").plot().axes) == 4
    with pytest.raises(TiskelError, match="a picture cannot be written as 'gif'; choose one of png, svg, pdf"):
        TRUE.plot(tmp_path / "y.gif")


def test_tables_have_a_row_each() -> None:
    pytest.importorskip("pandas")
    nodes, edges, branches = TRUE.to_pandas(), TRUE.to_pandas("edges"), TRUE.to_pandas("branches")
    assert np.array_equal(nodes[["x", "y", "z"]], TRUE.nodes)
    assert nodes["degree"].tolist() == TRUE.degrees.tolist()
    assert set(nodes["radius_source"]) == {"measured"}
    assert np.array_equal(edges[["first", "last"]], TRUE.edges)
    assert edges["length"].sum() == pytest.approx(TRUE.length)
    assert branches["kind"].tolist() == ["joint-end"] * 3
    with pytest.raises(TiskelError, match="a skeleton has tables of nodes, edges, branches, not of 'faces'; choose"):
        TRUE.to_pandas("faces")  # type: ignore[arg-type]


def test_tables_say_what_they_need(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(TiskelError, match=r'need pandas, which is not installed; run: pip install "tiskel\[pandas\]"'):
        TRUE.to_pandas()


def test_a_shape_has_a_name_and_a_number() -> None:
    from tiskel import ShapeParams, named_shape

    wanted = make_shape(named_shape("banana"), ShapeParams(count=300, noise=0.1))[0]
    assert np.array_equal(make_shape("banana", 300, noise=0.1)[0], wanted)
    assert np.array_equal(make_shape("banana", np.int64(300), noise=0.1)[0], wanted)
    assert np.array_equal(make_shape("banana", ShapeParams(noise=0.1), count=300)[0], wanted)
    with pytest.raises(TiskelError, match="no shape is called 'bananna'"):
        make_shape("bananna", 300)
    with pytest.raises(TiskelError, match="ShapeParams has no setting noize; did you mean noise"):
        make_shape("banana", noize=0.1)  # type: ignore[call-arg]
