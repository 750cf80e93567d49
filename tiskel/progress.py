"""How far a stage is, told to whoever asked; the library itself prints nothing."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """How far a stage is.

    Attributes
    ----------
    stage : str
        Its name: contract, skeleton, metrics, stability, slice, body, roll, plan, split or join.
    part : str
        What begins now; empty where the stage is done.
    share : float
        How much of the stage is done, from 0 to 1; it never falls while a stage runs, and ends at 1.

    Examples
    --------
    >>> from tiskel import contract, make_shape, shape_graph
    >>> told = []
    >>> c = contract(make_shape(shape_graph("capsule"))[0], progress=told.append)
    >>> told[0].stage, told[0].share, told[-1].share
    ('contract', 0.0, 1.0)
    """

    stage: str
    part: str
    share: float


Report = Callable[[Progress], None]  #: what a caller gives; what it raises ends the stage


@dataclass(frozen=True)
class Span:
    """A stretch of a stage, from one share of it to another; without anyone to tell, it does nothing.

    Examples
    --------
    >>> from tiskel.progress import Span
    >>> second_half = Span(lambda told: print(told.part, told.share), "roll").within(0.5, 1)
    >>> second_half.at(0.5, "descent")
    descent 0.75
    """

    report: Report | None = None
    stage: str = ""
    low: float = 0.0
    high: float = 1.0

    def at(self, share: float, part: str = "") -> None:
        """Tell that a share of this stretch is done, and what begins now."""
        if self.report is not None:
            self.report(Progress(self.stage, part, self.low + share * (self.high - self.low)))

    def step(self, number: int, usual: int, part: str = "") -> None:
        """Tell that a step of unknown many begins, counted from 0: they count as the usual number, or as one more."""
        self.at(number / max(usual, number + 1), part)

    def within(self, low: float, high: float) -> "Span":
        """Return a part of this stretch, from a share of it to another."""
        width = self.high - self.low
        return Span(self.report, self.stage, self.low + low * width, self.low + high * width)

    def parts(self, usual: int) -> Callable[[str], None]:
        """Return what is to be called with the name of every part as it begins, the usual number of them in all."""
        begun: list[str] = []

        def begin(part: str) -> None:
            self.step(len(begun), usual, part)
            begun.append(part)

        return begin


SILENT = Span()  #: tells nobody
