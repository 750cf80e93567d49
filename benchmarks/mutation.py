"""Change the code in one place after the other, and see whether a test notices: what survives is untested or the same.

    pip install mutmut==3.8.1
    python benchmarks/mutation.py --state out/mutation --jobs 2            # all, resumable
    python benchmarks/mutation.py --state out/mutation --jobs 2 --every 8  # every eighth mutant
    python benchmarks/mutation.py --state out/mutation --write             # benchmarks/mutation.md from what was run

mutmut makes the mutants of io, metrics and rolling/equations: every function becomes a switch between itself and its
mutants. Here they are run: one process collects the tests once, a first fork of it learns which functions each test
calls and how long it takes, and every mutant is a fork that runs the tests of its function until one fails: those first
that are fast and that noticed other mutants of the function. Mutants are taken in the order of their hash, so that a
part of them is a fair sample.
"""

import argparse
import hashlib
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import defaultdict
from functools import partial
from pathlib import Path
from typing import Any

from mutation_page import SWITCH, page, told_of

ROOT = Path(__file__).parents[1]
MUTATED = ("tiskel/io/**/*.py", "tiskel/metrics/*.py", "tiskel/rolling/equations.py")
TESTS = (
    "tests/io",
    "tests/metrics",
    "tests/rolling",
    "tests/one_call",
    "tests/slicing",
    "tests/surfaces",
    "tests/kernels/test_coverage.py",
    "tests/kernels/test_hulls.py",
)
SLACK, FACTOR = 10, 10  #: seconds of the processor that a mutant may take: so many, and so often what its tests take
WAITING = 10  #: times as many seconds by the clock: one that waits for nothing is killed
LONGEST, BUDGET = 4.0, 8.0  #: seconds of the processor of a test that is still run, and of all of a mutant
MEMORY = 8 << 30  #: bytes of address space of a mutant: one that asks for all must not take the machine with it
PAGE = ROOT / "benchmarks" / "mutation.md"
WHY = (ROOT / "benchmarks" / "mutation_why.md").read_text()


def make_tree(tree: Path) -> dict[str, list[str]]:
    """Copy the project with the mutants in it; return the names of the mutants by function."""
    from mutmut.mutation.file_mutation import mutate_file_contents

    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    for name in listed.decode().split("\0"):
        if name:
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, tree / name, follow_symlinks=False)
    found: dict[str, list[str]] = defaultdict(list)
    for path in sorted(path for pattern in MUTATED for path in tree.glob(pattern)):
        made = mutate_file_contents(str(path), path.read_text())
        path.write_text(made.code)
        module = ".".join(path.relative_to(tree).with_suffix("").parts).removesuffix(".__init__")
        for name in made.mutant_names:
            found[f"{module}.{name.split(SWITCH)[0]}"].append(f"{module}.{name}")
    return found


