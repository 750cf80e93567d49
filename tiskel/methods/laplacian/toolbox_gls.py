"""GLSkeleton as its toolbox ships it (Wen et al. 2024), departures from its paper included: `--variant toolbox`.

For those who compare with results that the toolbox made; :mod:`tiskel.methods.laplacian.gls` follows the paper.

- U takes the Laplacian coordinate of the first point for every point, and its means count the repeated first member of
  a closed ring twice.
- psi is the ratio of ring sizes itself in the first step, later the fall of the ratio of the points present.
- The score of a step is that of the cloud before it; its change is multiplied by one less the share that the step
  before removed; the bounding box is not looked at in the first step.
- Points are gone through in index order, each merging with its nearest ring member where both are free. An open ring
  must keep four members, a closed one three. Other rings are renamed, repeats dropped where they stand side by side: a
  ring can hold a member twice.
- Attraction takes the ring sizes of before the merge. One step without a merge turns reduction off for good.
"""

from dataclasses import dataclass, field

import numpy as np

from tiskel.arrays import Indices, Mask, Numbers, Points
from tiskel.geometry.rings import Rings, cotangent_laplacian, smallest_distances
from tiskel.geometry.solve import SingularStep, contracted
from tiskel.methods.laplacian.gls import explained_score
from tiskel.methods.laplacian.lbc import RINGS, USUAL_STEPS, first_weight, grew, next_weights, published_rings, weighted
from tiskel.methods.laplacian.reduction import stage_function
from tiskel.methods.laplacian.toolbox_rings import Ring, merged_ring, renamed, with_repeats, without_repeats
from tiskel.methods.trace import Status, StepRecord, Trace
from tiskel.params import GlsParams
from tiskel.progress import SILENT, Span
from tiskel.timing import Stopwatch


def contract_as_toolbox(
    points: Points, params: GlsParams, weights: Numbers | None = None, span: Span = SILENT
) -> Trace:  # fmt: skip
    """Contract and reduce as the published toolbox does; see the module for how that departs from the paper.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in normalised coordinates.
    params : GlsParams
    weights : (n,) float64, optional
        What W_L of every point is multiplied by; as in lbc.
    span : Span
        Told as steps begin.

    Returns
    -------
    Trace
        Its points are those that no merge removed.
    """
    watch = Stopwatch()
    span.at(0, "rings")
    with watch.measure("rings"):
        run = _Run(points, params, weights)
    status = Status.MAX_STEPS
    for number in range(params.max_steps):
        span.within(RINGS, 1).step(number, USUAL_STEPS, f"step {number + 1}")
        ended = run.step(number)
        if ended is not None:
            status = ended
            break
    return Trace(
        cloud=points, points=run.here, rows=run.rows, merged_into=run.merged_into, merged_step=run.merged_step,
        history=tuple(run.history), steps=tuple(run.steps), status=status, rings=without_repeats(run.rings),
        ring_seconds=watch.seconds["rings"],
    )  # fmt: skip


