"""Formats that only Open3D reads here; it is imported when one of them is met."""

from pathlib import Path
from typing import Any

import numpy as np

from tiskel.arrays import Indices, Points
from tiskel.errors import TiskelError

MESHES = (".off", ".obj", ".stl")
CLOUDS = (".pcd",)
SYSTEM_PACKAGES = "libgl1 libegl1 libx11-6 libgomp1 libusb-1.0-0"


def open3d() -> Any:
    """Return the module, or raise with what a bare server lacks."""
    try:
        import open3d as module
    except (ImportError, OSError) as error:
        raise TiskelError(
            f"this format needs Open3D, which cannot be imported ({error}); "
            f"install it (pip install open3d-cpu), on a bare server with its system packages ({SYSTEM_PACKAGES}), "
            "or convert the file to PLY, XYZ or NPY, which need none of it"
        ) from None
    return module


def read(path: Path, kind: str) -> tuple[Points, Indices]:
    """Return points and triangles, none of the latter for a cloud."""
    module = open3d()
    with module.utility.VerbosityContextManager(module.utility.VerbosityLevel.Error):
        if kind in CLOUDS:
            points, faces = np.asarray(module.io.read_point_cloud(str(path)).points), np.empty((0, 3), np.int32)
        else:
            mesh = module.io.read_triangle_mesh(str(path))
            points, faces = np.asarray(mesh.vertices), np.asarray(mesh.triangles, np.int32)
    if len(points) == 0:
        raise TiskelError(f"{path.name} holds no points, or Open3D cannot read it as {kind}")
    return np.array(points, np.float64), np.array(faces, np.int32)
