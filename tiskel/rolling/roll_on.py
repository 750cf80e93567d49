"""The stage ``roll`` without a chart: over joints, ends and caps of a whole body, or any implicit surface."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import Numbers
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import RollSettings
from tiskel.progress import Report, Span
from tiskel.rolling.ambient import AmbientRate, Ground, frame_about
from tiskel.rolling.begin import first_place, radius_of
from tiskel.rolling.free_endings import Watch, finite, watches
from tiskel.rolling.free_reading import read_free
from tiskel.rolling.free_solution import solve_stretches
from tiskel.rolling.inputs import Inputs, constant
from tiskel.rolling.second import Surroundings
from tiskel.rolling.solution import duration_of, longest_step, told_of
from tiskel.rolling.trajectory import RollStatus, Trajectory
from tiskel.surfaces.implicit import ImplicitSurface


def roll_on(
    surface: ImplicitSurface, params: RollParams | None = None, inputs: Inputs | None = None, *,
    progress: Report | None = None, **settings: Unpack[RollSettings],
) -> Trajectory:  # fmt: skip
    """Roll a sphere over a surface that has no chart (see :mod:`tiskel.rolling.ambient`).

    Parameters
    ----------
    surface : ImplicitSurface
        The surface of a whole body, or an analytic one; lengths in any unit.
    params : RollParams, optional
        The contact begins at the surface's place at start_at; on surfaces of clouds, without it, where the body is as
        thick as usual. attitude and heading set how sphere and contact frame begin. model, start, normals and
        neighbours do not count.
    inputs : Inputs, optional
        omega and V over time, in place of those of the settings.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the run.
    **settings
        Those of :class:`tiskel.RollParams` by name; over those of params.

    Returns
    -------
    Trajectory
        u_o and v_o are NaN; u_s, v_s and psi are those of the carried frame.

    Raises
    ------
    TiskelError
        Where the start is missing or far from the surface, the sphere cannot stand there, or has no radius.

    Examples
    --------
    Over the end of a capsule, once around through both caps: 2 (length + pi (r + R_s)) / R_s of turning.

    >>> from math import pi
    >>> from tiskel import RollParams, roll_on
    >>> from tiskel.surfaces.implicit_bodies import Capsule
    >>> body = Capsule((-1, 0, 0), (1, 0, 0), 0.5)
    >>> p = RollParams(radius=0.25, start_at=(0, 0, 0.5), heading=(1, 0, 0), omega=(1, 0, 0), duration=16 + 6 * pi)
    >>> r = roll_on(body, p)
    >>> r.status.value, (abs(r.contact[-1] - [0, 0, 0.5]) < 1e-5).all().item()
    ('finished', True)
    """
    span = Span(progress, "roll")
    span.at(0, "start")
    params = replace(settled(RollParams, params, settings), model="body")
    inputs = inputs or constant(params)
    ground = Ground(surface, params.sigma, radius_of(surface, params.radius))
    around = Surroundings.of(ground)
    rate = AmbientRate(ground, inputs, params.twist, first_place(ground, around, params))
    start = _start(rate, params)
    watched = watches(rate, around, params)
    _check_start(rate, watched, start)
    duration = duration_of(params, inputs)
    told = rate if progress is None else told_of(rate, duration, span)
    found = solve_stretches(rate, told, start, duration, longest_step(inputs, ground.radius), params, around, watched)
    span.at(1)
    return read_free(rate, found, params)


def _start(rate: AmbientRate, params: RollParams) -> Numbers:
    """Return the state (10,) to begin with."""
    frame = frame_about(rate.ground.touch(rate.origin).z, params.heading)
    attitude = np.array(params.attitude) / np.linalg.norm(params.attitude)
    return np.asarray(np.concatenate([np.zeros(3), attitude, frame[:, 0]]))


def _check_start(rate: AmbientRate, watched: list[Watch], start: Numbers) -> None:
    """Raise where the sphere cannot stand at the start."""
    for watch in watched:
        if not watch(0.0, start) > 0:
            side = "outside" if rate.ground.sigma > 0 else "inside"
            advice = "take a smaller one or start elsewhere" if watch.status is RollStatus.TIGHT else "start elsewhere"
            raise TiskelError(
                f"a sphere of radius {rate.ground.radius:.4g} cannot stand {side} at "
                f"{','.join(f'{x:.4g}' for x in rate.origin)}: {watch.what}; {advice}"
            )
    if not finite(rate(0.0, start)):
        raise TiskelError(f"nothing is known of the surface at {rate.origin.tolist()}; start elsewhere")
