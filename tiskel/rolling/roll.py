"""The stage ``roll``: a surface and a twist in, the way of a sphere over the surface out."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import TINY, Numbers
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import RollSettings
from tiskel.progress import Report, Span
from tiskel.rolling.endings import Ending, endings
from tiskel.rolling.equations import frame_turn, margin
from tiskel.rolling.inputs import Inputs, constant, of_the_object
from tiskel.rolling.models import RollingModel, model_of, tube_of
from tiskel.rolling.reading import read, ways_of
from tiskel.rolling.solution import duration_of, solve, told_of
from tiskel.rolling.sphere import orientation, quaternion_of, quaternion_rate, rotation_of
from tiskel.rolling.trajectory import RollStatus, Trajectory, told_inputs, told_slip
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.forms import forms_of
from tiskel.surfaces.jets import ParametricSurface
from tiskel.surfaces.nearest import even_places, nearest_place
from tiskel.surfaces.tube import V_STOP

USUAL_RADIUS = 0.25  # of the surface's median radius
GRID = 72, 200  # places around and along where a sphere that does not fit is tried
COARSE = 16, 32  # and where one that meets points is
FAR = 1.0  # radii of the body, or of the sphere: places to start at that are farther from the surface are none of it


def roll(
    surface: ParametricSurface, params: RollParams | None = None, inputs: Inputs | None = None, *,
    progress: Report | None = None, **settings: Unpack[RollSettings],
) -> Trajectory:  # fmt: skip
    """Roll a sphere over a surface (Wen et al. 2025, corrected; see :mod:`tiskel.rolling.equations`).

    The state is integrated as u_o, v_o and a unit quaternion, so that the poles
    of the sphere's chart are places like others. A run ends early, with a status
    and a reason, where the contact leaves the branch, where the sphere no longer
    fits or meets another part of the cloud, or where the surface folds.

    Parameters
    ----------
    surface : ParametricSurface
        Fitted to a cloud or analytic; lengths in any unit.
    params : RollParams, optional
        Model, side, sphere, twist, duration and tolerances.
    inputs : Inputs, optional
        omega and V over time, in place of those of the settings.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the run.
    **settings
        Those of :class:`tiskel.RollParams` by name; over those of params.

    Returns
    -------
    Trajectory
        State, contact and pose over time, why the run ended, and warnings.

    Raises
    ------
    TiskelError
        Where the sphere cannot stand at the start, its radius is missing on a surface without a skeleton, or the
        model needs another kind of surface.

    Examples
    --------
    Around a cylinder of radius 2, outside: u' = -R_s omega_y / (R + R_s).

    >>> from tiskel import RollParams, roll
    >>> from tiskel.surfaces.analytic import cylinder
    >>> r = roll(cylinder(2.0), RollParams(radius=0.5, omega=(0, 1, 0), start=(0, 0, 0, 0, 0), duration=5))
    >>> f"{r.state[-1, 0]:.6f}"
    '-1.000000'
    >>> r.status.value, r.warnings
    ('finished', ())
    """
    span = Span(progress, "roll")
    span.at(0, "start")
    params = settled(RollParams, params, settings)
    inputs = inputs or constant(params)
    if params.model == "body":
        raise TiskelError("model 'body' rolls over the surface of a whole body; give that one to roll_on")
    radius = params.radius or USUAL_RADIUS * median_radius(surface)
    model = model_of(surface, params, radius)
    watched = endings(surface, model, params, radius)
    start, far = _start(surface, params, radius)
    _check_start(surface, params, radius, start, watched)
    rate = _Rate(model, params, inputs)
    told = rate if progress is None else told_of(rate, duration_of(params, inputs), span)
    solution = solve(told, start, params, inputs, radius, watched)
    ways = ways_of(model, radius, solution)
    lengths = float(ways[-1, 0]), float(ways[-1, 1])
    span.at(1)
    return Trajectory(
        solution.t, **read(surface, model, params.sigma, radius, solution.states, params.start[4]),
        path_object=lengths[0], path_sphere=lengths[1], status=solution.status, reason=solution.reason,
        evaluations=solution.evaluations, radius=radius, params=params, inputs=inputs.over(solution.t), ways=ways,
        warnings=(*far, *told_inputs(inputs), *told_slip(inputs, lengths, radius, params)),
    )  # fmt: skip


def median_radius(surface: ParametricSurface) -> float:
    """Return the median radius of a surface around a skeleton, in its unit of length.

    Raises
    ------
    TiskelError
        For other surfaces: the sphere's radius has to be given.
    """
    if isinstance(surface, FittedSurface):
        return surface.radius
    tube = tube_of(surface)
    if tube is None:
        raise TiskelError("the radius of the sphere is missing; only surfaces around a skeleton suggest one")
    return float(np.median(tube.series.along(np.linspace(0, V_STOP, GRID[1]))[:, 0, 0]))


@dataclass(frozen=True, eq=False)
class _Rate:
    """The right-hand side: derivatives of u_o, v_o and the quaternion of F^T Q, the sphere as the contact sees it."""

    model: RollingModel
    params: RollParams
    inputs: Inputs

    def __call__(self, t: float, y: Numbers) -> tuple[float, ...]:
        u, v, *q = y.tolist()
        forms = self.model.forms(u, v)
        omega, velocity = self.inputs.at(t)
        if self.params.twist != "object":
            turn = self.model.frame(u, v).T if self.params.twist == "world" else rotation_of(y[2:])
            omega, velocity = of_the_object(turn, omega, velocity)
        moving = self.model.rates(u, v, forms, omega, velocity)
        a, b, c = frame_turn(forms, moving)
        # In the axes of the contact frame the sphere turns by -omega, and the frame itself turns.
        return *moving, *quaternion_rate((-omega[0] - a, -omega[1] - b, -omega[2] - c), q)


def _start(surface: ParametricSurface, params: RollParams, radius: float) -> tuple[Numbers, tuple[str, ...]]:
    """Return u_o, v_o and the quaternion to begin with, and a warning where that is far from the place asked for."""
    u, v, u_s, v_s, psi = params.start
    far: tuple[str, ...] = ()
    if params.start_at is not None:
        u, v = nearest_place(surface, np.array(params.start_at))
        place = np.array(surface.jet(u, v).f, float)
        off, tube = float(np.linalg.norm(place - params.start_at)), tube_of(surface)
        if off > FAR * max(radius, 0.0 if tube is None else float(tube.at(u, v)[1].R)):
            where = ",".join(f"{x:.4g}" for x in place)
            far = (f"the place to start at is {off:.4g} away from the surface; the run starts at {where} (--start-at)",)
    low, high = surface.v_range
    if not low <= v <= high:
        raise TiskelError(f"the start v = {v:g} lies outside the branch, where v is from {low:g} to {high:.6g}")
    return np.array([u, v, *quaternion_of(orientation(np.eye(3), u_s, v_s, psi))]), far


def _check_start(
    surface: ParametricSurface, params: RollParams, radius: float, start: Numbers, watched: list[Ending]
) -> None:
    """Raise where the sphere cannot stand at the start."""
    for ending in watched:
        if ending.status is not RollStatus.LEFT and not ending(0.0, start) > 0:
            told = (
                f"a sphere of radius {radius:.4g} cannot stand {params.side} at u = {start[0]:.4g}, v = {start[1]:.4g}"
            )
            tight = ending.status is RollStatus.TIGHT
            advice = _elsewhere(surface, params, radius) if tight else _free(surface, start, watched)
            raise TiskelError(f"{told}: {ending.what}; {advice}")


def _free(surface: ParametricSurface, start: Numbers, watched: list[Ending]) -> str:
    """Return the place nearest to the start, of a coarse grid, where nothing ends a run at once."""
    low, high = surface.v_range
    us, vs = (part.ravel() for part in even_places(surface, *COARSE))
    for i in np.argsort(np.hypot(np.mod(us - start[0] + np.pi, 2 * np.pi) - np.pi, vs - start[1]), kind="stable"):
        if low < vs[i] < high and all(ending(0.0, np.array([us[i], vs[i]])) > 0 for ending in watched):
            return f"start at u = {us[i]:.4g}, v = {vs[i]:.4g}"
    return "there is no place where it could; take another sphere or another branch"


def _elsewhere(surface: ParametricSurface, params: RollParams, radius: float) -> str:
    """Return where a sphere that does not fit at the start would fit, or which sphere would."""
    u, v = even_places(surface, *GRID)
    free = margin(forms_of(surface.jet(u, v), params.sigma), radius)
    if not (free > 0).any():
        largest = 1 / max(float(1 / radius - free.max()), TINY)
        return f"it fits nowhere, a sphere of less than {largest:.4g} somewhere"
    best = np.unravel_index(int(np.argmax(free)), free.shape)
    return f"start at u = {u[best]:.4g}, v = {v[best]:.4g}, or take a smaller one"
