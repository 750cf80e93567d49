"""Every command through a real process: what it writes, where it says so, and how it ends."""

import json
from pathlib import Path

import numpy as np
import pytest
from plyfile import PlyData, PlyElement

from reference.fixtures import Runner, one_error_line, wrong_usage
from tiskel import (
    LbcParams,
    ShapeParams,
    load_cloud,
    make_shape,
    named_shape,
    read_contraction,
    read_skeleton,
)
from tiskel.cli.table import COMMANDS
from tiskel.gallery.catalogue import SHAPES
from tiskel.gallery.families import BODIES, GROUPS


def test_stages_chain_through_pipes_with_data_alone_on_stdout(tiskel: Runner, cloud: Path) -> None:
    contracted = tiskel("contract", cloud.name)
    assert contracted.returncode == 0
    assert contracted.stdout.startswith(b"ply\n")
    curve = tiskel("skeleton", "-", data=contracted.stdout)
    assert curve.returncode == 0
    assert curve.stdout.startswith(b"ply\n")
    assert b"nodes" in curve.stderr
    said = tiskel("info", "-", data=curve.stdout)
    assert json.loads(said.stdout)["cloud"]["points"] == 900
    assert json.loads(said.stdout)["skeleton"]["nodes"] > 3
    assert tiskel("convert", "-", "y.swc", data=curve.stdout).returncode == 0


