"""Manifest and leases: lines that cannot be torn apart, one owner at a time, and heirs of the dead."""

import contextlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tiskel.batch.leases import Leases
from tiskel.batch.manifest import Manifest, locked
from tiskel.batch.owner import Owner, machine, myself, started


def test_the_last_line_of_a_cloud_counts_and_a_torn_one_does_not(tmp_path: Path) -> None:
    path = tmp_path / "m"
    manifest = Manifest(path)
    manifest.append({"name": "a", "n": 1})
    manifest.append({"name": "a", "n": 2})
    with path.open("a") as file:
        file.write('{"name": "b", "n"')  # a write that a full disk cut short
    reader = Manifest(path)
    reader.refresh()
    assert reader.records() == [{"name": "a", "n": 2}]
    manifest.append({"name": "c", "n": 3})
    reader.refresh()
    assert [record["name"] for record in reader.records()] == ["a", "c"]
    record, place = reader.last("c") or ({}, 0)
    assert json.loads(path.read_bytes()[place:]) == record


def test_processes_write_lines_at_once_and_none_is_mixed_up(tmp_path: Path) -> None:
    code = (
        f"import sys; sys.path[:] = {sys.path!r}\n"
        "from pathlib import Path; from tiskel.batch.manifest import Manifest\n"
        "manifest = Manifest(Path(sys.argv[1]))\n"
        "for i in range(100): manifest.append({'name': f'{sys.argv[2]} {i}', 'x': 'y' * 5000})\n"
    )
    processes = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path / "m"), str(i)]) for i in range(3)]
    assert [process.wait(60) for process in processes] == [0, 0, 0]
    manifest = Manifest(tmp_path / "m")
    manifest.refresh()
    assert len(manifest.records()) == 300
    assert all(len(json.loads(line)["x"]) == 5000 for line in (tmp_path / "m").read_text().splitlines())


def leases(folder: Path, seconds: float = 60.0) -> Leases:
    return Leases(folder / "leases", folder / "guard", seconds)


def other(folder: Path, **parts: object) -> Leases:
    """Return the leases as another process sees them."""
    found = leases(folder, 1.0)
    found.me = Owner(**{**myself().as_dict(), "token": "other", **parts})
    return found


def test_a_lease_has_one_owner_at_a_time(tmp_path: Path) -> None:
    mine, theirs = leases(tmp_path), other(tmp_path)
    assert mine.take("a")
    assert not mine.take("a")
    assert not theirs.take("a")
    theirs.release("a")
    assert mine.mine("a")
    mine.release("a")
    assert theirs.take("a")


def test_the_lease_of_a_dead_process_of_this_machine_is_taken_over_at_once(tmp_path: Path) -> None:
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    theirs = other(tmp_path, pid=dead.pid, start=1)
    assert theirs.take("a")
    mine = leases(tmp_path)
    assert mine.take("a")
    assert not theirs.mine("a")


def test_a_process_number_that_was_given_out_again_is_another_process(tmp_path: Path) -> None:
    theirs = other(tmp_path, pid=os.getpid(), start=started(os.getpid()) - 1)
    assert theirs.take("a")
    assert leases(tmp_path).take("a")


def test_the_lease_of_another_machine_is_taken_over_when_nobody_touches_it(tmp_path: Path) -> None:
    theirs = other(tmp_path, machine="elsewhere", pid=1, start=1)
    assert theirs.take("a")
    mine = leases(tmp_path, 1.0)
    time.sleep(2.0)  # twice the time of a lease, through which its owner touches it
    assert not mine.take("a")
    theirs._over.set()  # the machine loses its power
    deadline = time.monotonic() + 30.0
    while not mine.take("a"):
        assert time.monotonic() < deadline
        time.sleep(0.1)
    assert mine.mine("a")


