"""What commands make of words and numbers: options with commas, outputs, weights, bodies, how far a batch is."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import typer

from tiskel.batch import Settled, Task
from tiskel.batch.pool import Begun
from tiskel.cli import batch_board, batch_options, console, doctor, roll_body, stages
from tiskel.cli.batch_board import Board
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.surfaces.analytic import Ellipsoid, Rod


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("surface, skeleton", (("skeleton", "surface"), False)),
        ("metrics,pictures,contract", (("contract", "metrics"), True)),
        ("pictures,,", ((), True)),
        (" ", ((), False)),
    ],
)
def test_stages_have_their_own_order_and_pictures_are_beside_them(words: str, found: object) -> None:
    assert batch_options.stages_of(words) == found


def test_shards_are_two_numbers() -> None:
    assert batch_options.shard_of("2/10") == (2, 10)
    for wrong in ("2", "2/", "/3", "a/b", "1/-2"):
        with pytest.raises(typer.BadParameter, match=f"it needs I/N, such as 1/4, got '{wrong}'"):
            batch_options.shard_of(wrong)


def test_classes_columns_and_samples() -> None:
    assert stages.classes_of(None) is None
    assert stages.classes_of("4, 05,255") == (4, 5, 255)
    for wrong in ("4;5", "", "1000", "-1", "٤"):
        with pytest.raises(typer.BadParameter, match="numbers of classes such as 4,5"):
            stages.classes_of(wrong)
    assert (stages.columns_of(None), stages.columns_of("x,y,h")) == (None, ("x", "y", "h"))
    assert [stages.sample_of(value) for value in (None, "auto", "70", 70)] == [None, None, 70, 70]
    with pytest.raises(typer.BadParameter, match="auto or a number of points, got 'many'"):
        stages.sample_of("many")


def test_numbers_with_commas_may_be_parts_of_pi() -> None:
    assert stages.numbers_of("--start", "1e-3, -pi/2,3*pi/4", 3) == (0.001, -math.pi / 2, 3 * math.pi / 4)
    for wrong in ("1,2", "1,2,3,4", "1,x,3", "1,2*pie,3", "1,,3"):
        with pytest.raises(typer.BadParameter, match="3 numbers separated by commas"):
            stages.numbers_of("--start", wrong, 3)


def test_weights_are_a_property_of_the_cloud() -> None:
    cloud: Any = SimpleNamespace(name="a.ply", properties={"density": np.ones(3)})
    assert stages.weights_of(cloud, None) is None
    assert stages.weights_of(cloud, "density") is cloud.properties["density"]
    with pytest.raises(TiskelError, match=r"--weights: a.ply has no property 'mass'; it has density"):
        stages.weights_of(cloud, "mass")
    cloud.properties = {}
    with pytest.raises(TiskelError, match="it has none"):
        stages.weights_of(cloud, "mass")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(console, "session", console.Session())
    return tmp_path


@pytest.mark.usefixtures("here")
def test_a_terminal_gets_no_data_but_a_file_named_after_the_input(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert stages.output_path(None, Path("scans/oak.1.ply.gz"), "contraction.ply") == Path("oak.contraction.ply")
    assert stages.output_path(None, Path("-"), "path.csv") == Path("stdin.path.csv")
    assert len(stages.output_path(None, Path("n" * 240), "path.csv").name) == 100 + len(".path.csv")
    assert capsys.readouterr().err.splitlines()[:2] == ["writing oak.contraction.ply", "writing stdin.path.csv"]
    monkeypatch.setattr("sys.stdout.isatty", lambda: False)
    assert stages.output_path(None, Path("oak.ply"), "contraction.ply") == Path("-")


def test_the_suffix_of_an_output_says_its_format(here: Path) -> None:
    for name in ("a.ply", "a.PLY", "a", "-"):
        assert stages.output_path(Path(name), Path("x"), "contraction.ply") == Path(name)
    assert stages.output_path(Path("a.tum"), Path("x"), "path.csv", (".tum",)) == Path("a.tum")
    with pytest.raises(TiskelError, match=r"written as .csv, not as '.tum'; name the file so"):
        stages.output_path(Path("a.tum"), Path("x"), "path.csv")
    stages.check_targets(None, here / "a.png")
    with pytest.raises(TiskelError, match="there is no folder"):
        stages.check_targets(None, here / "no" / "a.png")


def test_no_pictures_without_matplotlib(
    here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(stages, "there", lambda name: name != "matplotlib")
    assert not stages.can_draw()
    assert capsys.readouterr().err.startswith("no pictures: they need matplotlib; ")
    monkeypatch.setattr(stages, "there", lambda name: True)
    assert stages.can_draw()


def test_bodies_have_names_and_sizes() -> None:
    assert roll_body.body_named("ellipsoid:1,2,3") == Ellipsoid(1, 2, 3)
    assert roll_body.body_named("cylinder:1,2") == Rod(1, 2)
    with pytest.raises(typer.BadParameter, match="positive sizes of an ellipsoid, got '1,-2,3'"):
        roll_body.body_named("ellipsoid:1,-2,3")
    with pytest.raises(typer.BadParameter, match="positive sizes of a cylinder, got '1,0'"):
        roll_body.body_named("cylinder:1,0")
    with pytest.raises(typer.BadParameter, match="2 numbers"):
        roll_body.body_named("cylinder:1,2,3")
    with pytest.raises(TiskelError, match="no file cone:1,2"):
        roll_body.body_named("cone:1,2")


@pytest.mark.parametrize(
    ("models", "pictured", "said"),
    [
        (["local"], False, "leave out --model local"),
        (["global", "local"], False, "leave out --model global"),
        (["global"], True, "draw spheres only"),
    ],
)
def test_what_other_bodies_cannot_do_is_refused_before_anything_is_read(
    models: list[Any], pictured: bool, said: str
) -> None:
    settings = [RollParams(model=model) for model in models]
    with pytest.raises(TiskelError, match=said):
        roll_body.rolled(Path("gone"), None, None, "cylinder:1,1", settings, None, as_json=False, pictured=pictured)


def settled(name: str, outcome: Any, **record: object) -> Settled:
    return Settled(Task(name, f"/{name}"), outcome, record)


@pytest.fixture
def clock(here: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[float], None]]:
    """Time that passes when it is told to."""
    now = [1000.0]

    def passes(seconds: float) -> None:
        now[0] += seconds

    monkeypatch.setattr(batch_board, "time", SimpleNamespace(monotonic=lambda: now[0]))
    console.errors.cache_clear()
    yield passes
    console.errors.cache_clear()


def test_a_batch_says_every_so_often_how_far_it_is(
    clock: Callable[[float], None], capsys: pytest.CaptureFixture[str]
) -> None:
    with Board(9) as board:
        board.tell(Begun("a"))
        board.tell(None)
        assert capsys.readouterr().err == ""
        board.tell(settled("old", "kept"))
        board.tell(settled("bad", "failed", kind="refused", message="it is no cloud"))
        assert capsys.readouterr().err == "failed: bad: refused: it is no cloud\n"
        board.tell(settled("a", "done", seconds=12.34))
        clock(30.0)
        board.tell(None)
        line = "1 done, 1 done before, 1 failed, 6 left, 4.0 clouds per minute, 1:30 left\n"
        assert capsys.readouterr().err == line
        board.tell(None)
        assert capsys.readouterr().err == ""
        console.session.verbose = True
        board.tell(settled("b", "done", seconds=12.34))
        assert capsys.readouterr().err == "done: b: 12.3 s\n"
    assert capsys.readouterr().err == "2 done, 1 done before, 1 failed, 5 left, 6.0 clouds per minute, 0:50 left\n"


def test_a_terminal_sees_what_is_being_done_the_longest_at_the_top(
    clock: Callable[[float], None], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with Board(3) as board:
        for name in ("first", "second", "third"):
            board.tell(Begun(name))
            clock(40.0)
        board.tell(settled("second", "done", seconds=40.0))
        rows = [line.replace("│", " ").split() for line in capsys.readouterr().err.splitlines()]
        shown = [row for row in rows if row[:1] in (["first"], ["third"])][-2:]
        assert shown == [["first", "2:00"], ["third", "0:40"]]
    last = capsys.readouterr().err.splitlines()[-1].rpartition("\x1b[2K")[2]  # the table is gone
    assert last == "1 done, 0 failed, 2 left, 0.5 clouds per minute, 4:00 left"
    console.session.quiet = True
    with Board(3) as board:
        assert board._live is None
        board.tell(settled("bad", "failed", kind="refused", message="it is no cloud"))
    assert capsys.readouterr().err == ""


@pytest.mark.usefixtures("clock")
def test_a_clock_that_has_not_moved_yet_says_nothing_of_the_pace() -> None:
    board = Board(2)
    board.tell(settled("a", "done", seconds=0.0))
    assert board.line() == "1 done, 0 failed, 1 left"


@pytest.fixture
def kernels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "_kernels", lambda: [("kernels", "run on 1 threads", True)])


@pytest.mark.usefixtures("here", "kernels")
def test_the_doctor_tells_what_is_needed_from_what_is_optional(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    usual = dict.fromkeys(("threads", "log_file", "config")) | dict.fromkeys(("quiet", "verbose", "strict"), False)
    run: Callable[..., None] = doctor.doctor
    monkeypatch.setattr(doctor, "OPTIONAL", {"e57": "E57", "broken_one": "breaks"})
    monkeypatch.setattr(doctor, "there", lambda name: name != "e57")
    run(**usual)
    lines = capsys.readouterr().out.splitlines()
    assert "ok  e57          not installed; optional: E57" in lines
    assert "ok  broken_one   not usable (No module named 'broken_one'); optional: breaks" in lines
    monkeypatch.setattr(doctor, "NEEDED", ("numpy", "broken_one"))
    with pytest.raises(TiskelError, match="not usable: broken_one; install tiskel again"):
        run(**usual)
    assert "BAD broken_one   No module named 'broken_one'" in capsys.readouterr().out


def test_the_doctor_says_why_kernels_do_not_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*given: object) -> None:
        raise RuntimeError("no memory")

    monkeypatch.setattr("tiskel.contract", fail)
    monkeypatch.setenv("TI_OFFLINE_CACHE", "0")
    kernels, cache = doctor._kernels()
    assert kernels == ("kernels", "RuntimeError: no memory", False)
    assert cache == ("cache", "off: its folder cannot be made, or TI_OFFLINE_CACHE is 0", True)
