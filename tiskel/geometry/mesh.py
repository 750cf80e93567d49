"""Points on a triangle mesh."""

import numpy as np

from tiskel.arrays import Edges, Points
from tiskel.errors import TiskelError


def sample_mesh(vertices: Points, faces: Edges, count: int, seed: int = 0) -> Points:
    """Return points on the triangles of a mesh, uniform by area.

    Parameters
    ----------
    vertices : (v, 3) float64
        In any unit.
    faces : (m, 3) int32
        The vertices of every triangle.
    count : int
        How many points.
    seed : int
        The same seed gives the same points.

    Returns
    -------
    (count, 3) float64
        In the unit of the vertices.

    Raises
    ------
    TiskelError
        Where the triangles have no area.
    """
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    areas = np.where(np.isfinite(areas), areas, 0)
    if areas.sum() == 0:
        raise TiskelError(f"the mesh of {len(faces)} triangles has no area; check its vertices")
    generator = np.random.default_rng(seed)
    chosen = generator.choice(len(faces), size=count, p=areas / areas.sum())
    # The square root makes the pair uniform on the triangle (Osada et al. 2002, equation 1).
    root, share = np.sqrt(generator.random((count, 1))), generator.random((count, 1))
    return (1 - root) * a[chosen] + root * (1 - share) * b[chosen] + root * share * c[chosen]
