"""Curve in the air, place by place, from its definition."""

import numpy as np

from tiskel.arrays import Numbers, Points


def widest_gap(place: Points, direction: Numbers, half: float, cloud: Points) -> float:
    """Return the widest angle without points about a place (3,), of those in a slab, no farther than twice the nearest.

    With complex numbers for the plane: the angle of each point, in order, and
    the differences of neighbours round the turn.
    """
    offset = cloud - place
    offset = offset[np.abs(offset @ direction) <= half]
    flat = offset - (offset @ direction)[:, None] * direction
    distance = np.linalg.norm(flat, axis=1)
    if len(flat) == 0:
        return 2 * np.pi
    flat = flat[distance <= 2 * distance.min()]
    x = np.linalg.svd(direction[None])[2][1]
    angles = np.sort(np.angle(flat @ x + 1j * (flat @ np.cross(direction, x))))
    return float(np.diff(np.append(angles, angles[0] + 2 * np.pi)).max())
