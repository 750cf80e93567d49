"""What a solution says: chart, places, poses, margins, and the lengths of both ways."""

import numpy as np

from tiskel.arrays import Floats, Numbers, Points, Stack, Table
from tiskel.geometry.frames import step_lengths
from tiskel.rolling.equations import controllability, margin
from tiskel.rolling.models import RollingModel, tube_of
from tiskel.rolling.solution import Solution
from tiskel.rolling.sphere import chart_of, quaternions_of, rotation_of
from tiskel.surfaces.forms import Forms, forms_of
from tiskel.surfaces.jets import ParametricSurface, Vector

FINE, LEAST = 2000, 10  # places along the ways whose lengths are compared: at least so many in all, and in a step


def read(
    surface: ParametricSurface, model: RollingModel, sigma: float, radius: float, y: Table, psi_start: float
) -> dict[str, Floats]:
    """Return the columns of a trajectory from solved states (n, 6).

    The quaternions are those of F^T Q; Q is reported with the frame of the
    surface as it is. psi begins nearest to where it was started.
    """
    u, v = y[:, 0], y[:, 1]
    own = model.forms(u, v)
    seen = rotation_of(y[:, 2:])
    u_s, v_s, psi = chart_of(np.broadcast_to(np.eye(3), seen.shape), seen)
    v_s, psi = np.unwrap(v_s), np.unwrap(psi)
    psi += 2 * np.pi * np.round((psi_start - psi[0]) / (2 * np.pi))  # as it was given
    jet = surface.jet(u, v)
    forms = forms_of(jet, sigma)
    contact, up = columns(jet.f), columns(forms.z)
    tube = tube_of(surface)
    return {
        "state": np.stack([u, v, u_s, v_s, psi], axis=1),
        "contact": contact,
        "centre": contact + radius * up,
        "normal": up,
        "orientation": quaternions_of(frames_of(forms) @ seen),
        "object_radius": np.full(len(u), np.nan) if tube is None else np.asarray(tube.at(u, v)[1].R),
        "margin": np.asarray(margin(own, radius)),
        "determinant": np.asarray(controllability(own, radius, u_s)),
    }


def ways_of(model: RollingModel, radius: float, solution: Solution) -> Table:
    """Return (n, 2) how far the contact has come over the object and the sphere at every row, from places along both.

    They are two measurements of one length where there is no slip: the first
    integrates the metric of the surface along u and v, the second adds up arcs
    between the places (n, 3) on the sphere that the quaternions say.
    """
    fine = fine_times(solution.steps)
    y = solution.at(fine).T
    (m11, m12), (_, m22) = model.forms(*((y[1:, :2] + y[:-1, :2]) / 2).T).M
    du, dv = np.diff(y[:, :2], axis=0).T
    on_sphere = -rotation_of(y[:, 2:])[:, 2]  # Q^T (-z_o)
    chords = step_lengths(on_sphere)
    arcs = 2 * radius * np.arcsin(np.minimum(chords / 2, 1))
    steps = np.column_stack([np.hypot(m11 * du + m12 * dv, m22 * dv), arcs])
    reached = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    return np.column_stack([np.interp(solution.t, fine, column) for column in reached.T])


def fine_times(steps: Numbers) -> Numbers:
    """Return times that divide the solver's steps (k,) evenly: close where it had to look closely."""
    pieces = max(-(-FINE // (len(steps) - 1)), LEAST)
    return np.interp(np.arange((len(steps) - 1) * pieces + 1) / pieces, np.arange(len(steps)), steps)


def arcs(places: Points) -> Numbers:
    """Return the lengths (n - 1,) of a smooth way between places (n, 3), n odd, exact to the fourth order."""
    chords = step_lengths(places)
    if len(chords) % 2:
        return chords
    pairs = chords[::2] + chords[1::2]
    double = step_lengths(places[::2])
    return np.asarray(
        chords * np.repeat(np.where(pairs > 0, 1 + (pairs - double) / (3 * np.maximum(pairs, 1e-300)), 1), 2)
    )


def frames_of(forms: Forms) -> Stack:
    """Return (n, 3, 3), x, y and z as columns."""
    return np.stack([columns(side) for side in forms[:3]], axis=-1)


def columns(vector: Vector) -> Points:
    """Return (n, 3)."""
    return np.stack(np.broadcast_arrays(*vector), axis=-1)
