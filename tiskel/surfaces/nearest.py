"""The place of a surface that is nearest to a point."""

from math import pi

import numpy as np

from tiskel.arrays import Numbers, Table
from tiskel.errors import TiskelError
from tiskel.surfaces.jets import ParametricSurface

GRID = 96, 400  # first guesses around and along
EDGE = 10.0  # of v, that the first guesses go to where a surface has no end
ROUNDS, ENOUGH = 50, 1e-14  # Newton steps; the last one, in radians
LONGEST = 0.3  # of a step; beyond the first guesses it grows with the way: by 0.3 a round, to a million in all


def even_places(surface: ParametricSurface, around: int, along: int) -> tuple[Table, Table]:
    """Return u and v (along, around) of an even grid; a surface without end in v is taken from -10 to 10."""
    low, high = surface.v_range
    period = surface.periods[1]
    span = (0.0, period) if period else (max(low, -EDGE), min(high, EDGE))
    u, v = np.meshgrid(np.linspace(0, 2 * pi, around, endpoint=False), np.linspace(*span, along))
    return u, v


def nearest_place(surface: ParametricSurface, point: Numbers) -> tuple[float, float]:
    """Return u and v of the place nearest to a point (3,), v held to the branch.

    Newton's method on the distance from the best place of a grid, with steps of
    Gauss and Newton where the distance is not convex.

    Raises
    ------
    TiskelError
        For a point that is not finite.

    Examples
    --------
    >>> from tiskel.surfaces.analytic import cylinder
    >>> u, v = nearest_place(cylinder(2.0), np.array([1.5, 0.0, 3.0]))
    >>> f"{u:.4f} {v:.4f}"
    '1.5708 1.5000'
    """
    if not np.isfinite(point).all():
        raise TiskelError(f"a point needs three finite coordinates, got {point.tolist()}")
    u, v = even_places(surface, *GRID)
    off = np.stack(np.broadcast_arrays(*surface.jet(u, v).f), axis=-1) - point
    best = np.unravel_index(int((off**2).sum(axis=-1).argmin()), u.shape)
    return refined_place(surface, point, float(u[best]), float(v[best]))


def refined_place(surface: ParametricSurface, point: Numbers, u: float, v: float) -> tuple[float, float]:
    """Return u and v of the place nearest to a point (3,), from a good guess."""
    low, high = surface.v_range
    for _ in range(ROUNDS):
        f, f_u, f_v, f_uu, f_uv, f_vv = (np.array(part, float) for part in surface.jet(u, v))
        off = f - point
        slope = np.array([off @ f_u, off @ f_v])
        metric = np.array([[f_u @ f_u, f_u @ f_v], [f_u @ f_v, f_v @ f_v]])
        hessian = metric + np.array([[off @ f_uu, off @ f_uv], [off @ f_uv, off @ f_vv]])
        convex = hessian[0, 0] > 0 and np.linalg.det(hessian) > 0
        step = np.linalg.solve(hessian if convex else metric, -slope)
        longest = LONGEST * max(1.0, abs(v) - EDGE + 1)
        step *= min(1.0, longest / max(float(np.abs(step).max()), 1e-300))
        after = min(max(v + float(step[1]), low), high)
        moved = max(abs(float(step[0])), abs(after - v))
        u, v = u + float(step[0]), after
        if moved < ENOUGH:
            break
    return u, v
