"""Bulky bodies with limbs: superellipsoids and sweeps, whose skeletons are middle lines from joint to joint."""

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Body, Part, joined
from tiskel.gallery.solids import superellipsoid
from tiskel.gallery.sweep import Axes, Sweep, spline

Limb = tuple[Part, Points, Numbers]  # the solid, its middle line, the radii there


def _tapered(first: float, last: float) -> Axes:
    return lambda t: (first + (last - first) * t, first + (last - first) * t)


def _limb(path: npt.ArrayLike, first: float, last: float, root: npt.ArrayLike) -> Limb:
    """Return a limb along a path that begins inside the trunk, and its curve from the root in the trunk's middle."""
    sweep = Sweep(spline(path), _tapered(first, last), up=(0.0, 1.0, 0.0))
    line, radii = sweep.axis(24)
    return sweep.part(), np.concatenate([[np.asarray(root, dtype=float)], line]), np.concatenate([radii[:1], radii])


def torso() -> Body:
    """A bulky trunk with a neck and a head, two arms and two legs: five ends."""
    half, power = np.array([0.36, 0.24, 0.55]), 3.0
    shoulders, hips, head = (0.0, 0.0, 0.34), (0.0, 0.0, -0.34), (0.0, 0.0, 0.92)
    limbs = [
        *(_limb([(s * 0.22, 0, 0.36), (s * 0.5, 0, 0.3), (s * 0.75, 0.05, -0.05), (s * 0.8, 0.15, -0.4)],
                0.11, 0.06, shoulders) for s in (-1, 1)),
        *(_limb([(s * 0.18, 0, -0.42), (s * 0.2, 0, -0.8), (s * 0.22, 0.03, -1.2), (s * 0.22, 0, -1.6)],
                0.15, 0.08, hips) for s in (-1, 1)),
    ]  # fmt: skip
    neck = Sweep(spline([(0, 0, z) for z in (0.4, 0.55, 0.7, 0.9)]), _tapered(0.1, 0.1), (0.0, 1.0, 0.0))
    z = np.array([-0.34, -0.2, 0.0, 0.2, 0.34, 0.5, 0.65, 0.8, 0.92])
    girth = np.sqrt(half[0] * half[1] * 1.13) * np.maximum(1 - np.abs(z / half[2]) ** power, 0) ** (1 / power)
    spine = np.stack([0 * z, 0 * z, z], axis=1), np.where(z > 0.75, 0.18, np.maximum(girth, 0.1))
    solids = superellipsoid((0, 0, 0), half, power), superellipsoid(head, (0.17, 0.19, 0.22)), neck.part()
    return _united(spine, limbs, solids, 0.06)


def knobs() -> Body:
    """A spheroid with two ears, and a tail, short against its thickness: five ends."""
    half = np.array([0.32, 0.32, 0.7])
    focal = half[2] - half[0] ** 2 / half[2]  # where the middle line of a spheroid ends
    z = np.unique(np.concatenate([np.linspace(-focal, focal, 13), [0.3, -0.2]]))
    spine = np.stack([0 * z, 0 * z, z], axis=1), half[0] * np.sqrt(1 - (z / half[2]) ** 2)
    ears = [_limb([(s * 0.15, 0.1, 0.35), (s * 0.3, 0.2, 0.42), (s * 0.45, 0.3, 0.5)], 0.1, 0.08, (0, 0, 0.3))
            for s in (-1, 1)]  # fmt: skip
    tail = _limb([(0, -0.15, -0.22), (0, -0.35, -0.25), (0, -0.55, -0.28)], 0.09, 0.07, (0, 0, -0.2))
    return _united(spine, [*ears, tail], (superellipsoid((0, 0, 0), half),), 0.07)


def _united(spine: tuple[Points, Numbers], limbs: list[Limb], solids: tuple[Part, ...], unit: float) -> Body:
    """Return the body of a trunk and limbs, whose roots are nodes of the spine."""
    lines = [spine[0], *(line for _, line, _ in limbs)]
    radii = [spine[1], *(r for _, _, r in limbs)]
    return joined(lines, radii, [*solids, *(part for part, _, _ in limbs)], unit)
