"""What a contraction loop records while it runs."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum

from tiskel.arrays import Indices, Points
from tiskel.geometry.rings import Rings


class Status(str, Enum):
    """Why a contraction stopped."""

    CONVERGED = "converged"
    COMPLETE = "complete"
    MAX_STEPS = "step limit"
    BOX_GREW = "bounding box grew"
    SINGULAR = "singular system"

    @property
    def advice(self) -> str:
        """One sentence: what happened, and what to do where something can be done."""
        return _ADVICE[self]


_ADVICE = {
    Status.CONVERGED: "the stopping rule of the method was met",
    Status.COMPLETE: "all fronts have run",
    Status.MAX_STEPS: "the step limit was reached before the stopping rule was met; raise max_steps",
    Status.BOX_GREW: "a step grew the bounding box past the limit and was discarded; open or stretched rings cause it",
    Status.SINGULAR: "a step had no finite solution and was discarded; rings have degenerated",
}


@dataclass(frozen=True)
class StepRecord:
    """One accepted step.

    Attributes
    ----------
    contraction_weight : W_L of the step; 0 for robust, which has none.
    ring_ratio : summed ring sizes after the solve, over the summed first ring sizes of the same points.
    score, score_change : explained score of the contracted cloud, and the quantity that theta is held against (gls).
    points : points left after the step.
    seconds : wall time per part.
    """

    contraction_weight: float
    ring_ratio: float
    score: float | None
    score_change: float | None
    points: int
    seconds: dict[str, float] = field(compare=False)


@dataclass(frozen=True)
class Trace:
    """What a contraction loop returns, in normalised coordinates; rows are those of the cloud it was given.

    Attributes
    ----------
    points : (m, 3) contracted.
    rows : (m,) rows of the points that are left.
    rings : of these points, by their place in ``rows``.
    merged_into, merged_step : (n,) row that each removed point was merged into, and the step, from 1; -1 elsewhere.
    history : positions of the points left after each step, with their rows.
    sections, levels : (n,) by robust, see :class:`tiskel.Contraction`.
    """

    points: Points
    rows: Indices
    rings: Rings
    merged_into: Indices
    merged_step: Indices
    history: tuple[tuple[Indices, Points], ...]
    steps: tuple[StepRecord, ...]
    status: Status
    ring_seconds: float
    sections: Indices | None = None
    levels: Indices | None = None


class Stopwatch:
    """Collect wall time by part; measured times never reach a result file."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def measure(self, part: str) -> Iterator[None]:
        start = time.perf_counter()
        yield
        self.seconds[part] = self.seconds.get(part, 0.0) + time.perf_counter() - start
