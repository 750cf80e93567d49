"""Laplacian-based contraction of a point cloud (Cao et al. 2010, section 3; Au et al. 2008 on meshes).

Follows the toolbox where print differs: the ring size is the smallest distance
(print: the mean), attraction is reset from the first ring sizes at every step
(not compounded), and the first step is always accepted.
"""

import numpy as np
from scipy import sparse

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry.neighbours import surroundings
from tiskel.geometry.rings import Rings, cotangent_laplacian, mean_ring_length, smallest_distances
from tiskel.geometry.solve import SingularStep, contracted
from tiskel.methods.laplacian.toolbox_order import in_published_order
from tiskel.methods.trace import Status, StepRecord, Trace
from tiskel.params import LaplacianParams, LbcParams
from tiskel.progress import SILENT, Span
from tiskel.timing import Stopwatch

RINGS, USUAL_STEPS = 0.1, 6  # share of the time that rings take, and steps, in most clouds; for who waits only


def contract_lbc(
    points: Points, params: LbcParams, weights: Numbers | None = None, span: Span = SILENT
) -> Trace:  # fmt: skip
    """Contract until the ratio of summed ring sizes falls by less than the stop ratio.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in normalised coordinates.
    params : LbcParams
    weights : (n,) float64, optional
        Multiply W_L point by point, as in S-LBC (Meyer et al. 2023), where parts of one thickness share one; None: 1.
    span : Span
        Told as steps begin.

    Returns
    -------
    Trace
        A contraction without a single step holds the points as they came.
    """
    watch = Stopwatch()
    span.at(0, "rings")
    with watch.measure("rings"):
        rings = published_rings(points, params.neighbours_for(len(points)))
    first_sizes = smallest_distances(points, rings)
    contraction = first_weight(points, rings, params, count_first_twice=True)
    attraction = np.full(len(points), params.attraction_weight)
    here, status = points, Status.MAX_STEPS
    steps: list[StepRecord] = []
    history: list[tuple[Indices, Points]] = []
    everyone = np.arange(len(points), dtype=np.int32)
    for number in range(params.max_steps):
        span.within(RINGS, 1).step(number, USUAL_STEPS, f"step {number + 1}")
        step_watch = Stopwatch()
        try:
            there = one_step(here, rings, contraction, attraction, params, step_watch, weights)
        except SingularStep:
            status = Status.SINGULAR
            break
        sizes = smallest_distances(there, rings)
        ratio = float(sizes.sum() / first_sizes.sum())
        if steps and grew(there, points, params):
            status = Status.BOX_GREW
            break
        if steps and steps[-1].ring_ratio - ratio < params.stop_ratio:
            status = Status.CONVERGED
            break
        steps.append(StepRecord(contraction, ratio, None, None, len(points), step_watch.seconds))
        history.append((everyone, there))
        here = there
        contraction, attraction = next_weights(contraction, first_sizes, sizes, params)
    never = np.full(len(points), -1, np.int32)
    return Trace(
        cloud=points, points=here, rows=everyone, merged_into=never, merged_step=never, history=tuple(history),
        steps=tuple(steps), status=status, rings=rings, ring_seconds=watch.seconds["rings"],
    )  # fmt: skip


def first_weight(points: Points, rings: Rings, params: LaplacianParams, *, count_first_twice: bool) -> float:
    """Return W_L of the first step: 1 / (5 times the mean ring length), unless it is given.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in normalised coordinates.
    rings : Rings
        Of all points.
    params : LaplacianParams
        ``contraction_weight`` counts.
    count_first_twice : bool
        Whether to do as the toolbox, see :func:`tiskel.geometry.rings.mean_ring_length`.

    Returns
    -------
    float
    """
    if params.contraction_weight is not None:
        return params.contraction_weight
    return 1 / (5 * mean_ring_length(points, rings, count_first_twice=count_first_twice))


def published_rings(points: Points, k: int) -> Rings:
    """Return the one-rings of the cloud in the order of the toolbox, which its first weight depends on.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    k : int
        How many nearest a ring is made of, the point itself among them.

    Returns
    -------
    Rings
        Of all points.
    """
    neighbours, _, rings = surroundings(points, k)
    return in_published_order(points, neighbours, rings)


def one_step(
    here: Points,
    rings: Rings,
    contraction: float,
    attraction: Numbers,
    params: LbcParams,
    watch: Stopwatch,
    weights: Numbers | None = None,
) -> Points:
    """Return the contracted cloud: the Laplacian of the cloud as it is, over its original rings, solved once.

    Parameters
    ----------
    here : (n, 3) float64
        The cloud as it is, in normalised coordinates.
    rings : Rings
        Of the cloud before all contraction.
    contraction : float
        W_L.
    attraction : (n,) float64
        W_H of every point.
    params : LbcParams
        The cap of the cotangents and the solver count.
    watch : Stopwatch
        Gets the times of ``laplacian`` and ``solve``.
    weights : (n,) float64, optional
        What W_L of every point is multiplied by; None: 1.

    Returns
    -------
    (n, 3) float64

    Raises
    ------
    SingularStep
        Where the equations have no solution.
    """
    with watch.measure("laplacian"):
        laplacian = weighted(cotangent_laplacian(here, rings, params.cotangent_cap), weights)
    with watch.measure("solve"):
        return contracted(laplacian, contraction, attraction, here, params.solver)


def weighted(laplacian: sparse.csr_array, weights: Numbers | None) -> sparse.csr_array:
    """Return the Laplacian with its rows times the weights.

    Parameters
    ----------
    laplacian : (n, n) sparse array
        L.
    weights : (n,) float64, optional
        What W_L of every point is multiplied by; None: 1.

    Returns
    -------
    (n, n) sparse array
    """
    return laplacian if weights is None else sparse.csr_array(sparse.diags_array(weights) @ laplacian)


def grew(points: Points, original: Points, params: LaplacianParams) -> bool:
    """Tell whether a side of the bounding box has grown past the limit.

    Parameters
    ----------
    points : (m, 3) float64
        The contracted points.
    original : (n, 3) float64
        The cloud before all contraction, in the same coordinates.
    params : LaplacianParams
        ``box_growth`` is the limit, a factor.

    Returns
    -------
    bool
    """
    return bool((np.ptp(points, axis=0) > params.box_growth * np.ptp(original, axis=0)).any())


def next_weights(
    contraction: float, first_sizes: Numbers, sizes: Numbers, params: LaplacianParams
) -> tuple[float, Numbers]:
    """Return W_L <- s_L W_L and W_H,i <- W_H(0) S_i(0) / S_i(k) for the next step (Cao et al. 2010, section 3.3).

    Parameters
    ----------
    contraction : float
        W_L of this step.
    first_sizes : (n,) float64
        S_i(0), the ring sizes before all contraction.
    sizes : (n,) float64
        S_i(k), those after this step; where both are 0, W_H is W_H(0).
    params : LaplacianParams
        Growth s_L and the caps of both weights.

    Returns
    -------
    contraction : float
        W_L, capped.
    attraction : (n,) float64
        W_H, capped.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        attraction = params.attraction_weight * np.nan_to_num(first_sizes / sizes, nan=1.0, posinf=np.inf)
    return min(contraction * params.growth, params.max_contraction_weight), np.minimum(
        attraction, params.max_attraction_weight
    )
