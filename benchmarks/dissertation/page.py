"""The page: a table for each chapter, what made it, and how long that took."""

import datetime
import platform
from collections.abc import Sequence
from importlib.metadata import version

from core import AGAINST, KIND, MET, UNTESTED, Bench, Found, Row

Spent = dict[str, tuple[float, float]]  # seconds of processors and elapsed, by chapter
WORDS = """\
Numbered algorithms, equations, definitions, figures and tables of chapters 3 to 5 that a number can settle, and claims
of the text, with the value that is published and the one found here. *met*: the value, within the tolerance that the
row names, or 10 %; *met in kind*: not the value, or print has none, but the tendency or rule that the row names;
*contradicted*: another, and why; *not testable*: what is missing. Rules of rows for which print shows pictures only are
ours, and say so. What stands as a conjecture is one.

`make dissertation` writes this page; `python benchmarks/dissertation --only "Fig 3.5"` makes one row, `--chapter 4` a
chapter, in `out`; `--data FOLDER` takes the scans of the original experiments in place of generated clouds. Figures are
in the published form."""


def page(rows: Sequence[tuple[str, Row, Found]], bench: Bench, spent: Spent) -> str:
    """Return the table as a page, a part for each chapter."""
    count = {verdict: sum(found.verdict == verdict for *_, found in rows) for verdict in (MET, KIND, AGAINST, UNTESTED)}
    lines = ["# The dissertation, claim by claim", "", WORDS, "", made_of(bench, spent), ""]
    lines += [f"{len(rows)} rows: {', '.join(f'{n} {verdict}' for verdict, n in count.items())}.", ""]
    for chapter in dict.fromkeys(chapter for chapter, *_ in rows):
        lines += [f"## {chapter}", "", "| what | claim | published | here | verdict |", "|---" * 5 + "|"]
        lines += [line(row, found) for of, row, found in rows if of == chapter]
        lines.append("")
    return "\n".join(lines)


def line(row: Row, found: Found) -> str:
    links = " ".join(f"[figure](dissertation/{name})" for name in found.pictures)
    claim = "; ".join(filter(None, (row.claim, f"`{row.command}`" if row.command else "")))
    verdict = f"**{found.verdict}**" + (f": {found.why}" if found.why else "")
    cells = [row.number, claim, row.published, " ".join(filter(None, (found.ours, links))), verdict]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def made_of(bench: Bench, spent: Spent) -> str:
    """Return what was run, with what, and the time of the raw results that the rows stand on."""
    clouds = ", ".join(f"{count} clouds of {points} points" for points, count in bench.sizes.clouds.items())
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "taichi"))
    source = "scans of --data" if bench.data else "the gallery's shapes, turned, with random proportions"
    parts = ", ".join(f"{chapter.partition(':')[0].lower()} {busy / 60:.0f} min ({elapsed / 60:.0f} elapsed)"
                      for chapter, (busy, elapsed) in spent.items())  # fmt: skip
    busy, elapsed = (sum(column) / 60 for column in zip(*spent.values(), strict=True))
    return (
        f"Made of {source}: {clouds}; measures on {bench.sizes.shapes} shapes of {bench.sizes.points} points; density "
        f"up to {max(bench.sizes.density)}. {datetime.date.today()}, Python {platform.python_version()}, {packages}, "
        f"{platform.machine()}. Times hang on the machine, and are compared with one another only.\n\n"
        f"What the rows stand on took, in processes of one thread, {parts}: {busy:.0f} min of processor time in all, "
        f"{busy / 2:.0f} min on each of two cores; {elapsed:.0f} min elapsed, {elapsed / 2:.0f} min with two processes "
        "side by side, others at work on the machine included."
    )
