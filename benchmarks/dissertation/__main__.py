"""The dissertation, claim by claim: every figure, table and equation of chapters 3 to 5 with a verdict.

    make dissertation                                   # or: python benchmarks/dissertation
    python benchmarks/dissertation --only "Fig 3.5"     # one row; --chapter 3 one chapter
    python benchmarks/dissertation --data FOLDER        # scans in place of generated clouds, under the published names
    python benchmarks/dissertation --clouds 1024:24     # fewer of them
    python benchmarks/dissertation --quick --out DIR    # does it run?

Writes docs/dissertation.md and the figures in docs/dissertation; of a part of the rows, out/dissertation.md and the
figures beside it. Raw results are kept in out/raw, by settings and by the sources that make them: what was interrupted
goes on, what did not change is not run again. Two processes of one thread each make them (--processes).
"""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import contraction
import measures
import rolling
from core import QUICK, UNTESTED, Bench, Found, Row, Sizes
from kept import ROOT, Failed, Job, Store, Wanted
from page import Spent, page

from tiskel import TiskelError

CHAPTERS = {
    "Chapter 3: contraction": contraction.ROWS,
    "Chapter 4: measures": measures.ROWS,
    "Chapter 5: rolling contact": rolling.ROWS,
}
NOT_RUN = Found("", UNTESTED, "this row was not run when the page was made; --only runs it")


def main() -> None:
    """Make what the rows asked for stand on; write the page with them and with those whose results are there."""
    chosen = arguments()
    part = chosen.only or chosen.chapter or chosen.quick
    out = chosen.out or ROOT / ("out" if part else "docs")
    bench = Bench(sizes(chosen), out / "dissertation", Store(chosen.kept), chosen.reference, chosen.data)
    rows = [(chapter, row) for chapter, some in CHAPTERS.items() for row in some]
    asked = [
        row for chapter, row in rows
        if (chosen.chapter is None or f"Chapter {chosen.chapter}:" in chapter)
        and (chosen.only is None or chosen.only.lower() in row.key.lower())
    ]  # fmt: skip
    start, desk = time.perf_counter(), Desk(bench)
    while wanted := [job for chapter, row in rows if row in asked for job in desk.lacking(chapter, row)]:
        print(f"{len(wanted)} raw results are to be made", file=sys.stderr, flush=True)
        bench.store.make(wanted, chosen.processes)
    for chapter, row in rows:
        desk.lacking(chapter, row)
    print(f"{time.perf_counter() - start:.0f} s in all", file=sys.stderr)
    out.mkdir(parents=True, exist_ok=True)
    every = [(chapter, row, desk.found.get(row.key, NOT_RUN)) for chapter, row in rows]
    (out / "dissertation.md").write_text(page(every, bench, desk.spent))


@dataclass
class Desk:
    """Rows that are settled, and by chapter what their raw results took."""

    bench: Bench
    found: dict[str, Found] = field(default_factory=dict)
    spent: Spent = field(default_factory=dict)
    counted: set[str] = field(default_factory=set)

    def lacking(self, chapter: str, row: Row) -> Sequence[Job]:
        """Settle a row, or return what has to be made before."""
        if row.key in self.found:
            return ()
        try:
            found = row.find(self.bench)
        except Wanted as wanted:
            return wanted.jobs
        except (Failed, TiskelError) as error:
            found = Found("", UNTESTED, f"a run ended with an error: {error}")
        self.found[row.key] = found
        print(f"{row.number} | {found.ours} | {found.verdict}", flush=True)
        self._count(chapter)
        return ()

    def _count(self, chapter: str) -> None:
        new = {name: took for name, took in self.bench.store.used.items() if name not in self.counted}
        self.counted |= set(new)
        busy, elapsed = self.spent.get(chapter, (0.0, 0.0))
        self.spent[chapter] = (
            busy + sum(took["processor"] for took in new.values()),
            elapsed + sum(took["elapsed"] for took in new.values()),
        )  # fmt: skip


def sizes(chosen: argparse.Namespace) -> Sizes:
    """Return how much is run."""
    found = QUICK if chosen.quick else Sizes()
    if chosen.clouds:
        pairs = (pair.split(":") for pair in chosen.clouds)
        found = replace(found, clouds={int(points): int(count) for points, count in pairs})
    if chosen.shapes:
        found = replace(found, shapes=chosen.shapes)
    return replace(found, density=tuple(chosen.density)) if chosen.density else found


def arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    reference = os.environ.get("TISKEL_REFERENCE", ROOT / ".." / "shared" / "reference")
    parser = argparse.ArgumentParser(
        prog="benchmarks/dissertation", description="See benchmarks/dissertation/__main__.py"
    )
    parser.add_argument("--chapter", type=int, choices=(3, 4, 5))
    parser.add_argument("--only", help="rows whose number or claim contains this")
    parser.add_argument(
        "--data", type=Path, help="folder of scans, in place of generated clouds, under published names"
    )
    parser.add_argument("--quick", action="store_true", help="few and small clouds: does it run?")
    parser.add_argument("--clouds", nargs="+", metavar="POINTS:COUNT", help="by default 1024:216 4096:216 16384:216")
    parser.add_argument("--shapes", type=int, help="shapes with a true skeleton, for the measures")
    parser.add_argument("--density", type=int, nargs="+", metavar="POINTS", help="of the study of density")
    parser.add_argument("--processes", type=int, default=2, help="that make raw results, of one thread each")
    parser.add_argument("--out", type=Path, help="folder of dissertation.md and its figures; docs, of a part out")
    parser.add_argument("--kept", type=Path, default=ROOT / "out" / "raw", help="folder of raw results")
    parser.add_argument("--reference", type=Path, default=Path(reference))
    return parser.parse_args(words)


if __name__ == "__main__":
    main()
