"""Raw results that are kept between runs, by settings and by the code that makes them; processes make what is missing.

A row asks for what its works give for its settings. What is not there yet is wanted: rows are asked again when it has
been made, in processes of one thread each. A result counts as long as the modules that its work's module reaches by
imports, library or benchmark, say the same; comments and docstrings aside.
"""

import ast
import hashlib
import inspect
import json
import os
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from threading import Thread
from typing import Any

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
ONE = dict.fromkeys(("TISKEL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
OUTSIDE = {"viewer", "pictures", "io", "messages", "wording", "pipeline"}  # read, show and say: move no number
GLANCE = 2.0  # seconds between looks at whether the process that started this one is there
Json = dict[str, Any]
Work = Callable[..., Json]
Job = tuple[Work, Json]


class Wanted(Exception):
    """Raised where raw results are not there yet; holds what makes them."""

    def __init__(self, jobs: Sequence[Job]) -> None:
        super().__init__(f"{len(jobs)} raw results are to be made")
        self.jobs = jobs


class Failed(Exception):
    """Raised where a work ended with an error, with its words."""


@dataclass
class Store:
    """A folder of raw results; remembers what was used of it, with the seconds each took."""

    folder: Path
    errors: dict[str, str] = field(default_factory=dict)
    used: dict[str, Json] = field(default_factory=dict)  #: by file: elapsed and processor seconds

    def many(self, work: Work, settings: Sequence[Json]) -> list[Json]:
        """Return what a work gives for each of these settings; raise Wanted where some are not there."""
        missing = [(work, one) for one in settings if not self.place(work, one).exists()]
        for job in missing:
            if error := self.errors.get(self.place(*job).name):
                raise Failed(error)
        if missing:
            raise Wanted(missing)
        return [self._read(self.place(work, one)) for one in settings]

    def place(self, work: Work, settings: Json) -> Path:
        said = json.dumps(settings, sort_keys=True, default=content)
        return self.folder / f"{work.__name__}-{hashed(said)}-{version(work)}.json"

    def make(self, jobs: Sequence[Job], processes: int) -> None:
        """Make raw results, so many at a time; what is interrupted is made by the next run."""
        wanted = {self.place(*job).name: job for job in jobs}
        self.folder.mkdir(parents=True, exist_ok=True)
        os.environ.update(ONE)
        context = get_context("spawn")
        with ProcessPoolExecutor(processes, context, initializer=follow, initargs=(os.getpid(),)) as pool:
            made = {pool.submit(written, *job, self.folder / name): name for name, job in wanted.items()}
            try:
                for number, done in enumerate(as_completed(made), 1):
                    self._tell(done, made[done], wanted[made[done]], f"{number}/{len(made)}")
            except KeyboardInterrupt:
                pool.shutdown(cancel_futures=True)
                raise

    def _tell(self, done: "Future[float]", name: str, job: Job, count: str) -> None:
        error = done.exception()
        if error is not None:
            self.errors[name] = f"{type(error).__name__}: {error}"
        said = ", ".join(str(value) for value in job[1].values() if not isinstance(value, Path))
        end = f"{done.result():.1f} s" if error is None else self.errors[name]
        print(f"    {count} {job[0].__name__}: {said}: {end}", file=sys.stderr, flush=True)

    def _read(self, place: Path) -> Json:
        record = json.loads(place.read_text())
        self.used[place.name] = {key: record[key] for key in ("elapsed", "processor")}
        return dict(record["result"])


def follow(parent: int) -> None:
    """End this process soon after the one that started it, however that ended."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(GLANCE)
        os._exit(1)

    Thread(target=watch, daemon=True).start()


def written(work: Work, settings: Json, place: Path) -> float:
    """Write what a work gives, with its seconds, and return the elapsed ones; runs in a process of its own."""
    start, busy = time.perf_counter(), time.process_time()
    result = work(**settings)
    record = {"elapsed": time.perf_counter() - start, "processor": time.process_time() - busy, "result": result}
    partial = place.with_suffix(f".{os.getpid()}")
    partial.write_text(json.dumps(record))
    partial.replace(place)
    return float(record["elapsed"])


@lru_cache
def content(path: Path) -> str:
    """Return what stands for a file wherever it lies, its name and a hash of it; for a folder its name."""
    return f"{path.name} {hashlib.sha256(path.read_bytes()).hexdigest()}" if path.is_file() else path.name


def hashed(*texts: str) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:12]


def version(work: Work) -> str:
    """Return a hash of the code that a work's module reaches."""
    return version_of(Path(inspect.getfile(work)).resolve())


@lru_cache
def version_of(module: Path) -> str:
    reached, waiting = set(), [module]
    while waiting:
        path = waiting.pop()
        if path not in reached:
            reached.add(path)
            waiting += imported(path)
    return hashed(*(said(path) for path in sorted(reached)))


@lru_cache
def said(path: Path) -> str:
    """Return what a module says: its syntax tree without docstrings."""
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node) is not None:
            node.body = node.body[1:]
    return ast.dump(tree)


@lru_cache
def imports(path: Path) -> dict[str, tuple[str, str]]:
    """Return by its name here what a module imports, wherever it does: the module and the name there."""
    found = {}
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found |= {alias.asname or alias.name: (node.module, alias.name) for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {alias.name: (alias.name, "") for alias in node.names}
    return found


@lru_cache
def imported(path: Path) -> list[Path]:
    """Return the files of library and benchmark that a module imports from."""
    homes = (home(module, name) for module, name in imports(path).values())
    return [place for place in homes if place is not None and not OUTSIDE & {*place.parts, place.stem}]


def home(module: str, name: str) -> Path | None:
    """Return the file where a name is defined, through packages that hand it on; None outside library and benchmark."""
    base = (ROOT if module.split(".", maxsplit=1)[0] == "tiskel" else HERE) / module.replace(".", "/")
    if base.with_suffix(".py").exists():
        return base.with_suffix(".py")
    if not (base / "__init__.py").exists():
        return None
    if name and ((base / name).is_dir() or (base / f"{name}.py").exists()):
        return home(f"{module}.{name}", "")
    handed = imports(base / "__init__.py").get(name)
    return base / "__init__.py" if handed is None else home(*handed)
