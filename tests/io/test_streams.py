"""Bytes in and out: pipes and devices, files that are whole or absent, and what is said where neither can be."""

import errno
import mmap
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from tiskel import TiskelError
from tiskel.io import streams
from tiskel.io.streams import check_target, mapped, read_bytes, write_bytes


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_named_pipe_takes_bytes_as_they_come(tmp_path: Path) -> None:
    """It is no file that another could be put in the place of."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    try:
        check_target(pipe)
        write_bytes(pipe, b"abc")
        assert os.read(reader, 10) == b"abc"
    finally:
        os.close(reader)
    assert [file.name for file in tmp_path.iterdir()] == ["pipe"]


@pytest.mark.skipif(not Path("/dev/fd").is_dir(), reason="no /dev/fd")
def test_a_pipe_without_a_name_takes_them_too() -> None:
    """As shells name what they start: -o >(gzip > a.gz), -o /dev/stdout."""
    reader, writer = os.pipe()
    try:
        write_bytes(f"/dev/fd/{writer}", b"abc")
        assert os.read(reader, 10) == b"abc"
    finally:
        os.close(reader)
        os.close(writer)


@pytest.mark.skipif(os.name != "posix", reason="links and permissions of another kind")
def test_what_a_link_leads_to_is_replaced_and_the_link_stays(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "a").chmod(0o640)
    (tmp_path / "link").symlink_to("a")
    write_bytes(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "a").read_bytes() == b"new"
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_device_is_told() -> None:
    with pytest.raises(TiskelError, match="cannot write /dev/full: No space left on device"):
        write_bytes("/dev/full", b"abc")


def test_a_write_that_fails_at_the_last_leaves_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EDQUOT, "Disk quota exceeded")

    (tmp_path / "a").write_bytes(b"old")
    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(TiskelError, match="a: Disk quota exceeded; check the folder, its space"):
        write_bytes(tmp_path / "a", b"new")
    assert [(file.name, file.read_bytes()) for file in tmp_path.iterdir()] == [("a", b"old")]


def test_targets_that_take_nothing_are_told_before_the_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    check_target("-")
    check_target(tmp_path / "a")
    for target, said in (
        (tmp_path, "is a directory; name a file in it"),
        (tmp_path / "none" / "a", "there is no folder"),
        (tmp_path / "a\0b", "null (byte|character).*; name another file"),
    ):
        with pytest.raises(TiskelError, match=said):
            check_target(target)
    monkeypatch.setattr(os, "statvfs", lambda _: SimpleNamespace(f_blocks=10, f_bavail=0), raising=False)
    with pytest.raises(TiskelError, match="no space is left in"):
        check_target(tmp_path / "a")
    monkeypatch.setattr(os, "statvfs", lambda _: SimpleNamespace(f_blocks=0, f_bavail=0))  # it counts no blocks
    check_target(tmp_path / "a")
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(TiskelError, match="takes no files; check its permissions"):
        check_target(tmp_path / "a")


def test_streams_that_are_closed_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", None)
        with pytest.raises(TiskelError, match="standard output is closed; name a file with -o"):
            write_bytes("-", b"abc")
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(TiskelError, match="standard input is closed; name a file"):
        read_bytes("-")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_standard_output_that_is_full_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with Path("/dev/full").open("w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        with pytest.raises(TiskelError, match="cannot write standard output: No space left on device"):
            write_bytes("-", b"abc")
        monkeypatch.undo()
        with Path("/dev/null").open("wb") as null:
            os.dup2(null.fileno(), full.fileno())  # what is left in its memory goes without an error


def test_a_file_that_cannot_be_mapped_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_bytes(b"abc")
    assert isinstance(mapped(tmp_path / "a"), mmap.mmap)

    def refuse(*_: object, **__: object) -> None:
        raise OSError(errno.ENODEV, "No such device")

    monkeypatch.setattr(mmap, "mmap", refuse)
    assert mapped(tmp_path / "a") == b"abc"


def test_names_that_no_file_can_have_are_told() -> None:
    with pytest.raises(TiskelError, match="cannot be the name of a file"):
        read_bytes("a\0b")
    with pytest.raises(TiskelError, match=r"cannot read aaa.*: File name too long"):
        read_bytes("a" * 5000)


def test_a_device_that_never_ends_is_left_sooner_than_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streams, "DEVICE_BYTES", 3 << 20)
    with pytest.raises(TiskelError, match="gives more than 3 MB and is no file on disk"):
        read_bytes("/dev/zero")