class Plugin:
    """What pytest does in place of running the collected tests."""

    def __init__(self, state: Path, part: int, parts: int, every: int, only: str) -> None:
        self.state, self.part, self.parts, self.every, self.only = state, part, parts, every, only
        self.failed = False
        self.at = os.memfd_create("at")  # a mutant tells here which test it has come to
        self.calls: set[str] = set()  # of the test that runs
        self.prepared: dict[Path, set[str]] = defaultdict(set)  # by fixtures of a file, some of them once for all tests

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Note failures."""
        self.failed |= report.failed

    def pytest_runtest_call(self, item: Any) -> None:
        """Note what has been called before the test itself begins."""
        self.prepared[item.path] |= self.calls

    def pytest_runtestloop(self, session: Any) -> bool:
        """Learn what tests call, or run mutants."""
        import gc

        gc.freeze()
        learnt = self.state / "tests.json"
        if self.part < 0:
            if _forked(lambda: self._learn(session.items, learnt), 3600) != 0:
                raise SystemExit("the tests fail without any mutant, or take more than an hour")
            return True
        tests = json.loads(learnt.read_text())
        items = {item.nodeid: item for item in session.items}
        told = self.state / f"told.{self.part}.jsonl"
        done = {mutant for mutant, _, _ in told_of(self.state)}
        ran: dict[tuple[str, str], list[int]] = defaultdict(lambda: [0, 0])  # mutants of a function that a test saw
        for function, mutant in _shuffled(self.state, self.every, self.only)[self.part :: self.parts]:
            if mutant in done:
                continue
            chosen, seconds = [], 0.0
            for each, name in sorted(
                (one["seconds"], name) for name, one in tests.items() if name in items and function in one["calls"]
            ):
                if each <= LONGEST and seconds + each <= BUDGET:
                    chosen, seconds = [*chosen, items[name]], seconds + each
            chosen.sort(key=lambda item: _cost(tests[item.nodeid]["seconds"], *ran[function, item.nodeid]))
            limit = SLACK + FACTOR * math.ceil(seconds)
            begun = time.monotonic()
            self._comes_to(0)
            code = _forked(partial(self._mutant, chosen, mutant, limit), WAITING * limit) if chosen else None
            last = self._came_to() if chosen else -1
            for item in chosen[: last + 1]:
                ran[function, item.nodeid][0] += 1
            if chosen and code != 0:
                ran[function, chosen[last].nodeid][1] += 1
            with told.open("a") as file:
                file.write(json.dumps([mutant, _verdict(code), round(time.monotonic() - begun, 2)]) + "\n")
        return True

    def _learn(self, items: list[Any], learnt: Path) -> int:
        """Run all tests; write which functions each calls and how long it takes."""
        from mutmut.mutation import trampoline

        trampoline.record_trampoline_hit = lambda name, caller=None: self.calls.add(name)
        trampoline.set_mutant_under_test("stats")
        tests: dict[str, Any] = json.loads(learnt.read_text()) if learnt.exists() else {}
        items = [item for item in items if item.nodeid not in tests]
        for item, following in zip(items, [*items[1:], None], strict=True):
            self.calls.clear()
            self.failed, begun = False, sum(os.times()[:4])
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed:
                sys.stderr.write(f"{item.nodeid} fails, and is left out\n")
                continue
            tests[item.nodeid] = {"seconds": round(sum(os.times()[:4]) - begun, 3), "calls": sorted(self.calls)}
        for item in items:
            if item.nodeid in tests:
                tests[item.nodeid]["calls"] = sorted({*tests[item.nodeid]["calls"], *self.prepared[item.path]})
        learnt.write_text(json.dumps(tests))
        return 0

    def _mutant(self, items: list[Any], mutant: str, limit: int) -> int:
        import resource

        from mutmut.mutation import trampoline

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
        trampoline.set_mutant_under_test(mutant)
        for at, (item, following) in enumerate(zip(items, [*items[1:], None], strict=True)):
            self._comes_to(at)
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed:
                return 1
        return 0

    def _comes_to(self, at: int) -> None:
        os.pwrite(self.at, b"%8d" % at, 0)

    def _came_to(self) -> int:
        """Return the place of the test that the last mutant ran last."""
        return int(os.pread(self.at, 8, 0))


def _cost(seconds: float, runs: int, noticed: int) -> float:
    """Return the seconds that a test takes for each mutant it notices; one that has seen none notices one in ten."""
    return max(seconds, 0.01) * (runs + 1) / (noticed + 0.1)


def _forked(work: Any, limit: float) -> int:
    """Call in a fork; return its exit code, or the negative signal; one past its time is killed."""
    child = os.fork()
    if child == 0:
        os.setpgid(0, 0)
        code = 1
        try:
            code = work()
        finally:
            os._exit(code)
    ends = time.monotonic() + limit
    while time.monotonic() < ends:
        gone, status = os.waitpid(child, os.WNOHANG)
        if gone:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.003)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return -signal.SIGALRM


def _verdict(code: int | None) -> str:
    if code is None:
        return "no test"
    return {0: "survived", 1: "killed", -signal.SIGALRM: "out of time", -signal.SIGKILL: "out of time"}.get(
        code, "died"
    )


def _shuffled(state: Path, every: int, only: str) -> list[tuple[str, str]]:
    """Return function and mutant of what is asked for, in the order of their hash."""
    found = json.loads((state / "mutants.json").read_text())
    pairs = [(function, name) for function, names in found.items() for name in names if only in function]
    pairs.sort(key=lambda pair: hashlib.sha256(pair[1].encode()).digest())
    return pairs[: -(-len(pairs) // every)]


def work(state: Path, part: int, parts: int, every: int, only: str) -> None:
    """Collect the tests in the tree, and hand over to the plugin."""
    import pytest

    tree = state / "tree"
    os.chdir(tree)
    sys.path[:0] = [str(tree), str(tree / "tests")]
    quiet = ["-q", "-p", "no:cacheprovider", "-o", "timeout=0", "-m", "not slow", "--no-header", "--tb=no"]
    pytest.main([*quiet, *TESTS], plugins=[Plugin(state, part, parts, every, only)])


def main() -> None:
    """Make the tree, learn, run in so many processes, and tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--state", type=Path, default=Path("out/mutation"))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--every", type=int, default=1, help="one mutant of so many")
    parser.add_argument("--only", default="", help="functions whose full names hold this, such as rolling.equations")
    parser.add_argument("--write", action="store_true", help="the page only, from what was run")
    parser.add_argument("--part", type=int, help=argparse.SUPPRESS)
    given = parser.parse_args()
    state = given.state.resolve()
    if given.part is not None:
        return work(state, given.part, given.jobs, given.every, given.only)
    if not given.write:
        if not (state / "mutants.json").exists():
            found = make_tree(state / "tree")
            (state / "mutants.json").write_text(json.dumps(found))
        parts = range(given.jobs) if (state / "tests.json").exists() else range(-1, given.jobs)
        said = {"--state": state, "--jobs": given.jobs, "--every": given.every, "--only": given.only}
        words = [sys.executable, __file__, *(str(word) for pair in said.items() for word in pair)]
        if -1 in parts:
            subprocess.run([*words, "--part", "-1"], check=True)
        running = [subprocess.Popen([*words, "--part", str(part)]) for part in range(given.jobs)]
        for one in running:
            one.wait()
    PAGE.write_text(page(state, WHY))


if __name__ == "__main__":
    main()
