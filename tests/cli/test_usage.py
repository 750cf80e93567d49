"""The command line as people type it: completion, misspelt words, help, settings files, logs, tables on a terminal."""

import json
import os
import pty
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from reference.fixtures import PROGRAM, Runner
from reference.forked import outcomes
from tiskel import ShapeParams, contract, extract_skeleton, load_cloud, make_shape, shape_graph
from tiskel.cli.app import app
from tiskel.cli.info import rounded
from tiskel.cli.table import COMMANDS, PURPOSES
from tiskel.io.clouds import dump_cloud
from tiskel.io.stages.skeleton import dump_skeleton


def flat(text: str) -> str:
    """Return what is in the boxes of a message, in one line."""
    return " ".join(text.replace("│", " ").split())


MISSPELT = {
    "skelton a.ply": "No such command 'skelton'. Did you mean 'skeleton'?",
    "shape bananna": "no shape is called 'bananna'. Did you mean 'banana'?",
    "shape unicorn": "no shape is called 'unicorn'. tiskel shape lists all",
    "contract a.ply --metod gls": "No such option: --metod (Possible options: --method",
    "contract a.ply --method robst": "'robst' is not one of 'robust', 'gls', 'lbc'. Did you mean 'robust'?",
    "contract a.ply --up Q": "'Q' is not one of",
    "batch a -o b --stages contract,skelton": "'skelton' is not one of 'contract', 'skeleton', 'metrics', 'stability', "
    "'surface', 'roll', 'pictures'. Did you mean 'skeleton'?",
    "slice a.ply --m norml": "'norml' is not one of 'normal', 'rotation-minimising'. Did you mean 'normal'?",
}


def test_misspelt_words_are_wrong_usage_and_asked_after(tmp_path: Path) -> None:
    runs = outcomes([words.split() for words in MISSPELT], tmp_path)
    for run, said in zip(runs, MISSPELT.values(), strict=True):
        assert (run["code"], run["out"]) == (2, ""), run
        assert said in flat(run["err"])


COMPLETED = {
    "contract --method ": {"robust", "gls", "lbc"},
    "contract --me": {"--method"},
    "con": {"contract", "convert"},
    "shape ba": {"banana", "band"},
    "run a.ply --branch l": {"longest"},
    "slice a.ply --m ": {"normal", "rotation-minimising"},
    "contract --max-points a": {"auto", "all"},
    "batch a --stages contract,s": {"contract,skeleton", "contract,stability", "contract,surface"},
}


