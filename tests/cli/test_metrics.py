"""`tiskel metrics`, `tiskel stability` and `tiskel compare` through real processes."""

import csv
import json
from pathlib import Path

import pytest
from plyfile import PlyData

from reference.fixtures import Runner, one_error_line
from tiskel import ContractionParams, ShapeParams, contract, extract_skeleton, make_shape, shape_graph
from tiskel.io.clouds import dump_cloud
from tiskel.io.stages.contraction import dump_contraction
from tiskel.io.stages.skeleton import dump_skeleton


@pytest.fixture(scope="module")
def made() -> dict[str, bytes]:
    """Stage files of a Y, by name, made in this process: the commands that make them have tests of their own."""
    points = make_shape(shape_graph("y"), ShapeParams(count=900))[0]
    files = {"y.ply": dump_cloud(points, "y.ply")}
    for method in ("gls", "lbc"):
        contraction = contract(points, ContractionParams(method=method))
        files[f"{method}.c.ply"] = dump_contraction(contraction, history=True)
        files[f"{method}.ply"] = dump_skeleton(extract_skeleton(contraction))
    return files


@pytest.fixture
def skeletons(made: dict[str, bytes], tmp_path: Path) -> list[str]:
    for name, data in made.items():
        (tmp_path / name).write_bytes(data)
    return ["gls.ply", "lbc.ply"]


def test_metrics_of_one_skeleton_are_one_document(tiskel: Runner, skeletons: list[str]) -> None:
    done = tiskel("metrics", skeletons[1])
    assert done.returncode == 0, done.stderr.decode()
    document = json.loads(done.stdout)
    assert document["file"] == "lbc.ply"
    assert 0 <= document["centredness"]["curve"] <= 1
    assert document["loops"]["solid"] == 0
    assert document["settings"]["bars"] == "toolbox"
    assert b"NaN" not in done.stdout


def test_metrics_are_the_same_bytes_on_one_thread_and_two(tiskel: Runner, skeletons: list[str]) -> None:
    for name in skeletons:
        made = {tiskel("metrics", name, "--threads", n).stdout for n in (1, 2)}
        assert len(made) == 1


def test_several_skeletons_are_lines_or_rows(tiskel: Runner, skeletons: list[str]) -> None:
    lines = tiskel("metrics", *skeletons).stdout.decode().splitlines()
    assert [json.loads(line)["file"] for line in lines] == skeletons
    rows = list(csv.DictReader(tiskel("metrics", *skeletons, "--csv").stdout.decode().splitlines()))
    assert [row["file"] for row in rows] == skeletons
    assert float(rows[0]["inside_curve"]) == json.loads(lines[0])["inside"]["curve"]


def test_metrics_options_reach_the_library(tiskel: Runner, skeletons: list[str]) -> None:
    words = ("--bars", "max", "--no-diagonal", "--normalise", "diagonal", "--seed", 3, "--verbose")
    done = tiskel("metrics", skeletons[1], *words)
    settings = json.loads(done.stdout)["settings"]
    assert (settings["bars"], settings["diagonal"], settings["normalise"], settings["seed"]) == (
        "max",
        False,
        "diagonal",
        3,
    )
    assert b"boundedness" in done.stderr


def test_heat_maps_are_scalar_fields_and_pictures_are_drawn(
    tiskel: Runner, skeletons: list[str], tmp_path: Path
) -> None:
    done = tiskel("metrics", skeletons[0], "--ply", "heat.ply", "--plot", "heat.png")
    assert done.returncode == 0, done.stderr.decode()
    vertex = PlyData.read(tmp_path / "heat.ply")["vertex"].data
    assert {"x", "y", "z", "of_curve", "beta", "inside", "centredness", "smoothness", "in_air", "medialness"} <= set(
        vertex.dtype.names
    )
    assert len(vertex) > 100
    assert (tmp_path / "heat.png").read_bytes().startswith(b"\x89PNG")
    assert tiskel("metrics", *skeletons, "--plot", "both.svg").returncode == 0
    assert "measure them one by one" in one_error_line(tiskel("metrics", *skeletons, "--ply", "heat.ply"))


