"""Which clouds there are: folders, patterns and lists, and the name of each one's sub-folder."""

import glob
import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath

from tiskel.errors import TiskelError
from tiskel.io.formats import SUFFIXES

LIST, COMMENT, TAB = "@", "#", "\t"
PACKED = ".gz"
OWN = {"manifest.jsonl", "summary.csv", "failed.txt", ".batch"}  # names in the folder of the output


@dataclass(frozen=True)
class Task:
    """One cloud.

    Attributes
    ----------
    name : str
        Of its sub-folder, with slashes where it lies in folders of its own.
    path : str
        Of its file, absolute.
    """

    name: str
    path: str


def find_tasks(sources: Sequence[str], output: Path, shard: tuple[int, int] = (1, 1)) -> list[Task]:
    """Return the clouds that words name, in the order of their names.

    A folder stands for all files in and below it that tiskel reads, hidden ones and the output left out. A pattern is
    one where no such file exists; ``@FILE`` is a list, a path a line, ``-`` a list on standard input. Lines that begin
    with # are skipped; behind a tab there may be the name of the sub-folder.

    Parameters
    ----------
    sources : sequence of str
    output : Path
        The folder of the results.
    shard : (int, int)
        Part I of N, from 1 to N: every N-th cloud of the same list.

    Raises
    ------
    TiskelError
        Where a word names nothing, or two clouds would share a sub-folder.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel.batch import find_tasks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     for name in ("b.ply", "a.ply", "a.xyz", "c/d.ply"):
    ...         Path(folder, name).parent.mkdir(exist_ok=True)
    ...         Path(folder, name).touch()
    ...     [task.name for task in find_tasks([folder], Path(folder, "out"))]
    ['a.ply', 'a.xyz', 'b', 'c/d']
    """
    files = {path: name for word in sources for path, name in _files(word, output)}
    short = {path: stem(name) for path, name in files.items()}
    counts = Counter(short.values())
    tasks = [Task(name if counts[short[path]] > 1 else short[path], path) for path, name in files.items()]
    _check(tasks)
    part, parts = shard
    return sorted(tasks, key=lambda task: task.name)[part - 1 :: parts]


def absolute(path: str | Path) -> Path:
    """Return a path from the root, without . and .., links as they are."""
    return Path(os.path.abspath(path))  # noqa: PTH100  # resolve() would follow links


def _files(word: str, output: Path) -> Iterator[tuple[str, str]]:
    """Yield the absolute path of every file that a word names, and its name, folders below the word included."""
    if word == "-":
        yield from _listed(sys.stdin.read().splitlines())
    elif word.startswith(LIST):
        try:
            lines = Path(word[1:]).read_text().splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise TiskelError(f"cannot read the list {word[1:]}: {error}") from None
        yield from _listed(lines)
    elif Path(word).is_dir():
        yield from _below(Path(word), output)
    elif Path(word).exists() or not glob.has_magic(word):
        if not Path(word).exists():
            raise TiskelError(f"no file {word}; check the path; a list of files is named as @FILE")
        yield str(absolute(word)), Path(word).name
    else:
        found = [path for path in sorted(glob.glob(word, recursive=True)) if Path(path).is_file()]  # noqa: PTH207
        if not found:
            raise TiskelError(f"no file fits {word}; check the pattern")
        yield from ((str(absolute(path)), Path(path).name) for path in found)


def _listed(lines: Iterable[str]) -> Iterator[tuple[str, str]]:
    for line in lines:
        if line.strip() and not line.startswith(COMMENT):
            path, _, name = line.partition(TAB)
            yield str(absolute(path)), name + "." if name else Path(path).name  # a full stop: nothing to cut off


def _below(folder: Path, output: Path) -> Iterator[tuple[str, str]]:
    beside, count = absolute(output), 0
    for root, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name[0] != "." and absolute(Path(root, name)) != beside)
        for name in sorted(names):
            if name[0] != "." and _plain(name).lower().endswith(SUFFIXES):
                count += 1
                path = Path(root, name)
                yield str(absolute(path)), path.relative_to(folder).as_posix()
    if not count:
        raise TiskelError(f"{folder} holds no cloud; files that end in {', '.join(SUFFIXES)} are read")


def _plain(name: str) -> str:
    return name[: -len(PACKED)] if name.lower().endswith(PACKED) else name


def stem(name: str) -> str:
    """Return a name without what says of which kind the file is."""
    return str(PurePath(_plain(name)).with_suffix("")) if not name.endswith(".") else name[:-1]


def _check(tasks: Sequence[Task]) -> None:
    """Raise where two clouds have one name, or one that is none for a folder, or lies inside another's."""
    by_name: dict[str, Task] = {}
    for task in tasks:
        parts = PurePath(task.name).parts
        if not parts or PurePath(task.name).is_absolute() or ".." in parts or parts[0] in OWN:
            raise TiskelError(f"{task.path}: {task.name!r} cannot be the name of a sub-folder; rename the file")
        if task.name in by_name:
            other = by_name[task.name].path
            raise TiskelError(
                f"{other} and {task.path} would both go to {task.name}; name the folder that holds both instead"
            )
        by_name[task.name] = task
    for task in tasks:
        for above in PurePath(task.name).parents:
            if str(above) in by_name:
                raise TiskelError(
                    f"{task.path} would go into the sub-folder of {by_name[str(above)].path}; rename one of them"
                )