@pytest.mark.parametrize("line", COMPLETED)
def test_the_shell_completes_commands_options_and_choices(line: str) -> None:
    words = ["tiskel", *line.split(" ")]
    asked = {"_TISKEL_COMPLETE": "complete_bash", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    done = CliRunner().invoke(app, [], env=asked, prog_name="tiskel")
    assert done.exit_code == 0
    assert set(done.output.split()) == COMPLETED[line]


def test_bash_completes_files_where_a_command_takes_one(tmp_path: Path) -> None:
    """The program answers nothing for files, and its script leaves them to bash then."""
    asked = {"_TISKEL_COMPLETE": "complete_bash", "COMP_WORDS": "tiskel contract sc", "COMP_CWORD": "2"}
    [named] = outcomes([[]], tmp_path, **asked)
    [script] = outcomes([[]], tmp_path, _TISKEL_COMPLETE="source_bash")
    assert (named["code"], named["out"].strip(), named["err"]) == (0, "", "")
    assert "complete -o default -F" in script["out"]


def test_the_overview_is_by_purpose_and_flags_have_no_type(tmp_path: Path) -> None:
    helps = outcomes([["--help"], *([name, "-h"] for name in COMMANDS), ["-V"]], tmp_path, TERM="dumb")
    overview, *pages, version = (run["out"] for run in helps)
    at = [overview.index(f"\n{purpose}:\n") for purpose in PURPOSES]
    assert at == sorted(at)
    found = [line.split()[0] for line in overview[at[0] :].splitlines() if line[:2] == "  " and line[2:3].strip()]
    assert found == list(COMMANDS)
    assert not [page for page in pages if "bool" in page or "<int" in page]
    assert version.startswith("tiskel 0.")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a cloud of a Y and its skeleton, made in this process."""
    folder = tmp_path_factory.mktemp("y")
    points = make_shape(shape_graph("y"), ShapeParams(count=600))[0]
    (folder / "y.ply").write_bytes(dump_cloud(points, "y.ply"))
    cloud = load_cloud(folder / "y.ply")
    (folder / "s.ply").write_bytes(dump_skeleton(extract_skeleton(contract(cloud.points)), cloud.source))
    return folder


def test_a_cloud_is_contracted_by_skeleton_itself_to_the_same_bytes(tiskel: Runner, files: Path) -> None:
    straight = tiskel("skeleton", files / "y.ply")
    assert straight.returncode == 0, straight.stderr
    assert b"y.ply is a cloud: contracted first, by method robust" in straight.stderr
    assert straight.stdout == (files / "s.ply").read_bytes()


SETTINGS = """
[contract]
method = "lbc"
max_steps = 2
crop = [-9, -9, -9, 9, 9, 9.5]
outliers = true
log = "of-file.log"
[shape]
view = [[0, 0, 1], "1,0,0"]
count = 30
"""


def test_a_settings_file_sets_what_the_command_line_leaves_open(tmp_path: Path) -> None:
    """The commands find no cloud; the log has their settings all the same."""
    (tmp_path / "s.toml").write_text(SETTINGS)
    contracting, of_file = ["contract", "no.ply", "-o", "a.ply"], ["--config", "s.toml"]
    sides = ["-n", "30", "--view", "0,0,1", "--view", "1,0,0"]
    runs = outcomes(
        [
            [*contracting, *of_file], [*contracting, *of_file, "--max-steps", "1", "--log", "b.log"],
            ["shape", "y", *of_file], ["shape", "y", *sides],
        ],
        tmp_path,
    )  # fmt: skip
    assert [run["code"] for run in runs] == [1, 1, 0, 0]
    set_by_file, both = (logged(tmp_path / name)[0] for name in ("of-file.log", "b.log"))
    assert {key: set_by_file[key] for key in ("method", "max_steps", "crop", "outliers", "voxel")} == {
        "method": "lbc", "max_steps": 2, "crop": "-9,-9,-9,9,9,9.5", "outliers": True, "voxel": None,
    }  # fmt: skip
    assert (both["method"], both["max_steps"], both["output"]) == ("lbc", 1, "a.ply")
    assert runs[2]["out"] == runs[3]["out"] != ""


WRONG = {
    "a = 1": "'a' stands outside of a table",
    "[contrct]": "[contrct] is no command of tiskel. Did you mean 'contract'?",
    "[contract]\nmethd = 'gls'": "tiskel contract has no setting 'methd'. Did you mean 'method'?",
    "[contract]\nmethod = 'gsl'": "Did you mean 'gls'? (from s3)",
    "[contract]\nneighbours = 'x'": "(from s4)",
    "[contract]\noutliers = 3": "outliers in [contract] must be true or false, got 3",
    "[contract]\nmethod = true": "method in [contract] must be a value, got True",
    "[contract]\ncrop = {a = 1}": "must be text, numbers or a list of them",
    "[contract": "is not valid TOML",
    "[contract]\nconfig = 's.toml'": "has no setting 'config'",
    "\ud800": "is not valid TOML",
    "#" * ((1 << 20) + 1): "has more than 1 MB",
}


def test_settings_files_that_mean_nothing_are_wrong_usage(tmp_path: Path) -> None:
    names = [f"s{number}" for number in range(len(WRONG))]
    for name, text in zip(names, WRONG, strict=True):
        (tmp_path / name).write_text(text, errors="surrogatepass")
    runs = outcomes([["contract", "a.ply", "--config", name] for name in (*names, "nowhere.toml")], tmp_path)
    for run, said in zip(runs, (*WRONG.values(), "cannot read nowhere.toml: No such file"), strict=True):
        assert (run["code"], run["out"]) == (2, ""), said
        assert said in flat(run["err"])


def logged(path: Path) -> tuple[dict[str, Any], list[str]]:
    """Return the settings in a log, and its lines without the time and the level."""
    lines = [line.split(" ", 3)[3] for line in path.read_text().splitlines()]
    return json.loads(next(line for line in lines if line.startswith("settings: ")).removeprefix("settings: ")), lines


def test_a_log_holds_versions_settings_times_and_the_end(tiskel: Runner, files: Path, tmp_path: Path) -> None:
    tiskel("metrics", files / "s.ply", "--log", "a.log", "-q", "--seed", 3)
    settings, said = logged(tmp_path / "a.log")
    assert said[0].startswith("tiskel metrics ")
    assert said[1].startswith("versions: tiskel 0.")
    assert "numpy " in said[1]
    assert settings["seed"] == 3
    assert json.loads(next(line for line in said if line[:9] == "seconds: ")[9:])["loops"] > 0
    assert said[-1].startswith("done after ")
    tiskel("info", "nowhere.ply", "--log", "a.log", "-q")
    assert logged(tmp_path / "a.log")[1][-1].startswith("failed after ")


def test_branches_are_summed_up_and_listed_with_verbose_and_in_the_log(
    tiskel: Runner, files: Path, tmp_path: Path
) -> None:
    words = ("slice", files / "s.ply", "--no-body", "--interval", 0.05, "-o", "a.json", "--log", "a.log")
    short = tiskel(*words).stderr.decode()
    assert "3 branches have surfaces: lengths " in short
    assert "branch 0: length" not in short
    assert "--verbose has a line for each of them" in short
    long = tiskel(*words, "--verbose").stderr.decode()
    for told in (long, (tmp_path / "a.log").read_text()):
        assert [f"branch {i}: length " in told for i in range(3)] == [True] * 3


def on_a_terminal(folder: Path, *words: str, **variables: str) -> str:
    """Run the program with a terminal as its output; return what it shows."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm-256color", "COLUMNS": "130", **variables}
    with subprocess.Popen([PROGRAM, *words], stdout=theirs, stderr=theirs, cwd=folder, env=environment) as process:
        os.close(theirs)
        shown = b""
        while piece := _read(ours):
            shown += piece
        process.wait()
    os.close(ours)
    return shown.decode()


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other side is closed
        return b""


