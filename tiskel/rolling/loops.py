"""Closed ways that bring a sphere back to its place in another attitude.

Without spin the attitude changes by holonomy: three straight moves suffice for
nearly every rotation on a plane (Hammersley 1983, Oxford commemoration ball).
On a surface triangles are tried from the place itself, and those that come
nearest are made exact by Newton's method, the least change that does.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from tiskel.arrays import Floats, Mask, Numbers, Points, Table
from tiskel.rolling.ambient import Ground
from tiskel.rolling.courses import bump
from tiskel.rolling.many import Flown, Poses, roll_many
from tiskel.rolling.reachable import FITS, Standing

MOVES, ROWS = 3, 24  # of a loop, and rows of each
TRIED, KEPT, ENOUGH = 320, 10, 3  # random triangles, those that are made exact, and of these enough
LONGEST, SHORTEST = 3.6, 0.2  # radians of a side
NEWTON, MOST = 10, 0.7  # steps, and radians of one
SMALL = 1e-5  # radii and radians that are none
NUDGE = 1e-4  # radians: for differences
LONG = 0.03  # of what a loop is off, per radian of its way: the shorter one of two alike


class Loop(NamedTuple):
    """A closed way, or the best that was found.

    Attributes
    ----------
    moves : (3, 3) float64
        Rotation vectors of the object in the carried frame, one after the other.
    off : float
        What is left, in radii and radians.
    free : bool
        Whether the sphere stands all along.
    """

    moves: Table
    off: float
    free: bool


def moved(ground: Ground, pose: Poses, moves: Floats) -> Flown:
    """Roll from one pose by m triples of moves (m, 3, 3)."""
    profile = np.tile(bump(ROWS)[:-1], MOVES)
    rows = np.repeat(moves, ROWS, axis=1) * profile[None, :, None]
    omega = np.concatenate([rows, np.zeros((len(moves), 1, 3))], axis=1)
    return roll_many(ground, pose.of(0, len(moves)), np.moveaxis(omega, 0, 1), 1 / ROWS)


def missed(ground: Ground, poses: Poses, place: Numbers, attitude: Numbers | None) -> Table:
    """Return (m, 2) what contacts are off a place in radii, along the surface, and (m, 3) radians off an attitude."""
    z = ground.touches(place[None])[1][0]
    x = np.cross(z, [1.0, 0, 0] if abs(z[0]) < 0.8 else [0, 1.0, 0])
    x = x / np.linalg.norm(x)
    off = poses.place - place
    flat = np.stack([off @ x, off @ np.cross(z, x)], axis=1) / ground.radius
    if attitude is None:
        return np.asarray(flat)
    return np.asarray(np.concatenate([flat, turned_by(poses.q, attitude)], axis=1))


def turned_by(q: Table, attitude: Numbers) -> Points:
    """Return rotation vectors (m, 3) from an attitude (4,) to quaternions (m, 4); NaN for those that are none."""
    good: Mask = np.asarray(np.isfinite(q).all(axis=1))
    safe = np.where(good[:, None], q, [1.0, 0, 0, 0])
    order = [1, 2, 3, 0]
    found = (Rotation.from_quat(safe[:, order]) * Rotation.from_quat(attitude[order]).inv()).as_rotvec()
    return np.asarray(np.where(good[:, None], found, np.nan))


def loop_to(
    standing: Standing, pose: Poses, place: Numbers, attitude: Numbers, spin: bool, rng: np.random.Generator
) -> Loop:  # fmt: skip
    """Return the shortest loop found from a pose, of one sphere, back to a place (3,) in an attitude (4,)."""
    ground = standing.ground
    tried = _triangles(spin, rng)
    flown = moved(ground, pose, tried)
    off = np.linalg.norm(missed(ground, flown.poses, place, attitude), axis=1)
    score = np.where(np.isfinite(off) & (flown.margin > FITS), off + LONG * _length(tried), np.inf)
    best = np.argsort(score, kind="stable")[:KEPT]
    best = best[np.isfinite(score[best])]
    if len(best) == 0:
        return Loop(np.zeros((MOVES, 3)), np.inf, False)
    moves, off = _exact(ground, pose, tried[best], place, attitude, spin)
    flown = moved(ground, pose, moves)
    good = (off < SMALL) & (flown.margin > FITS)
    for row in np.argsort(np.where(good, _length(moves), np.inf), kind="stable")[: int(good.sum())].tolist():
        if standing.stands(flown.places[::3, row]).all():
            return Loop(moves[row], float(off[row]), True)
    row = int(np.argmin(np.where(np.isfinite(off), off, np.inf)))
    return Loop(moves[row], float(off[row]), False)


def _triangles(spin: bool, rng: np.random.Generator) -> Floats:
    """Return (TRIED, 3, 3) moves that would close on a plane."""
    lengths = rng.uniform(SHORTEST, LONGEST, (TRIED, 2))
    angles = rng.uniform(0, 2 * np.pi, (TRIED, 2))
    first = np.stack([lengths * np.cos(angles), lengths * np.sin(angles)], axis=2)
    sides = np.concatenate([first, -first.sum(axis=1, keepdims=True)], axis=1)
    turns = rng.uniform(-np.pi, np.pi, (TRIED, MOVES, 1)) * spin
    return np.concatenate([sides, turns], axis=2)


def _length(moves: Floats) -> Numbers:
    return np.asarray(np.linalg.norm(moves, axis=2).sum(axis=1))


def _exact(
    ground: Ground, pose: Poses, moves: Floats, place: Numbers, attitude: Numbers, spin: bool
) -> tuple[Floats, Numbers]:  # fmt: skip
    """Return moves (m, 3, 3) made exact, all at once, and what is left of each (m,)."""
    axes = 3 if spin else 2
    count, size = len(moves), MOVES * axes
    nudges = np.zeros((size, MOVES, 3))
    for number in range(size):
        nudges[number, number // axes, number % axes] = NUDGE
    for _ in range(NEWTON):
        every = np.concatenate([moves[:, None], moves[:, None] + nudges], axis=1).reshape(-1, MOVES, 3)
        off = missed(ground, moved(ground, pose, every).poses, place, attitude).reshape(count, size + 1, 5)
        now = off[:, 0]
        slopes = np.swapaxes(off[:, 1:] - now[:, None], 1, 2) / NUDGE
        known: Mask = np.asarray(np.isfinite(off).all(axis=(1, 2)))
        step = -np.einsum("mij,mj->mi", np.linalg.pinv(np.where(known[:, None, None], slopes, 0), rcond=1e-3),
                          np.where(known[:, None], now, 0))  # fmt: skip
        length = np.linalg.norm(step, axis=1, keepdims=True)
        step *= np.minimum(1, MOST / np.maximum(length, 1e-300))
        moves = moves.copy()
        moves[:, :, :axes] += step.reshape(count, MOVES, axes)
        if (np.linalg.norm(now[known], axis=1) < SMALL).sum() >= min(ENOUGH, count):
            break
    left = np.linalg.norm(missed(ground, moved(ground, pose, moves).poses, place, attitude), axis=1)
    return moves, np.where(np.isfinite(left), left, np.inf)