def test_of_many_heirs_one_inherits(tmp_path: Path) -> None:
    assert other(tmp_path, pid=os.getpid(), start=1).take("a")
    code = (
        f"import sys; sys.path[:] = {sys.path!r}\n"
        "from pathlib import Path; from tiskel.batch.leases import Leases\n"
        "folder = Path(sys.argv[1]); leases = Leases(folder / 'leases', folder / 'guard', 60.0)\n"
        "sys.stdin.readline(); print(leases.take('a'), flush=True); sys.stdin.readline()\n"
    )
    heirs = [
        subprocess.Popen(
            [sys.executable, "-c", code, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        for _ in range(4)
    ]
    for heir in heirs:
        assert heir.stdin is not None
        heir.stdin.write("\n")
        heir.stdin.flush()
    told = [heir.stdout.readline().strip() for heir in heirs if heir.stdout is not None]
    for heir in heirs:
        heir.communicate("\n", timeout=30)
    assert sorted(told) == ["False", "False", "False", "True"]


def test_the_dead_are_swept_up_and_the_living_left_alone(tmp_path: Path) -> None:
    assert other(tmp_path, pid=os.getpid(), start=1).take("dead")
    mine = leases(tmp_path)
    assert mine.take("mine")
    mine.sweep()
    assert [path.stem for path in (tmp_path / "leases").glob("*.lease")] == ["mine"]
    mine.release("mine")
    mine.close()
    assert not (tmp_path / "leases").exists()


@pytest.mark.skipif(not machine(), reason="the system does not say which processes live")
def test_a_process_knows_itself() -> None:
    assert not myself().gone()


def test_the_folder_stays_while_another_is_at_a_cloud_and_goes_with_what_the_killed_left(tmp_path: Path) -> None:
    mine, theirs = leases(tmp_path), other(tmp_path)
    assert theirs.take("a")
    left = tmp_path / "leases" / "b.token.1"  # of who was killed while writing a lease
    left.touch()
    mine.close()
    assert theirs.mine("a")
    assert left.exists()
    theirs.release("a")
    theirs.close()
    assert not (tmp_path / "leases").exists()


def test_a_lease_that_comes_while_the_folder_is_being_cleared_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine, theirs = leases(tmp_path), other(tmp_path)
    monkeypatch.setattr(
        "tiskel.batch.leases.any", lambda leases: bool(list(leases)) or not theirs.take("a"), raising=False
    )
    mine.close()
    assert theirs.mine("a")
    theirs._over.set()


def test_a_file_system_without_links_has_leases_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*paths: object) -> None:
        raise PermissionError("links are not supported")

    monkeypatch.setattr("tiskel.batch.leases.os.link", refuse)
    mine, theirs = leases(tmp_path), other(tmp_path)
    assert mine.take("a")
    assert not theirs.take("a")
    assert mine.mine("a")
    mine.release("a")
    assert theirs.take("a")


def test_a_lease_that_was_never_written_to_its_end_is_respected_while_it_is_young(tmp_path: Path) -> None:
    mine = leases(tmp_path)
    half = tmp_path / "leases" / "a.lease"
    half.parent.mkdir()
    half.write_text('{"token": ')
    assert not mine.take("a")
    old = time.time() - 120
    os.utime(half, (old, old))
    assert mine.take("a")
    assert mine.mine("a")


def test_who_waited_for_the_lock_looks_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another heir had it, and inherited."""
    assert other(tmp_path, pid=os.getpid(), start=1).take("a")
    mine, heir = leases(tmp_path), other(tmp_path, token="heir")

    @contextlib.contextmanager
    def late(path: Path) -> Iterator[int]:
        with monkeypatch.context() as plain:
            plain.setattr("tiskel.batch.leases.locked", locked)
            assert heir.take("a")
        with locked(path) as handle:
            yield handle

    monkeypatch.setattr("tiskel.batch.leases.locked", late)
    assert not mine.take("a")
    assert heir.mine("a")


def test_a_lease_that_is_given_back_while_we_look_is_not_of_the_dead(tmp_path: Path) -> None:
    elsewhere = Owner("x", "elsewhere", "there", 1, 1)
    assert not leases(tmp_path)._stale("gone", elsewhere)
