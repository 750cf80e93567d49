"""How far a batch is: a table on a terminal, lines elsewhere."""

import sys
import time
from collections import Counter
from types import TracebackType
from typing import TYPE_CHECKING, Any

from tiskel.cli import console
from tiskel.cli.progress import clock

if TYPE_CHECKING:
    from tiskel.batch.pool import News

EVERY = 15.0  # seconds between two lines that say how far it is
REFRESH = 0.5  # seconds between two looks of the table


class Board:
    """Hears the news of a batch and shows them; with --quiet it is silent.

    Parameters
    ----------
    total : int
        Clouds of the list.
    """

    def __init__(self, total: int) -> None:
        self.total, self.counts, self.running = total, Counter[str](), dict[str, float]()
        self.began, self.told, self.here = time.monotonic(), time.monotonic(), 0
        self._live: Any = None

    def __enter__(self) -> "Board":
        if not console.session.quiet and sys.stderr.isatty() and not console.errors().is_dumb_terminal:
            from rich.live import Live

            self._live = Live(console=console.errors(), auto_refresh=False, transient=True)
            self._live.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._live is not None:
            self._live.stop()
        console.say(self.line())

    def tell(self, news: "News") -> None:
        """Take what happened; a name is a cloud that begins."""
        if isinstance(news, str):
            self.running[news] = time.monotonic()
        elif news is not None:
            self.running.pop(news.task.name, None)
            self.counts[news.outcome] += 1
            self.here += news.outcome != "kept"
            self._say(news.task.name, news.outcome, news.record)
        self._show()

    def _say(self, name: str, outcome: str, record: dict[str, Any]) -> None:
        if outcome == "failed":
            console.say(f"failed: {name}: {record['kind']}: {record['message']}")
        elif outcome == "done" and console.session.verbose:
            console.say(f"done: {name}: {record['seconds']:.1f} s")

    def _show(self) -> None:
        now = time.monotonic()
        if now - self.told < (EVERY if self._live is None else REFRESH):
            return
        self.told = now
        if self._live is None:
            console.say(self.line())
        else:
            self._live.update(self._table(now), refresh=True)

    def _table(self, now: float) -> Any:
        """Return what is being done, the longest at the top, below how far it is."""
        rows = [[name, clock(now - since)] for name, since in sorted(self.running.items(), key=lambda item: item[1])]
        return console.table(self.line(), ["cloud", "since"], rows)

    def line(self) -> str:
        """Return how far it is, in words."""
        left = self.total - sum(self.counts.values())
        minutes = (time.monotonic() - self.began) / 60
        rate = self.here / minutes if minutes > 0 else 0.0
        kept = f", {self.counts['kept']} done before" if self.counts["kept"] else ""
        pace = f", {rate:.1f} clouds per minute" if rate else ""
        time_left = f", {clock(left / rate * 60)} left" if rate and left else ""
        return f"{self.counts['done']} done{kept}, {self.counts['failed']} failed, {left} left{pace}{time_left}"
