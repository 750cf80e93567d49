"""view, run and --plot through real processes."""

import re
from pathlib import Path

import pytest

from reference.fixtures import Runner, one_error_line
from tiskel import ShapeParams, make_shape, shape_graph, write_skeleton
from tiskel.io.clouds import dump_cloud


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    cloud, true = make_shape(shape_graph("banana"), ShapeParams(count=700))
    (tmp_path / "b.ply").write_bytes(dump_cloud(cloud, "b.ply"))
    write_skeleton(tmp_path / "s.ply", true)
    return tmp_path


@pytest.mark.slow
def test_stage_files_are_shown_together(tiskel: Runner, folder: Path) -> None:
    assert tiskel("slice", "s.ply", "-o", "f.json").returncode == 0
    assert tiskel("roll", "f.json", "-o", "p.csv", "--duration", 1).returncode == 0
    assert tiskel("metrics", "s.ply", "--ply", "m.ply", "--json").returncode == 0
    assert tiskel("convert", "s.ply", "c.obj").returncode == 0
    files = ("s.ply", "m.ply", "f.json", "p.csv", "b.ply", "c.obj")
    done = tiskel("view", *files, "-o", "v.html", "--unit", "mm", "--up", "y")
    assert (done.returncode, done.stdout) == (0, b""), done.stderr
    page = (folder / "v.html").read_text()
    kinds = re.findall(r'"kind":"(\w+)"', page)
    assert {"points", "curve", "tube", "mesh", "lines", "path"} <= set(kinds)
    assert '"up":"y"' in page
    assert '"unit":"mm"' in page
    assert '"title":"boundedness"' in page
    assert len(page) < 1_500_000
    assert tiskel("view", "f.json", "p.csv", "-o", "v.png").returncode == 0
    assert (folder / "v.png").read_bytes().startswith(b"\x89PNG")


def test_a_cloud_comes_through_a_pipe(tiskel: Runner, folder: Path) -> None:
    done = tiskel("view", "-", "-o", "-", data=(folder / "b.ply").read_bytes())
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(b"<!doctype html>")


def test_bad_input_is_one_line(tiskel: Runner, folder: Path) -> None:
    (folder / "m.json").write_text('{"topology": {}}')
    assert "holds nothing that has a place" in one_error_line(tiskel("view", "m.json", "-o", "v.html"))
    assert "cannot be written as" in one_error_line(tiskel("view", "b.ply", "-o", "v.gif"))
    assert "no file" in one_error_line(tiskel("view", "absent.ply", "-o", "v.html"))
    (folder / "p.csv").write_text("contact_x,centre_x,q_w\n1,2,3\n")
    assert "has no rows with" in one_error_line(tiskel("view", "p.csv", "-o", "v.html"))


@pytest.mark.slow
def test_run_ends_with_a_report_and_stages_draw(tiskel: Runner, folder: Path) -> None:
    done = tiskel("run", "b.ply", "-o", "out", "--duration", 0.5, "--unit", "mm")
    assert done.returncode == 0, done.stderr
    page = (folder / "out" / "report.html").read_text()
    assert "tiskel run b.ply -o out --duration 0.5 --unit mm" in page
    assert page.count("data:image/png;base64,") == 6  # five pictures and the still one of the viewer
    linked = set(re.findall(r'href="([^"#:]+)"', page))
    assert linked - {"report.html"} == {path.name for path in (folder / "out").iterdir()} - {"report.html"}
    done = tiskel("contract", "b.ply", "-o", "c.ply", "--plot", "c.svg")
    assert done.returncode == 0, done.stderr
    assert b"<svg" in (folder / "c.svg").read_bytes()
    assert tiskel("skeleton", "c.ply", "-o", "k.ply", "--plot", "k.pdf", "--up", "x").returncode == 0
    assert (folder / "k.pdf").read_bytes().startswith(b"%PDF")
