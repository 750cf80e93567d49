"""``view``: anything that has a place in space, on one page."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from tiskel.arrays import as_points
from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.graph import CurveGraph
from tiskel.io.anything import MeasureFile, MeshFile
from tiskel.io.clouds import Cloud
from tiskel.io.stages.path import RolledPath
from tiskel.io.streams import write_bytes
from tiskel.metrics.result import Quality
from tiskel.params import LookParams, Up
from tiskel.pipeline import PipelineResult
from tiskel.rolling.trajectory import Trajectory
from tiskel.shown import Brief
from tiskel.skeleton import Skeleton
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.viewer.curves import (
    cloud_layer,
    contracted_layer,
    curve_layers,
    property_fields,
    skeleton_layers,
)
from tiskel.viewer.frame import framed
from tiskel.viewer.measured import Measured, measured_by, measured_in
from tiskel.viewer.page import page
from tiskel.viewer.scene import Layer, Remark, Scene, scene_of
from tiskel.viewer.still import still
from tiskel.viewer.surfaces import mesh_layer, path_layer, path_of, surface_layers

SUFFIXES = (".html", ".htm", ".png", ".svg", ".pdf")


@dataclass(frozen=True, eq=False, repr=False)
class View(Brief):
    """Something to look at; a notebook shows it.

    Attributes
    ----------
    scene : Scene
        The layers, for whoever wants to draw them otherwise.

    Examples
    --------
    >>> from tiskel import make_shape, shape_graph, view
    >>> shown = view(make_shape(shape_graph("y"))[1])
    >>> [layer.name for layer in shown.scene.layers]
    ['cloud', 'curve', 'thickness']
    >>> shown.html().startswith("<!doctype html>")
    True
    """

    _said = ("scene.layers", "scene.remarks")

    scene: Scene

    def html(self) -> str:
        """Return one page that needs nothing else: no network, no other file."""
        return page(self.scene)

    def save(self, target: str | Path) -> None:
        """Write a page (.html) or a still picture (.png, .svg, .pdf); raise TiskelError for another suffix."""
        write_bytes(target, self.dump(Path(target).suffix or ".html"))

    def dump(self, suffix: str) -> bytes:
        """Return the bytes of a page (".html") or a picture (".png", ".svg", ".pdf")."""
        kind = suffix.lower()
        if kind not in SUFFIXES:
            raise TiskelError(f"a view cannot be written as {suffix!r}; choose one of {', '.join(SUFFIXES)}")
        return self.html().encode() if kind.startswith(".htm") else still(self.scene, kind[1:])

    def _repr_html_(self) -> str:
        return framed(self.html())


def view(*things: Any, up: Up = "auto", unit: str = "", title: str = "") -> View:
    """Return clouds, curves, surfaces and runs as something to look at: a page, or a picture.

    Parameters
    ----------
    *things
        Any of: an array (n, 3), Cloud, Contraction, Skeleton, CurveGraph, Quality, Surfaces, FittedSurface,
        Trajectory, PipelineResult, and lists of them.
    up : "auto", "x", "y" or "z"
        The axis that points up; auto: z, but y where the cloud stands on y = 0 and not on z = 0.
    unit : str
        What the unit of length is called.
    title : str
        What the page is called.

    Returns
    -------
    View

    Raises
    ------
    TiskelError
        For a thing that has no place in space, or where none is given.

    Examples
    --------
    >>> from tiskel import make_shape, shape_graph, view
    >>> cloud, true = make_shape(shape_graph("banana"))
    >>> view(cloud, unit="m").scene.unit
    'm'
    """
    look = LookParams(up=up, unit=unit)
    gathered = _Gathered()
    every = list(_flat(things))
    for thing in every:
        if isinstance(thing, (Quality, MeasureFile)):
            gathered.measured = _measured(thing)
    for thing in every:
        gathered.add(thing)
    if not gathered.layers:
        raise TiskelError("there is nothing to show; give a cloud, a curve, a surface or a run")
    return View(scene_of(title or gathered.title, _one_cloud(gathered.layers), gathered.remarks, gathered.said, look))


def _flat(things: Iterable[Any]) -> Iterable[Any]:
    """Yield things one by one, out of lists and results of a whole pipeline."""
    for thing in things:
        if isinstance(thing, PipelineResult):
            yield from _flat((thing.skeleton, thing.quality or (), thing.surfaces or (), thing.trajectories))
        elif isinstance(thing, Surfaces):
            yield thing
        elif isinstance(thing, (list, tuple)):
            yield from _flat(thing)
        else:
            yield thing


def _measured(thing: Quality | MeasureFile) -> Measured:
    return measured_by(thing) if isinstance(thing, Quality) else measured_in(thing.places, thing.columns)


def _one_cloud(layers: Sequence[Layer]) -> list[Layer]:
    """Return the layers with clouds of the same places once: the one that knows most about them."""
    kept: list[Layer] = []
    for layer in layers:
        same = [
            one for one in kept if layer.role == one.role == "cloud" and np.array_equal(layer.places, one.places)
        ]  # fmt: skip
        if not same:
            kept.append(layer)
        elif len(layer.fields) > len(same[0].fields):
            kept[kept.index(same[0])] = replace(layer, name=same[0].name)
    return kept


@dataclass
class _Gathered:
    """Layers of things, one after the other."""

    layers: list[Layer] = field(default_factory=list)
    remarks: list[Remark] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    measured: Measured | None = None
    title: str = ""

    def add(self, thing: Any) -> None:
        for kind, act in ADD.items():
            if isinstance(thing, kind):
                layers, said = act(self, thing)
                self.layers += layers
                if said and said not in self.said:
                    self.said.append(said)
                self.title = self.title or str(getattr(thing, "name", ""))
                return
        layer, said = cloud_layer("cloud", as_points(thing))
        self.layers.append(layer)
        self.said += [said] if said else []

    def remark(self, doubts: Iterable[CurveWarning]) -> None:
        for doubt in doubts:
            self.remarks.append(Remark(doubt.text, doubt.severity, np.reshape(np.array(doubt.places, float), (-1, 3))))


Added = tuple[list[Layer], str]


def _skeleton(g: _Gathered, s: Skeleton) -> Added:
    g.remark((*s.warnings, *s.notes))
    return skeleton_layers(s, g.measured)


def _cloud(g: _Gathered, c: Cloud) -> Added:
    layer, said = cloud_layer(c.name or "cloud", c.points, property_fields(c.properties))
    return [layer], said


def _contraction(g: _Gathered, c: Contraction) -> Added:
    cloud, said = cloud_layer("cloud", c.cloud)
    return [cloud, contracted_layer(c.points, shown=True)], said


def _mesh(g: _Gathered, m: MeshFile) -> Added:
    return [mesh_layer(m.name, m.points, m.faces)], ""


def _surfaces(g: _Gathered, surfaces: Surfaces) -> Added:
    layers, said = surface_layers(surfaces.surfaces)
    cloud, left_out = cloud_layer("cloud", surfaces.cloud)
    return [cloud, *layers], "; ".join(filter(None, (left_out, said)))


def _measures(g: _Gathered, q: Quality | MeasureFile) -> Added:
    """Return the skeletal points that were measured; the curve gets its measures where it is drawn."""
    m = _measured(q)
    known = any(layer.name == "contracted points" and layer.fields for layer in g.layers)
    return (
        [] if known or not len(m.points) else [replace(contracted_layer(m.points, m.of_points), name="measured points")]
    ), ""


def _run(g: _Gathered, run: Trajectory | RolledPath) -> Added:
    number = sum(layer.kind == "path" for layer in g.layers)
    return [path_layer(run if isinstance(run, RolledPath) else path_of(run), number)], ""


ADD: dict[Any, Any] = {
    Skeleton: _skeleton,
    CurveGraph: lambda g, c: (curve_layers(c, g.measured), ""),
    Cloud: _cloud,
    Contraction: _contraction,
    MeshFile: _mesh,
    Surfaces: _surfaces,
    FittedSurface: lambda g, s: surface_layers((s,)),
    (Quality, MeasureFile): _measures,
    (Trajectory, RolledPath): _run,
}
