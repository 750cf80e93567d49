"""How many threads there may be, where Taichi starts, and that it refuses to in a forked process."""

import os
from pathlib import Path

import pytest

from tiskel.errors import TiskelError
from tiskel.kernels import folders, runtime, threads


@pytest.fixture
def cgroups(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A machine of 64 cores, and a process in the group /a/b."""
    (tmp_path / "sys" / "a" / "b").mkdir(parents=True)
    (tmp_path / "mine").write_text("1:name=old:/elsewhere\n0::/a/b\n")
    monkeypatch.setattr(threads, "CGROUPS", tmp_path / "sys")
    monkeypatch.setattr(threads, "MINE", tmp_path / "mine")
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: set(range(64)), raising=False)
    return tmp_path / "sys"


@pytest.mark.parametrize(
    ("quotas", "count"),
    [
        ({}, 64),
        ({"": "max 100000", "a/b": "max 100000"}, 64),
        ({"a": "800000 100000", "a/b": "max 100000"}, 8),
        ({"": "1600000 100000", "a": "800000 100000", "a/b": "350000 100000"}, 3),
        ({"a/b": "50000 100000"}, 1),  # half a core
        ({"a/b": "9900000 100000"}, 64),  # more than there are
        ({"a": "nonsense", "a/b": "400000 0 0"}, 64),
        ({"elsewhere": "100000 100000"}, 64),  # of others
    ],
)
def test_the_least_quota_of_the_groups_around_a_process_counts(
    quotas: dict[str, str], count: int, cgroups: Path
) -> None:
    for folder, words in quotas.items():
        (cgroups / folder).mkdir(exist_ok=True)
        (cgroups / folder / "cpu.max").write_text(f"{words}\n")
    assert threads.available_threads() == count


def test_a_process_that_is_in_no_group_of_the_second_version_has_the_quota_of_the_root(
    cgroups: Path, tmp_path: Path
) -> None:
    (cgroups / "cpu.max").write_text("200000 100000\n")
    (cgroups / "a" / "cpu.max").write_text("100000 100000\n")
    (tmp_path / "mine").write_text("1:cpu:/a\n")
    assert threads.available_threads() == 2
    (tmp_path / "mine").unlink()
    assert threads.available_threads() == 2


def test_kernels_do_not_start_in_a_forked_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the child of a fork finds: they were started by a process of another number."""
    monkeypatch.setattr(runtime, "started_in", [os.getppid()])
    monkeypatch.setattr(runtime, "_start", lambda: pytest.fail("started again"))
    with pytest.raises(TiskelError, match="do not survive a fork"):
        runtime.ensure()


def test_taichi_starts_in_a_folder_that_is_there_and_the_process_is_back_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with folders.somewhere():
        assert Path.cwd() == tmp_path
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    place = Path("/proc/self/cwd").readlink() if Path("/proc/self/cwd").exists() else None
    with folders.somewhere():
        assert Path.cwd() == Path(folders.__file__).resolve().parent
    with pytest.raises(FileNotFoundError):
        Path.cwd()
    assert place is None or Path("/proc/self/cwd").readlink() == place
