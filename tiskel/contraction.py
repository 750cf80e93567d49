"""The stage ``contract``: a cloud in, a contracted cloud out, with the record of how."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import (
    Frame,
    Indices,
    Mask,
    Points,
    PointsLike,
    Stack,
    as_weights,
    check_solid,
    finite_rows,
    first_of_duplicates,
    normalisation,
)
from tiskel.errors import TiskelError
from tiskel.geometry.given import given_cloud
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.geometry.rings import Rings
from tiskel.geometry.scatter import doubts_about
from tiskel.geometry.strays import stray_points
from tiskel.methods import METHODS
from tiskel.methods.trace import Sections, Status, StepRecord, Trace, remarks, survivors
from tiskel.params import ContractionParams
from tiskel.params.given import Unpack, settled_method
from tiskel.params.keywords import MethodSettings
from tiskel.progress import Report, Span
from tiskel.shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Contraction(Shown):
    """A contracted cloud and where it came from; coordinates in the input's units.

    Attributes
    ----------
    points : (m, 3) float64
        The points that are left, contracted.
    origin : (m, 3) float64
        Where they were.
    rows : (m,) int32
        Their rows in the cloud.
    cloud : (n, 3) float64
        The finite points of the input.
    input_rows : (n,) int32
        Their rows in the input.
    merged_into : (n,) int32
        Row of the cloud that each removed point was merged into, -1 for the others.
    merged_step : (n,) int32
        The step of that, from 1; 0 for a duplicate or a stray point, which no method sees; -1 for points that are left.
    history : (k, m, 3) float64
        Positions of the points that are left, after each step; none (k = 0) where a file was written without.
    steps : tuple of StepRecord
        One record per accepted step.
    status : Status
        Why the contraction stopped.
    warnings : tuple of str
        What a user should know about the input or the result.
    params : RobustParams, LbcParams or GlsParams
        The settings.
    rings : Rings or None
        The ring of each point, by place in ``points``, merged rings for gls; None by robust, which has none.
    sections : Sections or None
        By robust: the section that each point belongs to, a connected piece of what the last front passed in one bin
        of distance, and the number of the bin. None by the others.
    surface : MeshSurface or None
        By robust, of points on a mesh: what it knows about each of ``points``.
    prepared : object
        What the method worked out about the cloud, so that the curve need not do it again; not in files.
    ring_seconds : float
        Wall time of neighbours and rings.

    Examples
    --------
    >>> from tiskel import LbcParams, contract, make_shape, shape_graph
    >>> c = contract(make_shape(shape_graph("capsule"))[0], LbcParams(max_steps=2))
    >>> len(c.steps), c.status.value, c.points.shape == c.origin.shape
    (2, 'step limit', True)
    """

    _said = ("params.method", "points", "cloud", "steps", "status", "warnings")

    points: Points
    origin: Points
    rows: Indices
    cloud: Points
    input_rows: Indices
    merged_into: Indices
    merged_step: Indices
    history: Stack
    steps: tuple[StepRecord, ...]
    status: Status
    warnings: tuple[str, ...]
    params: ContractionParams
    rings: Rings | None = None
    sections: Sections | None = None
    surface: MeshSurface | None = None
    prepared: Any = field(default=None, repr=False)
    ring_seconds: float = 0.0

    def survivor_of(self) -> Indices:
        """Return (n,), for each point of the cloud the place in ``points`` of the one it ended up in."""
        return survivors(self.rows, self.merged_into)

    @property
    def strays(self) -> Mask:
        """(n,) which points of the cloud are stray, see :mod:`tiskel.geometry.strays`."""
        into = np.where(self.merged_into < 0, np.arange(len(self.cloud)), self.merged_into)
        return np.asarray((self.merged_step == 0) & (self.cloud != self.cloud[into]).any(axis=1))

    def as_trace(self) -> tuple[Trace, Frame]:
        """Return what the method's curve needs, and the way back.

        In normalised coordinates, without the history and without stray points.
        """
        body = np.flatnonzero(~self.strays)
        frame = normalisation(self.cloud[body], self.params.normalise)
        place = np.full(len(self.cloud) + 1, -1, np.int32)
        place[body] = np.arange(len(body), dtype=np.int32)
        trace = Trace(
            cloud=frame.apply(self.cloud[body]),
            points=frame.apply(self.points),
            rows=place[self.rows],
            merged_into=place[self.merged_into[body]],
            merged_step=self.merged_step[body],
            history=(),
            steps=self.steps,
            status=self.status,
            rings=self.rings,
            sections=self.sections,
            surface=self.surface and self.surface.scaled(frame.scale),
            prepared=self.prepared,
        )
        return trace, frame


def contract(
    points: PointsLike, params: ContractionParams | None = None, weights: npt.ArrayLike | None = None,
    surface: MeshSurface | None = None, *, progress: Report | None = None, **settings: Unpack[MethodSettings],
) -> Contraction:  # fmt: skip
    """Contract a cloud towards its medial curve.

    Methods: "robust", by fronts over the original cloud (:mod:`tiskel.methods.robust.fronts`),
    "gls", GLSkeleton (Wen et al. 2024), and "lbc", Laplacian-based contraction
    (Cao et al. 2010). Departures from print are listed in :mod:`tiskel.methods.laplacian.lbc` and
    :mod:`tiskel.methods.laplacian.reduction`.

    Parameters
    ----------
    points : (n, 3) array, Cloud, or an object of Open3D or trimesh, in any unit; a mesh is sampled. Rows that are
        not finite are dropped and exact duplicates merged; both are counted in the warnings. Stray points
        (:mod:`tiskel.geometry.strays`) stay in the cloud, but no method sees them.
    params : settings.
    **settings : the same by name, ``method`` among them; over those of params.
    weights : (n,) positive, for lbc and gls: what W_L is multiplied by at each
        point. Thick parts contract more slowly; one weight for each semantic part
        evens that out (S-LBC, Meyer et al. 2023).
    surface : what is known of the mesh that the points lie on, a row for each, see
        :class:`tiskel.geometry.mesh_surface.MeshSurface`; ``load_cloud`` gives it. Only robust uses it.
    progress : called with a :class:`tiskel.Progress` as parts begin; what it raises ends the contraction.

    Returns
    -------
    Contraction

    Raises
    ------
    TiskelError
        Fewer than ten distinct finite points, all points on a plane or a line,
        settings or weights that do not fit, or a first step that has no solution.

    Examples
    --------
    >>> from tiskel import GlsParams, contract, make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("capsule"))
    >>> contract(cloud).params.method
    'robust'
    >>> len(contract(cloud, GlsParams(), max_steps=2).points) < len(cloud)
    True
    """
    params, span = settled_method(params, settings), Span(progress, "contract")
    span.at(0, "cloud")
    every, known_mesh = given_cloud(points)
    surface = known_mesh if surface is None else surface
    finite = finite_rows(every)
    cloud, input_rows = np.ascontiguousarray(every[finite]), np.flatnonzero(finite).astype(np.int32)
    if len(cloud) == 0:
        raise TiskelError(f"the cloud holds no finite point ({len(every)} rows in all); check the file")
    first = first_of_duplicates(cloud)  # of a stray point, later on, the nearest of the others
    stray = stray_points(cloud, first)
    distinct = np.flatnonzero((first == np.arange(len(cloud))) & ~stray).astype(np.int32)
    check_solid(cloud[distinct])
    frame = normalisation(cloud[distinct], params.normalise)
    chosen = None if weights is None else as_weights(weights, len(every))[finite][distinct]
    known = None if surface is None else surface.checked(len(every)).at(input_rows[distinct])
    scaled = known and known.scaled(frame.scale)
    placed, body = params.placed(frame.place), frame.apply(cloud[distinct])
    trace = METHODS[params.method].contract(body, placed, chosen, scaled, span)
    if not trace.steps:
        raise TiskelError(f"contraction failed in its first step: {trace.status.advice}; try --voxel or --outliers")
    warnings = remarks(len(every) - len(cloud), int((~stray).sum()) - len(distinct), trace.status)
    warnings += doubts_about(body)
    if stray.any():
        first[stray] = distinct[cKDTree(cloud[distinct]).query(cloud[stray])[1]]
    trace = replace(trace, surface=known if trace.sections is not None else None)
    span.at(1)
    return _assembled(trace, frame, cloud, input_rows, first, distinct, warnings, params)


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
        cloud=cloud,
        input_rows=input_rows,
        merged_into=merged_into,
        merged_step=merged_step,
        history=np.stack([frame.undo(positions) for positions in history]),
        steps=trace.steps,
        status=trace.status,
        warnings=warnings,
        params=params,
        rings=trace.rings,
        sections=trace.sections,
        surface=trace.surface,
        prepared=trace.prepared,
        ring_seconds=trace.ring_seconds,
    )
