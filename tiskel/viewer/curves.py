"""Layers of clouds and curves: points, contracted points, branches, their thickness, and what they measure."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Points
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.geometry.strays import body_rows
from tiskel.skeleton import Skeleton
from tiskel.viewer.measured import Measured
from tiskel.viewer.scene import Field, Layer

# By trial: what a graphics chip of a laptop draws without a pause, and 1.1 MB of a page with one property.
MOST_POINTS = 100_000
MOST_CONTRACTED = 20_000  # they lie on a curve, close together
WORTH = {  # of a radius, for a reader
    RadiusSource.UNKNOWN: "",
    RadiusSource.MEASURED: "measured: points about the curve determine it",
    RadiusSource.BOUNDED: "a bound: the body is thinner than its points can tell",
    RadiusSource.MODELLED: "modelled: no points here, taken from beside",
}
BODIES = {
    Regime.UNKNOWN: "",
    Regime.TUBE: "tube: points lie all about",
    Regime.SHEET: "sheet: one side was seen",
    Regime.WIRE: "wire: thinner than points are apart",
}
COLOURS = ("red", "green", "blue")
BYTE = 255  # colours of floats up to 1 are shares of it


def shown_rows(points: Points, most: int = MOST_POINTS) -> tuple[Indices, str]:
    """Return the rows of a cloud that are shown, and what there is to say about the others.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud; rows may be NaN or Inf.
    most : int
        How many are shown at most: of more a random part, the same each time.
    """
    rows = np.arange(len(points))
    said = []
    if len(points) > most:
        rows = np.sort(np.random.default_rng(0).choice(len(points), most, replace=False))
        said.append(f"{most:,} of {len(points):,} points are shown")
    body = body_rows(points[rows])
    if not body.all():
        said.append(f"{int((~body).sum())} stray points are not shown")
    return rows[body].astype(np.int32), "; ".join(said)


def cloud_layer(name: str, points: Points, fields: tuple[Field, ...] = ()) -> tuple[Layer, str]:
    """Return the layer of a cloud (n, 3), and what was left out."""
    rows, said = shown_rows(points)
    more = {} if len(rows) == len(points) else {"rows": rows.astype(np.uint32)}
    return Layer(name, "points", "cloud", points[rows], tuple(field.at(rows) for field in fields), more=more), said


def contracted_layer(points: Points, fields: tuple[Field, ...] = (), *, shown: bool = False) -> Layer:
    """Return the layer of contracted points (m, 3); of many a part."""
    rows = np.arange(len(points))[:: -(-len(points) // MOST_CONTRACTED) or 1]
    named = tuple(field.at(rows) for field in fields)
    return Layer("contracted points", "points", "points", points[rows], named, shown=shown)


def property_fields(properties: Mapping[str, npt.NDArray[Any]]) -> tuple[Field, ...]:
    """Return the properties of a cloud as fields, red, green and blue as one of colours."""
    plain = [
        Field(name, np.asarray(values, float)) for name, values in properties.items()
        if name not in COLOURS and np.ndim(values) == 1 and np.asarray(values).dtype.kind in "fiub"
    ]  # fmt: skip
    if not all(name in properties for name in COLOURS):
        return tuple(plain)
    colours = np.stack([np.asarray(properties[name], float) for name in COLOURS], axis=1)
    scale = BYTE if colours.max(initial=0) <= 1 else 1
    return (Field("colour of the input", np.clip(colours * scale, 0, BYTE).astype(np.uint8)), *plain)


def skeleton_layers(s: Skeleton, measured: Measured | None = None) -> tuple[list[Layer], str]:
    """Return the layers of a skeleton: cloud, contracted points, branches and their thickness."""
    branch, radius = s.branch_of_node(), s.radii
    owner = np.where(s.node_of_point < 0, 0, s.node_of_point)
    fields: tuple[Field, ...] = ()
    if len(s.nodes):
        fields = (_branches(branch[owner], len(s.branches)), _radius(radius[owner]))
    cloud, said = cloud_layer("cloud", s.cloud, fields)
    same = measured is not None and len(measured.points) == len(s.contracted)
    contracted = contracted_layer(s.contracted, measured.of_points if same and measured else ())
    return [cloud, *curve_layers(s, measured), contracted], said


def curve_layers(curve: CurveGraph, measured: Measured | None = None) -> list[Layer]:
    """Return the layers of a curve: its branches, their thickness where it is known, and bridges over gaps."""
    if len(curve.edges) == 0:
        return [Layer("nodes", "points", "points", curve.nodes)] if len(curve.nodes) else []
    branches = [branch for branch in curve.branches if len(branch) > 1]
    rows, counts = np.concatenate(branches), np.array([len(branch) for branch in branches], np.uint32)
    number = np.repeat(np.arange(len(branches)), counts)
    places, radii = curve.nodes[rows], curve.radii[rows]
    fields = [_branches(number, len(branches))]
    if np.isfinite(radii).any():
        fields.append(_radius(radii))
    fields += _sources(curve, rows)
    fields += _nearest(measured, places)
    degrees = curve.degrees[rows]
    knots = {"end": np.flatnonzero(degrees == 1), "joint": np.flatnonzero(degrees > 2)}
    more = {"edges": _pairs(counts), **{role: found.astype(np.uint32) for role, found in knots.items()}}
    made = [Layer("curve", "curve", "curve", places, tuple(fields), more=more)]
    if (np.nan_to_num(radii) > 0).any():
        thickness = {"radii": np.nan_to_num(radii).astype(np.float32), "counts": counts}
        made.append(Layer("thickness", "tube", "tube", places, tuple(fields[:2]), shown=False, more=thickness))
    return made + _bridges(curve)


def _pairs(counts: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint32]:
    """Return the neighbours along lines of so many vertices, one after the other."""
    stops = np.cumsum(counts)
    start = np.delete(np.arange(int(stops[-1])), stops - 1)
    return np.stack([start, start + 1], axis=1).astype(np.uint32)


def _branches(number: npt.NDArray[Any], count: int) -> Field:
    """Return the branch of every place; -1 is that of a joint, which has none of its own."""
    labels = (*map(str, range(count)), "")
    return Field("branch", np.where(number < 0, count, number), labels=labels)


def _radius(values: npt.NDArray[Any]) -> Field:
    return Field("radius", np.where(values > 0, values, np.nan), length=True)


def _sources(curve: CurveGraph, rows: Indices) -> list[Field]:
    """Return what radii are worth and what the body is like, where anybody said."""
    made = []
    for name, title, kind, words, numbers in (
        ("worth", "the radius is", RadiusSource, WORTH, curve.radius_sources),
        ("body", "the body is a", Regime, BODIES, curve.regimes),
    ):
        if (numbers > 0).any():
            labels = tuple(words[member] for member in kind)  # type: ignore[index]
            made.append(Field(name, np.minimum(numbers[rows], len(labels) - 1), title, labels))
    return made


def _nearest(measured: Measured | None, places: Points) -> list[Field]:
    """Return the measures of a curve at places on it: of the nearest place that was measured."""
    if measured is None:
        return []
    made = []
    for where, fields in measured.of_curve:
        if len(where):
            rows = cKDTree(where).query(places)[1]
            made += [field.at(rows) for field in fields]
    return made


def _bridges(curve: CurveGraph) -> list[Layer]:
    """Return the edges that were laid over gaps."""
    laid = curve.edges[curve.bridged]
    if len(laid) == 0:
        return []
    counts = np.full(len(laid), 2, np.uint32)
    return [Layer("bridges over gaps", "lines", "note", curve.nodes[laid.ravel()], more={"counts": counts})]
