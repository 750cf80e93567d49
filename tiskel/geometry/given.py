"""Clouds as functions are given them: arrays, clouds, and meshes, of this program and of others."""

from contextlib import suppress
from typing import Any

import numpy as np

from tiskel.arrays import Pairs, Points, PointsLike, as_points, finite_rows
from tiskel.errors import TiskelError
from tiskel.geometry.mesh_sample import sample_mesh
from tiskel.geometry.mesh_surface import MeshSurface

FACES = ("triangles", "regular_faces", "faces")  # what Open3D, PyVista and trimesh call them


def given_cloud(thing: PointsLike) -> tuple[Points, MeshSurface | None]:
    """Return the points of anything that has points; a mesh is sampled to some, as mesh files are.

    Parameters
    ----------
    thing : array_like, or an object with ``points`` or ``vertices``
        (n, 3) in any unit. An object that has (m, 3) ``faces`` or ``triangles`` besides, of trimesh, Open3D or
        PyVista, is a mesh.

    Returns
    -------
    points : (n, 3) float64
        In the unit of the thing.
    surface : MeshSurface or None
        What its mesh knows about each of them; None where there is none.

    Raises
    ------
    TiskelError
        For what has no points, and for a mesh without area.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from tiskel.geometry.given import given_cloud
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> given_cloud(SimpleNamespace(points=corners))[0].shape
    (4, 3)
    >>> mesh = SimpleNamespace(vertices=corners, faces=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> len(given_cloud(mesh)[0]) > 4000
    True
    """
    points, faces = as_points(thing), _faces(thing)
    if faces is None:
        known = getattr(thing, "surface", None)
        return points, known if isinstance(known, MeshSurface) else None
    if faces.min() < 0 or faces.max() >= len(points):
        raise TiskelError(f"a face of the mesh names vertex {faces.max()}, there are {len(points)}; repair the mesh")
    whole = finite_rows(points)[faces].all(axis=1)
    found = sample_mesh(np.where(np.isfinite(points), points, 0), faces[whole].astype(np.int32))
    return found.points, found.surface


def _faces(thing: Any) -> Pairs | None:
    """Return the triangles (m, 3) of a mesh; None where there are none."""
    for name in FACES:
        with suppress(ValueError):  # PyVista, where they are not triangles alone
            faces = np.asarray(getattr(thing, name, ()))
            if faces.ndim == 2 and faces.shape[1] == 3 and len(faces):
                return np.asarray(faces, np.int64)
    return None
