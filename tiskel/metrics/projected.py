"""Beta as printed and as the skeleton evaluation toolbox computes it: triangles of a flat map of the sphere.

The unit vectors from a place to all points are put on the sinusoidal map (longitude times the cosine of latitude,
latitude), triangulated there (Delaunay), and what lies beyond the map's rim is closed by a strip of triangles from its
lowest corner up. Beta is the area of the flat triangles between the vectors as a share of the sphere's (Wen et al.
2025). The toolbox leaves out triangles that are far from the sphere although what they span is small: plane nearer to
the place than 0.8, and area times the squared mean distance of the three points below 1e-4, on a cloud whose longest
side is 1.6. Both see hollows that the convex hull of the vectors spans; both take a Delaunay triangulation a place.
"""

from typing import Literal

import numpy as np
from scipy.spatial import ConvexHull, Delaunay, QhullError

from tiskel.arrays import TINY, Lists, Numbers, Points, Table

SUNK = 0.8  # distance of a triangle's plane from the place, in units of the sphere [T]
SMALL = 1e-4  # true area of a triangle, in the squared unit of a cloud whose longest side is 1.6 [T]


def projected_betas(places: Points, cloud: Points, rule: Literal["print", "toolbox"]) -> Numbers:
    """Return (m,) beta of places (m, 3) in a cloud (n, 3), normalised to a longest side of 1.6.

    Examples
    --------
    From the middle of an octahedron's corners all of it is seen: eight triangles of half the root of 3.

    >>> corners = np.concatenate([np.eye(3), -np.eye(3)]) @ np.linalg.qr(np.random.default_rng(0).random((3, 3)))[0]
    >>> f"{projected_betas(np.zeros((1, 3)), corners, 'print')[0]:.6f} {3**0.5 / np.pi:.6f}"
    '0.551329 0.551329'
    """
    return np.array([_beta(cloud - place, rule == "toolbox") for place in places])


def _beta(offsets: Points, drop: bool) -> float:
    far = np.linalg.norm(offsets, axis=1)
    offsets, far = offsets[far > TINY], far[far > TINY]  # what is at the very place has no direction
    vectors = -offsets / far[:, None]  # towards the place, as the toolbox has them
    level = np.hypot(vectors[:, 0], vectors[:, 1])
    flat = np.stack([np.arctan2(vectors[:, 1], vectors[:, 0]) * level, np.arctan2(vectors[:, 2], level)], axis=1)
    try:
        triangles = np.concatenate([Delaunay(flat).simplices, _closing(flat)])
    except (QhullError, ValueError):
        return 0.0  # fewer than three directions, or all on a line of the map
    a, b, c = (vectors[triangles[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1) / 2
    if drop:
        planes = np.einsum("ij,ij->i", a, normals) / (2 * np.maximum(areas, TINY))
        areas[(planes < SUNK) & (far[triangles].mean(axis=1) ** 2 * areas < SMALL)] = 0
    return float(areas.sum() / (4 * np.pi))


def _closing(flat: Table) -> Lists:
    """Return the triangles (h - 2, 3) that close the rim of a map (n, 2), a strip from its lowest corner up."""
    rim = ConvexHull(flat).vertices  # against the clock
    count, height = len(rim), flat[ConvexHull(flat).vertices, 1]
    first = int(height.argmin())
    second = (first + 1) % count
    left, right = (first - 1) % count, (second + 1) % count
    strip = []
    for _ in range(count - 2):
        if height[left] > height[right]:
            third, right = right, (right + 1) % count
        else:
            third, left = left, (left - 1) % count
        strip.append((rim[first], rim[second], rim[third]))
        first, second = second, third
    return np.array(strip, np.int32).reshape(-1, 3)
