"""What goes into a method and what comes out: the contract of its two functions."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np

from tiskel.arrays import Indices, Points, resolved
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.geometry.rings import Rings


class Status(str, Enum):
    """Why a contraction stopped.

    Examples
    --------
    >>> from tiskel import Status
    >>> Status("step limit").advice
    'the step limit was reached before the stopping rule was met; raise max_steps'
    """

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


def remarks(dropped: int, duplicates: int, status: Status) -> tuple[str, ...]:
    """Return what to know of a contraction: points that were left out, and that it stopped early."""
    counted = [(dropped, "rows with NaN or Inf were dropped"), (duplicates, "exact duplicates were merged")]
    found = [f"{count} {what}" for count, what in counted if count]
    if status not in (Status.CONVERGED, Status.COMPLETE):
        found.append(f"stopped early: {status.advice}")
    return tuple(found)


@dataclass(frozen=True)
class StepRecord:
    """One accepted step.

    Attributes
    ----------
    contraction_weight : float
        W_L of the step; 0 for robust, which has none.
    ring_ratio : float
        Summed ring sizes after the solve, over the summed first ring sizes of the same points.
    score : float or None
        Explained score of the contracted cloud (gls).
    score_change : float or None
        The quantity that theta is held against (gls).
    points : int
        Points left after the step.
    seconds : dict
        Wall time per part; no part of a comparison, nor of a file.

    Examples
    --------
    >>> from tiskel import LbcParams, ShapeParams, contract, make_shape, shape_graph
    >>> steps = contract(make_shape(shape_graph("capsule"), ShapeParams(count=1000))[0], LbcParams(max_steps=2)).steps
    >>> steps[1].points, steps[1].ring_ratio < steps[0].ring_ratio < 1, steps[1].score
    (1000, True, None)
    """

    contraction_weight: float
    ring_ratio: float
    score: float | None
    score_change: float | None
    points: int
    seconds: dict[str, float] = field(compare=False)


@dataclass(frozen=True, eq=False)
class Sections:
    """What a front found: the connected pieces of each bin of geodesic distance, a Reeb graph's level sets.

    Attributes
    ----------
    section : (n,) int32
        The section of every point, numbered along the front; -1 in small components.
    level : (n,) int32
        The bin of the front at every point; -1 in small components.
    """

    section: Indices
    level: Indices

    @property
    def count(self) -> int:
        """The number of sections."""
        return int(self.section.max(initial=-1)) + 1


@dataclass(frozen=True, eq=False)
class Trace:
    """What the first function of a method, ``contract``, returns and its second, ``curve``, takes.

    In normalised coordinates; rows are those of the cloud.

    Attributes
    ----------
    cloud : (n, 3) float64
        The cloud that was contracted.
    points : (m, 3) float64
        The points that are left, contracted.
    rows : (m,) int32
        Their rows in the cloud.
    merged_into : (n,) int32
        The row that each removed point was merged into; -1 elsewhere.
    merged_step : (n,) int32
        The step of that, from 1; -1 elsewhere.
    history : tuple
        The rows and positions of the points left after each step.
    steps : tuple of StepRecord
        One for each accepted step.
    status : Status
        Why the contraction stopped.
    rings : Rings or None
        One-rings of the points that are left, by place in ``rows``; None from methods without.
    sections : Sections or None
        What the last front found, a row for each of ``rows``; None from methods without fronts.
    surface : MeshSurface or None
        What a mesh knows about the points, a row for each of ``rows``; None where they were a cloud.
    prepared : object
        What the method worked out about the cloud and would work out again; never in a file.
    ring_seconds : float
        Wall time of neighbours and rings.
    """

    cloud: Points
    points: Points
    rows: Indices
    merged_into: Indices
    merged_step: Indices
    history: tuple[tuple[Indices, Points], ...]
    steps: tuple[StepRecord, ...]
    status: Status
    rings: Rings | None = None
    sections: Sections | None = None
    surface: MeshSurface | None = None
    prepared: Any = None
    ring_seconds: float = 0.0

    def survivor_of(self) -> Indices:
        """Return (n,), for each point of the cloud the place in ``points`` of the one it ended up in."""
        return survivors(self.rows, self.merged_into)


def survivors(rows: Indices, merged_into: Indices) -> Indices:
    """Return for each point of a cloud where the one is that it was merged into in the end.

    Parameters
    ----------
    rows : (m,) int32
        The points that are left.
    merged_into : (n,) int32
        The row that each removed point was merged into; -1 elsewhere.

    Returns
    -------
    (n,) int32
        Places in ``rows``.
    """
    everyone = np.arange(len(merged_into), dtype=np.int32)
    place = np.full(len(merged_into), -1, np.int32)
    place[rows] = np.arange(len(rows), dtype=np.int32)
    return place[resolved(np.where(merged_into < 0, everyone, merged_into))]


@dataclass(frozen=True, eq=False)
class MethodCurve:
    """What the second function of a method, ``curve``, returns, in normalised coordinates.

    Attributes
    ----------
    graph : CurveGraph
        The curve.
    node_of_point : (n,) int32
        The node of every point of the cloud.
    contracted : (m, 3) float64
        The contracted points that the curve stands on, in the order of the trace's.
    warnings : tuple of CurveWarning
        Where the curve may be wrong, and what to know of it, places in normalised coordinates.
    """

    graph: CurveGraph
    node_of_point: Indices
    contracted: Points
    warnings: tuple[CurveWarning, ...] = ()
