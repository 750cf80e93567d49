"""Faults of the environment: closed streams, full disks, odd names, links, limits; none ends in a traceback."""

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from reference.fixtures import PROGRAM, Runner, one_error_line
from tiskel.io.streams import BESIDE, STALE, write_bytes

POINTS = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n"
FULL = Path("/dev/full")
needs_full = pytest.mark.skipif(not FULL.exists(), reason="no /dev/full")


@pytest.fixture
def points(tmp_path: Path) -> Path:
    path = tmp_path / "p.xyz"
    path.write_text(POINTS)
    return path


def shell(line: str, folder: Path, **variables: str) -> subprocess.CompletedProcess[bytes]:
    """Run a line of shell in which $T is the program."""
    environment = {**os.environ, "T": str(PROGRAM), **variables}
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, env=environment, capture_output=True, check=False, timeout=60
    )


def only_error(done: subprocess.CompletedProcess[bytes]) -> str:
    return one_error_line(done)


@needs_full
def test_a_full_disk_behind_standard_output_is_one_line(points: Path, tmp_path: Path) -> None:
    assert "No space left" in only_error(shell("$T info p.xyz > /dev/full", tmp_path))
    assert "No space left" in only_error(shell("$T convert p.xyz - > /dev/full", tmp_path))


@needs_full
def test_a_full_disk_behind_the_log_is_one_warning(points: Path, tiskel: Runner) -> None:
    done = tiskel("info", points, "--log", "/dev/full")
    assert done.returncode == 0
    assert done.stderr == b"warning: the log /dev/full cannot be written: No space left on device\n"


