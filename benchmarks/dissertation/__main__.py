"""The dissertation, claim by claim: every figure, table and equation of chapters 3 to 5 with a verdict.

    make dissertation                                   # or: python benchmarks/dissertation
    python benchmarks/dissertation --only "Fig 3.5"     # one row; --chapter 3 one chapter
    python benchmarks/dissertation --data FOLDER        # scans in place of generated clouds, under the published names
    python benchmarks/dissertation --clouds 1024:216 4096:216 16384:216
    python benchmarks/dissertation --quick --out DIR    # does it run?

Writes docs/dissertation.md and the figures in docs/dissertation. Raw results are kept in out/dissertation, by settings
and the library's sources: what was interrupted goes on, what did not change is not run again.
"""

import datetime
import platform
import sys
import time
from dataclasses import replace
from importlib.metadata import version

import contraction
import measures
import rolling
from core import QUICK, UNTESTED, Bench, Found, Row, Sizes, arguments, page, remember, remembered

from tiskel import TiskelError

CHAPTERS = {
    "Chapter 3: contraction": contraction.ROWS,
    "Chapter 4: measures": measures.ROWS,
    "Chapter 5: rolling contact": rolling.ROWS,
}

NOT_RUN = Found("", UNTESTED, "this row was not run when the page was made; --only runs it")


def main() -> None:
    """Run the rows that were asked for; write the page with them and with those of earlier runs."""
    chosen = arguments()
    sizes = QUICK if chosen.quick else Sizes()
    if chosen.clouds:
        pairs = (pair.split(":") for pair in chosen.clouds)
        sizes = replace(sizes, clouds={int(points): int(count) for points, count in pairs})
    if chosen.shapes:
        sizes = replace(sizes, shapes=chosen.shapes)
    if chosen.density:
        sizes = replace(sizes, density=tuple(chosen.density))
    bench = Bench(sizes, chosen.out / "dissertation", chosen.kept, chosen.reference, chosen.data, chosen.stale)
    rows = [(chapter, row) for chapter, some in CHAPTERS.items() for row in some]
    asked = [
        row for chapter, row in rows
        if (chosen.chapter is None or f"Chapter {chosen.chapter}:" in chapter)
        and (chosen.only is None or chosen.only.lower() in key(row).lower())
    ]  # fmt: skip
    found = remembered(bench)
    for number, row in enumerate(asked, 1):
        print(f"[{number}/{len(asked)}] {key(row)}", file=sys.stderr, flush=True)
        found[key(row)] = settled(bench, row)
        remember(bench, found)
        print(f"{row.number} | {found[key(row)].ours} | {found[key(row)].verdict}", flush=True)
    chosen.out.mkdir(parents=True, exist_ok=True)
    every = [(chapter, row, found.get(key(row), NOT_RUN)) for chapter, row in rows]
    (chosen.out / "dissertation.md").write_text(page(every, words(bench)))


def key(row: Row) -> str:
    return f"{row.number}: {row.claim}"


def settled(bench: Bench, row: Row) -> Found:
    start = time.perf_counter()
    try:
        return row.find(bench)
    except TiskelError as error:
        return Found("", UNTESTED, f"a run ended with an error: {error}")
    finally:
        print(f"    {time.perf_counter() - start:.1f} s", file=sys.stderr, flush=True)


def words(bench: Bench) -> str:
    """Return what stands above the table: what it is, what made it, and how much was run."""
    clouds = ", ".join(f"{count} clouds of {points} points" for points, count in bench.sizes.clouds.items())
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "taichi"))
    stale = " Raw results of earlier versions of the library count, too (--stale)." if bench.stale else ""
    source = "scans of --data" if bench.data else "the gallery's shapes, turned, with random proportions"
    return "\n".join([
        "Every numbered algorithm, equation, definition, figure and table of chapters 3 to 5 that a number can settle, "
        "and claims of the text, with the value that is published and the one found here. *met*: the value, within the "
        "tolerance that the row names, or 10 %; *met in kind*: the same tendency or order; *contradicted*: another, "
        "and why; *not testable*: what is missing. Things whose number is not known here are named without one.",
        "",
        "`make dissertation` writes this page; `python benchmarks/dissertation --only \"Fig 3.5\"` makes one row; "
        "`--data FOLDER` takes the scans of the original experiments, `--clouds 1024:216 4096:216 16384:216` their "
        "number. Figures are in the published form.",
        "",
        f"Made of {source}: {clouds}; measures on {bench.sizes.shapes} shapes of {bench.sizes.points} points; density "
        f"up to {max(bench.sizes.density)}. {datetime.date.today()}, Python {platform.python_version()}, {packages}, "
        f"{platform.machine()}; times hang on the machine, and are compared with one another only.{stale}",
    ])  # fmt: skip


if __name__ == "__main__":
    main()
