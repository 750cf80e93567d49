"""Measures of a skeleton as fields of places."""

from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Mask, Numbers, Points
from tiskel.metrics.result import Quality
from tiskel.viewer.scene import Field

SHARE = (0.0, 1.0)  # of all measures: from the worst to the best
TITLES = {
    "beta": "boundedness", "inside": "inside", "centredness": "centredness", "smoothness": "smoothness",
    "medialness": "medialness", "in_air": "in the air",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Measured:
    """What was measured, and where.

    Attributes
    ----------
    points : (m, 3) float64
        Skeletal points.
    of_points : tuple of Field
        Their measures.
    of_curve : tuple of ((q, 3) float64, tuple of Field)
        Places on the curve with their measures: samples, then vertices.
    """

    points: Points
    of_points: tuple[Field, ...]
    of_curve: tuple[tuple[Points, tuple[Field, ...]], ...]


def measure_field(name: str, values: Numbers | Mask) -> Field:
    """Return a measure as a field, named as files and tables have it."""
    return Field(name, np.asarray(values, float), TITLES.get(name, name), span=SHARE)


def measured_by(q: Quality) -> Measured:
    """Return the measures of a skeleton with their places."""
    points = np.zeros((0, 3))
    of_points: tuple[Field, ...] = ()
    if q.points is not None:
        p = q.points
        points = p.points
        of_points = _fields(
            beta=p.boundedness.beta, inside=p.inside, centredness=p.centredness, smoothness=p.smoothness
        )
    if q.curve is None:
        return Measured(points, of_points, ())
    c = q.curve
    samples = _fields(
        beta=c.boundedness.beta, inside=c.inside, centredness=c.centredness, medialness=c.medialness, in_air=c.in_air
    )
    vertices = (c.nodes[c.vertices], _fields(smoothness=c.smoothness))
    return Measured(points, of_points, ((c.samples.points, samples), vertices))


def _fields(**values: Numbers | Mask | None) -> tuple[Field, ...]:
    return tuple(measure_field(name, column) for name, column in values.items() if column is not None)


def measured_in(places: Points, columns: dict[str, Numbers]) -> Measured:
    """Return the measures that a file of them holds, see :func:`tiskel.io.stages.heat.dump_heat`.

    Parameters
    ----------
    places : (n, 3) float64
        Skeletal points, then samples, then vertices of the curve.
    columns : dict
        "of_curve", which says what a place is (0, 1 or 2), and the measures, NaN for none.
    """
    kind = columns["of_curve"]
    named = {name: column for name, column in columns.items() if name in TITLES}
    parts = []
    for number in range(3):
        rows = kind == number
        known = {name: column[rows] for name, column in named.items() if np.isfinite(column[rows]).any()}
        parts.append((places[rows], tuple(measure_field(name, column) for name, column in known.items())))
    return Measured(*parts[0], tuple(parts[1:]))
