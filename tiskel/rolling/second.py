"""Where a sphere that stands on a surface touches it a second time, and what of a cloud lies in it."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from tiskel.arrays import TINY, Mask, Numbers, Points
from tiskel.geometry.strays import body_of
from tiskel.rolling.ambient import EYE, Ground, least_curvature
from tiskel.surfaces.implicit import projected

NEAR = 1.15  # radii from the centre: what is nearer may be a second contact
APART = 0.75  # radii between two contacts at least: in a hollow that is bent less than the sphere there is but one
LOOKS = 256  # directions in which a surface without a cloud is looked for; about 13 degrees apart
ROOM, SLIGHT = 0.15, 0.04  # of the radius: how deep points may lie in a sphere that is free, by its contact and away
BATCH = 1024  # spheres at a time
STEEP = 0.1  # of 1 + h S at least for a step of Newton, else one straight downhill
FOOT_STEPS, STRIDE, STILL = (
    40,
    0.4,
    1e-10,
)  # of the way to the nearest place: steps, the longest one and the last, radii


class Second(NamedTuple):
    """The place that a sphere comes to next.

    Attributes
    ----------
    gap : float
        Between sphere and place, in the sphere's radii, negative inside; 0.15 where there is none nearer.
    place : (3,) float64 or None
        On the surface.
    """

    gap: float
    place: Numbers | None


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A ground and what is known to lie on it.

    Attributes
    ----------
    ground : Ground
        Surface, side and sphere.
    cloud : (n, 3) float64 or None
        Points of the surface, without stray ones; None where it has no cloud.
    """

    ground: Ground
    cloud: Points | None
    _tree: Any = field(default=None, repr=False)

    @staticmethod
    def of(ground: Ground) -> "Surroundings":
        """Return the surroundings of a ground, with the cloud that its surface was fitted to where it has one."""
        from scipy.spatial import cKDTree

        cloud = getattr(ground.surface, "cloud", None)
        if cloud is None:
            return Surroundings(ground, None)
        body = body_of(cloud)
        return Surroundings(ground, body, cKDTree(body))

    def clear(self, centres: Points) -> Numbers:
        """Return (n,) how far the nearest point of the cloud is from centres (n, 3), in radii; infinite without one."""
        if self._tree is None:
            return np.full(len(centres), np.inf)
        return np.asarray(self._tree.query(centres)[0] / self.ground.radius)

    def free(self, contacts: Points, centres: Points) -> Mask:
        """Return (n,) whether spheres about centres (n, 3) meet nothing but their contacts (n, 3)."""
        known = np.isfinite(centres).all(axis=1)
        out = np.zeros(len(centres), bool)
        rows = np.flatnonzero(known)
        for first in range(0, len(rows), BATCH):
            some = rows[first : first + BATCH]
            check = self._free_of_surface if self._tree is None else self._free_of_cloud
            out[some] = check(contacts[some], centres[some])
        return out

    def _free_of_cloud(self, contacts: Points, centres: Points) -> Mask:
        radius = self.ground.radius
        assert self.cloud is not None
        out = np.asarray(self._tree.query(centres)[0] > (1 - ROOM) * radius)
        for row, near in enumerate(self._tree.query_ball_point(centres, (1 - SLIGHT) * radius)):
            away = np.linalg.norm(self.cloud[near] - contacts[row], axis=1) > APART * radius
            out[row] &= not away.any()
        return out

    def _free_of_surface(self, contacts: Points, centres: Points) -> Mask:
        looks = (centres[:, None] + (1 - SLIGHT) * self.ground.radius * directions(LOOKS)).reshape(-1, 3)
        inside = (self.ground.sigma * self.ground.surface.level(looks).value < 0).reshape(len(centres), LOOKS)
        away = np.linalg.norm(looks.reshape(len(centres), LOOKS, 3) - contacts[:, None], axis=2)
        return np.asarray(~(inside & (away > APART * self.ground.radius)).any(axis=1))

    def second(self, contact: Numbers, centre: Numbers) -> Second:
        """Return where the sphere about a centre (3,) comes nearest to the surface besides its contact (3,)."""
        radius = self.ground.radius
        none = Second(NEAR - 1, None)
        found = self._candidates(contact, centre)
        if len(found) == 0:
            return none
        start = found[np.argmin(np.linalg.norm(found - centre, axis=1))]
        foot = nearest_foot(self.ground, start, centre, contact)
        gap = np.inf if foot is None else float(np.linalg.norm(foot - centre)) / radius - 1
        return Second(gap, foot) if gap < NEAR - 1 else none

    def _candidates(self, contact: Numbers, centre: Numbers) -> Points:
        """Return places (k, 3) near the sphere and away from its contact: of the cloud, else of the surface itself."""
        radius = self.ground.radius
        if self._tree is not None and self.cloud is not None:
            near = self.cloud[self._tree.query_ball_point(centre, NEAR * radius)]
        else:
            looks = centre + radius * directions(LOOKS)
            value, gradient, _ = self.ground.surface.level(looks)
            off = self.ground.sigma * value / np.maximum(np.linalg.norm(gradient, axis=1), TINY)
            away = np.linalg.norm(looks - contact, axis=1) > APART * radius
            looks = looks[away & (off < 2 * (NEAR - 1) * radius)]
            near = projected(self.ground.surface, looks) if len(looks) else looks
            near = near[np.linalg.norm(near - centre, axis=1) < NEAR * radius]
        return np.asarray(near[np.linalg.norm(near - contact, axis=1) > APART * radius])


def nearest_foot(ground: Ground, start: Numbers, point: Numbers, contact: Numbers) -> Numbers | None:
    """Return the place (3,) of a surface that is nearest to a point (3,), going downhill from a start (3,) near it.

    Newton's method: with d the offset in the tangent plane and h that along the
    normal, (I + h S) step = d; None where it comes to the contact (3,), leaves the
    surface, or does not end.
    """
    foot = start
    for _ in range(FOOT_STEPS):
        off, z, shape = ground.touch(foot)
        offset = point - foot
        high = float(offset @ z)
        tangent = offset - high * z
        bend = EYE + high * shape
        curved = 1 + high * float(least_curvature(shape[None])[0]) > STEEP
        step = np.linalg.solve(bend, tangent) if curved else tangent
        length = float(np.sqrt(step @ step))
        if not np.isfinite(length) or np.linalg.norm(foot - contact) < APART * ground.radius:
            return None
        if length < STILL * ground.radius and abs(off) < STILL * ground.radius:
            return foot
        foot = foot + step * min(1.0, STRIDE * ground.radius / max(length, TINY)) - off * z
    return None


def directions(count: int) -> Points:
    """Return unit vectors (count, 3) that are spread evenly, along a spiral (Fibonacci's, Gonzalez 2010)."""
    height = 1 - (2 * np.arange(count) + 1) / count
    angle = np.pi * (1 + np.sqrt(5)) * np.arange(count)
    across = np.sqrt(1 - height**2)
    return np.stack([across * np.cos(angle), across * np.sin(angle), height], axis=1)
