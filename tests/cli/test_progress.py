"""The line of progress: on a terminal's standard error, once there is something to wait for, and nowhere else."""

import os
import pty
import select
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from reference.fixtures import Runner
from tiskel.cli import console
from tiskel.cli import progress as line
from tiskel.progress import Progress

AT_ONCE = (
    "import sys; from tiskel.cli import progress, app; progress.PATIENCE = 0.0; sys.argv[0] = 'tiskel'; app.main()"
)


def on_terminal(folder: Path, *words: str, piped: bytes | None = None, **variables: str) -> tuple[str, bytes]:
    """Run the program with a terminal as its standard error, without patience; return what it shows and its output."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "100", **variables}
    with subprocess.Popen(
        [sys.executable, "-c", AT_ONCE, *words],
        stdin=subprocess.PIPE, stdout=(folder / "out").open("wb"), stderr=theirs, cwd=folder, env=environment,
    ) as process:  # fmt: skip
        os.close(theirs)
        assert process.stdin is not None
        process.stdin.write(piped or b"")
        process.stdin.close()
        shown = b"".join(iter(lambda: read(ours), b""))
        assert process.wait() == 0
    os.close(ours)
    return shown.decode(), (folder / "out").read_bytes()


def read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other side is closed
        return b""


def test_a_terminal_sees_stage_part_and_share_and_the_file_is_the_same(
    tiskel: Runner, cloud: Path, tmp_path: Path
) -> None:
    shown, made = on_terminal(tmp_path, "contract", cloud.name, "--method", "lbc")
    assert "contract: " in shown
    assert "%" in shown
    assert shown.rstrip().endswith("stopping rule of the method was met")  # the line is gone, the last word stands
    assert "\x1b[2K" in shown
    plain = tiskel("contract", cloud.name, "--method", "lbc")
    assert plain.stdout == made
    assert b"\x1b" not in plain.stderr
    assert b"step" not in plain.stderr.split(b"contracted")[0]


def test_quiet_and_dumb_terminals_see_no_line(cloud: Path, tmp_path: Path) -> None:
    assert on_terminal(tmp_path, "contract", cloud.name, "--quiet")[0] == ""
    assert "\x1b" not in on_terminal(tmp_path, "contract", cloud.name, TERM="dumb")[0]


def test_no_line_where_standard_error_is_a_file_whatever_the_environment_says(tiskel: Runner, cloud: Path) -> None:
    forced = tiskel("contract", cloud.name, "--method", "lbc", FORCE_COLOR="1")
    assert b"%" not in forced.stderr.split(b"contracted")[0]


def test_who_waits_for_a_pipe_shows_nothing_until_it_works(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    contracted = tiskel("contract", cloud.name).stdout
    shown, _ = on_terminal(tmp_path, "skeleton", "-", piped=contracted)
    assert "reading" not in shown
    assert line.reading(Path("a.ply"), Path("-")) == ""
    assert line.reading(Path("a.ply"), None) == "reading"


@contextmanager
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], str]]:
    """Make standard error a terminal; yield what waits for words on it and returns all that it shows.

    No fixture: pytest puts its own standard error back between fixtures and test.
    """
    ours, theirs = pty.openpty()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    seen = ""

    def until(words: str) -> str:
        nonlocal seen
        while words not in seen:
            assert select.select([ours], [], [], 60)[0], f"{words!r} is not in {seen!r}"
            seen += read(ours).decode()
        return seen

    with os.fdopen(theirs, "w") as standard_error:
        monkeypatch.setattr(sys, "stderr", standard_error)
        console.errors.cache_clear()
        yield until
    console.errors.cache_clear()
    os.close(ours)


def test_the_line_says_what_was_reported_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(line, "PATIENCE", 0.0)
    with terminal(monkeypatch) as until, line.shown("reading") as report:
        until("reading")
        assert report is not None
        report(Progress("contract", "rings", 0.0))
        until("contract: rings")
        report(Progress("contract", "step 1", 0.25))
        until("25%")
        until(" left")
        assert any(thread.name == "progress" for thread in threading.enumerate())
    assert not [thread for thread in threading.enumerate() if thread.name == "progress"]


def test_nothing_is_drawn_before_a_second_has_passed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(line, "PATIENCE", 1e6)
    with terminal(monkeypatch) as until:
        with line.shown("reading") as report:
            assert report is not None
            report(Progress("contract", "rings", 0.5))
            time.sleep(3 * line.REFRESH)
        console.errors().print("over")
        assert until("over").strip() == "over"


def test_no_terminal_no_callback(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with (tmp_path / "stderr").open("w") as file:
        monkeypatch.setattr(sys, "stderr", file)
        with line.shown("reading") as report:
            assert report is None


@pytest.mark.parametrize(("seconds", "words"), [(-3, "0:00"), (0.6, "0:01"), (75, "1:15"), (3 * 3600 + 5, "3:00:05")])
def test_times_are_read_at_a_glance(seconds: float, words: str) -> None:
    assert line.clock(seconds) == words
