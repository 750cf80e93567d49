"""How much of a cloud and of its curve the fitted surfaces cover, and how far all its points are from them."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Mask, Numbers, Points
from tiskel.geometry.frames import step_lengths
from tiskel.slicing.fitted import Coverage, Surfaces
from tiskel.slicing.mesh import distances_to_mesh, joined_mesh, row_places, surface_mesh

NEAR = 0.05  # local radii from a surface within which a point counts as covered


def coverage_of(surfaces: Surfaces, body: Mask, nodes: Points, length: float) -> Coverage:
    """Return how much the surfaces of a skeleton cover.

    Parameters
    ----------
    surfaces : Surfaces
        The surfaces.
    body : (n,) bool
        Which points of their cloud are not stray.
    nodes : (m, 3) float64
        The nodes of the skeleton, in the input's unit.
    length : float
        The length of the whole curve.
    """
    off, relative = distances_to_surfaces(surfaces, surfaces.cloud[body])
    along = sum(float(step_lengths(nodes[s.nodes]).sum()) * len(s.sections) / sum(s.cases().values()) for s in surfaces)
    return Coverage(
        points=float((relative <= NEAR).mean()),
        length=along / length,
        distance={"mean": float(off.mean()), "p95": float(np.quantile(off, 0.95)), "max": float(off.max())},
        radii={"mean": float(relative.mean()), "p95": float(np.quantile(relative, 0.95)), "max": float(relative.max())},
    )


def distances_to_surfaces(surfaces: Surfaces, points: Points) -> tuple[Numbers, Numbers]:
    """Return how far points (p, 3) are from the surface nearest to each.

    Returns
    -------
    off : (p,) float64
        Distances, in the input's unit.
    relative : (p,) float64
        The same in local radii: the mean radius of the section there.

    Examples
    --------
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("tunnel"), ShapeParams(count=1000))
    >>> surfaces = fit_surface(true, SurfaceParams(interval=0.05))
    >>> off, relative = distances_to_surfaces(surfaces, cloud)
    >>> bool(abs(off / relative - 0.25).max() < 0.01)
    True
    """
    meshes = [surface_mesh(surface) for surface in surfaces]
    radii = [
        np.repeat(np.maximum(surface.tube.series.along(v)[:, 0, 0], 0), len(mesh.vertices) // len(v))
        for surface, mesh in zip(surfaces, meshes, strict=True)
        for v in [row_places(surface)]
    ]
    whole = joined_mesh(meshes)
    off = distances_to_mesh(points, whole)
    local = np.concatenate(radii)[cKDTree(whole.vertices).query(points)[1]]
    return off, off / np.maximum(local, np.finfo(float).tiny)
