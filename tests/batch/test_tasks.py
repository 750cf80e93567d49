"""Which clouds words name, and where each goes."""

import io
from pathlib import Path

import pytest

from tiskel.batch.tasks import find_tasks
from tiskel.errors import TiskelError


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("b.ply", "a.xyz.gz", "deep/er/c.PLY", "deep/a.xyz", ".hidden.ply", "notes.md", "out/a/skeleton.ply"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def names(*words: str, shard: tuple[int, int] = (1, 1)) -> list[str]:
    return [task.name for task in find_tasks(words, Path("out"), shard)]


def test_a_folder_stands_for_its_clouds_but_not_for_its_results(folder: Path) -> None:
    assert names(".") == ["a", "b", "deep/a", "deep/er/c"]


def test_files_patterns_and_lists(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "list").write_text(f"# a comment\n\nb.ply\n{folder}/deep/a.xyz\tdeep/a.1\n")
    assert names("b.ply", "./b.ply", f"{folder}/b.ply") == ["b"]
    assert names("deep/**/*.PLY") == ["c"]
    assert names("@list") == ["b", "deep/a.1"]
    monkeypatch.setattr("sys.stdin", io.StringIO("b.ply\nmissing.ply\n"))
    assert names("-") == ["b", "missing"]  # which fails when it is read, and costs no other


def test_files_that_differ_by_their_kind_alone_keep_it(folder: Path) -> None:
    (folder / "b.xyz").touch()
    assert names(".") == ["a", "b.ply", "b.xyz", "deep/a", "deep/er/c"]


def test_shards_are_disjoint_and_together_the_whole(folder: Path) -> None:
    parts = [names(".", shard=(i, 3)) for i in (1, 2, 3)]
    assert sorted(name for part in parts for name in part) == names(".")


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("no.ply",), "no file"),
        (("no*.ply",), "no file fits"),
        (("@no",), "cannot read the list"),
        (("empty",), "holds no cloud"),
        (("deep/a.xyz", "a.xyz.gz"), "would both go to a"),
        (("@climber",), "cannot be the name"),
        (("@nested",), "into the sub-folder"),
    ],
)
def test_what_cannot_be_is_refused_with_a_reason(folder: Path, words: tuple[str, ...], complaint: str) -> None:
    (folder / "empty").mkdir()
    (folder / "same").mkdir()
    (folder / "climber").write_text("b.ply\t../b\n")
    (folder / "nested").write_text("b.ply\tb\na.xyz.gz\tb/a\n")
    if words == ("deep/a.xyz", "a.xyz.gz"):
        (folder / "same" / "a.xyz").touch()
        words = ("deep/a.xyz", "same/a.xyz")
        complaint = "would both go to a.xyz"
    with pytest.raises(TiskelError, match=complaint):
        names(*words)
