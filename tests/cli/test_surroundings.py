"""What the surroundings do to the program: signals, closed pipes, missing libraries, cold and unwritable caches."""

import fcntl
import os
import signal
import subprocess
import termios
import time
from pathlib import Path

import pytest

from reference.fixtures import PROGRAM, Runner, one_error_line


def ahead(folder: Path) -> str:
    """Return PYTHONPATH with a folder before all others."""
    return os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))


def waits_for_more(process: subprocess.Popen[bytes]) -> bool:
    """Tell whether a process has taken all that its standard input holds, and its main thread sleeps."""
    assert process.stdin is not None
    unread = bytearray(4)
    fcntl.ioctl(process.stdin, termios.FIONREAD, unread)
    state = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[0]
    return not any(unread) and state == "S"


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks /proc what a process does")
def test_interrupt_ends_with_130(tmp_path: Path) -> None:
    """The program waits for the rest of standard input when the signal comes."""
    with subprocess.Popen(
        [PROGRAM, "contract", "-"], stdin=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path
    ) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        process.stdin.write(b"ply\n")
        process.stdin.flush()
        while not waits_for_more(process):
            assert process.poll() is None, process.stderr.read().decode()
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        assert process.stderr.read() == b"interrupted\n"
        assert process.wait() == 130


def test_a_reader_that_leaves_early_is_no_accident(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        f"'{PROGRAM}' contract y.ply | head -c 10", shell=True, capture_output=True, cwd=tmp_path, check=True
    )
    assert done.stdout == b"ply\nformat"
    assert b"Traceback" not in done.stderr


def test_the_chain_runs_where_open3d_cannot_be_imported(tiskel: Runner, tmp_path: Path) -> None:
    (tmp_path / "blocked").mkdir()
    (tmp_path / "blocked" / "open3d.py").write_text("raise ImportError('libGL.so.1: cannot open shared object file')")
    bare = {"PYTHONPATH": ahead(tmp_path / "blocked")}
    for suffix in ("ply", "xyz", "npy"):
        assert tiskel("shape", "y", "-n", 600, "-o", f"a.{suffix}", **bare).returncode == 0
        assert tiskel("run", f"a.{suffix}", "-o", suffix, **bare).returncode == 0
    (tmp_path / "a.stl").write_text("solid a\nendsolid a\n")
    assert "holds no facets" in one_error_line(tiskel("contract", "a.stl", **bare))


def test_two_processes_start_cold_at_once_and_the_cache_location_is_kept(tmp_path: Path) -> None:
    subprocess.run([PROGRAM, "shape", "y", "-n", "600", "-o", "y.ply"], cwd=tmp_path, check=True, capture_output=True)
    cache = tmp_path / "cache"
    environment = {**os.environ, "TI_OFFLINE_CACHE_FILE_PATH": str(cache), "HOME": str(tmp_path / "home")}
    started = [
        subprocess.Popen(
            [PROGRAM, "skeleton", "y.ply", "-o", f"{i}.ply"], cwd=tmp_path, env=environment, stderr=subprocess.PIPE
        )
        for i in range(2)
    ]
    assert [process.wait(300) for process in started] == [0, 0]
    assert (tmp_path / "0.ply").read_bytes() == (tmp_path / "1.ply").read_bytes()
    assert any(cache.rglob("*"))
    assert not [p for p in (tmp_path / "home").rglob("*") if p.is_file()]


