"""What scripts can act on: warnings and notes as JSON, and the exit code of --strict."""

import json
from pathlib import Path

import numpy as np
import pytest

from reference.fixtures import Runner, one_error_line
from tiskel import read_skeleton


@pytest.fixture
def plate(tiskel: Runner, tmp_path: Path) -> Path:
    """A contracted plate, which has no curve skeleton."""
    generator = np.random.default_rng(0)
    slab = generator.uniform(-1, 1, (3000, 3)) * [1, 0.8, 0]
    slab[:, 2] = 0.12 * np.sign(generator.random(3000) - 0.5)
    np.save(tmp_path / "plate.npy", slab)
    assert tiskel("contract", "plate.npy", "-o", "c.ply").returncode == 0
    return tmp_path / "c.ply"


def test_warnings_are_data_and_strict_makes_them_the_exit_code(tiskel: Runner, plate: Path, tmp_path: Path) -> None:
    done = tiskel("skeleton", plate.name, "-o", "s.ply", "--json", "--strict")
    assert done.returncode == 1
    document = json.loads(done.stdout)
    assert document["file"] == "c.ply"
    assert document["graph"]["components"] == 2  # its two faces
    found = {one["code"]: one for one in document["warnings"]}
    flat = found["flat"]
    assert set(flat) == {"code", "severity", "text", "share", "places"}
    assert flat["severity"] == "warning"
    assert flat["share"] > 0.5
    assert 1 <= len(flat["places"]) <= 3
    assert np.abs(flat["places"]).max() < 1.2  # nodes, in the units of the input
    assert all(note["severity"] == "note" for note in document["notes"])
    lines = done.stderr.decode().splitlines()
    assert f"warning: {flat['text']}" in lines
    assert "because of --strict" in lines[-1]
    back = read_skeleton(tmp_path / "s.ply")  # written all the same, and what the file says is the same
    assert [w.as_dict() for w in back.warnings] == document["warnings"]
    assert [n.as_dict() for n in back.notes] == document["notes"]
    assert tiskel("skeleton", plate.name, "-o", "s.ply").returncode == 0


def test_a_right_curve_passes_strict(tiskel: Runner, cloud: Path) -> None:
    tiskel("contract", cloud.name, "-o", "c.ply")
    done = tiskel("skeleton", "c.ply", "-o", "s.ply", "--json", "--strict", "--quiet")
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads(done.stdout)["warnings"] == []


def test_one_output_takes_one_thing(tiskel: Runner, plate: Path) -> None:
    assert "name a file for it with -o" in one_error_line(tiskel("skeleton", plate.name, "--json"))
    assert "name a file for it with -o" in one_error_line(tiskel("skeleton", plate.name, "-o", "-", "--json"))


@pytest.mark.slow
def test_a_run_tells_the_same_and_writes_everything(tiskel: Runner, plate: Path, tmp_path: Path) -> None:
    done = tiskel("run", "plate.npy", "-o", "out", "--json", "--strict", "--quiet")
    assert done.returncode == 1
    assert {"skeleton.ply", "report.html", "metrics.json"} <= {path.name for path in (tmp_path / "out").iterdir()}
    document = json.loads(done.stdout)
    assert "flat" in {one["code"] for one in document["warnings"]}
    written = json.loads((tmp_path / "out" / "skeleton.json").read_text())
    codes = [one["code"] for one in written["warnings"]]
    assert codes == [one["code"] for one in document["warnings"]][: len(codes)]
