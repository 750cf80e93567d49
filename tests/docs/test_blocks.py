"""Every code block of the documentation and the README runs: page by page, in order, in a folder of its own."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from reference import warm
from reference.blocks import RUN, SHOWN, Block, blocks_of, prose_of

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
RUNNING = [page for page in PAGES if any(one.kind in RUN and not one.reason for one in blocks_of(page))]
PATIENCE = 60  # seconds that the program has to load its libraries


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with the program, which loads its libraries once."""
    folder = tmp_path_factory.mktemp("program")
    address = str(folder / "calls")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    server = subprocess.Popen([sys.executable, warm.__file__, address], env=environment)
    warm.caller(folder, address)
    (folder / "python").symlink_to(sys.executable)
    end = time.monotonic() + PATIENCE
    while not Path(address).exists():
        assert server.poll() is None
        assert time.monotonic() < end
        time.sleep(0.05)
    yield folder
    server.kill()
    server.wait()


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with what pages are given, made when it is asked for first."""
    return tmp_path_factory.mktemp("given")


def given(name: str, store: Path) -> Path:
    """Return a file that pages are given."""
    if not (store / name).exists():
        MAKERS[name](store)
    return store / name


def _cloud(shape: str, name: str, count: int = 800, **settings: object) -> Callable[[Path], None]:
    def make(store: Path) -> None:
        from tiskel import ShapeParams, make_shape, shape_graph
        from tiskel.io.clouds import dump_cloud

        points = make_shape(shape_graph(shape), ShapeParams(count=count, **settings))[0]  # type: ignore[arg-type]
        (store / name).write_bytes(dump_cloud(points, name))

    return make


def _scans(store: Path) -> None:
    (store / "scans").mkdir()
    _cloud("capsule", "scans/a.ply", 300)(store)


def _stages(store: Path) -> None:
    from tiskel import (
        RollParams,
        contract,
        extract_skeleton,
        fit_whole,
        load_cloud,
        roll_on,
        write_contraction,
        write_skeleton,
        write_surfaces,
    )
    from tiskel.io.stages.roll import to_csv

    c = contract(load_cloud(given("scan.ply", store)).points)
    s = extract_skeleton(c)
    whole = fit_whole(s)
    assert whole.body is not None
    write_contraction(store / "c.ply", c, history=True)
    for name in ("curve.ply", "other.swc"):
        write_skeleton(store / name, s)
    write_surfaces(store / "surface.json", whole)
    run = roll_on(whole.body, RollParams(model="body", duration=1.0))
    (store / "path.csv").write_bytes(to_csv([run]))


MAKERS: dict[str, Callable[[Path], None]] = {
    "scan.ply": _cloud("y", "scan.ply"),
    "tree.ply": _cloud("tree", "tree.ply", 1500),
    "front.ply": _cloud("y", "front.ply", views=((0, -1, 0),)),
    "tube.ply": _cloud("banana", "tube.ply"),
    "scans": _scans,
    **dict.fromkeys(("c.ply", "curve.ply", "other.swc", "surface.json", "path.csv"), _stages),
}


@pytest.mark.slow
@pytest.mark.parametrize("page", RUNNING, ids=lambda page: page.stem)
def test_the_blocks_of_a_page_run(page: Path, program: Path, store: Path, tmp_path: Path,
                                  monkeypatch: pytest.MonkeyPatch) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{program}{os.pathsep}{os.environ['PATH']}")
    known: dict[str, object] = {"__name__": "page"}
    for block in blocks_of(page):
        if block.kind not in RUN or block.reason:
            continue
        for name in block.given:
            _lay(given(name, store), tmp_path / name)
        if block.kind == "sh":
            _shell(block, page)
        else:
            exec(compile("\n" * block.line + block.code, str(page), "exec"), known)


def _lay(source: Path, target: Path) -> None:
    if source.is_dir():
        shutil.copytree(source, target, dirs_exist_ok=True)
    else:
        shutil.copy(source, target)


def _shell(block: Block, page: Path) -> None:
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", block.code], capture_output=True, text=True, check=False
    )  # fmt: skip
    assert done.returncode == 0, f"{page.name}:{block.line}\n{block.code}\n{done.stderr}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_block_runs_or_says_why_not(page: Path) -> None:
    for block in blocks_of(page):
        assert block.kind, f"{page.name}:{block.line}: a block without a kind"
        assert block.kind in (*RUN, *SHOWN) or block.reason, f"{page.name}:{block.line}: {block.kind}"
        assert set(block.given) <= set(MAKERS)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_no_code_hides_in_indented_blocks(page: Path) -> None:
    lines = prose_of(page).splitlines()
    for before, line in zip(lines, lines[1:], strict=False):
        assert before.strip() or not line.startswith("    "), f"{page.name}: {line}"
