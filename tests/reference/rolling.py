"""A sphere that rolls, by the contact found as the closest point only: nothing of the contact equations in it."""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tiskel.arrays import Numbers, Points, Stack, Table
from tiskel.surfaces.jets import ParametricSurface
from tiskel.surfaces.nearest import refined_place

Twist = Callable[[float], tuple[Numbers, Numbers]]


def pose_over_time(
    surface: ParametricSurface, sigma: float, radius: float, start: tuple[Numbers, Table, float, float],
    twist: Twist, times: Numbers,
) -> tuple[Points, Stack, Table]:  # fmt: skip
    """Return centres (n, 3), rotations (n, 3, 3) and (u, v) (n, 2) of a sphere that is driven in SE(3).

    Its material at the contact moves by -V, it turns by -omega, both along the
    frame at the closest point; ``start`` is centre, rotation, and a guess of u and v.
    """
    guess = [start[2], start[3]]

    def frame(centre: Numbers) -> tuple[Table, Numbers]:
        guess[:] = refined_place(surface, centre, *guess)
        place = surface.jet(*guess)
        f, f_u = np.array(place.f, float), np.array(place.f_u, float)
        z = (centre - f) / np.linalg.norm(centre - f)
        x = sigma * f_u / np.linalg.norm(f_u)
        return np.stack([x, np.cross(z, x), z], axis=1), f

    def rate(t: float, y: Numbers) -> Numbers:
        centre, rotation = y[:3], y[3:].reshape(3, 3)
        axes, contact = frame(centre)
        omega, velocity = twist(t)
        turning = -axes @ omega
        moving = -axes @ velocity + np.cross(turning, centre - contact)
        spin = np.array([[0, -turning[2], turning[1]], [turning[2], 0, -turning[0]], [-turning[1], turning[0], 0]])
        return np.concatenate([moving, (spin @ rotation).ravel()])

    y0 = np.concatenate([start[0], start[1].ravel()])
    solved = solve_ivp(rate, (0, times[-1]), y0, method="DOP853", rtol=1e-11, atol=1e-12, t_eval=times)
    places = []
    guess[:] = [start[2], start[3]]
    for centre in solved.y[:3].T:
        frame(centre)
        places.append(tuple(guess))
    rotations = Rotation.from_matrix(solved.y[3:].T.reshape(-1, 3, 3)).as_matrix()
    return solved.y[:3].T, rotations, np.array(places)
