"""The code blocks of a page of Markdown, and what is said about them in comments that a reader does not see.

``<!-- given: scan.ply curve.ply -->`` puts files into the folder before the block that follows;
``<!-- not run: REASON -->`` says why the next block cannot run.
"""

import re
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^(?P<indent> *)```(?P<kind>[^\n`]*)\n(?P<code>.*?)^(?P=indent)```$", re.M | re.S)
REMARK = re.compile(r"<!-- (given|not run): (.*?) -->")
RUN = ("sh", "python")
SHOWN = ("text", "")  # what is written or drawn, nothing to run; an empty kind is an error of the page
MADE = "{"  # directives of the site


@dataclass(frozen=True)
class Block:
    """A code block: its kind, its code, the files it finds, and why it is not run."""

    kind: str
    code: str
    given: tuple[str, ...]
    reason: str
    line: int


def blocks_of(page: Path) -> list[Block]:
    """Return the blocks of a page in order, those of the site's directives left out."""
    text, found, end = page.read_text(), [], 0
    for fence in FENCE.finditer(text):
        remarks = dict(REMARK.findall(text[end : fence.start()]))
        end = fence.end()
        if fence["kind"].startswith(MADE):
            continue
        given = tuple(remarks.get("given", "").split())
        line = text.count("\n", 0, fence.start()) + 1
        found.append(Block(fence["kind"].strip(), fence["code"], given, remarks.get("not run", ""), line))
    return found


def prose_of(page: Path) -> str:
    """Return a page without its code blocks."""
    return FENCE.sub("", page.read_text())
