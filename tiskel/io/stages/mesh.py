"""What a stage file keeps of the mesh that its points lie on."""

from typing import Any

import numpy as np

from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.io import ply
from tiskel.io.stages import door

NORMAL = ("nx", "ny", "nz")
LINKS = "surface_link"


def surface_columns(surface: MeshSurface | None) -> dict[str, Any]:
    """Return the columns of the points: normals and areas of the mesh, nothing without one."""
    return {} if surface is None else {**ply.xyz(surface.normals, NORMAL), "area": surface.areas}


def surface_elements(surface: MeshSurface | None) -> list[Any]:
    """Return the element of the links, by place in ``vertex``."""
    return [] if surface is None else [ply.element(LINKS, {"a": surface.links[:, 0], "b": surface.links[:, 1]})]


def surface_facts(surface: MeshSurface | None) -> dict[str, Any]:
    """Return what is true of the mesh as a whole."""
    return {} if surface is None else {"mesh": {"outward": surface.outward, "handles": surface.handles}}


def surface_from(file: Any, facts: Any) -> MeshSurface | None:
    """Return what a file says of the mesh, None where there was none.

    Raises ValueError where a link names a point that is not there.
    """
    if LINKS not in file:
        return None
    vertex, links = door.element(file, "vertex"), file[LINKS].data
    pairs = np.stack([door.whole(links, LINKS, name, len(vertex)) for name in "ab"], axis=1)
    handles = facts["mesh"]["handles"]
    known = None if handles is None else int(handles)
    areas = door.sizes(vertex, "vertex", "area")
    return MeshSurface(door.places(vertex, "vertex", NORMAL), areas, pairs, bool(facts["mesh"]["outward"]), known)
