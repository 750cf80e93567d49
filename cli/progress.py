"""The line on a terminal that says how far a command is, once it takes more than a second."""

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tiskel.cli import console
from tiskel.progress import Progress, Report

PATIENCE = 1.0  # seconds without a line: most clouds are done by then, and Rich need not be loaded
REFRESH = 0.1  # seconds between two looks of the line at how far the stage is
CLOSES = 2.0  # seconds that a line gets to leave the terminal
LEAST = 0.02  # share of a stage from which on the time left is worth saying


def reading(*sources: Path | None) -> str:
    """Return the words for reading files; none for standard input: what comes down a pipe, others work on."""
    return "" if any(str(source) == "-" for source in sources) else "reading"


@contextmanager
def shown(part: str) -> Iterator[Report | None]:
    """Show how far the stages of the block are, on a terminal's standard error; yield what they are to report to.

    None where nobody looks: with --quiet, or where standard error is no terminal; then nothing is loaded or started.
    The part is what the block begins with, before any stage; where it is empty, nothing is shown until then, so that
    of the commands of a pipe only one has a line at a time.
    """
    if console.session.quiet or not sys.stderr.isatty():
        yield None
        return
    line = _Line(part)
    line.start()
    try:
        yield line.told
    finally:
        line.over.set()
        line.join(CLOSES)


class _Line(threading.Thread):
    """A thread that draws what was reported last; the stages only leave it behind, and never wait."""

    def __init__(self, part: str) -> None:
        super().__init__(name="progress", daemon=True)
        self.over = threading.Event()
        self.last, self.began = Progress("", part, 0.0), time.monotonic()
        self.at, self.first = self.began, self.began  # of the last report, and of the work that is shown

    def told(self, progress: Progress) -> None:
        """Take a report."""
        self.at = time.monotonic()
        if progress.stage != self.last.stage or progress.share < self.last.share:
            self.began = self.at
        if not (self.last.stage or self.last.part):
            self.first = self.at
        self.last = progress

    def run(self) -> None:
        """Wait for a second, then draw until the block is over."""
        while not self.worth_it():
            if self.over.wait(REFRESH):
                return
        if console.errors().is_dumb_terminal:
            return
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Bar

        columns = TextColumn("{task.description}", markup=False), BarColumn(), TextColumn("{task.fields[left]}")
        with Bar(*columns, console=console.errors(), transient=True, auto_refresh=False) as bar:
            task = bar.add_task("", total=None, left="")
            while True:
                words, total, left = self.words()
                bar.update(task, description=words, total=total, completed=self.last.share, left=left, refresh=True)
                if self.over.wait(REFRESH):
                    return

    def worth_it(self) -> bool:
        """Tell whether there is work to show, and has been for a while."""
        return bool(self.last.stage or self.last.part) and time.monotonic() - self.first >= PATIENCE

    def words(self) -> tuple[str, float | None, str]:
        """Return stage and part, the share that the bar is out of (None: unknown), and the time left."""
        last, now = self.last, time.monotonic()
        words = ": ".join(filter(None, (last.stage, last.part)))
        if not last.stage or not last.part:  # before a stage, or after: nobody knows how long
            return words, None, ""
        left = "" if last.share < LEAST else f", {clock((self.at - self.began) / last.share - (now - self.began))} left"
        return words, 1.0, f"{last.share:.0%}{left}"


def clock(seconds: float) -> str:
    """Return a time as minutes and seconds, with hours where there are any; none is negative."""
    minutes, rest = divmod(max(0, round(seconds)), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
