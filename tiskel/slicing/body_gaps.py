"""Where a cloud has gaps, and what closes them: places where the winding number says that the body ends.

Where points are missing the generalised winding number (see
:mod:`tiskel.geometry.oriented`) still goes from one inside to zero outside, and a
half lies about where the surface would be: a smooth lid on a hole, a flat one on
an open end.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Points
from tiskel.geometry.marching import marched
from tiskel.geometry.oriented import INSIDE, OrientedCloud
from tiskel.geometry.spacing import NEIGHBOURS, spacings_from

WIDE = 2.0  # local spacings from the nearest point: at random that is there at one of 300 000 points
RIM, BESIDE = 1.0, 4.0  # the same for places that are so many spacings from those: the rest of the gap
STEP = 1.5  # median spacings from place to place of the grid
MOST = 60_000  # cells of it; of more, the grid is coarser
DROP = 0.05  # how far off a half the winding number may be at a lid: elsewhere normals disagree


class Lids(NamedTuple):
    """Places that close the gaps of a cloud.

    Attributes
    ----------
    points : (m, 3) float64
        In the cloud's unit.
    normals : (m, 3) float64
        Unit vectors out of the body.
    """

    points: Points
    normals: Points


def lids_of(surface: OrientedCloud) -> Lids:
    """Return places that close the gaps of a surface, about as far apart as its points; none where there are no gaps.

    Parameters
    ----------
    surface : OrientedCloud
        With normals that agree.

    Returns
    -------
    Lids
    """
    tree = cKDTree(surface.points)
    spacings = spacings_from(tree.query(surface.points, min(NEIGHBOURS + 1, tree.n))[0] ** 2)
    usual = float(np.median(spacings))
    step = max(STEP * usual, float(np.sqrt(2 * (spacings**2).sum() / MOST)))
    found = marched(lambda places: INSIDE - surface.winding_numbers(places), surface.points, step, 4 * MOST)
    far, nearest = tree.query(found.vertices)
    share = far / np.maximum(spacings[nearest], usual)
    sure = found.vertices[share > WIDE]
    rest = np.flatnonzero((share > RIM) & (share <= WIDE)) if len(sure) else np.zeros(0, int)
    if len(sure):
        rest = rest[cKDTree(sure).query(found.vertices[rest])[0] < BESIDE * spacings[nearest[rest]]]
    places = np.concatenate([sure, found.vertices[rest]])
    slopes = _slopes(surface, places, step)
    size = np.linalg.norm(slopes, axis=1)
    clear = size * step > DROP
    return Lids(places[clear], slopes[clear] / size[clear][:, None])


def _slopes(surface: OrientedCloud, places: Points, step: float) -> Points:
    """Return minus the gradient of the winding number at places (m, 3), by differences half a step to each side."""
    shifts = step / 2 * np.concatenate([np.eye(3), -np.eye(3)])
    values = surface.winding_numbers((places[None] + shifts[:, None]).reshape(-1, 3)).reshape(6, -1)
    return np.asarray((values[3:] - values[:3]).T / step)
