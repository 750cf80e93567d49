"""slice and roll through real processes: files, pipes, tables, pictures, and how bad input ends."""

import csv
import io
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from reference.fixtures import Runner, one_error_line, wrong_usage
from tiskel import contract, extract_skeleton, make_shape, read_surfaces, shape_graph, write_skeleton
from tiskel.io.stages.roll import COLUMNS
from tiskel.io.stages.trajectories import read_poses
from tiskel.params import ShapeParams


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A skeleton file of a bent rod."""
    cloud = make_shape(shape_graph("banana"), ShapeParams(count=1500))[0]
    path = tmp_path_factory.mktemp("stage") / "s.ply"
    write_skeleton(path, extract_skeleton(contract(cloud)))
    return path.read_bytes()


@pytest.fixture
def skeleton(stage: bytes, tmp_path: Path) -> Path:
    (tmp_path / "s.ply").write_bytes(stage)
    return tmp_path / "s.ply"


def table(data: bytes) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode())))


def test_slice_and_roll_chain_through_pipes(tiskel: Runner, stage: bytes) -> None:
    sliced = tiskel("slice", "-", data=stage)
    assert sliced.returncode == 0
    assert json.loads(sliced.stdout)["format"] == 1
    assert b"branch 0: length" in sliced.stderr
    assert b"fitted" in sliced.stderr
    rolled = tiskel("roll", "-", "--omega", "0,1,0", "--duration", 1, data=sliced.stdout)
    assert rolled.returncode == 0
    rows = table(rolled.stdout)
    assert list(rows[0]) == list(COLUMNS)
    assert len(rows) == 101
    assert float(rows[-1]["t"]) == 1.0
    assert b"finished" in rolled.stderr


def test_every_file_of_slice_is_written(tiskel: Runner, skeleton: Path, tmp_path: Path) -> None:
    words = ("-o", "f.json", "--mesh", "m.ply", "--caps", "--csv", "t.csv", "--plot", "p.png")
    done = tiskel("slice", skeleton.name, *words)
    assert done.returncode == 0
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "m.ply").read_bytes().startswith(b"ply")
    rows = table((tmp_path / "t.csv").read_bytes())
    assert float(rows[len(rows) // 2]["equivalent_radius"]) == pytest.approx(0.22, abs=0.01)
    assert read_surfaces(tmp_path / "f.json")[0].radius == pytest.approx(0.187, abs=0.01)
    said = json.loads(tiskel("info", "f.json").stdout)
    assert said["stage"] == "surface"
    assert said["surfaces"]["0"]["slices"]["fitted"] > 40


def test_the_whole_body_has_a_surface_and_a_closed_mesh(tiskel: Runner, skeleton: Path, tmp_path: Path) -> None:
    """Where no branch has a tube, too; what needs slices is then refused."""
    done = tiskel("slice", skeleton.name, "--interval", 0.9, "-o", "f.json", "--mesh", "m.ply")
    assert done.returncode == 0
    assert b"branch 0 has no surface" in done.stderr
    assert b"whole body: " in done.stderr
    found = read_surfaces(tmp_path / "f.json")
    assert found.body is not None
    assert (len(found), found.body.summary["coverage"]) == (0, 1.0)
    mesh: Any = trimesh.load(tmp_path / "m.ply", process=False)
    assert mesh.is_watertight
    assert b"property uchar trust" in (tmp_path / "m.ply").read_bytes()[:1000]
    assert json.loads(tiskel("info", "f.json").stdout)["body"]["patches"] == len(found.body.patches)
    for word in ("--plot", "--csv"):
        assert (
            "no branch has a tube" in tiskel("slice", skeleton.name, "--interval", 0.9, word, "p.png").stderr.decode()
        )
    tiskel("slice", skeleton.name, "--no-body", "-o", "g.json")
    assert read_surfaces(tmp_path / "g.json").body is None


def test_every_file_of_roll_is_written(tiskel: Runner, skeleton: Path, tmp_path: Path) -> None:
    tiskel("slice", skeleton.name, "-o", "f.json")
    words = ("-o", "t.csv", "--json", "--plot", "p.svg", "--model", "both", "--duration", 2, "--rate", 10)
    done = tiskel("roll", "f.json", *words, "--animate", "a.html")
    assert done.returncode == 0
    document = json.loads(done.stdout)
    assert [run["model"] for run in document["runs"]] == ["global", "local"]
    assert document["runs"][0]["path_difference"] == pytest.approx(0, abs=1e-4)
    rows = table((tmp_path / "t.csv").read_bytes())
    assert [row["model"] for row in rows].count("local") == 21
    assert b"<svg" in (tmp_path / "p.svg").read_bytes()
    page = (tmp_path / "a.html").read_text()
    assert '"kind":"path"' in page
    assert not re.findall(r'(?:src|href)="(?!data:)', page)
    assert tiskel("roll", "f.json", "-o", "t.csv", "--duration", 0.3, "--animate", "a.gif").returncode == 0
    assert (tmp_path / "a.gif").read_bytes().startswith(b"GIF89a")
    wrong = tiskel("roll", "f.json", "-o", "t.csv", "--animate", "a.mp4")
    assert (wrong.returncode, b"gif, html" in wrong.stderr) == (1, True)


def test_the_same_bytes_on_one_thread_and_two(tiskel: Runner, stage: bytes) -> None:
    made = [tiskel("slice", "-", "--threads", n, data=stage).stdout for n in (1, 2, 2)]
    assert made[0] == made[1] == made[2]
    rolled = [tiskel("roll", "-", "--threads", n, "--omega", "1,1,0", data=made[0]).stdout for n in (1, 2)]
    assert rolled[0] == rolled[1] != b""


def test_options_reach_the_library(tiskel: Runner, skeleton: Path, tmp_path: Path) -> None:
    words = ("--branch", "longest", "--interval", 0.04, "--m", "1,0,2", "--order-rule", "published", "--no-recentre")
    assert tiskel("slice", skeleton.name, "-o", "f.json", *words, "--orders", "2,6").returncode == 0
    document = json.loads((tmp_path / "f.json").read_bytes())
    params = document["params"]
    assert (params["branch"], params["interval"], params["m"]) == ("longest", 0.04, [1, 0, 2])
    assert (params["order_rule"], params["recentre"]) == ("published", False)
    assert (params["least_order"], params["most_order"]) == (2, 6)
    assert len(document["surfaces"][0]["sections"]) < 30
    more = ("--side", "inside", "--radius", 0.05, "--velocity", "0.01,0,0", "--twist", "sphere")
    start = ("--start", "0,pi/3,0,0,-pi")
    exact = ("--rtol", 1e-3, "--atol", 1e-5)
    run = json.loads(tiskel("roll", "f.json", "--json", "--duration", 1, *more, *start, *exact).stdout)["runs"][0]
    assert (run["rtol"], run["atol"]) == (1e-3, 1e-5)
    assert (run["side"], run["radius"], run["twist"], run["time"]) == ("inside", 0.05, "sphere", 1.0)
    assert run["start"] == pytest.approx([0, np.pi / 3, 0, 0, -np.pi], abs=1e-12)
    near = tiskel("roll", "f.json", "--json", "--duration", 1, "--start-at", "1.2,0,0")
    assert json.loads(near.stdout)["runs"][0]["start"][1] == pytest.approx(np.pi / 2, abs=0.1)


def test_a_curve_from_elsewhere(tiskel: Runner, tmp_path: Path) -> None:
    tiskel("shape", "tunnel", "-n", 1500, "-o", "tube.ply", "--skeleton", "curve.json")
    done = tiskel("slice", "tube.ply", "--curve", "curve.json", "-o", "f.json")
    assert done.returncode == 0
    assert read_surfaces(tmp_path / "f.json")[0].radius == pytest.approx(0.25, abs=0.005)
    both = tiskel("slice", "-", "--curve", "-")
    assert (both.returncode, b"cannot both come" in both.stderr) == (1, True)


def test_inputs_from_a_table(tiskel: Runner, skeleton: Path, tmp_path: Path) -> None:
    tiskel("slice", skeleton.name, "-o", "f.json")
    (tmp_path / "w.csv").write_text("t,wx,wy,wz\n0,0,1,0\n1,0,1,0\n2,0,0,0\n")
    done = tiskel("roll", "f.json", "--inputs", "w.csv", "--json")
    assert json.loads(done.stdout)["runs"][0]["time"] == 2.0
    rows = ["t,wx,wy,wz", *(f"{t / 10},1,0,0" for t in range(10)), "5,1,0,0"]
    (tmp_path / "w.csv").write_text("\n".join(rows))
    gap = tiskel("roll", "f.json", "--inputs", "w.csv", "-o", "t.csv")
    assert gap.returncode == 0
    assert b"no row between t = 0.9 and 5" in gap.stderr
    assert tiskel("roll", "f.json", "--inputs", "w.csv", "-o", "t.csv", "--strict").returncode == 1


def test_slip_that_nobody_asked_for_is_a_warning(tiskel: Runner, skeleton: Path) -> None:
    """A large sphere over the end of the rod: ways 0.7 % apart at coarse tolerances."""
    tiskel("slice", skeleton.name, "-o", "f.json")
    words = ("roll", "f.json", "-o", "t.csv", "--omega", "1,0,0", "--radius", 0.5)
    coarse = tiskel(*words, "--rtol", 0.5, "--atol", 0.5)
    assert coarse.returncode == 0
    assert b"warning: the contact's way is 0.7" in coarse.stderr
    strict = tiskel(*words, "--rtol", 0.5, "--atol", 0.5, "--strict", "--quiet")
    assert "apart though there is no slip; take a smaller rtol" in one_error_line(strict)
    assert tiskel(*words, "--strict").returncode == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t,wx,wy\n0,1,2\n", "no column wz"),
        ("t,wx,wy,wz\n", "no row below its header"),
        ("t,wx,wy,wz\n0,1,,3\n", "wy is missing in row 1"),
        ("t,wx,wy,wz\n0,1,x,3\n", "'x' is no number in row 1"),
        ("t,wx,wy,wz\n0,1,2,3\n1,1,2\n", "wz is missing in row 2"),
        ("t,wx,wy,wz\n1,0,0,0\n0,0,0,0\n", "times must rise, row 2 has t = 0 after 1; sort them"),
        ("", "no column t"),
    ],
)
def test_bad_tables_end_with_one_line(text: str, said: str, tiskel: Runner, tmp_path: Path) -> None:
    (tmp_path / "w.csv").write_text(text)
    done = tiskel("roll", "none.json", "--inputs", "w.csv")
    assert said in one_error_line(done)


def test_bad_runs_end_with_one_line(tiskel: Runner, skeleton: Path, tmp_path: Path) -> None:
    tiskel("slice", skeleton.name, "-o", "f.json")
    (tmp_path / "w.csv").write_text("t,wx,wy,wz\n0,0,1,0\n1,0,1,0\n")
    far = tiskel(
        "roll", "f.json", "--json", "--duration", 1, "--start-at", "9,9,9", "--model", "both", "--normals", "pca"
    )
    assert b"the place to start at is" in far.stderr
    assert b"--normals pca counts for the global model" in far.stderr
    newer = {**json.loads((tmp_path / "f.json").read_bytes()), "format": 9}
    (tmp_path / "newer.json").write_text(json.dumps(newer))
    for words, said in (
        (("newer.json",), "format 9, this tiskel reads up to 1; install a newer tiskel"),
        (("s.ply",), "is not a surface file"),
        (("f.json", "--side", "inside", "--radius", 0.5), "it fits nowhere, a sphere of less than"),
        (("f.json", "--start", "0,4,0,0,0"), "v = 4 lies outside the branch"),
        (("f.json", "--branch", "thumb"), "no surface of branch thumb; there are 0"),
        (("f.json", "--rtol", 0), "rtol must be a positive number, got 0"),
        (("f.json", "--velocity", "0,0,1"), "velocity along the normal must be 0"),
        (("f.json", "--model", "local", "--normals", "pca"), "the local model has its curvature from the Fourier"),
        (("f.json", "--inputs", "w.csv", "--omega", "1,0,0"), "--omega would not count; drop one"),
    ):
        assert said in one_error_line(tiskel("roll", *words))
    for option, value, count in (("--start", "0,4", 5), ("--omega", "a,b,c", 3)):
        said = wrong_usage(tiskel("roll", "f.json", option, value))
        assert f"{option}: it needs {count} numbers separated by commas, got '{value}'" in said
    assert "--m: it needs 3 numbers" in wrong_usage(tiskel("slice", "s.ply", "--m", "1,2"))
    still = tiskel("roll", "f.json", "--omega", "0,0,0", "--json", "--duration", 1)
    assert still.returncode == 0
    assert "stays where it is" in json.loads(still.stdout)["runs"][0]["warnings"][0]
    refused: list[tuple[tuple[object, ...], str]] = [
        (("s.ply", "--interval", 0.9, "--no-body"), "too short for 4 slices"),
        (("s.ply", "--branch", 7), "there is no branch 7"),
        (("f.json",), "is no"),
    ]
    for options, said in refused:
        assert said in one_error_line(tiskel("slice", *options))


def test_run_slices_and_rolls_and_says_where_it_cannot(tiskel: Runner, tmp_path: Path) -> None:
    tiskel("shape", "banana", "-n", 1500, "-o", "b.ply")
    words = ("--model", "both", "--side", "inside", "--sphere", 0.03, "--duration", 1, "--branch", "longest")
    exact = ("--rtol", 1e-4, "--atol", 1e-7)
    assert tiskel("run", "b.ply", "-o", "out", *words, *exact).returncode == 0
    made = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"surface.json", "surface.ply", "slices.csv", "path.csv", "roll.json", "slices.png", "roll.png"} <= made
    runs = json.loads((tmp_path / "out" / "roll.json").read_bytes())["runs"]
    assert [(run["rtol"], run["atol"]) for run in runs] == [(1e-4, 1e-7)] * 2
    report = (tmp_path / "out" / "report.html").read_text()
    figure = r'<img src="data:image/png;base64,[^"]{1000,}" alt="Where the sphere rolls[^"]*">'
    assert re.search(figure + r'<figcaption>[^<]*<a href="roll.png"', report)
    assert "inside" in report
    too_large = tiskel("run", "b.ply", "-o", "large", "--side", "inside", "--sphere", 9)
    assert too_large.returncode == 0
    assert b"no rolling: a sphere of radius 9" in too_large.stderr
    assert (tmp_path / "large" / "surface.json").exists()
    assert not (tmp_path / "large" / "path.csv").exists()
    assert "cannot stand inside" in (tmp_path / "large" / "report.html").read_text()


@pytest.fixture(scope="module")
def whole(stage: bytes, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The surface file of a bent rod, with the surface of the whole body."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "s.ply").write_bytes(stage)
    from tiskel import read_skeleton, write_surfaces
    from tiskel.params import SurfaceParams
    from tiskel.slicing.body import fit_whole

    write_surfaces(folder / "f.json", fit_whole(read_skeleton(folder / "s.ply"), SurfaceParams()), SurfaceParams())
    return (folder / "f.json").read_bytes()


@pytest.fixture
def surface(whole: bytes, tmp_path: Path) -> Path:
    (tmp_path / "f.json").write_bytes(whole)
    return tmp_path / "f.json"


def test_the_whole_body_is_rolled_over_and_exported(tiskel: Runner, surface: Path, tmp_path: Path) -> None:
    """Past the end of the rod, where the model of a branch stops; the table drives another run to the same place."""
    words = ("roll", "f.json", "--model", "body", "--omega", "1,0,0", "--duration", 3, "--rate", 20)
    done = tiskel(*words, "-o", "r.csv", "--json", "--plot", "p.png", "--animate", "f.gif")
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert (said["branch"], said["runs"][0]["model"], said["runs"][0]["status"]) == ("body", "body", "finished")
    assert said["runs"][0]["start"][:2] == [None, None]
    assert (tmp_path / "f.gif").read_bytes().startswith(b"GIF")
    rows = table((tmp_path / "r.csv").read_bytes())
    assert rows[0]["u_o"] == ""
    assert float(rows[-1]["way_o"]) == pytest.approx(float(rows[-1]["way_s"]), rel=1e-5)
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    again = tiskel("roll", "f.json", "--model", "body", "--inputs", "r.csv", "--rate", 20, "-o", "r.tum")
    assert again.returncode == 0, again.stderr
    assert tiskel(*words, "-o", "r.yaml").returncode == 0
    one, other = read_poses(tmp_path / "r.csv"), read_poses(tmp_path / "r.tum")
    np.testing.assert_allclose(one.centre, other.centre, atol=1e-6)
    np.testing.assert_allclose(np.abs((one.orientation * other.orientation).sum(axis=1)), 1, atol=1e-9)
    path = (tmp_path / "r.yaml").read_text()
    assert path.count("  pose: {position: {x: ") == len(rows)
    assert "stamp: {sec: 0, nanosec: 50000000}" in path
    both = tiskel("roll", "f.json", "--model", "both", "--duration", 1, "-o", "b.tum")
    assert (both.returncode, b"holds one run" in both.stderr) == (1, True)


def test_a_plan_is_rolled_to_where_it_should_come(tiskel: Runner, surface: Path, tmp_path: Path) -> None:
    cloud = read_surfaces(surface).cloud
    start, goal = (",".join(map(str, cloud[row])) for row in (np.argmin(cloud[:, 0]), np.argmax(cloud[:, 2])))
    words = ("plan", "f.json", f"--from={start}", f"--to={goal}", "--json", "--path", "run.tum", "-o", "w.csv")
    done = tiskel(*words)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert said["off"] < 1e-3
    command = done.stderr.decode().split("roll it with: ")[1].split("\n")[0].split()
    rolled = tiskel("roll", "f.json", *command, "w.csv", "--json")
    assert rolled.returncode == 0, rolled.stderr
    run = json.loads(rolled.stdout)["runs"][0]
    np.testing.assert_allclose(run["end_at"], said["end_at"], atol=2e-3 * run["radius"])
    assert len(read_poses(tmp_path / "run.tum").t) == 1 + round(said["time"] * 100)
    far = tiskel("plan", "f.json", f"--from={start}", "--to=9,9,9")
    assert "from the surface" in one_error_line(far)
    blocked = tiskel("plan", "f.json", f"--from={start}", f"--to={goal}", f"--avoid={goal},0.1")
    assert "cannot stand at the goal" in one_error_line(blocked)


def test_other_bodies_than_a_sphere(tiskel: Runner, surface: Path, tmp_path: Path) -> None:
    words = ("roll", "f.json", "--omega", "0.3,0.5,0", "--duration", 1, "--rate", 10)
    for body in ("ellipsoid:0.05,0.06,0.04", "cylinder:0.05,0.4", "f.json"):
        done = tiskel(*words, "--body", body)
        assert done.returncode == 0, done.stderr
        rows = table(done.stdout)
        assert len(rows) > 1
        assert float(rows[0]["margin"]) > 0
    said = json.loads(tiskel(*words, "--body", "ellipsoid:0.05,0.06,0.04", "--json").stdout)
    assert said["body"] == "ellipsoid:0.05,0.06,0.04"
    for more, wrong in (
        (("--body", "cylinder:1,1", "--model", "body"), "leave out --model body"),
        (("--model", "body", "--branch", "0"), "knows no branches"),
    ):
        assert wrong in one_error_line(tiskel(*words, *more))
    for option, value, wrong in (
        ("--body", "ellipsoid:1,2", "--body: it needs 3 numbers"),
        ("--body", "cylinder:1,0", "--body: it needs positive sizes of a cylinder, got '1,0'"),
        ("--heading", "1,2", "--heading: it needs 3 numbers"),
    ):
        assert wrong in wrong_usage(tiskel(*words, option, value))