@dataclass(eq=False)
class _Run:
    """The cloud between two steps, one row per point that is left, and what has been recorded."""

    points: Points
    params: GlsParams
    weights: Numbers | None
    steps: list[StepRecord] = field(default_factory=list)
    history: list[tuple[Indices, Points]] = field(default_factory=list)

    def __post_init__(self) -> None:
        count, points = len(self.points), self.points
        rings = published_rings(points, self.params.neighbours_for(count))
        self.rows = np.arange(count, dtype=np.int32)
        self.origin = self.here = points
        self.rings = with_repeats(rings)
        self.first_sizes = smallest_distances(points, rings)
        self.initial = self.contraction = first_weight(points, rings, self.params, count_first_twice=True)
        self.attraction = np.full(count, self.params.attraction_weight)
        self.merged_into, self.merged_step = np.full(count, -1, np.int32), np.full(count, -1, np.int32)
        self.score, self.ratio = 0.0, 0.0
        self.shares = 1.0, 1.0  # of the points, that were left before the last reduction, and after
        self.reducing = True

    def step(self, number: int) -> Status | None:
        """Do one step; return why it is the last one and is discarded, or None."""
        watch, params = Stopwatch(), self.params
        try:
            delta, there = self.solved(watch)
        except SingularStep:
            return Status.SINGULAR
        if number and grew(there, self.points, params):
            return Status.BOX_GREW
        score = explained_score(self.here if number else there)
        change = abs(score - self.score) * (1 - self.shares[0] + self.shares[1])
        if number >= params.min_steps and change < params.theta:
            return Status.CONVERGED
        sizes = smallest_distances(there, without_repeats(self.rings))
        ratio = float(sizes.sum() / self.first_sizes.sum())
        shrinkage = params.epsilon * (self.ratio - ratio if number else ratio)
        self.score, self.ratio = score, ratio
        into = np.full(len(there), -1, np.int32)
        if self.reducing:
            with watch.measure("reduce"):
                weight = params.growth ** (number + 2) * self.initial
                marked = self.marked(there, delta, sizes, shrinkage, weight)
                into, self.rings = merge_in_turn(self.origin, there, self.rings, marked, delta)
            self.reducing = bool((into >= 0).any())
        kept = np.flatnonzero(into < 0).astype(np.int32)
        self.shares = self.shares[1], len(kept) / len(self.points)
        self.steps.append(StepRecord(self.contraction, ratio, score, change, len(kept), watch.seconds))
        self.record(number, into)
        self.keep(kept, there, sizes)
        return None

    def solved(self, watch: Stopwatch) -> tuple[Points, Points]:
        """Return the Laplacian coordinates before the solve, and the contracted cloud."""
        with watch.measure("laplacian"):
            laplacian = cotangent_laplacian(self.here, without_repeats(self.rings), self.params.cotangent_cap)
            rowed = weighted(laplacian, None if self.weights is None else self.weights[self.rows])
        with watch.measure("solve"):
            there = contracted(rowed, self.contraction, self.attraction, self.here, self.params.solver)
        return np.ascontiguousarray(laplacian @ self.here), there

    def marked(self, there: Points, delta: Points, sizes: Numbers, shrinkage: float, weight: float) -> Mask:
        """Return which points have V1 - V2 + 3 U < phi s^2, with U from the first point's Laplacian coordinate."""
        count = len(there)
        none = Rings(np.zeros((count, 1), np.int32), np.zeros(count, np.int32), np.zeros(count, np.int32))
        pulls = stage_function(
            self.origin, there, delta, none, self.first_sizes, sizes, shrinkage=shrinkage,
            contraction_weight=weight, attraction_weight=self.params.attraction_weight, guard=self.params.guard,
        )  # fmt: skip
        means = np.array([delta[ring].mean(axis=0) for ring in self.rings])
        return np.asarray(pulls + 3 * ((delta[0] - means) ** 2).sum(axis=1) < self.params.phi * sizes**2)

    def record(self, number: int, into: Indices) -> None:
        """Write down, in rows of the whole cloud, what was merged into what."""
        removed = into >= 0
        self.merged_into[self.rows[removed]] = self.rows[into[removed]]
        self.merged_step[self.rows[removed]] = number + 1

    def keep(self, kept: Indices, there: Points, sizes: Numbers) -> None:
        """Go on with the points that are left, and the weights of the next step."""
        self.first_sizes = self.first_sizes[kept]
        self.contraction, self.attraction = next_weights(self.contraction, self.first_sizes, sizes[kept], self.params)
        self.rows, self.origin = self.rows[kept], np.ascontiguousarray(self.origin[kept])
        self.here = np.ascontiguousarray(there[kept])
        self.history.append((self.rows, self.here))


def merge_in_turn(
    origin: Points, there: Points, rings: list[Ring], marked: Mask, delta: Points
) -> tuple[Indices, list[Ring]]:
    """Merge in index order: each marked point takes its nearest ring member where both are free.

    Parameters
    ----------
    origin : (n, 3) float64
        The points before all contraction.
    there : (n, 3) float64
        The points just contracted.
    rings : list of n lists
        As the toolbox has them; they are read, not changed.
    marked : (n,) bool
        Which may merge.
    delta : (n, 3) float64
        Laplacian coordinates, which merged rings are projected along.

    Returns
    -------
    into : (n,) int32
        The row that each removed point was merged into; -1 for the others.
    rings : list of lists
        Of the points that stay, in their own numbers.
    """
    into, free = np.full(len(there), -1, np.int32), np.ones(len(there), bool)
    fresh = list(rings)
    for i in np.flatnonzero(marked).tolist():
        if not free[i]:
            continue
        ring = rings[i]
        lost = ring[int(np.linalg.norm(there[ring] - there[i], axis=1).argmin())]
        if not free[lost] or lost == i:
            continue
        merged = merged_ring(origin, i, lost, rings, delta[i])
        if merged:
            fresh[i], into[lost] = merged, i
            free[[i, lost]] = False
    return into, renamed(fresh, into)
