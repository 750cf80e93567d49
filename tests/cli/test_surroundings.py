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
    line = one_error_line(tiskel("contract", "a.stl", **bare))
    assert "libGL.so.1" in line
    assert "libgl1" in line
    assert b"not usable (libGL.so.1" in tiskel("doctor", **bare).stdout


def test_two_processes_start_cold_at_once_and_the_cache_location_is_kept(tmp_path: Path) -> None:
    subprocess.run([PROGRAM, "shape", "y", "-n", "600", "-o", "y.ply"], cwd=tmp_path, check=True, capture_output=True)
    cache = tmp_path / "cache"
    environment = {**os.environ, "TI_OFFLINE_CACHE_FILE_PATH": str(cache), "HOME": str(tmp_path / "home")}
    started = [
        subprocess.Popen(
            [PROGRAM, "contract", "y.ply", "-o", f"{i}.ply"], cwd=tmp_path, env=environment, stderr=subprocess.PIPE
        )
        for i in range(2)
    ]
    assert [process.wait(300) for process in started] == [0, 0]
    assert (tmp_path / "0.ply").read_bytes() == (tmp_path / "1.ply").read_bytes()
    assert any(cache.rglob("*"))
    assert not [p for p in (tmp_path / "home").rglob("*") if p.is_file()]


def test_a_home_that_cannot_be_written_is_no_obstacle(tmp_path: Path) -> None:
    (tmp_path / "home").write_text("a file, so that no folder can be made in it")
    environment = {**os.environ, "HOME": str(tmp_path / "home"), "MPLCONFIGDIR": str(tmp_path)}
    subprocess.run(
        [PROGRAM, "shape", "y", "-n", "300", "-o", "y.ply"],
        cwd=tmp_path,
        env=environment,
        check=True,
        capture_output=True,
    )
    done = subprocess.run(
        [PROGRAM, "contract", "y.ply"], cwd=tmp_path, env=environment, check=True, capture_output=True
    )
    assert done.stdout.startswith(b"ply")


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write a cloud of 300 points."""
    path = tmp_path_factory.mktemp("body") / "y.ply"
    subprocess.run([PROGRAM, "shape", "y", "-n", "300", "-o", path], check=True, capture_output=True)
    return path


@pytest.mark.parametrize("value", ["many", "0", "-1", "", " 2", "1.5", "²", "1025"])
def test_a_wrong_number_of_threads_is_one_error_line(value: str, tiskel: Runner, body: Path) -> None:
    line = one_error_line(tiskel("contract", body, TISKEL_NUM_THREADS=value))
    assert (
        line == f"error: TISKEL_NUM_THREADS must be a whole number from 1 to 1024, got {value!r}; correct or unset it"
    )
