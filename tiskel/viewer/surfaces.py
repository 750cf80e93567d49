"""Layers of fitted surfaces and of spheres that roll on them: slices, surface, paths."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tiskel.arrays import Points
from tiskel.io.stages.path import RolledPath
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface
from tiskel.slicing.mesh import slice_table
from tiskel.surfaces.tube import V_STOP
from tiskel.viewer.scene import Field, Layer

RING, AROUND = 48, 40  # corners of a slice, and of the surface around the curve
MOST_RINGS = 600  # slices that are shown; 48 corners of 6 bytes each are 230 kB of a page
PER_SLICE = 2  # rows of corners along the surface
MOST_ROWS = 2000  # of corners along all surfaces together
MOST_TIMES = 1200  # rows of a path that are kept


def surface_layers(surfaces: Sequence[FittedSurface]) -> tuple[list[Layer], str]:
    """Return the layers of surfaces, and what was left out."""
    slices, said = _slices(surfaces)
    return [_surface(surfaces), slices], said


def _slices(surfaces: Sequence[FittedSurface]) -> tuple[Layer, str]:
    """Return the rings where the surfaces were cut, with what they measure."""
    rings = [(s, row) for s in surfaces for row in slice_table(s)]
    kept = rings[:: -(-len(rings) // MOST_RINGS)]
    turn = np.linspace(0, 2 * np.pi, RING + 1)
    places = [np.stack(s.jet(turn, np.full(len(turn), row["v"])).f, axis=1) for s, row in kept]
    counts = np.full(len(kept), RING + 1, np.uint32)
    names = tuple(s.name for s in surfaces)
    cases = tuple(sorted({str(row["case"]) for _, row in kept}))

    def of(values: list[Any]) -> Any:
        return np.repeat(np.array(values), RING + 1)

    fields = (
        Field("branch", of([names.index(s.name) for s, _ in kept]), labels=names),
        Field("radius", of([row["equivalent_radius"] for _, row in kept]), length=True),
        Field("slice", of([cases.index(str(row["case"])) for _, row in kept]), "slice", cases),
        Field("misfit", of([np.nan if row["error"] is None else row["error"] for _, row in kept]), "misfit / radius"),
    )
    said = "" if len(kept) == len(rings) else f"{len(kept)} of {len(rings)} slices are shown"
    layer = Layer("slices", "lines", "slices", np.concatenate(places), fields, shown=False, more={"counts": counts})
    return layer, said


def _surface(surfaces: Sequence[FittedSurface]) -> Layer:
    """Return the surfaces as grids of corners, row by row along each."""
    every = sum(len(s.sections) for s in surfaces)
    per_slice = min(PER_SLICE, MOST_ROWS / max(every, 1))
    grids, places, radii, owner = [], [], [], []
    u = np.arange(AROUND) / AROUND * 2 * np.pi
    for number, s in enumerate(surfaces):
        closed = bool(s.tube.closed)
        rows = max(int(per_slice * len(s.sections)), 4)
        v = np.linspace(0, V_STOP, rows, endpoint=not closed)
        across, along = np.meshgrid(u, v)
        places.append(np.stack(s.jet(across, along).f, axis=-1).reshape(-1, 3))
        radii.append(s.tube.at(across.ravel(), along.ravel())[1].R)
        owner.append(np.full(rows * AROUND, number))
        grids.append([rows, AROUND, closed])
    names = tuple(s.name for s in surfaces)
    fields = (
        Field("branch", np.concatenate(owner), labels=names),
        Field("radius", np.concatenate(radii), "radius", length=True),
    )
    return Layer("surface", "mesh", "surface", np.concatenate(places), fields, shown=False, more={"grids": grids})


def mesh_layer(name: str, corners: Points, faces: Any) -> Layer:
    """Return the layer of a mesh of triangles."""
    return Layer(name, "mesh", "surface", corners, more={"triangles": np.asarray(faces, np.uint32).reshape(-1)})


def path_of(run: Trajectory) -> RolledPath:
    """Return what is shown of a run."""
    kind = "" if run.params.normals == "surface" else f"-{run.params.normals}"
    return RolledPath(f"{run.params.model}{kind}", run.t, run.contact, run.centre, run.orientation, run.radius)


def path_layer(path: RolledPath, number: int = 0) -> Layer:
    """Return the layer of a sphere that rolls; the first is shown."""
    rows = np.unique(np.linspace(0, len(path.t) - 1, min(MOST_TIMES, len(path.t))).astype(int))
    more = {
        "t": path.t[rows], "contact": path.contact[rows], "centre": path.centre[rows],
        "turns": path.orientation[rows], "radius": float(path.radius),
    }  # fmt: skip
    rim = [path.centre[rows] - path.radius, path.centre[rows] + path.radius]
    places = np.concatenate([path.contact[rows], *rim])
    return Layer(f"rolling sphere, {path.name}", "path", "path", places, shown=number == 0, more=more)