# What Taichi answers with an abort or a segmentation fault; None unsets a variable, FILE is one, so that no folder can
# be made in it (a folder without permissions would not keep root out).
SURROUNDINGS: dict[str, dict[str, str | None]] = {
    "no home": {"HOME": None, "XDG_CACHE_HOME": None},
    "a home that is a file": {"HOME": "FILE", "XDG_CACHE_HOME": None},
    "a cache home that is a file": {"XDG_CACHE_HOME": "FILE"},
    "a cache below a file": {"TI_OFFLINE_CACHE_FILE_PATH": "FILE/cache"},
    "a cache below a file, and switched on": {"TI_OFFLINE_CACHE_FILE_PATH": "FILE/cache", "TI_OFFLINE_CACHE": "1"},
    "nowhere": {"HOME": "FILE", "XDG_CACHE_HOME": "FILE/home", "TI_OFFLINE_CACHE_FILE_PATH": "FILE/cache"},
}


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write a cloud of 300 points."""
    path = tmp_path_factory.mktemp("body") / "y.ply"
    subprocess.run([PROGRAM, "shape", "y", "-n", "300", "-o", path], check=True, capture_output=True)
    return path


def skeleton_of(body: Path, tmp_path: Path, **changes: str | None) -> bytes:
    """Find a skeleton in changed surroundings; return standard output, having checked that nothing is left behind."""
    (tmp_path / "file").write_text("")
    (tmp_path / "temporary").mkdir()
    environment = {**os.environ, "MPLCONFIGDIR": str(tmp_path), "TMPDIR": str(tmp_path / "temporary")}
    for name, value in changes.items():
        environment.pop(name, None)
        if value is not None:
            environment[name] = value.replace("FILE", str(tmp_path / "file"))
    done = subprocess.run([PROGRAM, "skeleton", body], env=environment, capture_output=True, check=False, timeout=240)
    assert done.returncode == 0, done.stderr.decode()
    assert b"error" not in done.stderr
    assert list((tmp_path / "temporary").iterdir()) == []
    return done.stdout


@pytest.mark.parametrize("name", SURROUNDINGS)
def test_folders_that_cannot_be_made_are_no_obstacle(name: str, body: Path, tmp_path: Path) -> None:
    assert skeleton_of(body, tmp_path, **SURROUNDINGS[name]).startswith(b"ply")


def test_a_user_without_a_home_whom_the_system_does_not_know(body: Path, tmp_path: Path) -> None:
    """As in a container that runs under a number only: no HOME, no entry in the list of users."""
    (tmp_path / "early").mkdir()
    (tmp_path / "early" / "sitecustomize.py").write_text(
        "import pwd\ndef getpwuid(uid):\n    raise KeyError(uid)\npwd.getpwuid = getpwuid\n"
    )
    stage = skeleton_of(body, tmp_path, HOME=None, XDG_CACHE_HOME=None, PYTHONPATH=ahead(tmp_path / "early"))
    assert stage.startswith(b"ply")


def test_an_empty_cache_home_is_none(body: Path, tmp_path: Path) -> None:
    """Taichi would take it for the root folder."""
    skeleton_of(body, tmp_path, HOME=str(tmp_path), XDG_CACHE_HOME="")
    assert any((tmp_path / ".cache" / "taichi").iterdir())


def test_doctor_says_that_there_is_no_cache(tiskel: Runner, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert b"cache        off: " in tiskel("doctor", TI_OFFLINE_CACHE_FILE_PATH=f"{tmp_path}/file/cache").stdout


@pytest.mark.parametrize("value", ["many", "0", "-1", "", " 2", "1.5", "²", "1025"])
def test_a_wrong_number_of_threads_is_one_error_line(value: str, tiskel: Runner, body: Path) -> None:
    line = one_error_line(tiskel("contract", body, TISKEL_NUM_THREADS=value))
    assert (
        line == f"error: TISKEL_NUM_THREADS must be a whole number from 1 to 1024, got {value!r}; correct or unset it"
    )


def test_a_pipe_of_four_commands_shares_a_cold_cache_and_is_as_four_commands_in_turn(
    tiskel: Runner, cloud: Path, tmp_path: Path
) -> None:
    """Each waits for the one before it; all write kernels into one cache."""
    environment = {**os.environ, "TI_OFFLINE_CACHE_FILE_PATH": str(tmp_path / "cache")}
    stages = ("contract y.ply", "skeleton -", "slice -", "roll - --duration 1")
    piped = subprocess.run(
        " | ".join(f"'{PROGRAM}' {stage} -q" for stage in stages),
        shell=True, capture_output=True, cwd=tmp_path, env=environment, check=True,
    )  # fmt: skip
    assert piped.stderr == b""
    data: bytes | None = None
    for stage in stages:
        data = tiskel(*stage.split(), "-q", data=data, **environment).stdout
    assert piped.stdout == data
    assert piped.stdout.count(b"\n") > 10
