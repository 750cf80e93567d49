"""Ways over a surface pulled tight, and the twists that roll a sphere along them."""

from typing import Any

import numpy as np

from tiskel.arrays import Floats, Numbers, Points, Table
from tiskel.geometry.frames import step_lengths
from tiskel.rolling.many import Poses, roll_many
from tiskel.rolling.reachable import Standing
from tiskel.surfaces.implicit import projected

LEVELS = (2.0, 1.0, 0.5, 0.25)  # radii of the sphere between the places that are pulled, coarse first
BLOCKS, PULLS = 8, 6  # of each level; after every block it is looked whether the sphere still stands everywhere
CLOSE = 0.06  # radii of the sphere between places where a way is looked at once more
ROW = 0.08  # radians that the sphere turns from row to row at most
RAMP = 1.0  # radians per second per second, as it were: a way begins and ends this smoothly
BACK = 1.5  # of what the centre is off its way, made good per radian


def pulled_tight(standing: Standing, places: Points) -> Points:
    """Return the way (m, 3) between the ends of places (k, 3) that is nearly the shortest for the sphere's centre.

    Every place goes to the middle of its neighbours, over the surface that is a
    radius away; where the sphere could not stand it stays.
    """
    ground = standing.ground
    for level in LEVELS:
        places = _resampled(standing, places, level * ground.radius)
        held = np.zeros(len(places), bool)
        held[[0, -1]] = True
        for _ in range(BLOCKS if len(places) > 2 else 0):
            before = places
            for _ in range(PULLS):
                places = _pulled(standing, places, held)
            bad = ~standing.stands(places)
            bad[[0, -1]] = False
            if bad.any():
                places = np.where(bad[:, None], before, places)
                held |= bad
    return places


def tight_centres(standing: Standing, places: Points) -> Points:
    """Return centres (n, 3) between places (m, 3) of a way, closely looked at, where the sphere does not stand."""
    ground = standing.ground
    centres = places + ground.radius * ground.touches(places)[1]
    far = np.concatenate([[0.0], np.cumsum(step_lengths(centres))])
    even = np.linspace(0, far[-1], int(far[-1] / (CLOSE * ground.radius)) + 2)
    between = projected(ground.surface, np.column_stack([np.interp(even, far, column) for column in places.T]))
    bad = ~standing.stands(between)
    bad[[0, -1]] = False
    found = between[bad] + ground.radius * ground.touches(between[bad])[1]
    return np.asarray(found[np.isfinite(found).all(axis=1)])


def _resampled(standing: Standing, places: Points, spacing: float) -> Points:
    """Return places about so far apart, by the way of the centre; between two that stand another one may not."""
    ground = standing.ground
    centres = places + ground.radius * ground.touches(places)[1]
    far = np.concatenate([[0.0], np.cumsum(step_lengths(centres))])
    count = max(int(np.ceil(far[-1] / spacing)), 1) + 1
    even = np.linspace(0, far[-1], count)
    found = projected(ground.surface, np.column_stack([np.interp(even, far, column) for column in places.T]))
    found[[0, -1]] = places[[0, -1]]
    bad = ~standing.stands(found)
    nearest = places[np.abs(far[None] - even[bad][:, None]).argmin(axis=1)]
    found[bad] = nearest
    return found


def _pulled(standing: Standing, places: Points, held: Any) -> Points:
    ground = standing.ground
    off, z, shape = ground.touches(places)
    centres = places + ground.radius * z
    pull = np.zeros_like(places)
    pull[1:-1] = (centres[:-2] + centres[2:]) / 2 - centres[1:-1]
    pull -= z * (pull * z).sum(axis=1)[:, None]
    step = np.linalg.solve(np.eye(3) + ground.radius * shape, pull[:, :, None])[:, :, 0]
    length = np.linalg.norm(step, axis=1, keepdims=True)
    step *= np.minimum(1, ground.radius / np.maximum(length, 1e-300))
    moved = places + step - off[:, None] * z
    return np.where(held[:, None] | ~np.isfinite(moved), places, moved)


def clock(angle: float) -> tuple[Numbers, float]:
    """Return shares (k + 1,) of a way that takes so many radians, at even times, and the seconds between these.

    It begins and ends at rest, without a jump of acceleration; in between the
    sphere turns by a radian per second.
    """
    ramp = min(RAMP, angle)
    whole = angle + ramp
    rows = max(int(np.ceil(whole / ROW)), 12)
    t = np.linspace(0, whole, rows + 1)

    def begun(u: Numbers) -> Numbers:
        u = np.clip(u, 0, 1)
        return np.asarray(ramp * (u**3 - u**4 / 2))

    cruise = np.clip(t - ramp, 0, angle - ramp)
    gone = begun(t / ramp) + cruise + ramp / 2 - begun((whole - t) / ramp)
    return gone / angle, whole / rows


def tracked(standing: Standing, pose: Poses, places: Points) -> tuple[Table, float, Poses]:
    """Return the twist of the object (k + 1, 3) that rolls a sphere from a pose along places (m, 3), without spin.

    In the carried frame, with the seconds between rows and the pose at the end.
    What it is off the way is made good on the way, so that the twist holds when
    it is rolled again.
    """
    from scipy.interpolate import CubicSpline

    ground = standing.ground
    centres = places + ground.radius * ground.touches(places)[1]
    far = np.concatenate([[0.0], np.cumsum(step_lengths(centres))])
    if len(places) < 2 or not far[-1] > 0:
        return np.zeros((2, 3)), 1.0, pose
    keep = np.concatenate([[True], np.diff(far) > 1e-9 * far[-1]])
    spline = CubicSpline(far[keep], centres[keep]) if keep.sum() > 2 else _straight(far[[0, -1]], centres[[0, -1]])
    shares, step = clock(float(far[-1]) / ground.radius)
    aims = spline(shares * far[-1])
    speeds = np.gradient(aims, step, axis=0)
    omega, last = np.zeros((len(aims), 3)), np.zeros(3)
    for row in range(len(aims) - 1):
        wanted = _towards(ground.radius, ground.touches(pose.place)[1][0], pose, speeds[row], aims[row])
        # The twist at the next row goes on as it changed: its pose is not known yet.
        omega[row + 1] = 2 * wanted - last if 0 < row < len(aims) - 2 else wanted * (row < len(aims) - 2)
        last = wanted
        pose = roll_many(ground, pose, omega[row : row + 2, None], step).poses
    return omega, step, pose


def _straight(far: Numbers, ends: Points) -> Any:
    return lambda s: ends[0] + (s / far[-1])[:, None] * (ends[1] - ends[0])


def _towards(radius: float, z: Numbers, pose: Poses, speed: Numbers, aim: Numbers) -> Numbers:
    """Return omega (3,) in the carried frame that moves the centre as it should, and back to its way."""
    centre = pose.place[0] + radius * z
    moving = speed + BACK * (aim - centre)
    turning = np.cross(z, moving) / radius
    x = pose.x[0] - z * (pose.x[0] @ z)
    x = x / np.linalg.norm(x)
    return np.array([-(turning @ x), -(turning @ np.cross(z, x)), 0.0])


def bump(rows: int) -> Floats:
    """Return (rows + 1,) a smooth rise and fall whose integral by straight pieces of length 1 / rows is 1."""
    u = np.linspace(0, 1, rows + 1)
    values = np.sin(np.pi * u) ** 2
    values[[0, -1]] = 0
    return np.asarray(values / (values.sum() / rows))
