"""Meshes that Open3D reads; it is imported when one of them is met."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from tiskel.errors import TiskelError
from tiskel.io.formats.base import NO_FACES, Parsed

SYSTEM_PACKAGES = "libgl1 libegl1 libx11-6 libgomp1 libusb-1.0-0"


def open3d() -> Any:
    """Return the module.

    Raises
    ------
    TiskelError
        Where it cannot be imported; the message says what a bare server lacks.
    """
    try:
        import open3d as module
    except (ImportError, OSError) as error:
        raise TiskelError(
            f"this format needs Open3D, which cannot be imported ({error}); "
            f"install it (pip install open3d-cpu), on a bare server with its system packages ({SYSTEM_PACKAGES}), "
            "or convert the file to PLY, OBJ or OFF, which need none of it"
        ) from None
    return module


def read_mesh(data: bytes, name: str, suffix: str) -> Parsed:
    """Return the vertices and triangles of a mesh file.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.
    suffix : str
        With its dot: which kind it is.

    Raises
    ------
    TiskelError
        Where Open3D is missing, cannot read the file, or finds no points.
    """
    module = open3d()
    with tempfile.TemporaryDirectory() as folder:  # Open3D reads files only
        path = Path(folder) / f"mesh{suffix}"
        path.write_bytes(data)
        with module.utility.VerbosityContextManager(module.utility.VerbosityLevel.Error):
            mesh = module.io.read_triangle_mesh(str(path))
    points, faces = np.array(mesh.vertices, np.float64), np.array(mesh.triangles, np.int32)
    if len(points) == 0:
        raise TiskelError(f"{name} holds no points, or Open3D cannot read it as {suffix}; convert it to PLY")
    if len(faces) and (faces.min() < 0 or faces.max() >= len(points)):
        raise TiskelError(f"{name}: a face names vertex {faces.max()}, there are {len(points)}; export it again")
    return Parsed(points.reshape(-1, 3), faces.reshape(-1, 3) if len(faces) else NO_FACES)
