"""Ten scripts as users write them: they run, they are short, and type checkers find nothing but what is wrong."""

import json
import os
import re
import runpy
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from tiskel import make_shape
from tiskel.io.clouds import dump_cloud

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted(path for path in Path(__file__).parent.glob("*.py") if not path.name.startswith("test_"))
PYRIGHT = Path(sys.executable).with_name("basedpyright")
NEEDS = {"radius_table": "pandas", "open3d_cloud": "open3d", "trimesh_mesh": "trimesh", "threads": ""}

# What each writes, and a pattern of what it prints.
WRITES = {
    "array_to_graph": ((), r"\d+ nodes, 3 ends, radius at the first 0\.\d+"),
    "batch": (("scans/one.swc", "scans/two.swc"), r"flat\.ply all 20 points lie on a plane; .*"),
    "compare_two": ((), r"0\.00\d+ 0\.0\d+ \(1\.79\d+, 1\.7\d+\) 0 0"),
    "open3d_cloud": (("lines.ply",), ""),
    "plot": (("y.png", "y.html"), ""),
    "progress_told": ((), r"contract 0% cloud\n(.*\n)+skeleton 100% "),
    "radius_table": (("radii.csv",), r" +kind +length +radius_mean\n(\d +joint-end +0\.\d+ +0\.\d+\n?){3}"),
    "save_and_load": (("skeleton.ply", "skeleton.obj"), r"<Skeleton nodes=\d+ components=1 .*> finished"),
    "threads": ((), r"\[3, 2\]"),
    "trimesh_mesh": (("skeleton.dxf",), r"2 0 2\.\d"),
}

# Each line of this has one mistake; the first must not be told.
WRONG = """
points, true = make_shape("y", 500, noise=0.1)
make_shape("y", 500, noize=0.1)
skeletonize(points, resolutoin=3)
skeletonize(points, method="robsut")
skeletonize(points, progress=3)
contract(points, theta="much")
evaluate(true, curve_sampels=100)
extract_skeleton(contract(points), bridge_gap=0)
fit_surface(true, intervall=0.1)
roll(fit_surface(true)[0], omgea=(0, 1, 0))
plan_roll(Capsule((-1, 0, 0), (1, 0, 0), 0.5), gaol=(0, 0, 0))
condition(points, voxle=0.1)
view(points, up="w")
true.to_pandas("faces")
true.nodez
"""
NAMES = "condition, contract, evaluate, extract_skeleton, fit_surface, make_shape, plan_roll, roll, skeletonize, view"
HEAD = f"from tiskel import {NAMES}\nfrom tiskel.surfaces.implicit_bodies import Capsule\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the files that the scripts read."""
    points = make_shape("y", 700)[0]
    np.save(tmp_path / "scan.npy", points)
    (tmp_path / "scan.ply").write_bytes(dump_cloud(points, "scan.ply"))
    (tmp_path / "scans").mkdir()
    flat = np.c_[np.random.default_rng(0).random((20, 2)), np.zeros(20)]
    for name, cloud in (("one", points), ("two", make_shape("banana", 400)[0]), ("flat", flat)):
        (tmp_path / "scans" / f"{name}.ply").write_bytes(dump_cloud(cloud, "scan.ply"))
    return tmp_path


def test_there_are_ten_and_each_is_short() -> None:
    assert {path.stem for path in SCRIPTS} == set(WRITES)
    assert len(SCRIPTS) == 10
    for path in SCRIPTS:
        assert sum(bool(line.strip()) for line in path.read_text().splitlines()) < 10, path


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_runs(
    path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    if NEEDS.get(path.stem):
        pytest.importorskip(NEEDS[path.stem], exc_type=ImportError)
    monkeypatch.chdir(folder)
    if path.stem == "threads":  # kernels have to be cold
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, map(str, (ROOT, *sys.path))))}
        subprocess.run([sys.executable, path], check=True, timeout=240, env=environment)
    else:
        runpy.run_path(str(path), run_name="__main__")
    files, printed = WRITES[path.stem]
    assert all(Path(name).stat().st_size > 100 for name in files)
    assert re.fullmatch(printed, capfd.readouterr().out.removesuffix("\n"))


def lines_of(said: str, file: Path) -> set[int]:
    """Return the lines of a file that mypy names, counted from 1."""
    return {int(line) for line in re.findall(rf"{file.name}:(\d+): error:", said)}


@pytest.fixture
def wrong(tmp_path: Path) -> Path:
    """The file with a mistake in every line but the first after its head."""
    path = tmp_path / "wrong.py"
    path.write_text(HEAD + WRONG)
    return path


EVERY = set(range(5, 2 + len(WRONG.splitlines()) + 1))  # two lines of the head, an empty one, and the right one


@pytest.mark.slow
@pytest.mark.skipif(find_spec("mypy") is None, reason="mypy is not installed")
def test_mypy_finds_what_is_misspelt_and_nothing_in_the_scripts(wrong: Path) -> None:
    command = [sys.executable, "-m", "mypy", str(wrong), *map(str, SCRIPTS)]  # strict by pyproject.toml
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    assert lines_of(said, wrong) == EVERY, said
    assert f"Found {len(EVERY)} errors in 1 file" in said


@pytest.mark.slow
@pytest.mark.skipif(not PYRIGHT.is_file(), reason="pyright is not installed")
def test_pyright_finds_what_is_misspelt_and_nothing_in_the_scripts(wrong: Path) -> None:
    settings = {"include": [wrong.name, "scripts"], "typeCheckingMode": "standard", "extraPaths": [str(ROOT)]}
    (wrong.parent / "scripts").mkdir()
    for path in SCRIPTS:
        shutil.copy(path, wrong.parent / "scripts")
    (wrong.parent / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [str(PYRIGHT), "--outputjson", "--pythonpath", sys.executable]
    told = subprocess.run(command, cwd=wrong.parent, capture_output=True, text=True, check=False).stdout
    found = json.loads(told)["generalDiagnostics"]
    assert {Path(one["file"]).name for one in found} == {wrong.name}
    lines = {one["range"]["start"]["line"] + 1 for one in found if one["severity"] == "error"}
    assert lines == EVERY, told
