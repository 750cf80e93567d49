"""The commands split and join through real processes."""

import json
from pathlib import Path

import pytest

from reference.fixtures import Runner, one_error_line, wrong_usage
from tiskel import read_skeleton


@pytest.mark.slow
def test_a_cloud_is_split_done_and_joined(tiskel: Runner, tmp_path: Path) -> None:
    assert tiskel("shape", "knot", "-n", 3000, "-o", "k.ply").returncode == 0
    done = tiskel("split", "k.ply", "-o", "d", "--points", 1600, "--overlap", 0.45)
    assert done.returncode == 0
    assert done.stdout == b""
    assert b"3000 points, " in done.stderr
    names = sorted(path.stem for path in (tmp_path / "d" / "clouds").iterdir())
    assert len(names) > 1
    (tmp_path / "curves").mkdir()
    missing = tiskel("join", "d", "-o", "k.curve.ply", "--skeletons", "curves")
    assert "no skeleton" in one_error_line(missing)
    for name in names:
        contracted = tiskel("contract", f"d/clouds/{name}.ply", "-q")
        tiskel("skeleton", "-", "-q", "-o", f"curves/{name}.ply", data=contracted.stdout)
    joined = tiskel("join", "d", "-o", "k.curve.ply", "--skeletons", "curves", "--json")
    assert joined.returncode == 0, joined.stderr
    said = json.loads(joined.stdout)
    assert said["file"] == "k.ply"
    assert (said["graph"]["components"], said["graph"]["loops"], said["graph"]["ends"]) == (1, 1, 0)
    assert read_skeleton(tmp_path / "k.curve.ply").loops == 1
    assert tiskel("join", "d", "--skeletons", "curves", "--format", "obj").stdout.startswith(b"# tiskel")
    measured = json.loads(tiskel("metrics", "k.curve.ply").stdout)
    assert measured["inside"]["curve"] > 0.9


def test_wrong_usage_is_one_line(tiskel: Runner, tmp_path: Path) -> None:
    (tmp_path / "c.xyz").write_text("0 0 0\n1 0 0\n")
    assert "name a file" in one_error_line(tiskel("split", "-", "-o", "d"))
    assert "at least 10" in one_error_line(tiskel("split", "c.xyz", "-o", "d", "--points", 3))
    assert "positive length" in one_error_line(tiskel("split", "c.xyz", "-o", "d", "--overlap", "-1"))
    assert "index.json" in one_error_line(tiskel("join", ".", "-o", "out.ply"))
    assert "--keep: it needs all or a number of points" in wrong_usage(tiskel("join", ".", "--keep", "some"))
    assert tiskel("split", "c.xyz", "--objects", "-o", "d").returncode == 0
    assert sorted(path.name for path in (tmp_path / "d").iterdir()) == ["clouds", "index.json", "rest.ply"]