COLOUR = "\x1b[3"  # how a change of colour begins; bold and dim are no colours


def test_no_color_is_heeded(tmp_path: Path) -> None:
    coloured, plain = (on_a_terminal(tmp_path, "nonsense", **more) for more in ({}, {"NO_COLOR": "1"}))
    assert COLOUR in coloured
    assert COLOUR not in plain
    assert "No such command" in plain


def test_tables_round_and_explain(files: Path, tmp_path: Path) -> None:
    far = np.random.default_rng(0).normal(size=(50, 3)) + [5e6, 0, 0]
    np.save(tmp_path / "far.npy", far)
    assert f"{far[:, 0].min():.5f}" in on_a_terminal(tmp_path, "info", "far.npy", "-q")
    [exact] = outcomes([["info", "far.npy"]], tmp_path)
    assert json.loads(exact["out"])["cloud"]["min"][0] == far[:, 0].min()  # JSON has every digit
    told = on_a_terminal(tmp_path, "metrics", str(files / "s.ply"), "-q")
    for words in ("good", "near 0", "as the body", "* best of its row", "from 0 to 1."):
        assert words in told


def test_numbers_are_rounded_to_what_the_size_makes_worth_telling() -> None:
    assert rounded(0.1 + 0.2) == "0.3"
    assert rounded([5e6 + 1 / 3, 1.0], 3.0) == "5000000.33333, 1"
    assert rounded(123456.789, 2000.0) == "123456.79"
    assert rounded(1e-9, 1e-8) == "1e-09"
    assert (rounded(7), rounded(float("nan"), 1.0), rounded([])) == ("7", "nan", "")
