"""Tables of benchmarks, as text and as files in benchmarks/speed, with machine, versions and date."""

import csv
import datetime
import io
import os
import platform
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

Row = dict[str, str]  #: a cell for each column; all rows of a table have the same columns
FOLDER = Path(__file__).parent / "speed"
PACKAGES = ("numpy", "scipy", "taichi", "typer", "rich")


def shown(rows: Sequence[Row]) -> str:
    """Return a table in Markdown, in columns that are aligned as text."""
    rows = [{key: cell.replace("|", "\\|") for key, cell in row.items()} for row in rows]
    heads = list(rows[0])
    widths = [max(len(head), *(len(row[head]) for row in rows)) for head in heads]
    lines = [heads, ["-" * width for width in widths], *(list(row.values()) for row in rows)]
    return "\n".join(
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)) + " |" for line in lines
    )


def written(name: str, rows: Sequence[Row], words: str) -> None:
    """Write a table as NAME.csv and NAME.md, under words that say what was measured."""
    FOLDER.mkdir(exist_ok=True)
    out = io.StringIO()
    table = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    (FOLDER / f"{name}.csv").write_text(out.getvalue())
    (FOLDER / f"{name}.md").write_text(f"{words}\n\n{surroundings()}\n\n{shown(rows)}\n")


def surroundings() -> str:
    """Return processor, load, versions and date in a line."""
    packages = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    return (
        f"{datetime.date.today()}; {platform.machine()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} "
        f"at the end; Python {platform.python_version()}, {packages}."
    )
