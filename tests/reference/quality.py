"""Plain implementations of what the quality kernels compute."""

import numpy as np
from scipy.spatial import ConvexHull

from tiskel.arrays import Numbers, Points

SECTIONS = {  #: keys of the parts of a document of measures, whatever was given
    "topology": {"bottleneck", "wasserstein", "bars", "threshold", "similar", "reasons"},
    "boundedness": {"points", "curve", "reasons"},
    "inside": {"points", "curve", "reasons"},
    "medialness": {"curve", "reasons"},
    "air": {"curve", "places", "reasons"},
    "centredness": {"points", "curve", "points_raw", "reasons"},
    "smoothness": {"points", "curve", "reasons"},
    "loops": {"surface", "solid", "graph", "reasons"},
    "graph": {"components", "loops", "ends", "joints", "length"},
}


def winding_number(query: Numbers, points: Points, dipoles: Points, softening: np.ndarray) -> float:
    """Return the sum of solid angles of softened patches, over 4 pi."""
    total = 0.0
    for p, dipole, soft in zip(points, dipoles, softening, strict=True):
        d = p - query
        total += d @ dipole / (d @ d + soft) ** 1.5
    return total / (4 * np.pi)


def hull_beta(place: Numbers, cloud: Points) -> float:
    """Return the area of the convex hull of all unit vectors from a place, as a share of the sphere's."""
    vectors = cloud - place
    return float(ConvexHull(vectors / np.linalg.norm(vectors, axis=1)[:, None]).area / (4 * np.pi))


def cell_of(d: Numbers, side: int) -> int:
    """Return the cell of a direction on the cube map."""
    axis = int(np.argmax(np.abs(d)))
    face = 2 * axis + (d[axis] < 0)
    column, row = (min(side - 1, int((d[(axis + k) % 3] / abs(d[axis]) + 1) * 0.5 * side)) for k in (1, 2))
    return int((face * side + row) * side + column)


def covered_cells(place: Numbers, cloud: Points, spacing: np.ndarray, side: int) -> set[int]:
    """Return the cells that meet the points' discs, each tried at its middle and, where it is wide, at eight more."""
    cells = set()
    for p, radius in zip(cloud, spacing, strict=True):
        d = p - place
        if not d.any():
            continue
        cells.add(cell_of(d, side))
        if radius**2 * side**2 > d @ d:
            helper = np.eye(3)[1 if abs(d[0]) > abs(d[1]) else 0]
            u = np.cross(d, helper)
            u /= np.linalg.norm(u)
            v = np.cross(d / np.linalg.norm(d), u)
            cells |= {cell_of(d + radius * (i * u + j * v), side) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    return cells
