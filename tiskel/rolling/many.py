"""Many spheres that roll at once without slip, with fixed steps: what plans are tried out with."""

from typing import NamedTuple

import numpy as np

from tiskel.arrays import Floats, Numbers, Points, Stack, Table
from tiskel.rolling.ambient import Ground, least_curvature

EYE = np.eye(3)
AFTER, BEFORE = [1, 2, 0], [2, 0, 1]  # axes


class Poses(NamedTuple):
    """Where m spheres are.

    Attributes
    ----------
    place : (m, 3) float64
        Contacts.
    q : (m, 4) float64
        Unit quaternions w, x, y, z of the spheres.
    x : (m, 3) float64
        First axes of the carried frames.
    """

    place: Points
    q: Table
    x: Points

    def of(self, row: int, count: int) -> "Poses":
        """Return one of them, so many times."""
        return Poses(*(np.tile(part[row], (count, 1)) for part in self))

    def at(self, rows: Floats) -> "Poses":
        """Return some of them."""
        return Poses(*(part[rows] for part in self))


class Flown(NamedTuple):
    """What became of them.

    Attributes
    ----------
    poses : Poses
        At the end; NaN where the surface ended before.
    places : (k + 1, m, 3) float64
        Contacts at the rows.
    normals : (k + 1, m, 3) float64
        Normals there, towards the sphere.
    margin : (m,) float64
        Least of lambda_min(K_o) R_s + 1 at the rows.
    """

    poses: Poses
    places: Stack
    normals: Stack
    margin: Numbers


def roll_many(ground: Ground, poses: Poses, omega: Floats, step: float) -> Flown:
    """Roll m spheres by the twist of the object, omega (k + 1, m, 3), rows ``step`` seconds apart, straight in between.

    The classical method of Runge and Kutta, one step a row; what it leaves off
    the surface is put back at the next.
    """
    places, normals, margins = [], [], []
    for row in range(len(omega)):
        off, z, shape = ground.touches(poses.place)
        poses = poses._replace(place=poses.place - off[:, None] * z)
        places.append(poses.place)
        normals.append(z)
        margins.append(least_curvature(shape) * ground.radius + 1)
        if row + 1 < len(omega):
            poses = _stepped(ground, poses, z, shape, omega[row], omega[row + 1], step)
    least = np.min(margins, axis=0)
    return Flown(poses, np.array(places), np.array(normals), np.where(np.isfinite(least), least, -1.0))


def _stepped(
    ground: Ground, poses: Poses, z: Points, shape: Stack, first: Points, last: Points, step: float
) -> Poses:  # fmt: skip
    middle = (first + last) / 2
    a = _rates(ground, poses, z, shape, first)
    b = _rates_at(ground, _moved(poses, a, step / 2), middle)
    c = _rates_at(ground, _moved(poses, b, step / 2), middle)
    d = _rates_at(ground, _moved(poses, c, step), last)
    mean = Poses(*((p + 2 * q + 2 * r + s) / 6 for p, q, r, s in zip(a, b, c, d, strict=True)))
    moved = _moved(poses, mean, step)
    return moved._replace(q=moved.q / np.linalg.norm(moved.q, axis=1)[:, None])


def _moved(poses: Poses, rates: Poses, step: float) -> Poses:
    return Poses(*(part + step * rate for part, rate in zip(poses, rates, strict=True)))


def _rates_at(ground: Ground, poses: Poses, omega: Points) -> Poses:
    _, z, shape = ground.touches(poses.place)
    return _rates(ground, poses, z, shape, omega)


def _rates(ground: Ground, poses: Poses, z: Points, shape: Stack, omega: Points) -> Poses:
    """Return the derivatives of poses (see :mod:`tiskel.rolling.ambient`)."""
    turning = turned(poses.x, z, omega)
    relative = np.nan_to_num(EYE + ground.radius * shape, nan=1.0) + 0.0
    bad = ~np.isfinite(shape).all(axis=(1, 2)) | (np.abs(np.linalg.det(relative)) < 1e-12)
    relative[bad] = EYE
    moving = np.linalg.solve(relative, (ground.radius * crossed(turning, z))[:, :, None])[:, :, 0]
    moving[bad] = np.nan
    carried = -(poses.x * np.einsum("mij,mj->mi", shape, moving)).sum(axis=1)[:, None] * z
    return Poses(np.asarray(moving), quaternion_rates(turning, poses.q), carried)


def turned(x: Points, z: Points, omega: Points) -> Points:
    """Return Omega (m, 3) in the axes of space from the object's omega in the carried frames."""
    x = x - z * (x * z).sum(axis=1)[:, None]
    x = x / np.linalg.norm(x, axis=1)[:, None]
    y = crossed(z, x)
    return -(omega[:, :1] * x + omega[:, 1:2] * y + omega[:, 2:] * z)


def crossed(a: Points, b: Points) -> Points:
    """Return a x b (m, 3); that of NumPy takes four times as long for few."""
    return np.asarray(a[:, AFTER] * b[:, BEFORE] - a[:, BEFORE] * b[:, AFTER])


def quaternion_rates(turning: Points, q: Table) -> Table:
    """Return q' = (0, turning) q / 2 (m, 4)."""
    scalar = -(turning * q[:, 1:]).sum(axis=1)[:, None]
    vector = q[:, :1] * turning + crossed(turning, q[:, 1:])
    return np.asarray(np.concatenate([scalar, vector], axis=1) / 2)
