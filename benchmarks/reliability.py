"""How reliable reading is, counted anew: damaged files and files of reported trouble; writes docs/reliability.md.

    python benchmarks/reliability.py --cases 100000 --state out/fuzz --write
    python benchmarks/reliability.py --write  # without the fuzzer

Runs the fuzzer (tests/fuzz) until every reader has had so many cases, those of
earlier calls with the same --state included, and reads the files of TISKEL_CASES,
each in a process of its own. What benchmarks/kills.py, benchmarks/mutation.py and
`make coverage` left is told as it is; parts that nothing is left of stay as the page has them.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from fuzz.originals import originals
from mutation_page import rooms

from reference.forked import outcomes

CASES = Path(os.environ.get("TISKEL_CASES", ROOT / ".." / "shared" / "cases"))
PAGE = ROOT / "docs" / "reliability.md"
HEAD = """# How reliable reading is

Written by `python benchmarks/reliability.py --cases N --state DIR --write`; rerun it after changes to a reader."""
DAMAGED = """## Damaged files

Sound files with one to four changes each: bits, numbers, lines, lengths, pieces of other files (`tests/fuzz`). A fault
is a crash, more than 2 s of the processor, more memory than ten times the file and 200 MB, any exception but
`TiskelError`, a warning of NumPy, or a message of several lines or more than 300 characters.

| reader | cases | faults |
|---|---|---|
"""


def kept(heading: str) -> str:
    """Return a part of the page as it is."""
    return "## " + next(part for part in PAGE.read_text().split("\n\n## ") if part.startswith(heading))


def damaged(state: Path, cases: int) -> str:
    """Run the fuzzer and return the table of readers."""
    rows = fuzzed(state, cases)
    all_cases, faults = (sum(int(row.split("|")[at]) for row in rows) for at in (2, 3))
    return DAMAGED + "\n".join([*rows, f"| all | {all_cases} | {faults} |"])


def fuzzed(state: Path, cases: int) -> list[str]:
    """Run the fuzzer and return a row for each reader."""
    rows = []
    for name in originals():
        words = [
            sys.executable,
            ROOT / "tests" / "fuzz" / "run.py",
            "--state",
            state,
            "--cases",
            cases,
            "--readers",
            name,
        ]
        subprocess.run(list(map(str, words)), check=False)
        found = json.loads((state / f"{name}.json").read_text())
        rows.append(f"| {name} | {found['cases']} | {len(found['faults'])} |")
    return rows


def reported() -> list[str]:
    """Return a row for each folder of files of reported trouble."""
    rows = []
    for folder in ("formats", "broken"):
        files = sorted((CASES / folder).iterdir()) if (CASES / folder).is_dir() else []
        with tempfile.TemporaryDirectory() as place:
            runs = outcomes([["info", str(path)] for path in files], Path(place))
        read, refused = (sum(run["code"] == code for run in runs) for code in (0, 1))
        faults = len(runs) - read - refused
        most = max((run["megabytes"] for run in runs), default=0)
        slowest = max((run["seconds"] for run in runs), default=0)
        rows.append(f"| {folder} | {len(runs)} | {read} | {refused} | {faults} | {most:.0f} | {slowest:.1f} |")
    return rows


def killed(state: Path) -> str:
    """Return the table of runs that were killed, as benchmarks/kills.py left it."""
    found = json.loads(state.read_text())
    rows = [
        f"| `tiskel {name}` | {one['kills']} | {', '.join(f'{end} x{n}' for end, n in one['ends'].items())} | "
        f"{len(one['faults'])} |"
        for name, one in found.items()
    ]
    return "\n".join([KILLED, *rows])


def covered(report: Path) -> str:
    """Return the table of rooms, of how many statements and branches the tests run, as `make coverage` left it."""
    files = json.loads(report.read_text())["files"]
    rooms: dict[str, Counter[str]] = defaultdict(Counter)
    for path, one in files.items():
        words = Path(path).parts
        room = words[1] if words[0] == "tiskel" and len(words) > 2 else words[0]
        rooms[room].update({key: one["summary"][key] for key in (*STATEMENTS, *BRANCHES)})
    rooms["all"] = sum(rooms.values(), Counter())
    rows = [
        f"| {room} | {c[STATEMENTS[0]]} | {_share(c, *STATEMENTS)} | {c[BRANCHES[0]]} | {_share(c, *BRANCHES)} |"
        for room, c in rooms.items()
    ]
    return "\n".join([COVERED, *rows])


def _share(counts: "Counter[str]", whole: str, part: str) -> str:
    return f"{100 * counts[part] / counts[whole]:.1f}" if counts[whole] else "-"


STATEMENTS, BRANCHES = ("num_statements", "covered_lines"), ("num_branches", "covered_branches")
COVERED = """## Run by the tests

Statements, and ways out of those that have several, in percent of each room (`make coverage`); commands run in
processes of their own and count. Kernels are compiled and not counted: tests compare each with a plain reference.

| room | statements | run | branches | run |
|---|---|---|---|---|"""
REPORTED = """## Files of reported trouble

Each in a process of its own: a value (exit code 0) or one line (1).

| folder | files | read | refused | faults | MB at most | s at most |
|---|---|---|---|---|---|---|
"""
ENVIRONMENT = """## The environment

Closed streams, full disks, folders that are gone, limits of memory, odd names, links, endless input, killed
runs: `tests/cli/test_environment.py` and `tests/cli/test_surroundings.py`, one test each.
"""
MUTATED = """## Changed on purpose

Mutants of mutmut, one change in one function each, in the order of their hash, so that a part of them is a fair sample
(`benchmarks/mutation.py`); [the survivors](../benchmarks/mutation.md) are listed, with why they survive.

"""
KILLED = """## Killed at random moments

SIGKILL, SIGTERM and SIGINT at moments that are uniform over the time of an undisturbed run of small clouds
(`python benchmarks/kills.py --count 200`). After every kill each file under its own name is whole, no process lives on;
the next run finds its way, ends with 0, writes the same bytes as an undisturbed one and leaves nothing that was being
written. Ends are signal and exit code, "done" where the command was faster than the signal.

| command | kills | ends | faults |
|---|---|---|---|"""


def main() -> None:
    """Count, and write or print the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, help="of every reader; not given: the fuzzer does not run")
    parser.add_argument("--state", type=Path, default=Path("out/fuzz"))
    parser.add_argument("--kills", type=Path, default=Path("out/kills.json"), help="what benchmarks/kills.py counted")
    parser.add_argument("--coverage", type=Path, default=Path("out/coverage.json"), help="what `make coverage` wrote")
    parser.add_argument("--mutants", type=Path, default=Path("out/mutation"), help="what benchmarks/mutation.py found")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    parts = [
        kept("Damaged files") if given.cases is None else damaged(given.state, given.cases),
        REPORTED + "\n".join(reported()) if CASES.is_dir() else kept("Files of reported trouble"),
        killed(given.kills) if given.kills.exists() else kept("Killed at random moments"),
        covered(given.coverage) if given.coverage.exists() else kept("Run by the tests"),
        MUTATED + rooms(given.mutants) if given.mutants.exists() else kept("Changed on purpose"),
    ]
    page = "\n\n".join([HEAD, *parts, ENVIRONMENT])
    if given.write:
        PAGE.write_text(page)
    else:
        print(page)


if __name__ == "__main__":
    main()
