"""What a solution without a chart says: places, poses, margins, and the lengths of both ways."""

import numpy as np

from tiskel.arrays import Numbers, Points, Stack, Table
from tiskel.params import RollParams
from tiskel.rolling.ambient import AmbientRate, least_curvature
from tiskel.rolling.free_solution import Stretches
from tiskel.rolling.reading import arcs, fine_times
from tiskel.rolling.solution import even_times
from tiskel.rolling.sphere import chart_of, rotation_of
from tiskel.rolling.trajectory import Trajectory, told_inputs, told_slip
from tiskel.surfaces.implicit import projected

DOUBTFUL = 0.01  # of a run's way: more of it over what is not measured is told


def read_free(rate: AmbientRate, found: Stretches, params: RollParams) -> Trajectory:
    """Return the trajectory of a solved run."""
    ground, t = rate.ground, even_times(found.stop, params.rate)
    y = found.at(t)
    contact = _places(rate, y)
    _, normal, shape = ground.touches(contact)
    frames, turned = frames_along(y[:, 7:10], normal), rotation_of(y[:, 3:7])
    u_s, v_s, psi = chart_of(frames, turned)
    least = least_curvature(shape)
    relative = np.linalg.det(shape + np.eye(3) / ground.radius) * ground.radius  # the eigenvalue along z is 1/R_s
    ways = _ways(rate, found, t)
    lengths = float(ways[-1, 0]), float(ways[-1, 1])
    return Trajectory(
        t=t, state=np.column_stack([np.full((len(t), 2), np.nan), u_s, np.unwrap(v_s), np.unwrap(psi)]),
        contact=contact, centre=contact + ground.radius * normal, orientation=_unit(y[:, 3:7]),
        object_radius=_local_radii(rate, contact), margin=least + 1 / ground.radius,
        determinant=-1 / (relative**2 * ground.radius**2 * np.cos(u_s)), path_object=lengths[0],
        path_sphere=lengths[1], status=found.status, reason=found.reason, evaluations=found.evaluations,
        radius=ground.radius, params=params, normal=normal, inputs=rate.inputs.over(t), ways=ways,
        warnings=(*told_inputs(rate.inputs), *told_slip(rate.inputs, lengths, ground.radius, params),
                  *_doubts(rate, contact, ways[:, 0])),
    )  # fmt: skip


def frames_along(x: Points, normals: Points) -> Stack:
    """Return contact frames (n, 3, 3), x, y and z as columns, from their x axes (n, 3) and normals (n, 3)."""
    x = x - normals * (x * normals).sum(axis=1)[:, None]
    x = x / np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(normals, x), normals], axis=2)


def _places(rate: AmbientRate, y: Table) -> Points:
    """Return the places (n, 3) of states (n, 10), put onto the surface."""
    solved = rate.origin + rate.ground.radius * y[:, :3]
    found = projected(rate.ground.surface, solved)
    return np.asarray(np.where(np.isfinite(found), found, solved))


def _unit(q: Table) -> Table:
    return np.asarray(q / np.linalg.norm(q, axis=1)[:, None])


def _ways(rate: AmbientRate, found: Stretches, t: Numbers) -> Table:
    """Return (n, 2) how far the contact has come over the object and over the sphere at times (n,).

    Measured from places along both, with the two coarsest errors of chords taken
    out (Richardson); what lies between two contacts of a sphere that touches
    twice is no way.
    """
    moments, steps = [], []
    for times, solution in zip(found.times, found.solutions, strict=True):
        fine = fine_times(times)
        y = solution(fine).T
        places = _places(rate, y)
        normal = rate.ground.touches(places)[1]
        own = -np.einsum("nji,nj->ni", rotation_of(y[:, 3:7]), normal) * rate.ground.radius  # Q^T (-z_o)
        moments.append(fine)
        steps.append(np.column_stack([arcs(places), arcs(own)]))
    start = np.zeros((1, 2))
    ends = [np.concatenate([start, np.cumsum(part, axis=0)]) for part in steps]
    begun = np.cumsum([start[0], *(part[-1] for part in ends[:-1])], axis=0)
    reached = np.concatenate([part + first for part, first in zip(ends, begun, strict=True)])
    every = np.concatenate(moments)
    return np.column_stack([np.interp(t, every, column) for column in reached.T])


def _local_radii(rate: AmbientRate, places: Points) -> Numbers:
    """Return (n,) how thick the body is about places, NaN where the surface does not say."""
    known = getattr(rate.ground.surface, "local_radius", None)
    return np.full(len(places), np.nan) if known is None else np.asarray(known(places), float)


def _doubts(rate: AmbientRate, places: Points, way: Numbers) -> tuple[str, ...]:
    """Return how much of the way went over what is not measured."""
    trust = getattr(rate.ground.surface, "trust", None)
    if trust is None or not way[-1] > 0:
        return ()
    steps, worth = np.diff(way), np.asarray(trust(places))[1:]
    said = ((0, "bridged, where there are no points"), (1, "little seen"))
    shares = [(float(steps[worth == kind].sum() / way[-1]), word) for kind, word in said]
    return tuple(f"{100 * share:.0f} % of the way is {word}" for share, word in shares if share >= DOUBTFUL)
