"""Commands in this process, standard output a terminal or not: tables for people, plans, joined skeletons."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import typer

import tiskel
from tiskel import TiskelError, contract, extract_skeleton, make_shape, shape_graph, write_skeleton
from tiskel.cli import console
from tiskel.cli.app import app
from tiskel.io.clouds import dump_cloud
from tiskel.io.stages.contraction import write_contraction
from tiskel.params import GlsParams, ShapeParams, SplitParams
from tiskel.surfaces.implicit_bodies import Capsule

Here = Callable[..., tuple[str, str]]  #: words -> standard output and error


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A contraction by gls, its skeleton, and the skeleton of a body that is half as large again."""
    folder = tmp_path_factory.mktemp("made")
    cloud = make_shape(shape_graph("y"), ShapeParams(count=400))[0]
    contraction = contract(cloud, GlsParams())
    write_contraction(folder / "c.ply", contraction, history=True)
    write_skeleton(folder / "one.ply", extract_skeleton(contraction))
    write_skeleton(folder / "two.ply", extract_skeleton(contract(1.5 * cloud)))
    return folder


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Iterator[Here]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setattr(console, "session", console.Session())
    console.errors.cache_clear()

    def run(*words: object, terminal: bool = True) -> tuple[str, str]:
        monkeypatch.setattr("sys.stdout.isatty", lambda: terminal)
        app([str(word) for word in words], standalone_mode=False)
        return tuple(capsys.readouterr())  # type: ignore[return-value]

    yield run
    console.errors.cache_clear()


def rows_of(table: str) -> dict[str, list[str]]:
    """Return the cells of a table by the first of each row."""
    lines = (line.strip(" │┃").replace("┃", "│").split("│") for line in table.splitlines() if {"│", "┃"} & set(line))
    return {cells[0].strip(): [cell.strip() for cell in cells[1:]] for cells in lines}


def test_a_comparison_is_a_table_on_a_terminal(here: Here, made: Path) -> None:
    words = ("compare", made / "one.ply", made / "two.ply")
    facts = json.loads(here(*words, terminal=False)[0])
    assert here(*words, "--json")[0] == json.dumps(facts) + "\n"
    shown, _ = here(*words)
    assert shown.splitlines()[0].strip() == "one.ply and two.ply"
    rows = rows_of(shown)
    assert rows["same_graph"] == [str(facts["same_graph"])]
    assert [float(rows[f"length of {name}"][0]) for name in ("one.ply", "two.ply")] == pytest.approx(
        facts["lengths"], rel=1e-3
    )
    assert float(rows["one.ply to two.ply, largest"][0]) == pytest.approx(facts["there"]["largest"], rel=1e-3)
    assert float(rows["two.ply to one.ply, mean"][0]) == pytest.approx(facts["back"]["mean"], rel=1e-3)
    assert facts["there"] != facts["back"]


def test_stability_is_a_table_with_a_verdict_on_a_terminal(here: Here, made: Path) -> None:
    facts = json.loads(here("stability", made / "c.ply", terminal=False)[0])
    shown, _ = here("stability", made / "c.ply")
    rows = rows_of(shown)
    assert rows["step"] == [str(i + 1) for i in range(len(facts["steps"]))]
    assert rows["stable"] == ["yes" if step["stable"] else "no" for step in facts["steps"]]
    assert [float(cell) for cell in rows["in the hull before"]] == pytest.approx(
        [step["in_hull"] for step in facts["steps"]], abs=6e-4
    )
    last = " ".join(shown.split("└")[1].split()[1:])
    assert last == f"{'stable' if facts['stable'] else 'not stable'}: {facts['reason']}"


START, GOAL = "--from=0,0,0.5", "--to=0.5,0,0.5"


@pytest.fixture
def bodies(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What a surface file named so holds."""
    found = {"rod.json": Capsule((-1, 0, 0), (1, 0, 0), 0.5), "bare.json": None}
    monkeypatch.setattr(tiskel, "read_surfaces", lambda source: SimpleNamespace(body=found[source.name]))
    return found


@pytest.mark.usefixtures("bodies")
def test_a_plan_alone_goes_to_standard_output(here: Here) -> None:
    """And how to roll it is told as a command takes it, an attitude at the start too."""
    words = ("plan", "rod.json", START, GOAL, "--radius", 0.25)
    table, told = here(*words, terminal=False)
    rows = [line.split(",") for line in table.splitlines() if not line.startswith("#")]
    assert rows[0] == ["t", "wx", "wy", "wz", "vx", "vy", "vz"]
    assert {float(row[2]) for row in rows[1:]} != {0.0}
    assert "--model body --side outside --radius 0.25 --start-at=0.0,0.0,0.5 --inputs" in told
    assert "--start-attitude" not in told
    summary, told = here(*words, "--json", "--start-attitude=0,1,0,0", terminal=False)
    assert json.loads(summary)["end_at"] == pytest.approx([0.5, 0, 0.5], abs=1e-6)
    assert "--start-at=0.0,0.0,0.5 --start-attitude=0,1,0,0 --inputs" in told
    assert not any(Path.cwd().iterdir())


def test_a_plan_is_filmed_and_one_without_a_body_refused(
    here: Here, bodies: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    filmed: list[Any] = []

    def film(body: Any, runs: list[Any], target: str, look: Any) -> bytes:
        filmed.append((body, target))
        return f"{len(runs)} run, {runs[0].status.value}".encode()

    monkeypatch.setattr("tiskel.cli.films.film", film)
    here("plan", "rod.json", START, GOAL, "--radius", 0.25, "--animate", "f.html", "-o", "in.csv")
    assert filmed == [(bodies["rod.json"], "f.html")]
    assert Path("f.html").read_bytes() == b"1 run, finished"
    assert Path("in.csv").read_bytes().splitlines()[0].startswith(b"t,wx")
    with pytest.raises(TiskelError, match="no surface of the whole body in the file; slice again without --no-body"):
        here("plan", "bare.json", START, GOAL)


def test_objects_are_joined_to_a_file_or_a_pipe(here: Here) -> None:
    one = make_shape(shape_graph("capsule"), ShapeParams(count=300))[0]
    Path("c.npy").write_bytes(dump_cloud(np.concatenate([one, one + 50]), "c.npy"))
    index, _ = tiskel.split_cloud("c.npy", "d", SplitParams(parts="objects"))
    assert len(index.parts) == 2
    for part in index.parts:
        cloud = tiskel.load_cloud(f"d/clouds/{part.name}.ply")
        Path("d/skeletons").mkdir(exist_ok=True)
        write_skeleton(f"d/skeletons/{part.name}.ply", extract_skeleton(contract(cloud.points)), cloud.source)
    said = json.loads(here("join", "d", "-o", "j.ply", "--json", "--keep", 100)[0])
    assert (said["file"], said["graph"]["components"]) == ("c.npy", 2)
    made = tiskel.read_skeleton("j.ply")
    assert len(made.nodes) == said["graph"]["nodes"]
    assert len(made.cloud) <= 100
    assert here("join", "d", "-o", "k.obj", "--keep", "all", "--format", "obj")[0] == ""
    assert Path("k.obj").read_bytes().startswith(b"# tiskel")
    with pytest.raises(TiskelError, match="both go to standard output; name a file for it with -o"):
        here("join", "d", "--json", terminal=False)
    with pytest.raises(typer.BadParameter, match="all or a number of points, got 'few'"):
        here("join", "d", "--keep", "few")
