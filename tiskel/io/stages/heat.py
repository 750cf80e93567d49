"""Measures as a cloud: skeletal points, then places on the curve, with their values as vertex properties."""

from typing import Any

import numpy as np

from tiskel.arrays import Mask, Numbers, Points, Table
from tiskel.io import ply
from tiskel.metrics.boundedness import Boundedness
from tiskel.metrics.places import CurveQuality, PointQuality
from tiskel.metrics.result import Quality

NAMES = ("of_curve", "beta", "bounded", "inside", "centredness", "smoothness", "in_air", "medialness")


def dump_heat(quality: Quality) -> bytes:
    """Return a PLY file that CloudCompare and MeshLab show in colours; NaN where a measure has no value.

    Its vertices are the skeletal points, then the samples and the vertices of the
    curve, in the input's units. Properties: of_curve (0 skeletal point, 1 sample
    of the curve, 2 vertex of the curve), beta, bounded, inside, centredness,
    smoothness, in_air, medialness; each also as scalar_NAME for CloudCompare, and
    beta as the quality of MeshLab.
    """
    parts = [_points(quality.points), *_curve(quality.curve)]
    places = np.concatenate([part[0] for part in parts])
    values = np.concatenate([part[1] for part in parts])
    known = dict(zip(NAMES, values.T.astype(np.float32), strict=True))
    columns: dict[str, Any] = {**ply.xyz(places), **known, **ply.scalars(known, "beta")}
    return ply.dump([ply.element("vertex", columns)], "metrics", {"params": ply.plain(quality.params)})


Part = tuple[Points, Table]


def _points(p: PointQuality | None) -> Part:
    if p is None:
        return np.zeros((0, 3)), np.zeros((0, len(NAMES)))
    return p.points, _columns(0, len(p.points), p.boundedness, p.inside, p.centredness, p.smoothness, None, None)


def _curve(c: CurveQuality | None) -> list[Part]:
    if c is None:
        return []
    samples = _columns(1, len(c.samples.points), c.boundedness, c.inside, c.centredness, None, c.in_air, c.medialness)
    vertices = _columns(2, len(c.vertices), None, None, None, c.smoothness, None, None)
    return [(c.samples.points, samples), (c.nodes[c.vertices], vertices)]


def _columns(kind: int, count: int, bounded: Boundedness | None, *more: Numbers | Mask | None) -> Table:
    measured = (None, None) if bounded is None else (bounded.beta, bounded.bounded)
    columns = [np.full(count, float(kind))]
    columns += [np.full(count, np.nan) if value is None else np.asarray(value, float) for value in (*measured, *more)]
    return np.stack(columns, axis=1)