def test_closed_streams(points: Path, tmp_path: Path) -> None:
    assert "Bad file descriptor" in only_error(shell("$T info p.xyz >&-", tmp_path))
    assert "standard input is closed" in only_error(shell("$T info - <&-", tmp_path))
    done = shell("$T convert p.xyz q.npy <&- >&- 2>&-", tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    assert (tmp_path / "q.npy").exists()


def test_what_a_library_prints_from_c_is_no_data(points: Path, tmp_path: Path) -> None:
    """A module of ours stands in for one that writes to descriptor 1, as LAPACK does."""
    (tmp_path / "laspy.py").write_text("import os\nos.write(1, b'noise of a library')\nraise ValueError('gone')\n")
    header = b"LASF" + bytes(20) + b"\x01\x02" + bytes(70) + (227).to_bytes(4, "little") + bytes(5)
    header += (20).to_bytes(2, "little") + (1).to_bytes(4, "little")
    (tmp_path / "a.las").write_bytes(header + bytes(136))
    ahead = os.pathsep.join(filter(None, (str(tmp_path), os.environ.get("PYTHONPATH"))))
    done = shell("$T info a.las", tmp_path, PYTHONPATH=ahead)
    assert done.stdout == b""
    assert b"noise of a library" in done.stderr
    assert b"a.las is not a valid LAS file: gone" in done.stderr


@pytest.mark.parametrize("value", ["0", "1025", "99999999999999999999"])
def test_absurd_numbers_of_threads_are_wrong_usage(value: str, points: Path, tiskel: Runner) -> None:
    assert tiskel("info", points, "--threads", value).returncode == 2


def test_a_working_folder_that_is_gone(points: Path, tmp_path: Path) -> None:
    gone = f"mkdir gone; cd gone; rmdir ../gone; $T convert {points}"
    assert shell(f"{gone} {tmp_path}/q.npy", tmp_path).returncode == 0
    assert only_error(shell(f"{gone} q.npy", tmp_path)).startswith("error: cannot write q.npy")


def test_kernels_start_where_the_working_folder_is_gone(cloud: Path, tmp_path: Path) -> None:
    done = shell(f"mkdir gone; cd gone; rmdir ../gone; $T skeleton -q {cloud} -o {tmp_path}/c.ply", tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
@pytest.mark.parametrize("kilobytes", [200_000, 1_000_000])
def test_too_little_memory_is_one_line(kilobytes: int, cloud: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [PROGRAM, "skeleton", cloud, "-o", "c.ply"], cwd=tmp_path, capture_output=True, check=False,
        preexec_fn=limited(kilobytes),
    )  # fmt: skip
    assert done.returncode == 1
    last = done.stderr.decode().splitlines()[-1]
    assert last.startswith("error: ")
    assert "ulimit -v" in last
    assert not (tmp_path / "c.ply").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
def test_a_small_cloud_is_contracted_in_memory_that_kernels_could_not_start_in(cloud: Path, tmp_path: Path) -> None:
    words = [str(PROGRAM), "contract", str(cloud), "-o", "c.ply"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, check=False, preexec_fn=limited(1_000_000))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "c.ply").exists()


def limited(kilobytes: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (kilobytes * 1024, kilobytes * 1024))


@pytest.mark.parametrize("length", [246, 255])
def test_long_names(length: int, points: Path, tiskel: Runner, tmp_path: Path) -> None:
    name = "n" * (length - 4) + ".npy"
    assert tiskel("convert", points, name).returncode == 0
    assert (tmp_path / name).exists()


def test_a_name_that_is_too_long_is_a_short_line(tiskel: Runner) -> None:
    line = one_error_line(tiskel("info", "n" * 400 + ".ply"))
    assert "File name too long" in line
    assert len(line) < 320


ODD = {
    "no UTF-8": (b"a\xff\xfe.xyz", rb"a\udcff\udcfe.xyz"),
    "markup": (b"[bold]a[1;31m.xyz", b"[bold]a[1;31m.xyz"),
    "a closing tag": (b"a[red].xyz", b"a[red].xyz"),
    "mathematics": (b"$x^2$.xyz", b"$x^2$.xyz"),
    "escapes": (b"a\x1b[31mred\x07\r.xyz", rb"a\x1b[31mred\x07 .xyz"),
}


@pytest.mark.parametrize("name", ODD)
def test_odd_names_are_read_and_shown_as_they_are(name: str, tmp_path: Path) -> None:
    raw, shown = ODD[name]
    path = os.path.join(os.fsencode(tmp_path), raw)  # noqa: PTH118
    Path(os.fsdecode(path)).write_text(POINTS + "0 0\n")
    done = subprocess.run(
        [os.fsencode(PROGRAM), b"info", path, b"--log", b"log"], cwd=tmp_path, capture_output=True, check=False
    )
    assert done.returncode == 1
    assert b"error: " + shown + b": line 6 has 2 columns" in done.stderr
    assert shown in (tmp_path / "log").read_bytes()


def test_names_with_dollars_in_pictures() -> None:
    from tiskel.pictures.canvas import new_figure, rendered

    for title in ("$x_{$", "a\x1b[31m\udcff", "two\nlines"):
        figure = new_figure(2, 2)
        figure.suptitle(title)
        assert rendered(figure).startswith(b"\x89PNG")


def test_links_are_followed_and_modes_kept(points: Path, tiskel: Runner, tmp_path: Path) -> None:
    real, link, nowhere = tmp_path / "real.npy", tmp_path / "link.npy", tmp_path / "dangling.npy"
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to(real)
    nowhere.symlink_to("new.npy")
    for target in (link, nowhere):
        assert tiskel("convert", points, target).returncode == 0
        assert target.is_symlink()
        assert target.read_bytes().startswith(b"\x93NUMPY")
    assert real.stat().st_mode & 0o777 == 0o640
    assert (tmp_path / "new.npy").is_file()


@pytest.mark.parametrize(
    ("target", "said"),
    [("no/q.npy", "there is no folder"), ("p.xyz/q.npy", "there is no folder"), (".", "is a directory")],
)
def test_the_output_folder_is_checked_before_the_work(
    target: str, said: str, points: Path, tiskel: Runner, tmp_path: Path
) -> None:
    points.write_text("not even a cloud")
    assert said in one_error_line(tiskel("convert", points, target))


def test_a_stage_file_is_not_written_under_another_suffix(cloud: Path, tiskel: Runner) -> None:
    assert "written as .ply, not as '.xyz'" in one_error_line(tiskel("contract", cloud, "-o", "c.xyz"))


def test_endless_input_has_a_limit(tiskel: Runner, tmp_path: Path) -> None:
    if Path("/dev/zero").exists():
        assert "more than 64 MB and is no file on disk" in one_error_line(tiskel("info", "/dev/zero"))
    data = b"1 2 3\n" * 200_000
    assert "more than 1 MB" in one_error_line(tiskel("info", "-", data=data, TISKEL_MAX_INPUT="1"))
    assert tiskel("info", "-", data=data, TISKEL_MAX_INPUT="2").returncode == 0
    assert "TISKEL_MAX_INPUT must be" in one_error_line(tiskel("info", "-", data=data, TISKEL_MAX_INPUT="much"))


def test_what_killed_runs_left_is_removed_by_the_next(tmp_path: Path) -> None:
    """A file that another process is writing stays, however old; so does a young one."""
    import fcntl

    left, young, held = (tmp_path / f"{BESIDE}{name}.part" for name in ("left", "young", "held"))
    for path in (left, young, held):
        path.write_text("half")
    old = time.time() - 2 * STALE
    for path in (left, held):
        os.utime(path, (old, old))
    with held.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        write_bytes(tmp_path / "a.xyz", b"1 2 3\n")
        assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["a.xyz", young.name, held.name])


def test_an_unknown_backend_of_matplotlib_is_no_obstacle(tmp_path: Path, tiskel: Runner) -> None:
    (tmp_path / "s.json").write_text("{}")
    code = "from tiskel.pictures.canvas import new_figure, rendered; print(len(rendered(new_figure(1, 1))) > 99)"
    environment = {**os.environ, "MPLBACKEND": "nosuch"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def test_a_run_that_is_killed_leaves_no_file_under_the_name(cloud: Path, tmp_path: Path) -> None:
    for delay in (0.2, 0.5, 0.9, 1.3):
        with subprocess.Popen([PROGRAM, "contract", "-q", cloud, "-o", "c.ply"], cwd=tmp_path) as process:
            time.sleep(delay)
            process.send_signal(signal.SIGKILL)
        data = (tmp_path / "c.ply").read_bytes() if (tmp_path / "c.ply").exists() else b"ply"
        assert data.startswith(b"ply")