def test_curves_of_other_programs_come_with_their_cloud(tiskel: Runner, skeletons: list[str]) -> None:
    for suffix in ("obj", "swc"):  # tests/io/test_curves.py has them all
        tiskel("convert", "lbc.ply", f"line.{suffix}")
        done = tiskel("metrics", f"line.{suffix}", "--cloud", "y.ply")
        assert done.returncode == 0, done.stderr.decode()
        document = json.loads(done.stdout)
        assert document["topology"]["bottleneck"] is None
        assert document["boundedness"]["curve"] > 0.5
    done = tiskel("metrics", "--cloud", "y.ply", "--points", "lbc.c.ply", "--curve", "line.obj")
    assert json.loads(done.stdout)["settings"]["correspondence"] == "given"
    other = tiskel("shape", "capsule", "-n", 77, "-o", "other.ply")
    assert other.returncode == 0
    done = tiskel("metrics", "--cloud", "y.ply", "--points", "other.ply")
    assert json.loads(done.stdout)["settings"]["correspondence"] == "nearest"
    assert b"the nearest points of the cloud stand in" in done.stderr


def test_a_skeleton_from_a_pipe(tiskel: Runner, skeletons: list[str], tmp_path: Path) -> None:
    piped = json.loads(tiskel("metrics", "-", data=(tmp_path / skeletons[0]).read_bytes()).stdout)
    named = json.loads(tiskel("metrics", skeletons[0]).stdout)
    assert piped.pop("file") == "-"
    assert named.pop("file") == "gls.ply"
    assert piped == named


def test_metrics_of_nothing_and_of_the_wrong_things(tiskel: Runner, skeletons: list[str]) -> None:
    assert "nothing to measure" in one_error_line(tiskel("metrics", "--json"))
    assert "exclude each other" in one_error_line(tiskel("metrics", "gls.ply", "--json", "--csv"))
    assert "comes without its cloud" in one_error_line(tiskel("metrics", "--curve", "y.ply", "--points", "y.ply"))
    assert "no file nowhere.ply" in one_error_line(tiskel("metrics", "gls.ply", "nowhere.ply"))
    assert "cannot be written as 'gif'" in one_error_line(tiskel("metrics", "gls.ply", "--plot", "a.gif"))


def test_stability_is_one_document_and_a_picture(tiskel: Runner, skeletons: list[str], tmp_path: Path) -> None:
    made = [tiskel("stability", "gls.c.ply", "--threads", n, "--plot", "s.png") for n in (1, 2)]
    assert made[0].returncode == 0, made[0].stderr.decode()
    assert made[0].stdout == made[1].stdout
    document = json.loads(made[0].stdout)
    assert (document["file"], document["method"]) == ("gls.c.ply", "gls")
    assert isinstance(document["stable"], bool)
    assert not any(step["control_passes"] for step in document["steps"])
    assert (tmp_path / "s.png").read_bytes().startswith(b"\x89PNG")
    piped = tiskel("stability", "-", data=(tmp_path / "gls.c.ply").read_bytes())
    assert json.loads(piped.stdout)["steps"] == document["steps"]
    assert "a contraction file is needed" in one_error_line(tiskel("stability", skeletons[0]))


def test_a_skeleton_is_like_itself_and_near_another(tiskel: Runner, skeletons: list[str]) -> None:
    same = tiskel("compare", skeletons[0], skeletons[0])
    assert same.returncode == 0, same.stderr.decode()
    document = json.loads(same.stdout)
    assert document["files"] == ["gls.ply", "gls.ply"]
    assert document["same_graph"] is True
    assert document["radii_95"] == pytest.approx(0, abs=1e-9)
    other = json.loads(tiskel("compare", *skeletons).stdout)
    assert 0 < other["radii_95"] < 2
    assert 0 < other["there"]["mean"] <= other["there"]["p95"] <= other["there"]["largest"]
    assert other["lengths"][0] == document["lengths"][1]
    assert other["lengths"][1] != document["lengths"][1]
    assert "no file nowhere.ply" in one_error_line(tiskel("compare", "gls.ply", "nowhere.ply"))
