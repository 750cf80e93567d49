"""GLSkeleton: contraction with local point reduction and the explained-score stop (Wen et al. 2024).

Choices where print is silent or the toolbox differs (its own is :mod:`tiskel.methods.laplacian.toolbox_gls`):

- V1 has W_L squared, which print lacks (Eq 3.10): W_L grows by s_L a step, and V1 is what it weighs. V2 has w_h(0),
  as in the derivation; with w_h(k) the shrinkage would count twice.
- At least ``min_steps`` steps are kept, as in the toolbox, which print does not name: by its rule alone (Eq 3.15)
  about half of the gallery stops after one, and with the toolbox's score, that of the cloud before the step, all of it.
  The step that meets the rule is discarded.
- Ring sizes are always those of the rings as they are, merged ones included.
- e(k) is the score of the contracted cloud before its removal; the change is divided by the share of points kept.
- The mean ring length behind the first weight counts every member once.
- A ring that renaming leaves with two members keeps its triangles, as in the toolbox. With a zero row instead, its
  point is no longer held by anything but its attraction while its neighbours' rows still pull on it: it takes up their
  slack, and on most clouds one such point makes the bounding box grow and ends the run.
"""

from dataclasses import dataclass, replace

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry.neighbours import surroundings
from tiskel.geometry.rings import Rings, cotangent_laplacian, smallest_distances
from tiskel.geometry.solve import SingularStep, contracted
from tiskel.methods.laplacian.lbc import RINGS, USUAL_STEPS, first_weight, grew, next_weights, weighted
from tiskel.methods.laplacian.reduction import Merge, matching, merge, stage_function
from tiskel.methods.trace import Status, StepRecord, Trace
from tiskel.params import GlsParams
from tiskel.progress import SILENT, Span
from tiskel.timing import Stopwatch


@dataclass(frozen=True, eq=False)
class _State:
    """The cloud between two steps; all arrays have one row per point that is left."""

    rows: Indices
    origin: Points
    normals: Points  # least principal axes of the original neighbourhoods
    points: Points
    rings: Rings
    first_sizes: Numbers
    contraction: float
    attraction: Numbers
    score: float
    count_before: int  # points when the score was taken


def contract_gls(
    points: Points, params: GlsParams, weights: Numbers | None = None, span: Span = SILENT
) -> Trace:  # fmt: skip
    """Contract and reduce until the explained score settles.

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
        state = _start(points, params)
    initial, first_count = state.contraction, len(points)
    merged_into, merged_step = np.full(first_count, -1, np.int32), np.full(first_count, -1, np.int32)
    steps: list[StepRecord] = []
    history: list[tuple[Indices, Points]] = []
    status = Status.MAX_STEPS
    for number in range(params.max_steps):
        span.within(RINGS, 1).step(number, USUAL_STEPS, f"step {number + 1}")
        step_watch = Stopwatch()
        try:
            delta, there = _solve(state, params, step_watch, weights)
        except SingularStep:
            status = Status.SINGULAR
            break
        if grew(there, points, params):
            status = Status.BOX_GREW
            break
        score = explained_score(there)
        change = abs(score - state.score) / (1 - (state.count_before - len(there)) / first_count)
        if number >= params.min_steps and change < params.theta:
            status = Status.CONVERGED
            break
        sizes = smallest_distances(there, state.rings)
        with step_watch.measure("reduce"):
            reduced = _reduce(state, there, delta, sizes, params, initial * params.growth ** (number + 2))
        removed = reduced.merged_into >= 0
        merged_into[state.rows[removed]] = state.rows[reduced.merged_into[removed]]
        merged_step[state.rows[removed]] = number + 1
        ratio = float(sizes.sum() / state.first_sizes.sum())
        kept = reduced.kept()
        steps.append(StepRecord(state.contraction, ratio, score, change, len(kept), step_watch.seconds))
        state = _after(state, there, reduced, kept, score, params)
        history.append((state.rows, state.points))
    return Trace(
        cloud=points, points=state.points, rows=state.rows, merged_into=merged_into, merged_step=merged_step,
        history=tuple(history), steps=tuple(steps), status=status, rings=state.rings,
        ring_seconds=watch.seconds["rings"],
    )  # fmt: skip


def explained_score(points: Points) -> float:
    """Return e = (2 l1 + l2 + l3) / (2 (l1 + l2 + l3)) of the eigenvalues of the cloud's covariance.

    Parameters
    ----------
    points : (n, 3) float64
        Two at least, not all in one place; in any unit.

    Returns
    -------
    float
        From 2/3 for a ball to 1 for a line, l1 the largest eigenvalue.
    """
    values = np.linalg.eigvalsh(np.cov(points.T))
    return float((values.sum() + values[2]) / (2 * values.sum()))


def _start(points: Points, params: GlsParams) -> _State:
    _, axes, rings = surroundings(points, params.neighbours_for(len(points)))
    everyone = np.arange(len(points), dtype=np.int32)
    weight = first_weight(points, rings, params, count_first_twice=False)
    return _State(
        everyone, points, axes[:, 2], points, rings, smallest_distances(points, rings),
        weight, np.full(len(points), params.attraction_weight), explained_score(points), len(points),
    )  # fmt: skip


def _solve(state: _State, params: GlsParams, watch: Stopwatch, weights: Numbers | None) -> tuple[Points, Points]:
    """Return the Laplacian coordinates before the solve, and the contracted cloud."""
    with watch.measure("laplacian"):
        laplacian = cotangent_laplacian(state.points, state.rings, params.cotangent_cap)
    with watch.measure("solve"):
        there = contracted(
            weighted(laplacian, None if weights is None else weights[state.rows]),
            state.contraction,
            state.attraction,
            state.points,
            params.solver,
        )
    return np.ascontiguousarray(laplacian @ state.points), there


def _reduce(state: _State, there: Points, delta: Points, sizes: Numbers, params: GlsParams, weight: float) -> Merge:
    """Mark the points with F < phi s^2 and merge each with its nearest ring member."""
    before = smallest_distances(state.points, state.rings)
    shrinkage = params.epsilon * float((before.sum() - sizes.sum()) / state.first_sizes.sum())
    stage = stage_function(
        state.origin, there, delta, state.rings, state.first_sizes, sizes, shrinkage=shrinkage,
        contraction_weight=weight, attraction_weight=params.attraction_weight, guard=params.guard,
    )  # fmt: skip
    pairs = matching(there, state.rings, stage < params.phi * sizes**2)
    vanishing = np.linalg.norm(delta, axis=1) == 0
    return merge(state.origin, state.rings, pairs, np.where(vanishing[:, None], state.normals, delta))


def _after(state: _State, there: Points, reduced: Merge, kept: Indices, score: float, params: GlsParams) -> _State:
    """Return the cloud without the removed points, with the weights of the next step."""
    place = np.full(len(there), -1, np.int32)
    place[kept] = np.arange(len(kept), dtype=np.int32)
    members = reduced.rings.members[kept]
    rings = replace(reduced.rings.take(kept), members=np.where(members >= 0, place[members], -1).astype(np.int32))
    points, first_sizes = np.ascontiguousarray(there[kept]), state.first_sizes[kept]
    contraction, attraction = next_weights(state.contraction, first_sizes, smallest_distances(points, rings), params)
    # A point without a triangle is held in place: it would take up the slack of its neighbours' rows.
    attraction[rings.sizes < 2] = params.max_attraction_weight
    return _State(
        state.rows[kept], np.ascontiguousarray(state.origin[kept]), state.normals[kept], points, rings,
        first_sizes, contraction, attraction, score, len(there),
    )  # fmt: skip
