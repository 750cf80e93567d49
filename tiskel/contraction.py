"""The stage ``contract``: a cloud in, a contracted cloud out, with the record of how."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tiskel.arrays import (
    Frame,
    Indices,
    Numbers,
    Points,
    as_points,
    check_solid,
    finite_rows,
    first_of_duplicates,
    normalisation,
    resolved,
)
from tiskel.errors import TiskelError
from tiskel.geometry.rings import Rings
from tiskel.methods.laplacian.gls import contract_gls
from tiskel.methods.laplacian.lbc import contract_lbc
from tiskel.methods.robust.fronts import contract_robust
from tiskel.methods.trace import Status, StepRecord, Trace
from tiskel.params import ContractionParams

LOOPS = {"robust": contract_robust, "gls": contract_gls, "lbc": contract_lbc}


@dataclass(frozen=True)
class Contraction:
    """A contracted cloud and where it came from; coordinates in the input's units.

    Attributes
    ----------
    points : (m, 3), the points that are left, contracted.
    origin : (m, 3), where they were.
    rows : (m,) int32, their rows in the cloud.
    rings : the ring of each, by place in ``points``; merged rings for gls.
    cloud : (n, 3), the finite points of the input.
    input_rows : (n,) int32, their rows in the input.
    merged_into : (n,) int32, row of the cloud that each removed point was merged into, -1 for the others.
    merged_step : (n,) int32, the step of that, from 1; 0 for a duplicate; -1 for points that are left.
    history : (k, m, 3), positions of the points that are left, after each step.
    steps : one record per accepted step.
    status : why the contraction stopped.
    warnings : what a user should know about the input or the result.
    params : the settings.
    sections : (m,) int32, by robust: the section each point belongs to, a connected piece of what the last front
        passed in one stride, -1 for debris; levels : (m,) int32, the number of the stride. None by the others.
    ring_seconds : wall time of neighbours and rings.
    """

    points: Points
    origin: Points
    rows: Indices
    rings: Rings
    cloud: Points
    input_rows: Indices
    merged_into: Indices
    merged_step: Indices
    history: Numbers
    steps: tuple[StepRecord, ...]
    status: Status
    warnings: tuple[str, ...]
    params: ContractionParams
    sections: Indices | None = None
    levels: Indices | None = None
    ring_seconds: float = 0.0

    def survivor_of(self) -> Indices:
        """Return (n,), for each point of the cloud the place in ``points`` of the one it ended up in."""
        place = np.full(len(self.cloud), -1, np.int32)
        place[self.rows] = np.arange(len(self.rows), dtype=np.int32)
        into = np.where(self.merged_into < 0, np.arange(len(self.cloud), dtype=np.int32), self.merged_into)
        return place[resolved(into)]


def contract(
    points: npt.ArrayLike, params: ContractionParams | None = None, weights: npt.ArrayLike | None = None
) -> Contraction:
    """Contract a cloud towards its medial curve.

    Methods: "robust", by fronts over the original cloud (:mod:`tiskel.methods.robust.fronts`),
    "gls", GLSkeleton (Wen et al. 2024), and "lbc", Laplacian-based contraction
    (Cao et al. 2010). Departures from print are listed in :mod:`tiskel.methods.laplacian.lbc` and
    :mod:`tiskel.methods.laplacian.reduction`.

    Parameters
    ----------
    points : (n, 3), in any unit. Rows that are not finite are dropped and exact
        duplicates merged; both are counted in the warnings.
    params : settings.
    weights : (n,) positive, for lbc and gls: what W_L is multiplied by at each
        point. Thick parts contract more slowly; one weight for each semantic part
        evens that out (S-LBC, Meyer et al. 2023).

    Returns
    -------
    Contraction

    Raises
    ------
    TiskelError
        Fewer than ten distinct finite points, all points on a plane or a line,
        weights that do not fit, or a first step that has no solution.
    """
    params = params or ContractionParams()
    every = as_points(points)
    finite = finite_rows(every)
    cloud, input_rows = np.ascontiguousarray(every[finite]), np.flatnonzero(finite).astype(np.int32)
    if len(cloud) == 0:
        raise TiskelError(f"the cloud holds no finite point ({len(every)} rows in all); check the file")
    first = first_of_duplicates(cloud)
    distinct = np.flatnonzero(first == np.arange(len(cloud))).astype(np.int32)
    check_solid(cloud[distinct])
    frame = normalisation(cloud[distinct], params.normalise)
    chosen = None if weights is None else _weights(weights, len(every))[finite][distinct]
    trace = LOOPS[params.method](frame.apply(cloud[distinct]), params, chosen)
    if not trace.steps:
        raise TiskelError(f"contraction failed in its first step: {trace.status.advice}; try --voxel or --outliers")
    warnings = _warnings(len(every) - len(cloud), len(cloud) - len(distinct), trace.status)
    return _assembled(trace, frame, cloud, input_rows, first, distinct, warnings, params)


def _weights(weights: npt.ArrayLike, count: int) -> Numbers:
    values = np.asarray(weights, dtype=np.float64)
    if values.shape != (count,):
        raise TiskelError(f"weights must be one number for each of the {count} points, got shape {values.shape}")
    if not (np.isfinite(values) & (values > 0)).all():
        raise TiskelError("weights must be positive and finite; 1 leaves a point as it is")
    return values


def _warnings(dropped: int, duplicates: int, status: Status) -> tuple[str, ...]:
    counted = [(dropped, "rows with NaN or Inf were dropped"), (duplicates, "exact duplicates were merged")]
    found = [f"{count} {what}" for count, what in counted if count]
    if status not in (Status.CONVERGED, Status.COMPLETE):
        found.append(f"stopped early: {status.advice}")
    return tuple(found)


def _assembled(
    trace: Trace, frame: Frame, cloud: Points, input_rows: Indices, first: Indices, distinct: Indices,
    warnings: tuple[str, ...], params: ContractionParams,
) -> Contraction:  # fmt: skip
    """Translate a trace from rows of the distinct points to rows of the cloud, and back to its units."""
    merged_into, merged_step = np.full(len(cloud), -1, np.int32), np.full(len(cloud), -1, np.int32)
    gone = trace.merged_into >= 0
    merged_into[distinct[gone]] = distinct[trace.merged_into[gone]]
    merged_step[distinct] = trace.merged_step
    copies = first != np.arange(len(cloud))
    merged_into[copies], merged_step[copies] = first[copies], 0
    rows = distinct[trace.rows]
    history = [positions[np.searchsorted(step_rows, trace.rows)] for step_rows, positions in trace.history]
    return Contraction(
        points=frame.undo(trace.points),
        origin=cloud[rows],
        rows=rows,
        rings=trace.rings,
        cloud=cloud,
        input_rows=input_rows,
        merged_into=merged_into,
        merged_step=merged_step,
        history=np.stack([frame.undo(positions) for positions in history]),
        steps=trace.steps,
        status=trace.status,
        warnings=warnings,
        params=params,
        sections=trace.sections,
        levels=trace.levels,
        ring_seconds=trace.ring_seconds,
    )