def test_files_pipes_and_threads_give_the_same_bytes(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    for method in ("gls", "lbc"):
        made = [tiskel("contract", cloud.name, "--method", method, "--threads", n).stdout for n in (1, 2, 2)]
        assert made[0] == made[1] == made[2]
        assert tiskel("contract", "-", "--method", method, data=cloud.read_bytes()).stdout.count(b"stdin") == 1
        (tmp_path / "c.ply").write_bytes(made[0])
        curves = [tiskel("skeleton", "c.ply", "--threads", n).stdout for n in (1, 2)]
        assert curves[0] == curves[1]
        tiskel("skeleton", "c.ply", "-o", "s.ply")
        assert (tmp_path / "s.ply").read_bytes() == curves[0]


def test_results_hold_no_path_and_no_time(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "y.ply").write_bytes(cloud.read_bytes())
    here, there = (tiskel("contract", name).stdout for name in ("y.ply", tmp_path / "deep" / "y.ply"))
    assert here == there
    header = here.split(b"end_header")[0]
    assert b'"name": "y.ply"' in header
    assert str(tmp_path).encode() not in header
    assert b"seconds" not in header


@pytest.mark.parametrize("suffix", ["ply", "obj", "swc", "graphml", "json"])
def test_skeletons_in_every_format(suffix: str, tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    assert tiskel("contract", cloud.name, "-o", "c.ply").returncode == 0
    assert tiskel("skeleton", "c.ply", "-o", f"s.{suffix}").returncode == 0
    assert tiskel("skeleton", "c.ply", "--format", suffix).stdout == (tmp_path / f"s.{suffix}").read_bytes() != b""
    tiskel("skeleton", "c.ply", "-o", "again.ply")
    assert tiskel("convert", "again.ply", f"t.{suffix}").returncode == 0
    assert (tmp_path / f"t.{suffix}").stat().st_size > 0


def test_raw_and_radius_reach_the_library(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    tiskel("contract", cloud.name, "--method", "lbc", "-o", "c.ply")
    tiskel("skeleton", "c.ply", "--raw", "--radius", 0.3, "-o", "coarse.ply")
    tiskel("skeleton", "c.ply", "-o", "fine.ply")
    assert len(read_skeleton(tmp_path / "coarse.ply").nodes) < len(read_skeleton(tmp_path / "fine.ply").nodes)
    coarse = read_skeleton(tmp_path / "coarse.ply").params
    assert isinstance(coarse, LbcParams)
    assert (coarse.raw, coarse.radius) == (True, 0.3)


def test_contract_options_reach_the_library(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    words = ("--method", "lbc", "--neighbours", 12, "--max-steps", 2, "--normalise", "diagonal", "--solver", "scipy")
    done = tiskel("contract", cloud.name, *words, "--sample", 500, "--verbose", "-o", "c.ply")
    c = read_contraction(tmp_path / "c.ply")
    assert isinstance(c.params, LbcParams)
    assert (c.params.neighbours, c.params.max_steps, c.params.normalise) == (12, 2, "diagonal")
    assert len(c.cloud) == 500
    assert b"sampling took away 400 points" in done.stderr
    assert b"ring ratio" in done.stderr
    assert b"neighbours and rings:" in done.stderr
    assert b"W_L" in done.stderr


def test_steps_of_fronts_are_told_without_weights_that_they_do_not_have(tiskel: Runner, cloud: Path) -> None:
    done = tiskel("contract", cloud.name, "--sample", 500, "--verbose", "-o", "c.ply")
    assert b"ring ratio" in done.stderr
    assert b"W_L" not in done.stderr


def test_run_writes_every_file(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    done = tiskel("run", cloud.name, "-o", "out/deep")
    assert done.returncode == 0
    folder = tmp_path / "out" / "deep"
    names = {"contraction.ply", "report.html", "timings.json"}
    names |= {f"skeleton.{suffix}" for suffix in ("ply", "obj", "swc", "json", "png")}
    names |= {f"metrics.{suffix}" for suffix in ("json", "ply", "png")} | {"stability.json", "stability.png"}
    names |= {"surface.json", "surface.ply", "slices.csv", "slices.png", "path.csv", "roll.json", "roll.png"}
    assert {p.name for p in folder.iterdir()} == names
    assert json.loads((folder / "timings.json").read_text())["contract"] > 0
    for name in ("skeleton.png", "metrics.png", "stability.png", "slices.png", "roll.png"):
        assert (folder / name).read_bytes().startswith(b"\x89PNG")
        assert name in (folder / "report.html").read_text()
    assert json.loads((folder / "metrics.json").read_text())["inside"]["curve"] > 0
    piped = tiskel("skeleton", "-", data=tiskel("contract", cloud.name).stdout).stdout
    assert (folder / "skeleton.ply").read_bytes() == piped


@pytest.mark.slow
@pytest.mark.parametrize("name", ["dumbbell", "links", "tree"])
def test_shapes_go_through_run(name: str, tiskel: Runner, tmp_path: Path) -> None:
    """All of them go through the same stages in tests/pipeline/test_stages.py."""
    assert tiskel("shape", name, "-n", 1500, "-o", "a.ply", "--skeleton", "true.obj").returncode == 0
    done = tiskel("run", "a.ply", "-o", "out")
    assert done.returncode == 0, done.stderr.decode()
    assert len(read_skeleton(tmp_path / "out" / "skeleton.ply").nodes) > 0


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hammer", "horse", "joint", "fertility", "cave"])
def test_reference_clouds_go_through_run(name: str, tiskel: Runner, reference_folder: Path, tmp_path: Path) -> None:
    done = tiskel("run", reference_folder.resolve() / "clouds" / f"{name}.ply", "-o", "out")
    assert done.returncode == 0, done.stderr.decode()
    assert len(read_skeleton(tmp_path / "out" / "skeleton.ply").nodes) > 0


def test_shape_lists_names_and_is_seeded(tiskel: Runner) -> None:
    groups = dict(line.split(": ") for line in tiskel("shape").stdout.decode().splitlines())
    assert {group: names.split() for group, names in groups.items()} == {
        group: list(makers) for group, makers in GROUPS.items()
    }
    assert {*SHAPES, *BODIES} < {name for names in groups.values() for name in names.split()}
    one, same, other = (tiskel("shape", "egg", "-n", 50, "--seed", s).stdout for s in (1, 1, 2))
    assert one == same != other


def test_shape_is_scanned_from_sides_on_a_table(tiskel: Runner, tmp_path: Path) -> None:
    words = ("shape", "block-2", "-n", 400, "--view", "1,-2,1", "--view", "-1,2,1", "--sensor-noise", 0.05, "--table")
    assert tiskel(*words, "-o", "a.ply", "--skeleton", "true.ply").returncode == 0
    params = ShapeParams(count=400, views=((1, -2, 1), (-1, 2, 1)), sensor_noise=0.05, table=True)
    points, truth = make_shape(named_shape("block-2"), params)
    np.testing.assert_array_equal(load_cloud(tmp_path / "a.ply").points, points)
    found = read_skeleton(tmp_path / "true.ply")
    assert (found.components, found.loops, found.ends) == (1, 2, 0)
    np.testing.assert_array_equal(found.nodes, truth.nodes)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--view", "0,0,0"), "not all zero"),
        (("--sensor-noise", "0.1"), "give a view"),
        (("--view", "0,0,1", "--sensor-distance", "0.2"), "1 diagonal"),
    ],
)
def test_sensors_that_make_no_sense_are_refused(words: tuple[str, ...], said: str, tiskel: Runner) -> None:
    assert said in one_error_line(tiskel("shape", "y", *words))


def test_convert_between_cloud_formats(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    for suffix in ("xyz", "csv", "pts", "npy", "ply"):
        assert tiskel("convert", cloud.name, f"b.{suffix}").returncode == 0
        np.testing.assert_array_equal(load_cloud(tmp_path / f"b.{suffix}").points, load_cloud(cloud).points)
    assert "cannot be written as" in one_error_line(tiskel("convert", cloud.name, "b.docx"))
    assert "cannot be written as" in one_error_line(tiskel("convert", cloud.name, "b.obj"))


def test_info_of_stage_files(tiskel: Runner, cloud: Path) -> None:
    tiskel("run", cloud.name, "-o", "out")
    contraction, skeleton = (
        json.loads(tiskel("info", f"out/{stage}.ply").stdout) for stage in ("contraction", "skeleton")
    )
    assert contraction["contraction"]["method"] == "robust"
    assert skeleton["skeleton"]["components"] >= 1
    assert skeleton["cloud"]["points"] == 900


def test_doctor_finds_this_installation_well(tiskel: Runner) -> None:
    done = tiskel("doctor", "--threads", 1)
    assert done.returncode == 0, done.stdout.decode()
    assert b"kernels" in done.stdout
    assert b"1 threads" in done.stdout
    assert b"BAD" not in done.stdout


def xyz(points: np.ndarray) -> bytes:
    return "".join(f"{a} {b} {c}\n" for a, b, c in points.tolist()).encode()


RANDOM = np.random.default_rng(0).random((200, 3))
HOPELESS = {
    "empty": (b"", "is empty"),
    "one point": (b"1 2 3\n", "at least 10 distinct points, got 1"),
    "identical points": (b"1 2 3\n" * 1000, "at least 10 distinct points, got 1"),
    "line": (xyz(np.outer(np.arange(99.0), [1, 2, 3])), "lie on a line"),
    "plane": (xyz(RANDOM * [1, 1, 0]), "lie on a plane"),
    "words": (b"ply is not what this is\n", "PLY"),
    "broken rows only": (b"nan 0 0\n" * 20, "no finite point"),
}


@pytest.mark.parametrize("command", [("contract", "-"), ("run", "-", "-o", "out")])
@pytest.mark.parametrize("name", HOPELESS)
def test_hopeless_clouds_end_with_one_line_and_no_file(
    name: str, command: tuple[str, ...], tiskel: Runner, tmp_path: Path
) -> None:
    data, said = HOPELESS[name]
    assert said in one_error_line(tiskel(*command, data=data))
    assert not [p for p in tmp_path.rglob("*") if p.is_file()]


def test_broken_rows_are_dropped_counted_and_said(tiskel: Runner, capsule: np.ndarray, tmp_path: Path) -> None:
    done = tiskel("contract", "-", data=xyz(capsule) + b"nan 0 0\ninf 1 1\n")
    assert done.returncode == 0
    assert b"warning: 2 rows with NaN or Inf were dropped" in done.stderr
    strict = tiskel("contract", "-", "-o", "strict.ply", "--strict", "--quiet", data=xyz(capsule) + b"nan 0 0\n")
    assert "because of --strict" in one_error_line(strict)
    assert (tmp_path / "strict.ply").exists()
    quiet = tiskel("contract", "-", "--quiet", data=xyz(capsule) + b"nan 0 0\n")
    assert (quiet.returncode, quiet.stderr) == (0, b"")


def test_missing_files_folders_and_wrong_stages(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    assert "no file nowhere.ply" in one_error_line(tiskel("contract", "nowhere.ply"))
    assert "is a directory" in one_error_line(tiskel("contract", "."))
    tiskel("skeleton", cloud.name, "-o", "s.ply")
    assert "is a skeleton file, a contraction file is needed" in one_error_line(tiskel("skeleton", "s.ply"))
    assert "a contraction file is needed" in one_error_line(tiskel("stability", "-", data=cloud.read_bytes()))
    assert "cannot be written as '.dwg'" in one_error_line(tiskel("skeleton", cloud.name, "-o", "a.dwg"))
    assert "cannot write" in tiskel("contract", cloud.name, "-o", "no/such/folder/c.ply").stderr.decode()
    (tmp_path / "file").write_text("")
    assert "cannot make the folder" in one_error_line(tiskel("run", cloud.name, "-o", "file/out"))


def test_wrong_values_and_wrong_usage(tiskel: Runner, cloud: Path) -> None:
    for option, value, needed in (
        ("--crop", "1,2", "6 numbers separated by commas"),
        ("--classification", "ground", "numbers of classes such as 4,5"),
    ):
        said = wrong_usage(tiskel("contract", cloud.name, option, value))
        assert f"Invalid value for {option}: it needs {needed}, got '{value}'." in said
    assert "--view: it needs 3 numbers" in wrong_usage(tiskel("shape", "y", "--view", "1,2"))
    assert "TISKEL_NUM_THREADS must be" in tiskel("contract", cloud.name, TISKEL_NUM_THREADS="many").stderr.decode()
    for words in (
        ("contract",),
        ("nonsense",),
        ("contract", cloud.name, "--nonsense"),
        ("contract", cloud.name, "--threads", "0"),
        ("shape", "y", "-n", "many"),
    ):
        assert tiskel(*words).returncode == 2, words
    assert tiskel("contract", cloud.name, "--threads", "x").returncode == 2


@pytest.mark.parametrize(
    ("words", "choices"),
    [
        (("contract", "--method"), "robust gls lbc"),
        (("contract", "--noise-kind"), "coordinates diagonal"),
        (("skeleton", "--format"), "ply obj swc graphml json"),
        (("metrics", "--bars"), "toolbox max"),
        (("slice", "--order-rule"), "cross-validated published"),
        (("roll", "--model"), "global local both body"),
        (("roll", "--side"), "outside inside"),
        (("roll", "--twist"), "object sphere world"),
        (("roll", "--normals"), "surface pca"),
    ],
)
def test_a_choice_that_is_none_is_wrong_usage(words: tuple[str, str], choices: str, tiskel: Runner) -> None:
    done = tiskel(words[0], "a.ply", words[1], "magic")
    assert done.returncode == 2
    said = " ".join(done.stderr.decode().split())
    assert "'magic' is not one of " + ", ".join(f"'{choice}'" for choice in choices.split()) in said


def test_an_existing_file_stays_when_a_stage_fails(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    (tmp_path / "c.ply").write_text("precious")
    tiskel("contract", "-", "-o", "c.ply", data=b"1 2 3\n")
    assert (tmp_path / "c.ply").read_text() == "precious"


def test_log_and_version_and_help(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    tiskel("contract", cloud.name, "--log", "a.log", "--quiet")
    assert "contracted 900 points" in (tmp_path / "a.log").read_text()
    assert tiskel("--version").stdout.startswith(b"tiskel 0.")
    overview = " ".join(tiskel("-h").stdout.decode().split())
    for name, entry in COMMANDS.items():
        assert f"{name} {entry.summary}" in overview
        help_text = " ".join(tiskel(name, "-h", TERM="dumb").stdout.decode().split())
        assert f"Usage: tiskel {name} " in help_text
        assert entry.summary in help_text


def test_verbose_shows_the_traceback(tiskel: Runner) -> None:
    assert b"Traceback" in tiskel("contract", "nowhere.ply", "--verbose").stderr


def test_robust_is_the_same_on_one_thread_and_two_and_says_its_doubts(
    tiskel: Runner, cloud: Path, tmp_path: Path
) -> None:
    made = []
    for threads in (1, 2):
        contraction = tiskel("contract", cloud.name, "--threads", threads)
        skeleton = tiskel("skeleton", "-", "--threads", threads, data=contraction.stdout)
        made.append((contraction.stdout, skeleton.stdout))
    assert made[0] == made[1]
    assert b"components 1, loops 0, ends 3" in skeleton.stderr
    points = load_cloud(cloud).points
    stray = np.random.default_rng(0).normal(size=(7, 3)) * 0.01 + [3, 0, 0]  # too near to be stray
    np.save(tmp_path / "stray.npy", np.concatenate([points, stray]))
    tiskel("contract", "stray.npy", "-o", "c.ply")
    said = tiskel("skeleton", "c.ply", "-o", "s.ply").stderr
    assert b"note: 7 points in small separate parts were left out" in said
    assert tiskel("skeleton", "c.ply", "-o", "t.ply", "--strict").returncode == 0


def test_weights_name_a_property_of_the_cloud(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    points = load_cloud(cloud).points
    columns = [(axis, "f8") for axis in "xyz"] + [("heavy", "f4")]
    table = np.array([(*p, 1 + 9 * (p[2] > 0)) for p in points], dtype=columns)
    PlyData([PlyElement.describe(table, "vertex")]).write(tmp_path / "w.ply")
    words = ("contract", "w.ply", "--method", "lbc", "--max-steps", 1)
    plain, weighted = (tiskel(*words, *more).stdout for more in ((), ("--weights", "heavy")))
    assert plain.startswith(b"ply")
    assert weighted.startswith(b"ply")
    assert plain != weighted
    assert "has no property 'lead'; it has heavy" in one_error_line(tiskel(*words, "--weights", "lead"))
    fewer = tiskel(*words, "--weights", "heavy", "--sample", 300)
    assert fewer.returncode == 1
    assert b"leave out what changes the number of points" in fewer.stderr
    assert "robust takes no weights" in one_error_line(tiskel("contract", "w.ply", "--weights", "heavy"))
